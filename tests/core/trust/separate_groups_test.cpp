#include "core/base/eager_matrices.hpp"
#include "core/trust/check_list.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/test.hpp"

/// What stands beside a mechanism, tied to the ground only, changes nothing of it.
namespace pleuel::test::separate_groups_test {
namespace {

/// @param bodies, joints  of one mechanism
/// @param distance        of a cabinet beside it; 0: none
std::string scene(const std::string& bodies, const std::string& joints,
                  const std::string& responses, double distance) {
  const bool has_cabinet = distance > 0.0;
  return fmt::format(
      R"({{"scene": {{"gravity": [0, -9.81, 0], "bodies": {{{}{}}}, "joints": {{{}{}}}}},
          "simulation": {{"end_time": 0.5, "step": 0.001}}, "responses": {{{}}}}})",
      bodies,
      has_cabinet ? fmt::format(R"(, "cabinet": {{"type": "rigid", "at": [{}, 0, 0], "mass": 10,
                                    "inertia": [1, 1, 1, 0, 0, 0]}})",
                                distance)
                  : "",
      joints,
      has_cabinet ? fmt::format(R"(, "bolts": {{"type": "fixed", "bodies": ["ground", "cabinet"],
                                    "at": [{}, 0, 0]}})",
                                distance)
                  : "",
      responses);
}

Eigen::VectorXd values(const std::string& text) {
  const ProblemFile problem = read_scene(text);
  return values_of(*analyze(problem, start_design(problem)));
}

/// A door on two hinges, whose reactions only least norm tells apart.
TEST(SeparateGroups, ShareNoReactions) {
  const auto door = [](double distance) {
    return values(scene(
        R"("door": {"type": "rigid", "at": [0.4, 0, 0], "mass": 20,
                    "inertia": [2, 3, 1.5, 0, 0, 0], "angular_velocity": [0, 1, 0]})",
        R"("low": {"type": "revolute", "bodies": ["ground", "door"], "at": [0, -0.15, 0],
                   "axis": [0, 1, 0]},
           "high": {"type": "revolute", "bodies": ["ground", "door"], "at": [0, 0.15, 0],
                    "axis": [0, 1, 0]})",
        R"("force": {"type": "reaction-force", "joint": "high", "direction": "magnitude",
                     "over_time": "max"})",
        distance));
  };
  const double alone = door(0.0)(0);
  EXPECT_NEAR(door(5.0)(0), alone, 1e-9 * alone);
  EXPECT_NEAR(door(100.0)(0), alone, 1e-9 * alone);
}

std::string pendulum_on_carriage(double distance, const std::string& drive,
                                 const std::string& velocity = "") {
  return scene(fmt::format(R"("carriage": {{"type": "rigid", "at": [0, 0, 0], "mass": 5,
                                   "inertia": [0.01, 0.01, 0.01, 0, 0, 0]}},
                     "arm": {{"type": "rigid", "at": [0, -0.3, 0], "mass": 1,
                              "inertia": [0.03, 0.001, 0.03, 0, 0, 0]{}}})",
                           velocity),
               fmt::format(R"("rail": {{"type": "prismatic", "bodies": ["ground", "carriage"],
                               "at": [0, 0, 0], "axis": [1, 0, 0], "drive": {}}},
                     "hinge": {{"type": "revolute", "bodies": ["carriage", "arm"],
                                "at": [0, 0, 0]}})",
                           drive),
               R"("swing": {"type": "joint-position", "joint": "hinge", "over_time": "max-abs"})",
               distance);
}

constexpr const char* sudden = R"({"type": "constant-speed", "speed": 1})";

TEST(SeparateGroups, ShareNoStart) {
  const double alone = values(pendulum_on_carriage(0.0, sudden))(0);
  EXPECT_NEAR(values(pendulum_on_carriage(3.0, sudden))(0), alone, 1e-9);
}

/// A blow on the hinge of a rod at rest turns it by ω = m l v/(m l² + I) = 2.5 rad/s, so that its
/// middle moves by v − ω l = 0.25 m/s. Both differ by as much from the start that is found.
TEST(OpenVelocities, AreDoubtedWhereASuddenStartWouldMakeThemOthers) {
  const Finding finding =
      only(findings_of(read_scene(pendulum_on_carriage(0.0, sudden)), check_initial_motion));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_THAT(finding.text,
              AllOf(HasSubstr("the velocity of \"arm\""), HasSubstr("would make it 0.25 m/s")));
}

TEST(OpenVelocities, AreNoneThatTheFileGivesOrThatBeginAtRest) {
  EXPECT_THAT(
      findings_of(read_scene(pendulum_on_carriage(
                      0.0, sudden, R"(, "velocity": [1, 0, 0], "angular_velocity": [0, 0, 0])")),
                  check_initial_motion),
      IsEmpty());
  EXPECT_THAT(findings_of(read_scene(pendulum_on_carriage(
                              0.0, R"({"type": "harmonic", "amplitude": 0.1, "frequency": "2 Hz",
                                     "phase": "90 deg"})")),
                          check_initial_motion),
              IsEmpty());
}

/// A short thick block and a rod, each on a foundation of its own.
TEST(SeparateGroups, ShareNoDoubtsOfShear) {
  const ProblemFile problem = read_scene(R"({"scene": {
      "bodies": {"block": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0],
                           "material": "steel", "elements": 4,
                           "section": {"type": "rectangle", "width": 0.02, "height": 0.04}},
                 "rod": {"type": "beam", "from": [1, 0, 0], "to": [1.5, 0, 0],
                         "material": "steel", "elements": 4,
                         "section": {"type": "circle", "diameter": 0.02}}},
      "joints": {"left": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]},
                 "right": {"type": "fixed", "bodies": ["ground", "rod"], "at": [1, 0, 0]}},
      "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0, 0],
                         "direction": [0, 1, 0], "value": {"type": "step", "to": 5e4, "rise": 0.02}},
                "pull": {"type": "force", "body": "rod", "at": [1.5, 0, 0], "direction": [0, 1, 0],
                         "value": {"type": "step", "to": 10, "rise": 0.02}}}},
    "simulation": {"end_time": 0.05, "step": 0.0002},
    "responses": {"of_rod": {"type": "position", "body": "rod", "at": 1, "direction": "y",
                             "over_time": "max"},
                  "of_block": {"type": "position", "body": "block", "at": 1, "direction": "y",
                               "over_time": "max"}}})");
  const Finding finding = only(findings_of(problem, check_variants));
  EXPECT_THAT(finding.responses, ElementsAre("of_block"));
}

}  // namespace
}  // namespace pleuel::test::separate_groups_test
