#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/peak_problem.hpp"
#include "tests/support/parameter_name.hpp"

/// A limit on lateral buckling decides an optimum.
namespace pleuel::test::lateral_limit_test {
namespace {

constexpr double length = 1.2, height = 0.04, force = 10.0, young = 2.1e11, shear = 8.0e10,
                 density = 7850.0;

/// A flat bar on edge, clamped at one end, with a force across at the other.
ProblemFile flat_bar() {
  return read_problem_text(
             R"j({"scene": {
    "materials": {"steel": {"young": "210 GPa", "poisson": 0.3125, "density": 7850,
                            "strength": "235 MPa"}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1.2, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": {"variable": "b"}, "height": "40 mm"},
      "elements": 16}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {"f": {"type": "force", "body": "bar", "at": [1.2, 0, 0], "direction": [0, -1, 0],
                    "value": "10 N"}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static",
                 "resolution_check": false},
  "variables": {"b": {"start": "5 mm", "lower": "0.5 mm", "upper": "20 mm"}},
  "responses": {"mass": {"type": "mass"},
    "stress": {"type": "stress", "body": "bar", "part": "utilization", "over_time": "max"},
    "sideways": {"type": "lateral-buckling", "body": "bar", "over_time": "max"}},
  "objective": {"minimize": "mass"},
  "constraints": {"stress": {"response": "stress", "upper": 0.5},
                  "sideways": {"response": "sideways", "upper": 0.5}}})j",
             "flat_bar.json")
      .complete();
}

/// F/F_cr with F_cr = 4.0126 √(EI GJ)/L² (Timoshenko & Gere, §6.3), J = hb³/3 (1 − 0.63 b/h), over
/// √(1 − EI/EI_bending).
double closed_form(double b) {
  const double cube = height * b * b * b;
  const double lateral = young * cube / 12, twisting = shear * cube / 3 * (1 - 0.63 * b / height);
  const double held = std::sqrt(1 - b * b / (height * height));
  return force * held * length * length / (4.0126 * std::sqrt(lateral * twisting));
}

/// The share falls as b⁻³: an error of 1e-3 of sixteen elements is a third of that in b. Stress alone
/// would be content with 0.4 mm.
TEST(LateralLimit, SizesAFlatBar) {
  DesignProblem design(flat_bar());
  const Result result = solve_design(design, SolveOptions());
  EXPECT_EQ(result.status, Status::verified) << result.message;
  double low = 1e-4, high = 0.02;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (closed_form(middle) > 0.5 ? low : high) = middle;
  }
  EXPECT_NEAR(result.x(0) / low, 1.0, 1e-3);
  EXPECT_NEAR(result.evaluation.objective, density * height * result.x(0) * length, 1e-9);
  const double stress = force * length / (result.x(0) * height * height / 6);
  EXPECT_LT(stress, 0.5 * 235e6);
}

constexpr double strut_length = 1.0, press = 1e4;

/// A strut between a universal joint and a line, b wide along z and h high along y, with a limit on
/// its buckling. In space.
ProblemFile strut(const std::string& response, const std::string& over_time = "max") {
  return read_problem_text(
             R"j({"scene": {
    "materials": {"steel": {"young": "210 GPa", "poisson": 0.3125, "density": 7850}},
    "bodies": {"strut": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": {"variable": "b"}, "height": {"variable": "h"}},
      "elements": 8}},
    "joints": {
      "foot": {"type": "universal", "bodies": ["ground", "strut"], "at": [0, 0, 0],
               "axis": [0, 0, 1], "second_axis": [0, 1, 0]},
      "head": {"type": "point-on-line", "bodies": ["ground", "strut"], "at": [1, 0, 0],
               "axis": [1, 0, 0]}},
    "loads": {"press": {"type": "force", "body": "strut", "at": [1, 0, 0],
                        "direction": [-1, 0, 0], "value": "10 kN"}}},
  "effects": {"spatial_motion": "on", "geometric_stiffening": "off"},
  "simulation": {"end_time": "4 ms", "step": "1 ms", "initial_state": "quasi-static",
                 "resolution_check": false},
  "variables": {"b": {"start": "20 mm", "lower": "5 mm", "upper": "60 mm"},
                "h": {"start": "40 mm", "lower": "5 mm", "upper": "60 mm"}},
  "responses": {"mass": {"type": "mass"},
    "share": {"type": ")j" +
                 response + R"(", "body": "strut", "over_time": ")" + over_time + R"("}},
  "objective": {"minimize": "mass"},
  "constraints": {"share": {"response": "share", "upper": 0.5}}})",
             "strut.json")
      .complete();
}

/// P/P_E with P_E = π² E I/L², I = across thick³/12.
double euler_share(double thick, double across) {
  const double inertia = across * std::pow(thick, 3) / 12;
  return press * strut_length * strut_length /
         (std::numbers::pi * std::numbers::pi * young * inertia);
}

class BucklingInBothPlanes : public testing::TestWithParam<const char*> {};

