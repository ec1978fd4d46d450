#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/response/buckling_signal.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::shear_stress_test {
namespace {

// A light cantilever of 0.5 m with a force across its tip and a torque about its axis: V and T are
// the same all along.

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
  return problem_from(fmt::format(
      R"j({{"scene": {{"gravity": [0, 0, 0],
    "materials": {{"light": {{"young": "200 GPa", "poisson": 0.3, "density": 1}}}},
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "elements": 2,
                         "material": "light", "section": {}}}}},
    "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{"y": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [0, 1, 0], "value": {}}},
              "z": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [0, 0, 1], "value": {}}},
              "t": {{"type": "torque", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0], "value": {}}}}}}},
  "effects": {{"geometric_stiffening": "off", "spatial_motion": "on"}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static", "newton_tolerance": 1e-13}},
  "variables": {{{}}},
  "responses": {{"tau": {{"type": "shear-stress", "body": "bar", "over_time": "max"}}}}}})j",
      section, loads.y, loads.z, loads.torque, variables_of(section)));
}

double stress_of(const std::string& section, const Loads& loads) {
  const ProblemFile problem = cantilever(section, loads);
  return analyze(problem, start_design(problem))->reductions[0].value;
}

const std::string rectangle =
    R"({"type": "rectangle", "width": {"variable": "a"}, "height": {"variable": "b"}})";
const std::string circle = R"({"type": "circle", "diameter": {"variable": "a"}})";
const std::string tube =
    R"({"type": "tube", "outer_diameter": {"variable": "a"}, "thickness": "2 mm"})";
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
    const AtStart start(cantilever(section, {.y = force, .z = 0.4 * force, .torque = torque}));
    const Eigen::VectorXd& x = start.x;
    const Eigen::VectorXd found =
        gradients(start.problem, x, *start.analysis, GradientMethod::direct).row(0);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const auto at = [&](double factor) {
        Eigen::VectorXd moved = x;
        moved(i) *= factor;
        return analyze(start.problem, moved)->reductions[0].value;
      };
      const double expected = (at(1.0 + 1e-4) - at(1.0 - 1e-4)) / (2e-4 * x(i));
      EXPECT_NEAR(found(i), expected, 1e-6 * start.analysis->reductions[0].value / x(i)) << section;
    }
  }
}

TEST(ShearStress, OfAGeneralSectionIsNotKnown) {
  EXPECT_THAT(thrown<InputError>([] {
                stress_of(R"({"type": "general", "area": 1e-4, "inertia_y": 1e-9, "inertia_z": 1e-9,
                              "torsion": 1e-9, "points": [{"y": 0.01, "z": 0, "shear": 0}]})",
                          {.y = force});
              }),
              HasSubstr("/responses/tau/body names a beam with a general section"));
}

// Stress of a beam where a load acts, which the mesh of the file need not know of, against beam
// theory: a simply supported beam of 1 m with everything at 400 mm.

constexpr double length = 1.0, width = 0.01, height = 0.02;
constexpr double a = 0.4, b = 0.6;  ///< from the load to either end
constexpr double modulus = width * height * height / 6.0, area = width * height;

/// @param gravity  along y [m/s²]
/// @param load     without its place
ProblemFile supported_beam(int elements, double gravity, const std::string& load) {
  return problem_from(fmt::format(
      R"({{"scene": {{
  "gravity": [0, {}, 0],
  "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [{{"variable": "length"}}, 0, 0],
    "material": "steel", "elements": {}, "frame": "chord",
    "section": {{"type": "rectangle", "width": "10 mm", "height": {{"variable": "height"}}}}}}}},
  "joints": {{
    "left": {{"type": "revolute", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
    "right": {{"type": "point-on-line", "bodies": ["ground", "beam"],
              "at": [{{"variable": "length"}}, 0, 0], "axis": [1, 0, 0]}}}},
  "loads": {{"load": {{"body": "beam", "at": [{{"variable": "length", "factor": 0.4}}, 0, 0], {}}}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "0.2 ms", "step": "0.1 ms", "initial_state": "quasi-static"}},
  "variables": {{"length": {{"start": 1, "lower": 0.5, "upper": 2}},
                "height": {{"start": "20 mm", "lower": "10 mm", "upper": "40 mm"}}}},
  "responses": {{"stress": {{"type": "stress", "body": "beam", "over_time": "final"}}}}}})",
      gravity, elements, load));
}

double bending_stress_of(const ProblemFile& problem) {
  return values_of(*analyze(problem, start_design(problem)))(0);
}

