#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::size_test {
namespace {

/// The tip of a bent bar on a hinge with a spring, with a mass at its tip, over its length L, in
/// equilibrium with its loads. Materials stay, times go with L, accelerations with 1/L.
double tip_over_length(double length) {
  const double area = length * length, volume = area * length;
  const ProblemFile problem = problem_from(
      fmt::format(R"j({{"scene": {{"gravity": [0, {:.17g}, 0],
    "bodies": {{
      "bar": {{"type": "beam", "from": [0, 0, 0], "to": [{:.17g}, 0, 0], "material": "steel", "elements": 3,
        "frame": "chord", "section": {{"type": "rectangle", "width": {:.17g}, "height": {:.17g}}}}},
      "end": {{"type": "rigid", "at": [{:.17g}, 0, 0], "mass": {:.17g}, "inertia": [{:.17g}, {:.17g}, {:.17g}, 0, 0, 0]}}}},
    "joints": {{
      "hinge": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
      "weld": {{"type": "fixed", "bodies": ["bar", "end"], "at": [{:.17g}, 0, 0]}}}},
    "loads": {{
      "push": {{"type": "force", "body": "bar", "at": [{:.17g}, 0, 0], "direction": [0, 1, 0.3], "value": {:.17g}}},
      "coil": {{"type": "joint", "joint": "hinge", "stiffness": {:.17g}}}}}}},
  "simulation": {{"end_time": {:.17g}, "step": {:.17g}, "initial_state": "quasi-static"}},
  "responses": {{"y": {{"type": "position", "body": "end", "direction": "y", "over_time": "final"}}}}}})j",
                  -9.81 / length, length, 0.01 * length, 0.02 * length, length, 0.5 * volume,
                  1e-3 * volume * area, 1e-3 * volume * area, 1e-3 * volume * area, length,
                  0.5 * length, 20.0 * area, 100.0 * volume, 2e-4 * length, 1e-4 * length));
  return values_of(*analyze(problem, start_design(problem)))(0) / length;
}

/// From a centimetre to 100 m: forces and weights of the assembly are then up to 10¹³ apart. (The start
/// of free frames is less exact the larger they are: 1e-7 at 100 m.)
TEST(SizeOfAMechanism, DoesNotMatterToItsEquilibrium) {
  const double metre = tip_over_length(1.0);
  EXPECT_NEAR(tip_over_length(0.01), metre, 1e-9 * std::abs(metre));
  EXPECT_NEAR(tip_over_length(10.0), metre, 1e-8 * std::abs(metre));
  EXPECT_NEAR(tip_over_length(100.0), metre, 1e-6 * std::abs(metre));
}

/// Of kilometres it ended in "no elastic equilibrium was found".
TEST(SizeOfAMechanism, MayBeThatOfACity) {
  EXPECT_NEAR(tip_over_length(1000.0), tip_over_length(1.0), 2e-3 * std::abs(tip_over_length(1.0)));
}

// Machines that stand on springs and are shaken by a mass that turns in them.

/// 10 kg on a post of 300 mm, with 0.5 kg on a shaft 50 mm beside its centre, in space.
ProblemFile shaken_post(double revolutions_per_minute) {
  return problem_from(fmt::format(R"j({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
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
                                  revolutions_per_minute));
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
}  // namespace pleuel::test::size_test
