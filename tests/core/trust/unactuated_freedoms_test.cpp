#include "core/trust/check_list.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::unactuated_freedoms_test {
namespace {

// DegreesOfFreedom that nothing moves, and bodies that nothing holds.

TEST(IdleFreedoms, AreNotInADrivenMechanism) {
  EXPECT_THAT(findings_of(read_scene(crank_rocker(driven, closed)), check_unactuated_freedoms),
              IsEmpty());
}

TEST(IdleFreedoms, OfAForgottenDriveAreNamedByBody) {
  const Finding finding =
      only(findings_of(read_scene(crank_rocker("", closed)), check_unactuated_freedoms));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text,
              HasSubstr("\"crank\", \"coupler\", \"rocker\" can move freely (one free motion)"));
  EXPECT_THAT(finding.text, HasSubstr("nothing moves there"));
  EXPECT_THAT(finding.responses, ElementsAre("v"));
}

TEST(IdleFreedoms, OfAForgottenJointAreNamedByBody) {
  const Finding finding =
      only(findings_of(read_scene(crank_rocker(driven, "")), check_unactuated_freedoms));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr("\"coupler\", \"rocker\" can move freely (2 free motions)"));
  EXPECT_THAT(finding.text, HasSubstr("only the inertia"));
}

/// With weight what a forgotten joint leaves hangs on the crank, which may be meant; with friction it is.
TEST(IdleFreedoms, ThatHangBesideADriveAreMentioned) {
  const std::string weight = "[0, -9.81, 0]";
  const Finding finding =
      only(findings_of(read_scene(crank_rocker(driven, "", weight)), check_unactuated_freedoms));
  EXPECT_FALSE(finding.is_serious);
  EXPECT_THAT(finding.text,
              HasSubstr("beside the drives \"coupler\", \"rocker\" can move freely (2 "
                        "free motions), with nothing but weight that acts on them"));
  EXPECT_THAT(
      findings_of(read_scene(crank_rocker(driven, closed, weight)), check_unactuated_freedoms),
      IsEmpty());
  const std::string friction =
      R"(/scene/loads={"b": {"type": "joint", "joint": "B", "damping": 0.1},
                       "c": {"type": "joint", "joint": "C", "damping": 0.1}})";
  EXPECT_THAT(findings_of(read_scene(crank_rocker(driven, "", weight), {friction}),
                          check_unactuated_freedoms),
              IsEmpty());
}

/// Weight, a spring, a damper or a motor, a push, a start that moves: all of these are meant.
TEST(IdleFreedoms, AreNotWhereSomethingActs) {
  const auto load = [](const std::string& text) { return "/scene/loads={\"load\": " + text + "}"; };
  const std::string crank_joint = R"("type": "joint", "joint": "A")";
  for (
      const std::string& override_text :
      {std::string("/scene/gravity=[0, -9.81, 0]"),
       std::string("/scene/bodies/crank/angular_velocity=[0, 0, 3]"),
       load(
           R"({"type": "force", "body": "rocker", "at": [0.4, 0.2, 0], "direction": [1, 0, 0], "value": 1})"),
       load(R"({"type": "force", "body": "rocker", "at": [0.4, 0.2, 0], "direction": [1, 0, 0],
                 "value": {"type": "table", "times": [0, 0.01, 0.02], "values": [0, 1, 0]}})"),
       load(R"({"type": "spring", "bodies": ["ground", "rocker"],
                 "at": [[0.5, 0.2, 0], [0.4, 0.2, 0]], "stiffness": 100})")}) {
    EXPECT_THAT(findings_of(read_scene(crank_rocker("", closed), {override_text}),
                            check_unactuated_freedoms),
                IsEmpty())
        << override_text;
  }
}

/// Links that hang on a driven crank, so many that a basis of their motions would take longer than to
/// simulate them: each is free to turn.
TEST(IdleFreedoms, OfALongChainAreCounted) {
  constexpr int links = 120;
  std::string bodies = R"("crank": {"type": "rigid", "at": [0, 0, 0], "mass": 1,
                                    "inertia": [0.1, 0.1, 0.1, 0, 0, 0]})",
              joints = R"("A": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                                "drive": {"type": "constant-speed", "speed": 1}})",
              last = "crank";
  for (int i = 0; i < links; ++i) {
    bodies += fmt::format(R"(, "b{}": {{"type": "rigid", "at": [{}, 0, 0], "mass": 1,
                                        "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}})",
                          i, i + 1.5);
    joints += fmt::format(
        R"(, "j{0}": {{"type": "revolute", "bodies": ["{1}", "b{0}"], "at": [{2}, 0, 0]}})", i,
        last, i + 1);
    last = fmt::format("b{}", i);
  }
  const ProblemFile problem = problem_from(fmt::format(
      R"({{"scene": {{"gravity": [0, -9.81, 0], "bodies": {{{}}}, "joints": {{{}}}}},
                       "simulation": {{"end_time": 2e-3, "step": 1e-3}}, "responses": {{}}}})",
      bodies, joints));
  const Finding finding = only(findings_of(problem, check_unactuated_freedoms));
  EXPECT_THAT(finding.text, HasSubstr("(120 free motions)"));
  EXPECT_THAT(finding.bodies, SizeIs(links));
}