class Meshes : public testing::TestWithParam<int> {};

/// F a b/L + q a b/2; both parts have their largest moment where the force is, or next to it.
TEST_P(Meshes, GiveTheStressUnderAForce) {
  constexpr double force = 100.0, gravity = 9.81, density = 7850.0;
  const double moment = force * a * b / length + density * area * gravity * a * b / 2.0;
  const double stress = bending_stress_of(supported_beam(
      GetParam(), -gravity, R"("type": "force", "direction": [0, -1, 0], "value": "100 N")"));
  EXPECT_NEAR(stress, moment / modulus, 1e-6 * moment / modulus);
}

/// The moment jumps from −M a/L to M b/L.
TEST_P(Meshes, GiveTheStressBesideAMoment) {
  const double stress = bending_stress_of(supported_beam(
      GetParam(), 0.0, R"("type": "torque", "direction": [0, 0, 1], "value": "30 N m")"));
  EXPECT_NEAR(stress, 30.0 * b / length / modulus, 1e-6 * stress);
}

/// The axial force jumps from 600 N to zero; F a b/L of the bending force is on both sides.
TEST_P(Meshes, GiveTheStressBesideAnAxialForce) {
  const double stress = bending_stress_of(supported_beam(
      GetParam(), 0.0, R"("type": "force", "direction": [0.6, -0.8, 0], "value": "1000 N")"));
  const double expected = 600.0 / area + 800.0 * a * b / length / modulus;
  EXPECT_NEAR(stress, expected, 1e-6 * expected);
}

/// ∂(0.24 F L/W): the node at the load moves with the length.
TEST_P(Meshes, GiveTheGradient) {
  const auto [problem, x, analysis] = AtStart(supported_beam(
      GetParam(), 0.0, R"("type": "force", "direction": [0, -1, 0], "value": "100 N")"));
  const Eigen::MatrixXd gradient = direct_gradients(*analysis);
  const double stress = 100.0 * a * b / length / modulus;
  EXPECT_NEAR(gradient(0, 0), stress / length, 1e-6 * stress / length);
  EXPECT_NEAR(gradient(0, 1), -2.0 * stress / height, 1e-6 * 2.0 * stress / height);
}

/// 5 and 10 have a node there already.
INSTANTIATE_TEST_SUITE_P(Elements, Meshes, testing::Values(1, 2, 3, 4, 5, 7, 8, 10),
                         named_by_value());

constexpr double young = 2.1e11, shear_modulus = young / 2.6, density = 7850;
constexpr double span = 0.5, wide_area = 0.02, inertia = 7e-5, shear_area = 0.004;

/// A beam of 0.5 m along x in elastic equilibrium, so soft in shear that it counts.
std::unique_ptr<Analysis> analysis_of(const std::string& gravity, const std::string& joints,
                                      const std::vector<std::string>& responses) {
  std::string list;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    list += fmt::format(R"({}"r{}": {})", i == 0 ? "" : ", ", i, responses[i]);
  }
  const ProblemFile problem = problem_from(fmt::format(R"({{"scene": {{"gravity": {},
            "materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
            "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0],
              "material": "steel", "elements": 3, "shear": true,
              "section": {{"type": "general", "area": 0.02, "inertia_y": 7e-5, "inertia_z": 7e-5,
                "torsion": 1e-4, "shear_area_y": 0.004, "shear_area_z": 0.004,
                "points": [{{"y": 0.1, "z": 0, "shear": 0}}]}}}}}},
            "joints": {}}},
          "effects": {{"rotary_inertia": "off", "geometric_stiffening": "off"}},
          "simulation": {{"end_time": 2e-9, "step": 1e-9, "initial_state": "quasi-static"}},
          "responses": {{{}}}}})",
                                                       gravity, joints, list));
  return analyze(problem, start_design(problem));
}

std::string force_at(double share, const char* part) {
  return fmt::format(
      R"({{"type": "section-force", "body": "beam", "at": {}, "part": "{}", "over_time": "max-abs"}})",
      share, part);
}

double value(const Analysis& analysis, std::size_t response) {
  return std::abs(analysis.reductions[response].value);
}

