#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

namespace pleuel::test::size_test {
namespace {

/// The tip of a bent bar on a hinge with a spring, with a mass at its tip, over its length L, in
/// equilibrium with its loads. Materials stay, times go with L, accelerations with 1/L.
double tip_over_length(double length) {
  const double area = length * length, volume = area * length;
  const ProblemFile problem =
      read_problem_text(
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
                      0.5 * length, 20.0 * area, 100.0 * volume, 2e-4 * length, 1e-4 * length),
          "bar.json")
          .complete();
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

}  // namespace
}  // namespace pleuel::test::size_test