/// Both shares ½, b³h = bh³: a square with a⁴ = 12 P L²/(½ π² E). The lightest one: below it, one of
/// the shares is larger.
TEST_P(BucklingInBothPlanes, MakesAStrutSquare) {
  const double side = 0.01 * std::pow(euler_share(0.01, 0.01) / 0.5, 0.25);
  for (const char* backend : {"nlopt-slsqp", "ipopt"}) {
    DesignProblem design(strut(GetParam()));
    const Result result = solve_design(design, {.backend = backend});
    EXPECT_EQ(result.status, Status::verified) << backend << ": " << result.message;
    EXPECT_NEAR(result.x(0) / side, 1.0, 2e-4) << backend;
    EXPECT_NEAR(result.x(1) / side, 1.0, 2e-4) << backend;
    EXPECT_NEAR(result.evaluation.objective / (density * side * side * strut_length), 1.0, 1e-4);
  }
}

/// One limit is a row for each plane and window; each has the share of its plane, with the slopes of
/// 1/(thick³ across).
TEST_P(BucklingInBothPlanes, AreRowsOfTheirOwn) {
  DesignProblem design(strut(GetParam()));
  const ResponseSettings& share = design.file().responses[1];
  EXPECT_EQ(place_count(design.file(), share), 2);
  PeakProblem peaks(design, 1);
  for (const Eigen::Vector2d& x :
       {Eigen::Vector2d(0.02, 0.03), Eigen::Vector2d(0.03, 0.02), Eigen::Vector2d(0.02, 0.02)}) {
    const Evaluation rows = peaks.evaluate(x, Request::values_and_gradients);
    ASSERT_EQ(rows.constraints.size(), 2);
    const double b = x(0), h = x(1), along_z = euler_share(b, h), along_y = euler_share(h, b);
    const bool is_z_first =
        std::abs(rows.constraint_jacobian(0, 0) * b) > std::abs(rows.constraint_jacobian(0, 1) * h);
    const Eigen::Index z = is_z_first ? 0 : 1, y = 1 - z;
    EXPECT_NEAR(rows.constraints(z) / along_z, 1.0, 1e-4);
    EXPECT_NEAR(rows.constraints(y) / along_y, 1.0, 1e-4);
    const Eigen::MatrixXd slopes = rows.constraint_jacobian * x.asDiagonal();
    EXPECT_LT((slopes.row(z) / along_z - Eigen::RowVector2d(-3, -1)).norm(), 1e-3);
    EXPECT_LT((slopes.row(y) / along_y - Eigen::RowVector2d(-1, -3)).norm(), 1e-3);
    for (Eigen::Index variable = 0; variable < 2; ++variable) {
      const Eigen::Vector2d step = 1e-4 * x(variable) * Eigen::Vector2d::Unit(variable);
      const Eigen::Vector2d difference = (peaks.evaluate(x + step, Request::values).constraints -
                                          peaks.evaluate(x - step, Request::values).constraints) /
                                         2e-4;
      EXPECT_LT((difference - slopes.col(variable)).norm(), 1e-6 * slopes.norm());
    }
  }
}

/// What is no peak is that of the weaker plane at each instant: here all the time the same.
TEST_P(BucklingInBothPlanes, CountByTheWorseAtEachInstant) {
  for (const char* over_time : {"max", "max-abs", "min", "mean", "rms", "final"}) {
    const ProblemFile file = strut(GetParam(), over_time);
    for (const Eigen::Vector2d& x : {Eigen::Vector2d(0.02, 0.03), Eigen::Vector2d(0.03, 0.02)}) {
      EXPECT_NEAR(analyze(file, x)->reductions[1].value / euler_share(0.02, 0.03), 1.0, 1e-4)
          << over_time;
    }
    const bool is_divided = std::string(over_time).starts_with("max");
    EXPECT_EQ(place_count(file, file.responses[1]), is_divided ? 2 : 1) << over_time;
  }
}

INSTANTIATE_TEST_SUITE_P(Responses, BucklingInBothPlanes,
                         testing::Values("lateral-buckling", "buckling"), named_by_value());

TEST(LateralLimit, HasOnePlaceInAPlane) {
  ProblemFile file = flat_bar();
  const ResponseSettings& sideways = file.responses[2];
  EXPECT_EQ(place_count(file, sideways), 1);
  file.effects.spatial_motion = EffectChoice::off;
  EXPECT_EQ(place_count(file, sideways), 1);
  file.effects.spatial_motion = EffectChoice::on;
  EXPECT_EQ(place_count(file, sideways), 2);
}

/// A round beam has one Euler load, but its ends may be held differently in both planes.
TEST(LateralLimit, OfARoundBeamHasPlacesByItsJointsOnly) {
  for (const auto& [response, places] :
       {std::pair("buckling", 1), std::pair("lateral-buckling", 2)}) {
    ProblemFile file = strut(response);
    std::get<BeamBody>(file.scene.bodies[0].shape).segments[0].section = CircleSection{0.02};
    EXPECT_EQ(place_count(file, file.responses[1]), places);
  }
}

}  // namespace
}  // namespace pleuel::test::lateral_limit_test
