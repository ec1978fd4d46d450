#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"

/// A light cantilever of 0.5 m with a force across its tip and a torque about its axis: V and T are
/// the same all along.
namespace pleuel::test::shear_stress_test {
namespace {

constexpr double force = 5.0, torque = 0.2, pi = std::numbers::pi;

struct Loads {
  double y = 0.0, z = 0.0, torque = 0.0;
};

/// Those that a section names.
std::string variables_of(const std::string& section) {
  std::string variables;
  for (const auto& [name, start] : {std::pair("a", "20 mm"), {"b", "30 mm"}}) {
    if (section.find(fmt::format("\"{}\"", name)) == std::string::npos) continue;
    variables += fmt::format(R"({}"{}": {{"start": "{}", "lower": "5 mm", "upper": "50 mm"}})",
                             variables.empty() ? "" : ", ", name, start);
  }
  return variables;
}

ProblemFile cantilever(const std::string& section, const Loads& loads) {
  return read_problem_text(fmt::format(
                               R"j({{"scene": {{"gravity": [0, 0, 0],
    "materials": {{"light": {{"young": "200 GPa", "poisson": 0.3, "density": 1}}}},
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 2,
                         "material": "light", "section": {}}}}},
    "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{"y": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [0, 1, 0],
                      "value": {}}},
              "z": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [0, 0, 1],
                      "value": {}}},
              "t": {{"type": "torque", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
                     "value": {}}}}}}},
  "effects": {{"geometric_stiffening": "off", "spatial_motion": "on"}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static",
                  "newton_tolerance": 1e-13}},
  "variables": {{{}}},
  "responses": {{"tau": {{"type": "shear-stress", "body": "bar", "over_time": "max"}}}}}})j",
                               section, loads.y, loads.z, loads.torque, variables_of(section)),
                           "shear.json")
      .complete();
}

double stress_of(const std::string& section, const Loads& loads) {
  const ProblemFile problem = cantilever(section, loads);
  return analyze(problem, start_design(problem))->reductions[0].value;
}

const std::string rectangle =
    R"({"type": "rectangle", "width": {"variable": "a"}, "height": {"variable": "b"}})";
const std::string circle = R"({"type": "circle", "diameter": {"variable": "a"}})";
const std::string tube = R"({"type": "tube", "outer_diameter": {"variable": "a"},
                             "thickness": "2 mm"})";
const std::string ellipse =
    R"({"type": "ellipse", "width": {"variable": "a"}, "height": {"variable": "b"}})";
const std::string box = R"({"type": "box", "width": {"variable": "a"}, "height": {"variable": "b"},
                            "thickness": "2 mm"})";
const std::string i_beam = R"({"type": "i", "width": {"variable": "a"},
    "height": {"variable": "b"}, "flange_thickness": "3 mm", "web_thickness": "2 mm"})";

// 1e-6: the tip is bent by some 1e-4 rad against the axes of the force.
constexpr double tolerance = 1e-6;

void expect_ratio(double found, double expected) {
  EXPECT_NEAR(found / expected, 1.0, tolerance);
}

/// Gere & Timoshenko, Mechanics of Materials: 3/2 V/A, 4/3 V/A.
TEST(ShearStress, OfSolidSectionsIsThatOfTextbooks) {
  const double area = 0.02 * 0.03, round = pi * 0.01 * 0.01;
  expect_ratio(stress_of(rectangle, {.y = force}), 1.5 * force / area);
  expect_ratio(stress_of(rectangle, {.z = -force}), 1.5 * force / area);
  expect_ratio(stress_of(rectangle, {.y = 3 * force, .z = 4 * force}), 1.5 * 5 * force / area);
  expect_ratio(stress_of(circle, {.y = force}), 4.0 / 3.0 * force / round);
  expect_ratio(stress_of(circle, {.y = 3 * force, .z = 4 * force}), 4.0 / 3.0 * 5 * force / round);
  expect_ratio(stress_of(ellipse, {.z = force}), 4.0 / 3.0 * force / (pi * 0.01 * 0.015));
}

/// V Q/(I b) with Q = 2/3 (R³ − r³), I = π/4 (R⁴ − r⁴), b = 2 (R − r), for R = 10 mm, r = 8 mm.
TEST(ShearStress, OfATubeIsThatOfItsWall) {
  const double q = 2.0 / 3.0 * (1e-6 - 0.512e-6);
  const double i = pi / 4 * (1e-8 - 0.4096e-8);
  expect_ratio(stress_of(tube, {.y = force}), force * q / (i * 0.004));
}

