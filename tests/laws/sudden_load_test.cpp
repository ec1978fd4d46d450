#include <cmath>

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/laws/law_gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/differences.hpp"

namespace pleuel::test::sudden_load_test {
namespace {

constexpr double young = 2.1e11, density = 7850, gravity = 9.81, width = 0.02, height = 0.03;
constexpr double stiffness = young * width * height * height * height / 12;  // E I
constexpr double weight = density * width * height * gravity;                // per length
constexpr double sag = -weight / (8 * stiffness);                            // length 1

const std::string sudden = R"({"type": "table", "times": [-1, 0],
                               "values": [0, {"variable": "force"}], "interpolation": "step"})";

TEST(QuasiStaticStart, IsInEquilibriumWithWhatActsBeforeIt) {
  const ProblemFile problem = loaded_cantilever(sudden, {"/simulation/end_time=0.6"});
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::MatrixXd& deflection = analysis->histories[0];
  EXPECT_NEAR(deflection(0, 0), sag, 1e-5 * std::abs(sag));
  // The first vibration has 25 periods a second and loses 40 % in each.
  const double loaded = sag - 50.0 / (3 * stiffness);
  EXPECT_NEAR(values_of(*analysis)(response_index(problem, "end")), loaded,
              0.02 * std::abs(loaded));
  // It swings beyond that, but not as far as without damping.
  const double lowest = values_of(*analysis)(response_index(problem, "sag"));
  EXPECT_LT(lowest, loaded + 0.5 * (loaded - sag));
  EXPECT_GT(lowest, loaded + 1.01 * (loaded - sag));
}

TEST(QuasiStaticStart, StaysWhereItIsUnderALoadThatActsAlready) {
  const ProblemFile problem = loaded_cantilever(
      R"({"type": "table", "times": [0, 1], "values": [{"variable": "force"}, {"variable": "force"}]})");
  const auto analysis = analyze(problem, start_design(problem));
  const double loaded = sag - 50.0 / (3 * stiffness);
  for (const char* name : {"sag", "end"}) {
    EXPECT_NEAR(values_of(*analysis)(response_index(problem, name)), loaded,
                1e-5 * std::abs(loaded));
  }
}

TEST(SuddenLoad, HasTheGradientOfItsSimulation) {
  for (const char* formulation : {"index-3", "stabilized-index-2", "index-1"}) {
    const ProblemFile problem =
        loaded_cantilever(sudden, {std::string("/simulation/formulation=") + formulation,
                                   "/simulation/newton_tolerance=1e-13"});
    const auto [direct, adjoint, expected] = law_gradients(problem);
    EXPECT_LE(relative_difference(adjoint, direct), 1e-10) << formulation;
    for (Eigen::Index i = 0; i < expected.rows(); ++i) {
      for (Eigen::Index j = 0; j < expected.cols(); ++j) {
        EXPECT_NEAR(direct(i, j), expected(i, j), 1e-6 * expected.row(i).norm())
            << formulation << " " << i << " " << j;
      }
    }
  }
}

TEST(DriveTable, RefusesToJump) {
  try {
    sample_problem("robot_arm", {"/scene/joints/turntable/drive/interpolation=step"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("would move a drive in no time"));
  }
}

/// Between two equal values a drive rests if its table does not say otherwise; a spline would go
/// further, as it does if it is asked for.
TEST(DriveTable, StaysBetweenItsValuesUnlessItIsASpline) {
  const auto farthest = [](const std::string& interpolation) {
    const ProblemFile problem = read_problem_text(
                                    R"({"scene": {
            "bodies": {"block": {"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                 "inertia": [1, 1, 1, 0, 0, 0]}},
            "joints": {"guide": {"type": "prismatic", "bodies": ["ground", "block"],
              "at": [0, 0, 0], "axis": [1, 0, 0], "drive": {"type": "table",
                "times": [0, 1, 2, 3], "values": [0, 0.1, 0.1, 0])" +
                                        interpolation + R"(}}}},
          "simulation": {"end_time": 3, "step": 0.02},
          "responses": {"x": {"type": "position", "body": "block", "direction": "x",
                              "over_time": "max"}}})",
                                    "block.json")
                                    .complete();
    return analyze(problem, start_design(problem))->reductions[0].value;
  };
  EXPECT_NEAR(farthest(""), 0.1, 1e-9);
  EXPECT_NEAR(farthest(R"(, "interpolation": "monotone")"), 0.1, 1e-9);
  EXPECT_GT(farthest(R"(, "interpolation": "spline")"), 0.105);
}

/// It began with 14 degrees a second.
TEST(DriveTable, OfTheRobotArmStartsAtRest) {
  for (const char* interpolation : {"spline", "monotone"}) {
    const ProblemFile problem = sample_problem(
        "robot_arm", {std::string("/scene/joints/turntable/drive/interpolation=") + interpolation,
                      "/simulation/end_time=10 ms"});
    const auto analysis = analyze(problem, start_design(problem));
    State start;
    analysis->trajectory.states->load(0, start);
    EXPECT_LE(start.v.lpNorm<Eigen::Infinity>(), 1e-12) << interpolation;
  }
}

}  // namespace
}  // namespace pleuel::test::sudden_load_test