TEST(IdleFreedoms, AreNotInTheProblemsOfTheHouse) {
  for (const char* name :
       {"spatial_slider_crank", "robot_arm", "four_bar", "hard/dead_centres", "hard/free_vibration",
        "hard/bricard", "hard/flyball_governor", "hard/squeezer", "hard/change_point"}) {
    ProblemFile problem = sample_problem(name);
    EXPECT_THAT(check_proportions_before(problem, start_design(problem)), IsEmpty()) << name;
    problem.simulation.end_time = 2.0 * problem.simulation.step;
    problem.responses.clear();
    for (const FindChecks find :
         {check_unactuated_freedoms, check_unconnected_bodies, check_misaligned_joints}) {
      EXPECT_THAT(findings_of(problem, find), IsEmpty()) << name;
    }
  }
}

/// The spin of a rod between ball joints does nothing.
TEST(IdleFreedoms, AreNotTheSpinOfARodBetweenBallJoints) {
  ProblemFile problem = sample_problem("spatial_slider_crank", {"/simulation/end_time=2 ms"});
  for (Joint& joint : problem.scene.joints) {
    if (joint.name == "slider_pin") joint.type = JointType::spherical;
  }
  EXPECT_THAT(findings_of(problem, check_unactuated_freedoms), IsEmpty());
}

TEST(UnconnectedBodies, AreNamed) {
  const auto stray_with = [](const std::string& more) {
    return R"(/scene/bodies/stray={"type": "point-mass", "at": [0.2, 0.3, 0], "mass": 1)" + more +
           "}";
  };
  const std::string stray = stray_with("");
  const std::string other =
      R"(/scene/bodies/other={"type": "point-mass", "at": [0.3, 0.3, 0], "mass": 1})";
  const std::string tie =
      R"(/scene/joints/tie={"type": "distance", "bodies": ["stray", "other"], "at": [0.2, 0.3, 0], "to": [0.3, 0.3, 0]})";
  const Finding still = only(findings_of(
      read_scene(crank_rocker(driven, closed), {stray, other, tie}), check_unconnected_bodies));
  EXPECT_THAT(still.text, HasSubstr("connects \"stray\", \"other\" with the ground"));
  EXPECT_FALSE(still.is_serious) << "no response looks at it";
  const Finding falling = only(findings_of(
      read_scene(crank_rocker(driven, closed, "[0, -9.81, 0]"),
                 {stray, other, tie, R"(/responses/y={"type": "position", "body": "stray",
                                 "direction": "y", "over_time": "final"})"}),
      check_unconnected_bodies));
  EXPECT_TRUE(falling.is_serious);
  const Finding pushed = only(findings_of(
      read_scene(crank_rocker(driven, closed),
                 {stray, other, tie, R"(/responses/y={"type": "position", "body": "stray",
                                 "direction": "y", "over_time": "final"})",
                  R"(/scene/loads={"push": {"type": "force", "body": "stray", "at": [0.2, 0.3, 0],
                                   "direction": [1, 0, 0], "value": 1}})"}),
      check_unconnected_bodies));
  EXPECT_FALSE(pushed.is_serious) << "it may be meant to fly";
  // A mechanism that is free as a whole, for its vibrations or a fall.
  const auto free_as_a_whole = [](const char* gravity) {
    return findings_of(read_scene(fmt::format(R"({{"scene": {{"gravity": {}, "bodies": {{
        "bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 2,
                 "section": {{"type": "circle", "diameter": 0.04}}}},
        "lug": {{"type": "rigid", "at": [1, 0, 0], "mass": 1, "inertia": [0.01, 0.01, 0.01, 0, 0, 0]}}}},
        "joints": {{"weld": {{"type": "fixed", "bodies": ["bar", "lug"], "at": [1, 0, 0]}}}}}},
      "simulation": {{"end_time": 2e-3, "step": 1e-3}},
      "responses": {{"f": {{"type": "frequency", "body": "bar"}}}}}})",
                                              gravity)),
                       check_unconnected_bodies);
  };
  EXPECT_THAT(free_as_a_whole("[0, 0, 0]"), IsEmpty());
  EXPECT_FALSE(only(free_as_a_whole("[0, -9.81, 0]")).is_serious);
  EXPECT_THAT(pushed.text, HasSubstr("loads push it away"));
  EXPECT_THAT(findings_of(read_scene(crank_rocker(driven, closed),
                                     {stray_with(R"(, "velocity": [1, 2, 0])"), other, tie}),
                          check_unconnected_bodies),
              IsEmpty());
}