/// Clamped at one end, on a roller at the other, under its weight q: the roller's force R holds
///     q L⁴/8EI + q L²/2κGA = R (L³/3EI + L/κGA)
TEST(ForcesOfAShearedBeam, HeldTwiceAreTimoshenkos) {
  const auto found = analysis_of(
      "[0, -9.81, 0]",
      R"({"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]},
          "roller": {"type": "point-on-line", "bodies": ["ground", "beam"], "at": [0.5, 0, 0],
                     "axis": [1, 0, 0]}})",
      {force_at(0.0, "moment-z"), force_at(0.6, "moment-z"), force_at(0.6, "shear-y"),
       R"({"type": "reaction-force", "joint": "roller", "direction": "y", "over_time": "max-abs"})"});
  const double q = 9.81 * density * wide_area, L = span;
  const double bending = 1 / (young * inertia), shear = 1 / (shear_modulus * shear_area);
  const double R = q * (std::pow(L, 4) / 8 * bending + L * L / 2 * shear) /
                   (std::pow(L, 3) / 3 * bending + L * shear);
  ASSERT_GT(R, 1.1 * 3 * q * L / 8);  // not that of a beam without shear
  const double rest = 0.4 * L;        // from the cut to the roller
  const double expected[] = {q * L * L / 2 - R * L, R * rest - q * rest * rest / 2, R - q * rest,
                             R};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(value(*found, i), std::abs(expected[i]), 1e-6 * R) << i;
  }
}

/// Turned with the acceleration α: M = ρAα (L³/3 − x L²/2 + x³/6), V = ρAα (L² − x²)/2. Loads that
/// grow along an element are held by moments that depend on shear, and the strain of its nodes is
/// without them.
TEST(ForcesOfAShearedBeam, UnderALoadThatGrowsAreThoseOfStatics) {
  const auto found = analysis_of(
      "[0, 0, 0]",
      R"({"hinge": {"type": "revolute", "bodies": ["ground", "beam"], "at": [0, 0, 0],
                    "axis": [0, 0, 1], "drive": {"type": "polynomial", "coefficients": [0, 0, 5]}}})",
      {force_at(0.0, "moment-z"), force_at(0.45, "moment-z"), force_at(0.45, "shear-y")});
  const double load = density * wide_area * 10.0, L = span, x = 0.45 * L;
  const double moment = load * (L * L * L / 3 - x * L * L / 2 + x * x * x / 6);
  EXPECT_NEAR(value(*found, 0), load * L * L * L / 3, 1e-6 * load);
  EXPECT_NEAR(value(*found, 1), moment, 1e-6 * load);
  EXPECT_NEAR(value(*found, 2), load * (L * L - x * x) / 2, 1e-6 * load);
}

/// Engesser: P/(1 + P/κGA), in both planes: the sides of a square may be different variables.
TEST(EulerLoad, OfAShearedBeamIsEngessers) {
  const auto found = analysis_of(
      "[0, 0, 0]", R"({"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}})",
      {R"({"type": "mass"})"});
  const double euler = std::pow(std::numbers::pi / span, 2) * young * inertia;
  const double expected = euler / (1 + euler / (shear_modulus * shear_area));
  const auto loads = euler_loads(found->model.body("beam"), 0);
  ASSERT_EQ(loads.size(), 2u);
  for (const DesignFactor& load : loads) EXPECT_NEAR(load.value, expected, 1e-12 * expected);
  EXPECT_LT(expected, 0.5 * euler);
}

/// Whatever its sides are now: a run of values alone is the same number as one with gradients.
TEST(EulerLoad, OfASquareIsTheSameWithGradientsAndWithout) {
  const ProblemFile problem = problem_from(R"({
    "scene": {"bodies": {"column": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
        "elements": 2, "section": {"type": "rectangle", "width": {"variable": "a"}, "height": {"variable": "b"}}}},
      "joints": {"foot": {"type": "fixed", "bodies": ["ground", "column"], "at": [0, 0, 0]}},
      "loads": {"press": {"type": "force", "body": "column", "at": [1, 0, 0], "direction": [-1, 0, 0],
                          "value": "0.7 kN"}}},
    "simulation": {"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"},
    "variables": {"a": {"start": "13 mm", "lower": "5 mm", "upper": "50 mm"},
                  "b": {"start": "13 mm", "lower": "5 mm", "upper": "50 mm"}},
    "responses": {"u": {"type": "buckling", "body": "column", "over_time": "max"}}})");
  const Eigen::VectorXd x = start_design(problem);
  const auto differentiated = analyze(problem, x), alone = analyze(problem, x, values_only);
  EXPECT_EQ(alone->reductions[0].value, differentiated->reductions[0].value);
  EXPECT_EQ(alone->histories[0], differentiated->histories[0]);
}

}  // namespace
}  // namespace pleuel::test::shear_stress_test
