#include "core/base/eager_matrices.hpp"
#include "core/trust/check_list.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// What stands beside a mechanism, tied to the ground only, changes nothing of it.

namespace pleuel::test::proportions_test {
namespace {

// Sizes that are units forgotten, or a zero too many.

struct Slip {
  const char* override_text;
  const char* pointer;
};
class SizesOutOfProportion : public testing::TestWithParam<Slip> {};

/// Each of them is a unit forgotten, or a zero too many.
TEST_P(SizesOutOfProportion, AreNamedByTheirPlaceInTheFile) {
  const ProblemFile problem =
      sample_problem("slider_crank", {"/simulation/end_time=1 ms", GetParam().override_text});
  const Finding finding = only(findings_of(problem, check_proportions));
  EXPECT_FALSE(finding.is_serious);
  EXPECT_THAT(finding.text, HasSubstr(GetParam().pointer));
}
INSTANTIATE_TEST_SUITE_P(
    Slips, SizesOutOfProportion,
    testing::Values(Slip{"/scene/materials/steel/density=7.85", "/scene/materials/steel/density"},
                    Slip{"/scene/materials/steel/density=7.85e6", "/scene/materials/steel/density"},
                    Slip{"/scene/materials/steel/young=2.1e5", "/scene/materials/steel/young"},
                    Slip{"/scene/materials/steel/young=2.1e20", "/scene/materials/steel/young"},
                    Slip{"/scene/gravity=[0, -9810, 0]", "/scene/gravity"},
                    Slip{"/scene/joints/bearing/drive/speed=3000",
                         "/scene/joints/bearing/drive/speed"}),
    named_by(&Slip::pointer));

/// Just within and just beyond what is said of each: from foams to osmium, from rubber to what is
/// meant as rigid, for what is as dense as steel from 1 GPa on, from half a metre to 250 m/s².
TEST(SizesOutOfProportion, BeginWhereTheyAreSaidTo) {
  struct Edge {
    const char *pointer, *within, *beyond;
    std::string density = "7850";
  };
  for (const Edge& edge : {Edge{"/scene/materials/steel/density", "10.1", "9.9"},
                           Edge{"/scene/materials/steel/density", "24900", "25100"},
                           Edge{"/scene/materials/steel/young", "1.01e6", "0.99e6", "1200"},
                           Edge{"/scene/materials/steel/young", "1.01e9", "0.99e9"},
                           Edge{"/scene/materials/steel/young", "0.99e18", "1.01e18"},
                           Edge{"/scene/gravity", "[0, 0.51, 0]", "[0, 0.49, 0]"},
                           Edge{"/scene/gravity", "[0, 249, 0]", "[0, 251, 0]"}}) {
    // Rubber rods are for no motion: the finding looks at numbers only.
    StartRun start(sample_problem("slider_crank", {"/simulation/end_time=1 ms"}));
    const auto count = [&](const char* value) {
      start.problem.scene =
          sample_problem("slider_crank", {"/scene/materials/steel/density=" + edge.density,
                                          std::string(edge.pointer) + "=" + value})
              .scene;
      return check_proportions(start.run()).size();
    };
    EXPECT_EQ(count(edge.within), 0u) << edge.pointer << " " << edge.within;
    EXPECT_EQ(count(edge.beyond), 1u) << edge.pointer << " " << edge.beyond;
  }
}

/// Bodies that a massless rod holds: where they are, and what they weigh, are their own business.
TEST(SizesOutOfProportion, ArePointsFarAwayAndInertiaOfOtherUnits) {
  const auto with = [](const std::string& body, const std::string& at) {
    return findings_of(
        read_scene(
            crank_rocker(driven, closed),
            {"/scene/bodies/more=" + body,
             R"(/scene/joints/tie={"type": "distance", "bodies": ["ground", "more"], "at": [0.1, 0.1, 0], "to": )" +
                 at + "}"}),
        check_proportions);
  };
  const auto point = [&](const std::string& at) {
    return with(R"({"type": "point-mass", "mass": 1, "at": )" + at + "}", at);
  };
  EXPECT_THAT(point("[3, 0, 0]"), IsEmpty());
  ASSERT_THAT(point("[100, 0, 0]"), SizeIs(1));
  EXPECT_THAT(point("[100, 0, 0]")[0].text, HasSubstr("/scene/bodies/more/at is"));
  const std::string near = "[0.2, 0.1, 0]";
  const auto heavy = [&](const char* inertia) {
    return with(
        fmt::format(
            R"({{"type": "rigid", "at": {0}, "mass": 1, "inertia": [{1}, {1}, {1}, 0, 0, 0]}})",
            near, inertia),
        near);
  };
  EXPECT_THAT(heavy("1e-2"), IsEmpty());
  ASSERT_THAT(heavy("1e2"), SizeIs(1));
  EXPECT_THAT(heavy("1e2")[0].text, HasSubstr("/scene/bodies/more/inertia"));
}

/// A mass that is held a tenth of a millimetre beside the end of a bar of 400 mm is no mechanism
/// that the other end is far from.
TEST(SizesOutOfProportion, AreNoneWherePointsAreALittleApart) {
  const ProblemFile lug = read_scene(R"({"scene": {
        "bodies": {"arm": {"type": "beam", "from": [0, 0, 0], "to": [0.4, 0, 0], "material": "steel", "elements": 2,
                           "section": {"type": "circle", "diameter": 0.04}},
                   "lug": {"type": "rigid", "at": [0.4, 0.0001, 0], "mass": 20, "inertia": [0.01, 0.01, 0.01, 0, 0, 0]}},
        "joints": {"wall": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]},
                   "weld": {"type": "fixed", "bodies": ["arm", "lug"], "at": [0.4, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "arm", "at": [0.4, 0, 0], "direction": [0, 1, 0], "value": 1}}},
      "simulation": {"end_time": 2e-3, "step": 1e-3},
      "responses": {"m": {"type": "mass"}}})");
  EXPECT_THAT(findings_of(lug, check_proportions), IsEmpty());
}

