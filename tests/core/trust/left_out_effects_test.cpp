/// Stiffening that goes with axial elasticity.

#include "core/trust/left_out_effects.hpp"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/trust/doubts_of.hpp"

namespace pleuel::test::left_out_effects_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A pull of 200 N on a rod of 5 mm, 0.3 m long: of its Euler load π² E I/L² = 706 N, 28 %.
TEST(LostStiffening, IsADoubtWhereAxialForcesAreLarge) {
  const auto problem_with = [](double force) {
    return read_scene(fmt::format(
        R"({{"scene": {{"materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"rod": {{"type": "beam", "from": [0, 0, 0], "to": [0.3, 0, 0], "material": "m",
              "section": {{"type": "circle", "diameter": 0.005}}, "elements": 2, "frame": "chord"}}}},
          "joints": {{"a": {{"type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0]}},
                      "b": {{"type": "point-on-line", "bodies": ["ground", "rod"], "at": [0.3, 0, 0], "axis": [1, 0, 0]}}}},
          "loads": {{"pull": {{"type": "force", "body": "rod", "at": [0.3, 0, 0], "direction": [1, 0, 0], "value": {}}}}}}},
          "effects": {{"axial_elasticity": "off"}},
          "simulation": {{"end_time": 0.01, "step": 0.001}}}})",
        force));
  };
  EXPECT_THAT(doubts_of(problem_with(1.0), doubt_lost_stiffening), IsEmpty());
  // From one percent on.
  const double pi = 3.14159265358979, radius = 0.0025;
  const double euler = pi * pi * 2.1e11 * pi / 4 * std::pow(radius, 4) / (0.3 * 0.3);
  EXPECT_THAT(doubts_of(problem_with(0.0098 * euler), doubt_lost_stiffening), IsEmpty());
  EXPECT_THAT(doubts_of(problem_with(0.0102 * euler), doubt_lost_stiffening), SizeIs(1));
  const std::vector<Doubt> doubts = doubts_of(problem_with(200.0), doubt_lost_stiffening);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_TRUE(doubts[0].is_serious);
  EXPECT_THAT(doubts[0].text, HasSubstr("0.28 of its Euler load"));
}

}  // namespace
}  // namespace pleuel::test::left_out_effects_test