/// Elastic, so that it starts at all: nothing moves by more than its members bend.
std::vector<Finding> findings_with(const std::string& joint,
                                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      "/scene/bodies/crank/rigid=false",
      "/scene/bodies/coupler/rigid=false",
      "/scene/bodies/rocker/rigid=false",
      "/simulation/end_time=2e-5",
      "/simulation/step=1e-5",
      R"(/scene/joints/A/drive={"type": "ramp-to-speed", "speed": "300 rpm", "ramp": "1 s"})"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return findings_of(read_scene(crank_rocker("", joint), overrides), check_blocked_drives);
}

/// Nine rigid coordinates; with revolutes eight equations of joints, and one of the drive.
TEST(BlockedDrive, IsNamedWhereAJointHasAFreedomTooFew) {
  EXPECT_THAT(findings_with(closed), IsEmpty());
  const std::string welded =
      R"(, "D": {"type": "fixed", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0]})";
  const Finding finding = only(findings_with(welded));
  EXPECT_THAT(finding.text, HasSubstr("the joints leave no motion to the drive of \"A\""));
}

TEST(BlockedDrive, IsOneOfTwoForOneFreedom) {
  const std::string driven_too =
      R"(, "D": {"type": "revolute", "bodies": ["ground", "rocker"], "at": [0.4, 0, 0],
                 "drive": {"type": "ramp-to-speed", "speed": "300 rpm", "ramp": "1 s"}})";
  const Finding finding = only(findings_with(driven_too));
  EXPECT_THAT(finding.text,
              HasSubstr("there is one drive more than the joints leave motions to (drives: \"A\", "
                        "\"D\")"));
}

TEST(BlockedDrive, IsOneWhoseLoopCannotTurnAboutItsAxis) {
  // In space, with one axis across the others.
  EXPECT_THAT(findings_with(closed, {"/scene/joints/B/axis=[1, 0, 0]"}), SizeIs(1));
}

/// A loop of revolutes in space has three equations more than it needs, and moves all the same.
TEST(BlockedDrive, IsNoneOfALoopThatMovesInSpace) {
  EXPECT_THAT(findings_with(closed, {R"(/effects={"spatial_motion": "on"})"}), IsEmpty());
}

/// The drive stands still: what is simulated is round-off, unless something else acts.
TEST(BlockedDrive, ThatStandsStillMovesNothing) {
  const auto findings_at = [](const std::string& speed, const std::vector<std::string>& more) {
    std::vector<std::string> overrides = {
        R"(/scene/joints/A/drive={"type": "constant-speed", "speed": ")" + speed + R"("})",
        "/simulation/end_time=2e-3", "/simulation/step=1e-4"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return findings_of(read_scene(crank_rocker("", closed), overrides), check_rest);
  };
  const Finding finding = only(findings_at("0 rpm", {}));
  EXPECT_THAT(finding.text, HasSubstr("the drive of \"A\" stands still"));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(findings_at("1 rpm", {}), IsEmpty());
  EXPECT_THAT(findings_at("0 rpm", {"/scene/gravity=[0, -9.81, 0]"}), IsEmpty());
}

class ShippedMechanism : public testing::TestWithParam<const char*> {};

TEST_P(ShippedMechanism, HasNoBlockedDrive) {
  const ProblemFile problem = sample_problem(GetParam(), {"/simulation/end_time=20 ms"});
  EXPECT_THAT(findings_of(problem, check_blocked_drives), IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(Problems, ShippedMechanism,
                         testing::Values("slider_crank", "four_bar", "robot_arm",
                                         "spatial_slider_crank", "hard/dead_centres",
                                         "hard/bricard"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '/');
                           return name;
                         });

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
        "carriage": {{"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [0.01, 0.01, 0.01, 0, 0, 0]}},
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
}  // namespace pleuel::test::unactuated_freedoms_test
