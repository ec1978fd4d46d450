#include "core/model/joint_holds.hpp"

#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// What mechanisms hold of a bar from the origin to (1, 0, 0) m, which bends.
namespace pleuel::test::joint_holds_test {
namespace {

constexpr std::array<bool, 3> all = {true, true, true}, none = {false, false, false};

std::string beam(const std::string& from, const std::string& to) {
  return fmt::format(R"({{"type": "beam", "from": {}, "to": {}, "material": "steel", "elements": 2,
                         "section": {{"type": "circle", "diameter": "10 mm"}}}})",
                     from, to);
}
const std::string bar = R"("bar": )" + beam("[0, 0, 0]", "[1, 0, 0]");

std::string rigid(const std::string& name, const std::string& at) {
  return fmt::format(R"(, "{}": {{"type": "rigid", "at": {}, "mass": 1,
                                 "inertia": [1, 1, 1, 0, 0, 0]}})",
                     name, at);
}

std::string joint(const std::string& name, const std::string& type, const std::string& one,
                  const std::string& other, const std::string& at, const std::string& more = "") {
  return fmt::format(R"("{}": {{"type": "{}", "bodies": ["{}", "{}"], "at": {}{}}})", name, type,
                     one, other, at, more.empty() ? "" : ", " + more);
}

std::vector<JointHold> holds_of_bar(const std::string& bodies, const std::string& joints) {
  const std::string text = fmt::format(
      R"j({{"scene": {{"materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
                      "bodies": {{{}}}, "joints": {{{}}}}},
           "simulation": {{"end_time": 1, "step": 0.1}},
           "responses": {{"mass": {{"type": "mass"}}}}}})j",
      bodies, joints);
  const ProblemFile problem = problem_from(text);
  return JointHolds(problem.scene, {}).of("bar");
}

const std::string zero = "[0, 0, 0]", tip = "[1, 0, 0]";

TEST(JointHolds, OfAClampAreAll) {
  const auto holds = holds_of_bar(bar, joint("wall", "fixed", "ground", "bar", zero));
  ASSERT_EQ(holds.size(), 1);
  EXPECT_EQ(holds[0].displacements, all);
  EXPECT_EQ(holds[0].rotations, all);
}

/// What hangs on the tip holds nothing.
TEST(JointHolds, OfAPayloadAreNone) {
  const auto holds =
      holds_of_bar(bar + rigid("load", tip), joint("wall", "fixed", "ground", "bar", zero) + ", " +
                                                 joint("weld", "fixed", "bar", "load", tip));
  ASSERT_EQ(holds.size(), 2);
  EXPECT_DOUBLE_EQ(holds[1].at, 1.0);
  EXPECT_EQ(holds[1].rotations, none);
  EXPECT_FALSE(holds[1].displacements[1] || holds[1].displacements[2]);
}

/// The apex of three struts cannot move while none of them changes its length, although two alone
/// leave it a way.
TEST(JointHolds, OfAnApexOfThreeStrutsAreThoseOfPins) {
  const std::string other = "[1.6, 0.5, 0]", third = "[1.5, 0, 0.7]";
  const auto ball = [](const std::string& name, const std::string& one, const std::string& two,
                       const std::string& at) { return joint(name, "spherical", one, two, at); };
  const auto holds = holds_of_bar(
      bar + R"(, "b": )" + beam(other, tip) + R"(, "c": )" + beam(third, tip) + rigid("apex", tip),
      ball("1", "ground", "bar", zero) + ", " + ball("2", "ground", "b", other) + ", " +
          ball("3", "ground", "c", third) + ", " + ball("4", "bar", "apex", tip) + ", " +
          ball("5", "b", "apex", tip) + ", " + ball("6", "c", "apex", tip));
  ASSERT_EQ(holds.size(), 2);
  for (const JointHold& hold : holds) {
    EXPECT_EQ(hold.displacements, all);
    EXPECT_FALSE(hold.rotations[1] || hold.rotations[2]);
  }
}

/// The rod of a slider-crank, the guide at 60° to it: the slider cannot leave its place while the rod
/// keeps its length. With a crank that turns by itself both ends move, but the rod stays straight.
TEST(JointHolds, OfTheRodOfASliderCrankAreThoseOfPins) {
  for (const std::string drive :
       {"", R"("drive": {"type": "ramp-to-speed", "speed": 10, "ramp": 0.1})"}) {
    const std::string axis = R"("axis": [0, 0, 1])";
    const auto holds =
        holds_of_bar(bar + rigid("crank", "[0, 0.2, 0]") + rigid("slider", tip),
                     joint("bearing", "revolute", "ground", "crank", "[0, 0.3, 0]",
                           axis + (drive.empty() ? "" : ", " + drive)) +
                         ", " + joint("pin", "spherical", "crank", "bar", zero) + ", " +
                         joint("end", "spherical", "bar", "slider", tip) + ", " +
                         joint("guide", "prismatic", "ground", "slider", tip,
                               R"("axis": [0.5, 0.8660254037844386, 0])"));
    ASSERT_EQ(holds.size(), 2);
    for (const JointHold& hold : holds) {
      EXPECT_EQ(hold.displacements, all) << drive;
      EXPECT_FALSE(hold.rotations[1] || hold.rotations[2]) << drive;
    }
  }
}