/// A radius of gyration of ten times the mechanism's size; a hundred times its size away.
TEST(SizesOutOfProportion, BeginAtTenTimesTheInertiaAndAHundredTimesTheDistance) {
  // Bar of 1 m, and a wheel at its end: nothing else has a place.
  const auto findings = [](double inertia, double at) {
    StartRun start(read_scene(crank_rocker(driven, closed)));
    start.problem.scene = {};
    start.problem.scene.bodies = {
        {"one", PointMass{{0.0, 0.0, 0.0}, 1.0}},
        {"two", PointMass{{1.0, 0.0, 0.0}, 1.0}},
        {"three", PointMass{{0.5, 0.0, 0.0}, 1.0}},
        {"four", PointMass{{0.3, 0.0, 0.0}, 1.0}},
        {"wheel", RigidBody{{at, 0.0, 0.0}, 2.0, {inertia, 0.1, 0.1, 0.0, 0.0, 0.0}}}};
    return check_proportions(start.run()).size();
  };
  EXPECT_EQ(findings(2.0 * 9.9 * 9.9, 1.0), 0u);
  EXPECT_EQ(findings(2.0 * 10.1 * 10.1, 1.0), 1u);
  EXPECT_EQ(findings(1.0, 1.0 + 99.0), 0u);
  EXPECT_EQ(findings(1.0, 1.0 + 101.0), 1u);
}

/// A cart of 1 m on a rail that a drive moves, and a motor that is to move a second one: by a hundred times the
/// mechanism's size; for a hundred times the simulated time.
TEST(SizesOutOfProportion, AreWaysAndTimesOfDrivesAndTargets) {
  const auto findings = [](double way, double rise) {
    const std::string law = fmt::format(R"({{"type": "step", "to": {}, "rise": {}}})", way, rise);
    return findings_of(read_scene(fmt::format(
                           R"({{"scene": {{
          "bodies": {{"cart": {{"type": "point-mass", "at": [1, 0, 0], "mass": 1}},
                      "other": {{"type": "point-mass", "at": [0, 0, 0], "mass": 1}}}},
          "joints": {{"rail": {{"type": "prismatic", "bodies": ["ground", "cart"], "at": [1, 0, 0], "axis": [1, 0, 0],
                                "drive": {0}}},
                      "way": {{"type": "prismatic", "bodies": ["ground", "other"], "at": [0, 0, 0], "axis": [1, 0, 0]}}}},
          "loads": {{"motor": {{"type": "joint", "joint": "way",
                                "motor": {{"type": "control", "target": {0}, "proportional": 1, "derivative": 1}}}}}}}},
        "simulation": {{"end_time": 1, "step": 0.1}}, "responses": {{"m": {{"type": "mass"}}}}}})",
                           law)),
                       check_proportions);
  };
  EXPECT_THAT(findings(99.0, 0.5), IsEmpty());
  const auto far = findings(101.0, 0.5);
  ASSERT_THAT(far, SizeIs(2));
  EXPECT_THAT(far[0].text, HasSubstr("/scene/joints/rail/drive goes 101 m far"));
  EXPECT_THAT(far[1].text, HasSubstr("/scene/loads/motor/motor/target goes"));
  EXPECT_THAT(findings(1.0, 99.0), IsEmpty());
  const auto late = findings(1.0, 101.0);
  ASSERT_THAT(late, SizeIs(2));
  EXPECT_THAT(late[0].text, HasSubstr("goes on until t = 101 s, of which 1 s are simulated"));
}

