#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

/// Machines that stand on springs and are shaken by a mass that turns in them.
namespace pleuel::test::unbalanced_machine_test {
namespace {

/// 10 kg on a post of 300 mm, with 0.5 kg on a shaft 50 mm beside its centre, in space.
ProblemFile shaken_post(double revolutions_per_minute) {
  return read_problem_text(fmt::format(R"j({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
      "post": {{"type": "beam", "from": [0, 0, 0], "to": [0, 0.3, 0], "material": "steel", "elements": 4,
        "section": {{"type": "rectangle", "width": "40 mm", "height": "6 mm"}}, "damping": {{"stiffness": "0.5 ms"}}}},
      "machine": {{"type": "rigid", "at": [0, 0.35, 0], "mass": 10, "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}},
      "unbalance": {{"type": "rigid", "at": [0.05, 0.35, 0], "mass": 0.5, "inertia": [1e-3, 1e-3, 1e-3, 0, 0, 0]}}}},
    "joints": {{
      "foot": {{"type": "fixed", "bodies": ["ground", "post"], "at": [0, 0, 0]}},
      "top": {{"type": "fixed", "bodies": ["post", "machine"], "at": [0, 0.3, 0]}},
      "motor": {{"type": "revolute", "bodies": ["machine", "unbalance"], "at": [0, 0.35, 0], "axis": [0, 0, 1],
                 "drive": {{"type": "constant-speed", "speed": "{} rpm"}}}}}}}},
  "effects": {{"spatial_motion": "on"}},
  "simulation": {{"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"}},
  "responses": {{"sway": {{"type": "position", "body": "machine", "direction": "x", "over_time": "max"}}}}}})j",
                                       revolutions_per_minute),
                           "post.json")
      .complete();
}

/// The lowest frequency is 4.7 Hz, 280 rpm. Above it a shaft would have to be held by gyroscopic forces;
/// the post does not turn. The force of the turning mass grows with the square of the speed, and the
/// sway with it.
TEST(UnbalancedMachine, DoesNotBuckleAboveItsResonance) {
  const auto sway = [](double speed) {
    const ProblemFile problem = shaken_post(speed);
    return values_of(*analyze(problem, start_design(problem)))(0);
  };
  EXPECT_NEAR(sway(600.0) / sway(200.0), 9.0, 0.05);
}

}  // namespace
}  // namespace pleuel::test::unbalanced_machine_test
