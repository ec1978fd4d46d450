#include "core/response/whole_turns.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel::test::whole_turns_test {
namespace {

TEST(WholeTurns, AreAddedWhereAnAngleJumps) {
  Eigen::MatrixXd history(1, 400);
  for (int i = 0; i < 400; ++i) {
    const double angle = 20.0 * std::sin(0.02 * i);  // to and fro, three turns each way
    history(0, i) = std::remainder(angle, 2.0 * std::numbers::pi);
  }
  count_turns(history);
  for (int i = 0; i < 400; ++i) EXPECT_NEAR(history(0, i), 20.0 * std::sin(0.02 * i), 1e-12);
}

/// Two wheels on axes that differ, so that the motion is in space: 100 rad/s for 0.2 s.
TEST(WholeTurns, OfAJointCountInSpace) {
  const char* wheels = R"({
    "scene": {
      "bodies": {
        "one": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.02, 0.02, 0.02, 0, 0, 0],
                "angular_velocity": [0, 0, 100]},
        "two": {"type": "rigid", "at": [0, 1, 0], "mass": 2, "inertia": [0.02, 0.02, 0.02, 0, 0, 0],
                "angular_velocity": [10, 0, 0]}
      },
      "joints": {
        "first": {"type": "revolute", "bodies": ["ground", "one"], "at": [0, 0, 0], "axis": [0, 0, 1]},
        "second": {"type": "revolute", "bodies": ["ground", "two"], "at": [0, 1, 0], "axis": [1, 0, 0]}
      }
    },
    "simulation": {"end_time": 0.2, "step": "1 ms"},
    "responses": {
      "most": {"type": "joint-position", "joint": "first", "over_time": "max"},
      "mean": {"type": "joint-position", "joint": "first", "over_time": "mean"},
      "of_body": {"type": "angle", "body": "one", "direction": "z", "over_time": "final"}
    }
  })";
  const ProblemFile problem = read_problem_text(wheels, "wheels.json").complete();
  const Eigen::VectorXd values = values_of(*analyze(problem, start_design(problem)));
  EXPECT_NEAR(values(0), 20.0, 1e-6);
  EXPECT_NEAR(values(1), 10.0, 1e-6);
  EXPECT_NEAR(values(2), 20.0, 1e-6);
}

}  // namespace
}  // namespace pleuel::test::whole_turns_test