/// A free length of ten times the mechanism's size.
TEST(SizesOutOfProportion, AreSpringsThatAreMuchLongerThanTheMechanism) {
  const auto findings = [](double length) {
    return findings_of(read_scene(fmt::format(R"({{"scene": {{
          "bodies": {{"m": {{"type": "point-mass", "at": [1, 0, 0], "mass": 1}}}},
          "loads": {{"s": {{"type": "spring", "bodies": ["ground", "m"], "at": [[0, 0, 0], [1, 0, 0]],
                            "stiffness": 1e-3, "free_length": {}}}}}}},
        "simulation": {{"end_time": 2e-3, "step": 1e-3}}, "responses": {{"m": {{"type": "mass"}}}}}})",
                                              length)),
                       check_proportions);
  };
  EXPECT_THAT(findings(9.9), IsEmpty());
  EXPECT_THAT(only(findings(10.1)).text, HasSubstr("/scene/loads/s/free_length"));
}

TEST(SizesOutOfProportion, AreSectionsThatAreLargerThanTheBeamIsLong) {
  const auto with_diameter = [](double diameter) {
    return findings_of(
        read_scene(crank_rocker(driven, closed),
                   {fmt::format("/scene/bodies/crank/section/diameter={}", diameter)}),
        check_proportions);
  };
  EXPECT_THAT(with_diameter(0.02), IsEmpty());
  ASSERT_THAT(with_diameter(0.2), SizeIs(1));
  EXPECT_THAT(with_diameter(0.2)[0].text, HasSubstr("/scene/bodies/crank/section"));
  ASSERT_THAT(with_diameter(2e-5), SizeIs(1));
  EXPECT_THAT(with_diameter(2e-5)[0].text, HasSubstr("/scene/bodies/crank is 0.1 m long"));
}

/// A leaf of 20 mm by 10 µm, however it lies: what is too thin to be meant is so in both
/// directions.
TEST(SizesOutOfProportion, AreNotThinLeaves) {
  const auto with_section = [](const char* section) {
    return findings_of(read_scene(crank_rocker(driven, closed),
                                  {std::string("/scene/bodies/crank/section=") + section}),
                       check_proportions);
  };
  EXPECT_THAT(with_section(R"({"type": "rectangle", "width": 0.02, "height": 1e-5})"), IsEmpty());
  EXPECT_THAT(with_section(R"({"type": "rectangle", "width": 1e-5, "height": 0.02})"), IsEmpty());
  EXPECT_THAT(with_section(R"({"type": "rectangle", "width": 1e-5, "height": 1e-5})"), SizeIs(1));
}

/// A cantilever with a force at its tip, downwards and towards the wall.
const std::string scene = R"({
  "scene": {
    "bodies": {"beam": {"type": "beam", "from": [0, 0, 0], "to": [0.3, 0, 0], "material": "steel",
                        "section": {"type": "circle", "diameter": {"variable": "d"}}, "elements": 2}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
    "loads": {"tool": {"type": "force", "body": "beam", "at": [0.3, 0, 0], "direction": [-1, -1, 0],
                       "value": {"type": "constant", "value": "100 N"}}}},
  "simulation": {"end_time": 0.05, "step": 0.001},
  "variables": {"d": {"start": "10 mm", "lower": "5 mm", "upper": "30 mm"}},
  "responses": {"mass": {"type": "mass"},
    "sag": {"type": "deflection", "body": "beam", "at": 1, "direction": "y", "over_time": "max"},
    "low": {"type": "deflection", "body": "beam", "at": 1, "direction": "y", "over_time": "min"},
    "far": {"type": "deflection", "body": "beam", "at": 1, "direction": "y", "over_time": "max-abs"},
    "early": {"type": "deflection", "body": "beam", "at": 1, "direction": "y", "over_time": "max-abs", "to": 0.01},
    "moment": {"type": "section-force", "body": "beam", "at": 0.01, "part": "moment-z", "over_time": "min"},
    "axial": {"type": "section-force", "body": "beam", "at": 0.01, "part": "axial", "over_time": "max"},
    "height": {"type": "position", "body": "beam", "at": 1, "direction": "y", "over_time": "max"}},
  "objective": {"minimize": "mass"}
})";

