#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/trust/joint_findings.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::undetermined_reactions_test {
namespace {

using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// A shaft along x in two bearings, 100 mm apart, with a pull along y beyond the second one.
std::vector<Finding> findings(const std::string& first, const std::string& second) {
  const ProblemFile shaft = read_scene(fmt::format(
      R"({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
            "shaft": {{"type": "rigid", "at": [0.05, 0, 0], "mass": 1,
                       "inertia": [1e-3, 2e-3, 2e-3, 0, 0, 0]}}}},
          "joints": {{"one": {}, "other": {}}},
          "loads": {{"belt": {{"type": "force", "body": "shaft", "at": [0.13, 0, 0],
                               "direction": [0, 1, 0], "value": 500}}}}}},
          "simulation": {{"end_time": 0.01, "step": 0.001}},
          "responses": {{
            "one": {{"type": "reaction-force", "joint": "one", "direction": "y",
                     "over_time": "final"}},
            "other": {{"type": "reaction-force", "joint": "other", "direction": "y",
                       "over_time": "final"}},
            "speed": {{"type": "angular-velocity", "body": "shaft", "direction": "x",
                       "over_time": "max-abs"}}}}}})",
      first, second));
  return findings_of(shaft, check_undetermined_reactions);
}

std::string bearing(const std::string& type, double at) {
  const std::string axis = type == "spherical" ? "" : R"(, "axis": [1, 0, 0])";
  return fmt::format(R"({{"type": "{}", "bodies": ["ground", "shaft"], "at": [{}, 0, 0]{}}})", type,
                     at, axis);
}

/// Two hinges hold the tilt of the shaft twice: 650 and −150 N follow only where each holds forces
/// alone.
TEST(UndeterminedReactions, OfTwoHingesAreTold) {
  const std::vector<Finding> found = findings(bearing("revolute", 0.1), bearing("revolute", 0.0));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("one", "other"));
  EXPECT_FALSE(found[0].is_serious);
  // Nor where only one of them holds the tilt, and the other one the way of its end.
  EXPECT_THAT(findings(bearing("revolute", 0.1), bearing("spherical", 0.0)), SizeIs(1));
}

TEST(UndeterminedReactions, AreNoneOfBearingsThatHoldForces) {
  EXPECT_THAT(findings(bearing("point-on-line", 0.1), bearing("spherical", 0.0)), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::undetermined_reactions_test
