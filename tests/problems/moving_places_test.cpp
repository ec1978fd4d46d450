#include <cmath>

#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"

namespace pleuel::test::moving_places_test {
namespace {

/// Where two supports of a bar under its own weight bend it least: M over a support, q a²/2, is then M
/// in the middle, q L (L/4 − a)/2, so a = (√2 − 1) L/2.
TEST(MovingSupports, AreFoundWhereTheyBendLeast) {
  const ProblemFile problem = read_problem_text(R"({"scene": {"gravity": [0, "-9.81 m/s^2", 0],
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [2, 0, 0], "material": "steel", "elements": 8,
      "section": {"type": "rectangle", "width": "40 mm", "height": "20 mm"}}},
    "joints": {
      "left": {"type": "revolute", "bodies": ["ground", "bar"], "at": [{"variable": "a"}, 0, 0]},
      "right": {"type": "point-on-line", "bodies": ["ground", "bar"], "at": ["= 2 m - a", 0, 0],
                "axis": [1, 0, 0]}}},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"},
  "variables": {"a": {"start": "0.2 m", "lower": "0.05 m", "upper": "0.9 m"}},
  "responses": {"stress": {"type": "stress", "body": "bar", "over_time": "max"}},
  "objective": {"minimize": "stress"}})",
                                                "bar.json")
                                  .complete();
  DesignProblem design(problem);
  const Result result = solve_design(design, {});
  EXPECT_EQ(result.status, Status::verified);
  const double a = std::sqrt(2.0) - 1.0;
  EXPECT_NEAR(result.x(0), a, 1e-5);
  const double q = 7850 * 0.04 * 0.02 * 9.81;
  const double stress = 6 * (q * a * a / 2) / (0.04 * 0.02 * 0.02);
  EXPECT_NEAR(result.evaluation.objective, stress, 1e-4 * stress);
}

}  // namespace
}  // namespace pleuel::test::moving_places_test
