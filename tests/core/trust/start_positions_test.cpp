#include "core/trust/check_list.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::start_positions_test {
namespace {

// Velocities that the file gives.

/// A bar of 1 m on a hinge, whose frame is at its left end.
ProblemFile turning_bar(double hinge, const std::string& velocity) {
  return read_scene(fmt::format(
      R"({{"scene": {{"bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
          "material": "steel", "section": {{"type": "circle", "diameter": 0.03}}, "rigid": true,
          "elements": 1, "angular_velocity": [0, 0, 10], "velocity": {}}}}},
          "joints": {{"hinge": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [{}, 0, 0]}}}}}},
          "simulation": {{"end_time": 0.01, "step": 0.001}}}})",
      velocity, hinge));
}

/// About its middle the left end goes down with ω/2; at rest it is not.
TEST(InitialMotion, IsADoubtWhereJointsChangeWhatTheFileGives) {
  EXPECT_THAT(findings_of(turning_bar(0.0, "[0, 0, 0]"), check_initial_motion), IsEmpty());
  EXPECT_THAT(findings_of(turning_bar(0.5, "[0, -5, 0]"), check_initial_motion), IsEmpty());
  const Finding finding = only(findings_of(turning_bar(0.5, "[0, 0, 0]"), check_initial_motion));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("the initial angular velocity of \"bar\""));
  EXPECT_THAT(finding.text, HasSubstr("instead of the 10 rad/s of the file"));
  EXPECT_THAT(findings_of(turning_bar(0.0, "[0, 3, 0]"), check_initial_motion), SizeIs(1));
}

/// A slide that is turned by five degrees against the velocity leaves cos 5° of it, 0.4 % less, but
/// in another direction; by half a degree all of it, as nearly as it matters.
TEST(InitialMotion, InAnotherDirectionIsADoubt) {
  const auto findings = [](double angle) {
    return findings_of(
        read_scene(fmt::format(
            R"({{"scene": {{"bodies": {{"block": {{"type": "rigid", "at": [0, 0, 0], "mass": 1,
                "inertia": [1, 1, 1, 0, 0, 0], "velocity": [{:.12g}, {:.12g}, 0]}}}},
              "joints": {{"slide": {{"type": "prismatic", "bodies": ["ground", "block"],
                                     "at": [0, 0, 0], "axis": [1, 0, 0]}}}}}},
              "simulation": {{"end_time": 0.02, "step": 0.01}}}})",
            2.0 * std::cos(angle), 2.0 * std::sin(angle))),
        check_initial_motion);
  };
  const double degree = 3.14159265358979 / 180;
  EXPECT_THAT(findings(0.5 * degree), IsEmpty());
  const Finding turned = only(findings(5.0 * degree));
  EXPECT_THAT(turned.text, HasSubstr("in another direction instead of the 2 m/s"));
}

/// An elastic member begins without elastic rates, and takes the velocity of what it carries.
TEST(InitialMotion, OfAMassOnAnElasticMemberIsADoubt) {
  const Finding finding = only(findings_of(read_scene(
                                               R"({"scene": {"bodies": {
            "arm": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "steel",
                    "section": {"type": "circle", "diameter": 0.02}, "elements": 2},
            "mass": {"type": "point-mass", "at": [0.5, 0, 0], "mass": 10, "velocity": [0, 0.1, 0]}},
          "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]},
                     "tip": {"type": "spherical", "bodies": ["arm", "mass"], "at": [0.5, 0, 0]}}},
          "simulation": {"end_time": 0.01, "step": 0.001}})"),
                                           check_initial_motion));
  EXPECT_THAT(finding.text, HasSubstr("the initial velocity of \"mass\""));
}

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
  const Finding found = only(findings_of_arms(0.5, 0.0));
  EXPECT_TRUE(found.is_serious);
  EXPECT_THAT(found.text, HasSubstr("leave open where else"));
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
  const Finding rope =
      only(findings_of_mass(R"("type": "distance", "at": [0, 0, 0], "to": [0, -0.3, 0])"));
  EXPECT_THAT(rope.text, HasSubstr("\"mass\" begins 0.0"));
  EXPECT_THAT(findings_of_mass(R"("type": "point-on-line", "at": [0, -0.3, 0], "axis": [1, 1, 0])"),
              SizeIs(1));
  EXPECT_THAT(findings_of_mass(R"("type": "spherical", "at": [0, -0.3, 0])"), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::start_positions_test
