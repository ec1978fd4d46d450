/// Axial forces of bent beams.

#include "core/trust/turned_sections.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/trust/doubts_of.hpp"

namespace pleuel::test::turned_sections_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A leaf of 1 m × 20 mm × 5 mm with a force of 8 N across its tip, which bends it by 61 mm, and
/// one along it.
std::vector<Doubt> doubts(double along, double place, int frames) {
  return doubts_of(
      read_scene(fmt::format(
          R"j({{"scene": {{"bodies": {{"leaf": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
              "material": "steel", "section": {{"type": "rectangle", "width": "20 mm", "height": "5 mm"}},
              "elements": 8, "frame": "tangent", "frames": {}}}}},
            "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "leaf"], "at": [0, 0, 0]}}}},
            "loads": {{"across": {{"type": "force", "body": "leaf", "at": [1, 0, 0],
                                   "direction": [0, 1, 0], "value": 8}},
                       "along": {{"type": "force", "body": "leaf", "at": [1, 0, 0],
                                  "direction": [1, 0, 0], "value": {}}}}}}},
          "simulation": {{"end_time": 1e-3, "step": 1e-4, "initial_state": "quasi-static"}},
          "responses": {{"pull": {{"type": "section-force", "body": "leaf", "at": {}, "part": "axial",
                                   "over_time": "max"}}}}}})j",
          frames, along, place)),
      doubt_turned_sections);
}

/// In its middle the section is turned by ¾ · P L²/(2 EI) = 0.07 rad, which makes 0.55 N of 8 N.
TEST(TurnedSections, AreDoubtedWhereShearIsMostOfTheAxialForce) {
  const std::vector<Doubt> found = doubts(0.0, 0.5, 1);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].text, HasSubstr("takes up to 0.55 N of the shear force of 8 N"));
}

TEST(TurnedSections, AreNotWhereTheBeamIsPulledIsClampedOrIsDivided) {
  EXPECT_THAT(doubts(100.0, 0.5, 1), IsEmpty());
  EXPECT_THAT(doubts(0.0, 0.0, 1), IsEmpty());
  EXPECT_THAT(doubts(0.0, 0.5, 8), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::turned_sections_test