std::vector<Finding> findings_with_limits(const std::string& limits) {
  return findings_of(read_scene(scene, {"/constraints=" + limits}), check_other_side);
}

TEST(OtherSide, IsNotLimitedByTheLargestValue) {
  const Finding finding =
      only(findings_with_limits(R"({"stiff": {"response": "sag", "upper": "1 mm"}})"));
  EXPECT_THAT(finding.text, HasSubstr("holds \"sag\" at 1 mm to one side only"));
  EXPECT_THAT(finding.text, HasSubstr("comes to -"));
  EXPECT_FALSE(finding.is_serious);
}

TEST(OtherSide, IsNoneWhereItIsLimitedToo) {
  EXPECT_THAT(findings_with_limits(R"({"stiff": {"response": "sag", "upper": "1 mm"},
                                     "other": {"response": "low", "lower": "-20 mm"}})"),
              IsEmpty());
  EXPECT_THAT(findings_with_limits(R"({"stiff": {"response": "sag", "upper": "1 mm"},
                                     "other": {"response": "far", "upper": "20 mm"}})"),
              IsEmpty());
  EXPECT_THAT(findings_with_limits(R"({"stiff": {"response": "far", "upper": "1 mm"}})"),
              IsEmpty());
  EXPECT_THAT(findings_with_limits(R"({"stiff": {"response": "sag", "upper": "1 mm"},
                                     "other": {"response": "= -low", "upper": "20 mm"}})"),
              IsEmpty());
}

TEST(OtherSide, IsLimitedByWhatLooksAtAllInstants) {
  EXPECT_THAT(findings_with_limits(R"({"stiff": {"response": "sag", "upper": "1 mm"},
                                     "other": {"response": "early", "upper": "20 mm"}})"),
              SizeIs(1));
}

TEST(OtherSide, IsThatOfMomentsButNotOfPress) {
  EXPECT_THAT(findings_with_limits(R"({"weak": {"response": "moment", "lower": "-1 N m"},
                                     "press": {"response": "axial", "upper": "1 N"}})"),
              SizeIs(1));
  EXPECT_THAT(findings_with_limits(R"({"press": {"response": "axial", "upper": "1 N"}})"),
              IsEmpty());
}

TEST(OtherSide, IsNoneWhereTheMotionKeepsTheLimitThere) {
  EXPECT_THAT(findings_with_limits(R"({"stiff": {"response": "sag", "upper": "200 mm"}})"),
              IsEmpty());
  EXPECT_THAT(findings_with_limits(R"({"stiff": {"response": "low", "lower": "-1 mm"}})"),
              IsEmpty());
}

/// Heights are from where the axes are.
TEST(OtherSide, IsNoneOfPositions) {
  EXPECT_THAT(findings_with_limits(R"({"low": {"response": "height", "upper": "1 mm"}})"),
              IsEmpty());
}

std::vector<Finding> findings_with_bounds(double start, double lower, double upper) {
  ProblemFile problem;
  problem.variables = {{"width", start, lower, upper, "mm", quantities::length}};
  return check_far_bounds(problem);
}

TEST(FarBound, IsOneThatStandsForNone) {
  const Finding finding = only(findings_with_bounds(0.02, 0.004, 1e6));
  EXPECT_THAT(finding.text, HasSubstr("the upper bound of variable \"width\" is 1e+09 mm, 5e+07 "
                                      "times its start"));
  EXPECT_THAT(findings_with_bounds(0.02, -1e30, 0.04), SizeIs(1));
}