/// Between two lugs of an arm, whatever carries the arm. The bar may spin about its axis: as one of its
/// ends counts against the other, that spin is held at one of them.
TEST(JointHolds, OfAnArmAreTheSameHoweverTheArmMoves) {
  const std::string lugs = joint("a", "spherical", "arm", "bar", zero) + ", " +
                           joint("b", "spherical", "arm", "bar", tip);
  for (const char* type : {"fixed", "revolute", "spherical", "prismatic"}) {
    const bool has_axis = std::string(type) == "revolute" || std::string(type) == "prismatic";
    const auto holds = holds_of_bar(bar + rigid("arm", "[0.5, 0.1, 0]"),
                                    lugs + ", " +
                                        joint("carrier", type, "ground", "arm", "[-0.3, 0.2, 0]",
                                              has_axis ? R"("axis": [0, 0, 1])" : ""));
    ASSERT_EQ(holds.size(), 2) << type;
    for (const JointHold& hold : holds) {
      EXPECT_EQ(hold.displacements, all) << type;
      EXPECT_FALSE(hold.rotations[1] || hold.rotations[2]) << type;
    }
  }
}

/// A mast on a carriage is a cantilever, as it is on the ground.
TEST(JointHolds, OfACarriageAreThoseOfAClamp) {
  const auto holds = holds_of_bar(
      bar + rigid("carriage", zero),
      joint("weld", "fixed", "carriage", "bar", zero) + ", " +
          joint("rails", "prismatic", "ground", "carriage", zero, R"("axis": [0, 1, 0])"));
  ASSERT_EQ(holds.size(), 1);
  EXPECT_EQ(holds[0].displacements, all);
  EXPECT_EQ(holds[0].rotations, all);
}

/// Between two carriages one end moves across against the other; neither turns.
TEST(JointHolds, OfTwoCarriagesLetOneEndMoveAcross) {
  const auto rails = [](const std::string& name, const std::string& at) {
    return joint(name + "_rails", "prismatic", "ground", name, at, R"("axis": [0, 1, 0])") + ", " +
           joint(name + "_weld", "fixed", name, "bar", at);
  };
  const auto holds = holds_of_bar(bar + rigid("left", zero) + rigid("right", tip),
                                  rails("left", zero) + ", " + rails("right", tip));
  ASSERT_EQ(holds.size(), 2);
  EXPECT_NE(holds[0].displacements[1], holds[1].displacements[1]);
  for (const JointHold& hold : holds) {
    EXPECT_TRUE(hold.displacements[2]);
    EXPECT_EQ(hold.rotations, all);
  }
}

/// A rod that swings about a pin along its local z, with a body on a ball at its tip: against its
/// swing it is held there across itself in the plane of the swing, whatever the global axes are.
TEST(JointHolds, OfASwingingRodDoNotDependOnTheGlobalAxes) {
  const std::vector<std::array<std::string, 2>> tips_and_axes = {
      {"[1, 0, 0]", "[0, 0, 1]"}, {"[2, 1, 2]", "[-4, -2, 5]"}, {"[1, -2, 2]", "[-2, 4, 5]"}};
  for (const auto& [to, axis] : tips_and_axes) {
    const auto holds =
        holds_of_bar(R"("bar": )" + beam(zero, to) + rigid("load", to),
                     joint("pin", "revolute", "ground", "bar", zero, R"("axis": )" + axis) + ", " +
                         joint("ball", "spherical", "bar", "load", to));
    ASSERT_EQ(holds.size(), 2);
    EXPECT_TRUE(holds[1].displacements[1]) << to;
    EXPECT_FALSE(holds[1].displacements[2]) << to;
    EXPECT_TRUE(holds[0].rotations[1]) << to;
    EXPECT_FALSE(holds[0].rotations[2]) << to;
  }
}

/// Of a bar on a slide across no axis of it, both ends turn as a whole: which of them counts as still is
/// said by their places.
TEST(JointHolds, DoNotDependOnTheOrderOfJoints) {
  const std::string slide = joint("slide", "prismatic", "ground", "bar", zero,
                                  R"("axis": [0.2, 1, 0.5])"),
                    hinge = joint("hinge", "spherical", "bar", "load", tip);
  const std::string bodies = bar + rigid("load", tip);
  const auto one = holds_of_bar(bodies, slide + ", " + hinge);
  auto other = holds_of_bar(bodies, hinge + ", " + slide);
  ASSERT_EQ(one.size(), 2);
  ASSERT_EQ(other.size(), 2);
  if (other[0].at > other[1].at) std::swap(other[0], other[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_DOUBLE_EQ(one[i].at, other[i].at);
    EXPECT_EQ(one[i].displacements, other[i].displacements) << i;
    EXPECT_EQ(one[i].rotations, other[i].rotations) << i;
  }
}

}  // namespace
}  // namespace pleuel::test::joint_holds_test
