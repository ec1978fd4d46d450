/// A drive against dry friction, which turns round at its ends.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel::test::friction_reversal_test {
namespace {

/// 2 kg that go to and fro by 100 mm at 10 rad/s against 20 N.
double largest_force(double step, const std::string& over_time) {
  const ProblemFile problem =
      read_problem_text(
          fmt::format(
              R"j({{"scene": {{"bodies": {{"m": {{"type": "point-mass", "at": [0, 0, 0], "mass": 2}}}},
                "joints": {{"rail": {{"type": "point-on-line", "bodies": ["ground", "m"],
                  "at": [0, 0, 0], "axis": [1, 0, 0],
                  "drive": {{"type": "harmonic", "amplitude": 0.1, "frequency": "10 rad/s"}}}}}},
                "loads": {{"rub": {{"type": "joint", "joint": "rail",
                  "resistance": {{"type": "friction", "value": 20, "speed": "1 mm/s"}}}}}}}},
              "simulation": {{"end_time": 1.5, "step": {}}},
              "responses": {{"force": {{"type": "drive-force", "joint": "rail",
                                        "over_time": "{}"}}}}}})j",
              step, over_time),
          "rail.json")
          .complete();
  return analyze(problem, start_design(problem))->reductions[0].value;
}

/// m a + F = 2 · 0.1 · 10² + 20 N just before the ends; the last instant before misses (ω h)²/2 of
/// the inertia at most. A parabola through the samples beside would add up to 5 N with any step.
TEST(FrictionReversal, HasThePeakOfInertiaAndFriction) {
  for (const double step : {1e-2, 5e-3, 2e-3}) {
    const double missed = 20.0 * 0.5 * 100.0 * step * step + 0.01;
    EXPECT_NEAR(largest_force(step, "max"), 40.0, missed) << step;
    EXPECT_NEAR(largest_force(step, "min"), -40.0, missed) << step;
    EXPECT_NEAR(largest_force(step, "max-abs"), 40.0, missed) << step;
  }
}

}  // namespace
}  // namespace pleuel::test::friction_reversal_test