TEST(FarBound, IsNoneThatStartOrOtherBoundComesNear) {
  EXPECT_THAT(findings_with_bounds(0.02, 0.0, 1.0), IsEmpty());
  EXPECT_THAT(findings_with_bounds(1e-9, -1.0, 1.0), IsEmpty());
  EXPECT_THAT(findings_with_bounds(0.0, -1e9, 1e9), IsEmpty());
  EXPECT_THAT(findings_with_bounds(1e6, 0.0, 1e6), IsEmpty());
}

/// Three steel rods of 20 mm have some kilograms.
std::vector<Finding> findings_with_limit(const std::string& limit) {
  return findings_of(
      read_scene(crank_rocker(driven, closed),
                 {"/variables/d={\"start\": \"20 mm\", \"lower\": \"10 mm\", \"upper\": \"30 mm\"}",
                  R"(/scene/bodies/rocker/section/diameter={"variable": "d"})",
                  R"(/objective={"minimize": "m"})",
                  R"(/constraints/heavy={"response": "m", )" + limit + "}"}),
      check_far_limits);
}

TEST(FarLimit, IsOneInAnotherUnit) {
  const Finding finding = only(findings_with_limit(R"("upper": "80 mg")"));
  EXPECT_THAT(finding.text, HasSubstr("the limit of \"heavy\" is 8e-05 kg, and the value 1."));
  EXPECT_THAT(findings_with_limit(R"("lower": 1e6)"), SizeIs(1));
}

TEST(FarLimit, IsNoneThatIsBrokenByLessOrZero) {
  EXPECT_THAT(findings_with_limit(R"("upper": "1 g")"), IsEmpty());
  EXPECT_THAT(findings_with_limit(R"("upper": 0)"), IsEmpty());
  EXPECT_THAT(findings_with_limit(R"("upper": 1e9)"), IsEmpty());
  EXPECT_THAT(findings_with_limit(R"("lower": 1e3)"), IsEmpty());
}

std::vector<Finding> findings_at(const std::string& place) {
  const OneBeam bar{
      .name = "bar",
      .section = circle(0.04),
      .loads = fmt::format(
          R"("push": {{"type": "force", "body": "bar", "at": ["{}", 0, 0], "direction": [0, -1, 0], "value": 1}})",
          place),
      .simulation = time_loop(2e-3, 1e-3)};
  return findings_of(bar.problem(), check_lost_places);
}

/// A thousandth of the element is 0.25 mm; a millionth of the length is rounding.
TEST(LostPlaces, AreToldBetweenRoundingAndAnElement) {
  EXPECT_THAT(findings_at("0 mm"), IsEmpty());
  EXPECT_THAT(findings_at("0.0005 mm"), IsEmpty());
  EXPECT_THAT(findings_at("0.3 mm"), IsEmpty());
  const Finding found = only(findings_at("0.2 mm"));
  EXPECT_THAT(found.text, HasSubstr("\"push\" is only 0.0002 m beside an end of the beam \"bar\""));
}

// A post of 0.5 m along z whose tip a variable moves aside, pushed along y: 10 N · 0.5 m over W of 10 × 30 mm
// is 3.33 MPa about its strong axis and 10 MPa about the weak one.

ProblemFile post(double aside, const std::string& more = "", double width = 0.01) {
  return OneBeam{
      .name = "post",
      .to = R"([0, "= aside", 0.5])",
      .section = rectangle(width, 0.03),
      .elements = 2,
      .more = more,
      .end_loads = {{10.0}},
      .simulation = at_rest(0.01, 0.005),
      .responses = R"("stress": {"type": "stress", "body": "post", "over_time": "max"})",
      .rest = fmt::format(
          R"("variables": {{"aside": {{"start": "{} m", "lower": "-0.1 m", "upper": "0.1 m"}}}})",
          aside)}
      .problem();
}

double stress(const ProblemFile& problem) {
  return values_of(*analyze(problem, start_design(problem)))(0);
}

TEST(SectionAxes, AreDoubtedWhereTheSectionTurnsWithTheDesign) {
  EXPECT_NEAR(stress(post(0.0)), 10 * 0.5 * 6 / (0.01 * 0.03 * 0.03), 1e3);
  EXPECT_NEAR(stress(post(1e-6)), 10 * 0.5 * 6 / (0.03 * 0.01 * 0.01), 1e3);
  for (const double aside : {0.0, 1e-6}) {
    const Finding finding = only(findings_of(post(aside), check_section_axes));
    EXPECT_TRUE(finding.is_serious);
    EXPECT_THAT(finding.text, HasSubstr("the variable \"aside\" turns it"));
  }
}

