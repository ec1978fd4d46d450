#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/trust/start_positions.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::open_positions_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Two arms of 0.2 m and 0.3 m in a row, both free to turn but for the motor between them, which
/// holds an angle at t = 0.
/// @param drawn  the angle that the file places the second arm at, in the plane
std::vector<Finding> findings_of_arms(double angle, double drawn,
                                      const char* first_joint = "revolute") {
  return findings_of(read_scene(fmt::format(
                         R"j({{"scene": {{"gravity": [0, 0, 0],
      "bodies": {{
        "upper": {{"type": "beam", "from": [0, 0, 0], "to": [0.2, 0, 0], "material": "steel",
                   "rigid": true, "elements": 1, "section": {{"type": "circle", "diameter": 0.02}}}},
        "lower": {{"type": "beam", "from": [0.2, 0, 0], "to": [{}, {}, 0], "material": "steel",
                   "rigid": true, "elements": 1, "section": {{"type": "circle", "diameter": 0.02}}}}}},
      "joints": {{
        "shoulder": {{"type": "{}", "bodies": ["ground", "upper"], "at": [0, 0, 0]}},
        "elbow": {{"type": "revolute", "bodies": ["upper", "lower"], "at": [0.2, 0, 0],
                   "drive": {{"type": "constant", "value": {}}}}}}}}},
    "simulation": {{"end_time": 0.01, "step": 0.001}},
    "responses": {{"m": {{"type": "mass"}}}}}})j",
                         0.2 + 0.3 * std::cos(drawn), 0.3 * std::sin(drawn), first_joint, angle)),
                     check_open_positions);
}

/// A motor that begins at 0.5 rad turns both arms by something; one that is held leaves nothing
/// open, and a motor that begins at 0 has nothing to turn (the angle of a joint is zero as it is
/// drawn).
TEST(OpenPositions, AreToldWhereAMotorTurnsWhatIsFree) {
  const std::vector<Finding> found = findings_of_arms(0.5, 0.0);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].text, HasSubstr("leave open where else"));
  EXPECT_THAT(findings_of_arms(0.0, 0.0), IsEmpty());
  EXPECT_THAT(findings_of_arms(0.0, 0.5), IsEmpty());
  EXPECT_THAT(findings_of_arms(0.5, 0.0, "fixed"), IsEmpty());
}

/// A mass that hangs from a carriage, or slides in a slot of it, need not come along as a motor puts the
/// carriage elsewhere: only what a joint leaves no other place does.
TEST(OpenPositions, AreToldOfAMassThatHangsFromACarriage) {
  const auto findings_of_mass = [](const char* joint) {
    return findings_of(read_scene(fmt::format(R"j({{"scene": {{"gravity": [0, -9.81, 0],
      "bodies": {{
        "carriage": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                     "inertia": [0.01, 0.01, 0.01, 0, 0, 0]}},
        "mass": {{"type": "point-mass", "at": [0, -0.3, 0], "mass": 1}}}},
      "joints": {{
        "rail": {{"type": "prismatic", "bodies": ["ground", "carriage"], "at": [0, 0, 0],
                 "axis": [1, 0, 0], "drive": {{"type": "polynomial", "coefficients": [0.1, 0.1]}}}},
        "hook": {{"bodies": ["carriage", "mass"], {}}}}}}},
    "simulation": {{"end_time": 0.01, "step": 0.001}},
    "responses": {{"m": {{"type": "mass"}}}}}})j",
                                              joint)),
                       check_open_positions);
  };
  const std::vector<Finding> rope =
      findings_of_mass(R"("type": "distance", "at": [0, 0, 0], "to": [0, -0.3, 0])");
  ASSERT_THAT(rope, SizeIs(1));
  EXPECT_THAT(rope[0].text, HasSubstr("\"mass\" begins 0.0"));
  EXPECT_THAT(findings_of_mass(R"("type": "point-on-line", "at": [0, -0.3, 0], "axis": [1, 1, 0])"),
              SizeIs(1));
  EXPECT_THAT(findings_of_mass(R"("type": "spherical", "at": [0, -0.3, 0])"), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::open_positions_test