/// Q by strips of half the section: flange b t (h − t)/2 and webs.
TEST(ShearStress, OfAWallIsThatOfHalfTheSection) {
  const double t = 0.002, b = 0.02, h = 0.03;
  const double half_web = h / 2 - t;
  const double q_box = b * t * (h - t) / 2 + 2 * t * half_web * half_web / 2;
  const double i_box = (b * std::pow(h, 3) - (b - 2 * t) * std::pow(h - 2 * t, 3)) / 12;
  expect_ratio(stress_of(box, {.y = force}), force * q_box / (i_box * 2 * t));
  const double f = 0.003, half_i = h / 2 - f;
  const double q_i = b * f * (h - f) / 2 + t * half_i * half_i / 2;
  const double i_i = (b * std::pow(h, 3) - (b - t) * std::pow(h - 2 * f, 3)) / 12;
  expect_ratio(stress_of(i_beam, {.y = force}), force * q_i / (i_i * t));
  // Across: each flange is a rectangle 20 mm wide, with the web in its middle.
  const double i_across = (2 * f * std::pow(b, 3) + (h - 2 * f) * std::pow(t, 3)) / 12;
  expect_ratio(stress_of(i_beam, {.z = force}), force * b * b / 8 / i_across);
}

/// A square tube whose shear force is along its diagonal: shear flow of both parts adds up to the
/// corner, where each has t a²/4 of I/2 in the mean line (thin walls: 2 %).
TEST(ShearStress, OfABoxIsLargestAtTheCornerUnderADiagonalForce) {
  const std::string square =
      R"({"type": "box", "width": "30 mm", "height": "30 mm", "thickness": "0.5 mm"})";
  const double a = 0.0295, t = 0.5e-3, i = 2.0 / 3.0 * t * a * a * a;
  EXPECT_NEAR(stress_of(square, {.y = force, .z = force}) / (2 * force * a * a / 4 / i), 1.0, 0.02);
}

/// T r/J on the side where both add: 16 T/(π d³) and 4/3 V/A.
TEST(ShearStress, AddsThatOfTorsion) {
  const double d = 0.02, area = pi * d * d / 4;
  expect_ratio(stress_of(circle, {.torque = torque}), 16 * torque / (pi * d * d * d));
  expect_ratio(stress_of(circle, {.y = force, .torque = -torque}),
               4.0 / 3.0 * force / area + 16 * torque / (pi * d * d * d));
  // Timoshenko & Goodier, §109: τ = T/(0.231 a b²) of sides 1.5:1.
  EXPECT_NEAR(stress_of(rectangle, {.y = force, .torque = torque}) /
                  (1.5 * force / (0.02 * 0.03) + torque / (0.231 * 0.03 * 0.02 * 0.02)),
              1.0, 1e-3);
}

/// Central differences of simulated designs, 1e-4 of a variable: errors of 1e-7.
TEST(ShearStress, HasTheGradientOfDifferences) {
  for (const std::string& section : {rectangle, circle, tube, ellipse, box, i_beam}) {
    const ProblemFile problem =
        cantilever(section, {.y = force, .z = 0.4 * force, .torque = torque});
    const Eigen::VectorXd x = start_design(problem);
    const auto analysis = analyze(problem, x);
    const Eigen::VectorXd found = gradients(problem, x, *analysis, GradientMethod::direct).row(0);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const auto at = [&](double factor) {
        Eigen::VectorXd moved = x;
        moved(i) *= factor;
        return analyze(problem, moved)->reductions[0].value;
      };
      const double expected = (at(1.0 + 1e-4) - at(1.0 - 1e-4)) / (2e-4 * x(i));
      EXPECT_NEAR(found(i), expected, 1e-6 * analysis->reductions[0].value / x(i)) << section;
    }
  }
}

TEST(ShearStress, OfAGeneralSectionIsNotKnown) {
  try {
    stress_of(R"({"type": "general", "area": 1e-4, "inertia_y": 1e-9, "inertia_z": 1e-9,
                  "torsion": 1e-9, "points": [{"y": 0.01, "z": 0, "shear": 0}]})",
              {.y = force});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("/responses/tau/body names a beam with a general "
                        "section"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pleuel::test::shear_stress_test