TEST(SectionAxes, AreNotDoubtedWhereNothingTurns) {
  EXPECT_THAT(findings_of(post(0.05), check_section_axes), IsEmpty());
  EXPECT_THAT(findings_of(post(0.0, R"("reference": [0, 1, 0])"), check_section_axes), IsEmpty());
  EXPECT_THAT(findings_of(post(0.0, "", 0.03), check_section_axes), IsEmpty());
  ProblemFile fixed = post(0.0);
  fixed.variables[0].lower = fixed.variables[0].upper = 0.0;
  EXPECT_THAT(findings_of(fixed, check_section_axes), IsEmpty());
}

/// @param bodies, joints  of one mechanism
/// @param distance        of a cabinet beside it; 0: none
std::string scene_of(const std::string& bodies, const std::string& joints,
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
    return values(scene_of(
        R"("door": {"type": "rigid", "at": [0.4, 0, 0], "mass": 20,
                    "inertia": [2, 3, 1.5, 0, 0, 0], "angular_velocity": [0, 1, 0]})",
        R"("low": {"type": "revolute", "bodies": ["ground", "door"], "at": [0, -0.15, 0], "axis": [0, 1, 0]},
           "high": {"type": "revolute", "bodies": ["ground", "door"], "at": [0, 0.15, 0], "axis": [0, 1, 0]})",
        R"("force": {"type": "reaction-force", "joint": "high", "direction": "magnitude", "over_time": "max"})",
        distance));
  };
  const double alone = door(0.0)(0);
  EXPECT_NEAR(door(5.0)(0), alone, 1e-9 * alone);
  EXPECT_NEAR(door(100.0)(0), alone, 1e-9 * alone);
}

std::string pendulum_on_carriage(double distance, const std::string& drive,
                                 const std::string& velocity = "") {
  return scene_of(
      fmt::format(R"("carriage": {{"type": "rigid", "at": [0, 0, 0], "mass": 5,
                                   "inertia": [0.01, 0.01, 0.01, 0, 0, 0]}},
                     "arm": {{"type": "rigid", "at": [0, -0.3, 0], "mass": 1,
                              "inertia": [0.03, 0.001, 0.03, 0, 0, 0]{}}})",
                  velocity),
      fmt::format(R"("rail": {{"type": "prismatic", "bodies": ["ground", "carriage"],
                               "at": [0, 0, 0], "axis": [1, 0, 0], "drive": {}}},
                     "hinge": {{"type": "revolute", "bodies": ["carriage", "arm"], "at": [0, 0, 0]}})",
                  drive),
      R"("swing": {"type": "joint-position", "joint": "hinge", "over_time": "max-abs"})", distance);
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
      "bodies": {"block": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "steel", "elements": 4,
                           "section": {"type": "rectangle", "width": 0.02, "height": 0.04}},
                 "rod": {"type": "beam", "from": [1, 0, 0], "to": [1.5, 0, 0], "material": "steel", "elements": 4,
                         "section": {"type": "circle", "diameter": 0.02}}},
      "joints": {"left": {"type": "fixed", "bodies": ["ground", "block"], "at": [0, 0, 0]},
                 "right": {"type": "fixed", "bodies": ["ground", "rod"], "at": [1, 0, 0]}},
      "loads": {"push": {"type": "force", "body": "block", "at": [0.1, 0, 0],
                         "direction": [0, 1, 0], "value": {"type": "step", "to": 5e4, "rise": 0.02}},
                "pull": {"type": "force", "body": "rod", "at": [1.5, 0, 0], "direction": [0, 1, 0],
                         "value": {"type": "step", "to": 10, "rise": 0.02}}}},
    "simulation": {"end_time": 0.05, "step": 0.0002},
    "responses": {"of_rod": {"type": "position", "body": "rod", "at": 1, "direction": "y", "over_time": "max"},
                  "of_block": {"type": "position", "body": "block", "at": 1, "direction": "y",
                               "over_time": "max"}}})");
  const Finding finding = only(findings_of(problem, check_variants));
  EXPECT_THAT(finding.responses, ElementsAre("of_block"));
}

}  // namespace
}  // namespace pleuel::test::proportions_test
