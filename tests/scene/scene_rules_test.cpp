#include "core/scene/scene_rules.hpp"

#include "core/base/error.hpp"
#include "core/scene/body_rules.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::scene_rules_test {
namespace {

// What formulas must keep at every design: bounds are those of variables, not of what formulas
// make of them.

/// A clamped tube with a load and a mass at its end; two variables a and b, each of them harmless
/// at both its bounds while the other one keeps its start.
ProblemFile cantilever(const std::vector<std::string>& overrides) {
  return problem_from(R"json({
    "scene": {
      "bodies": {
        "tube": {"type": "beam", "from": [0, 0, 0], "to": ["1 m", 0, 0], "material": "steel", "elements": 1,
                 "section": {"type": "tube", "outer_diameter": "50 mm", "thickness": "4 mm"}},
        "end": {"type": "point-mass", "at": ["1 m", 0, 0], "mass": "1 kg"}
      },
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "tube"], "at": [0, 0, 0]},
                 "tip": {"type": "spherical", "bodies": ["tube", "end"], "at": ["1 m", 0, 0]}},
      "loads": {"push": {"type": "force", "body": "tube", "at": ["1 m", 0, 0], "direction": [0, -1, 0],
                         "value": "10 N"}}},
    "simulation": {"end_time": "2 ms", "step": "1 ms"},
    "variables": {"a": {"start": 1, "lower": 0.6, "upper": 1.5}, "b": {"start": 0.5, "lower": 0.4, "upper": 0.9}},
    "responses": {"mass": {"type": "mass"}},
    "objective": {"minimize": "= mass + 0 kg*(a + b)"}
})json",
                      overrides);
}

struct Escape {
  std::string pointer, formula, rule;
};
void PrintTo(const Escape& escape, std::ostream* stream) {
  *stream << escape.pointer;
}

class FormulaAtADesign : public testing::TestWithParam<Escape> {};

/// a − b is 0.5 at the start, at least 0.1 where one of them is at a bound, and −0.2 at the worst
/// corner.
TEST_P(FormulaAtADesign, IsRefusedWhereItLeavesItsRange) {
  const auto& [pointer, formula, rule] = GetParam();
  const ProblemFile problem =
      cantilever({fmt::format("{}={}", pointer, formula), "/objective={\"minimize\": \"mass\"}",
                  "/variables/b/upper=0.8"});
  const Design<double> start = {1.0, 0.5}, worst = {0.6, 0.8};
  EXPECT_FALSE(find_impossible(problem.scene, start, start));
  const auto found = find_impossible(problem.scene, start, worst);
  ASSERT_TRUE(found);
  EXPECT_THAT(*found, HasSubstr(rule));
}

INSTANTIATE_TEST_SUITE_P(
    Places, FormulaAtADesign,
    testing::Values(
        Escape{"/scene/bodies/end/mass", "= (a - b)*1 kg",
               "/scene/bodies/end/mass must be positive [kg], is -0.2"},
        Escape{"/scene/bodies/tube/section/thickness", "= (a - b)*4 mm",
               "/scene/bodies/tube/section/thickness must be positive [m], is -0.0008"},
        Escape{"/scene/bodies/tube/section",
               R"({"type": "rectangle", "width": "10 mm", "height": "= (a - b)*9 mm"})",
               "/scene/bodies/tube/section/height must be positive [m], is -0.0018"},
        Escape{
            "/scene/materials",
            R"json({"steel": {"young": "210 GPa", "poisson": 0.3, "density": "= (a - b)*7850 kg/m^3"}})json",
            "/scene/materials/steel/density must be positive [kg/m^3], is -1570"}),
    [](const auto& test) {
      std::string name = test.param.pointer;
      std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
      return name;
    });

/// Length and load agree where one variable is at a bound, but not where both are.
TEST(PlaceOfALoad, MustStayOnItsBodyAtEveryDesign) {
  const ProblemFile problem = cantilever(
      {"/scene/bodies/tube/to/0== 2*a*b*1 m", "/scene/loads/push/at/0== (a + 2*b - 1)*1 m",
       "/scene/bodies/end/at/0== 2*a*b*1 m", "/scene/joints/tip/at/0== 2*a*b*1 m"});
  const Design<double> start = {1.0, 0.5};
  EXPECT_FALSE(find_impossible(problem.scene, start, start));
  EXPECT_FALSE(find_impossible(problem.scene, start, {1.5, 0.5}));
  const auto found = find_impossible(problem.scene, start, {1.5, 0.8});
  ASSERT_TRUE(found);
  EXPECT_THAT(*found,
              HasSubstr("/scene/loads/push/at must stay at the share 1 of the length of the "
                        "beam \"tube\", which is (2.4, 0, 0) [m], is (2.1, 0, 0)"));
}

TEST(PlaceOfAMass, MustStayWhereItsJointIs) {
  const ProblemFile problem = cantilever(
      {"/scene/bodies/tube/to/0== 2*a*b*1 m", "/scene/loads/push/at/0== 2*a*b*1 m",
       "/scene/bodies/end/at/0== (a + 2*b - 1)*1 m", "/scene/joints/tip/at/0== 2*a*b*1 m"});
  const auto found = find_impossible(problem.scene, {1.0, 0.5}, {1.5, 0.8});
  ASSERT_TRUE(found);
  EXPECT_THAT(*found, HasSubstr("/scene/joints/tip/at must be where the point mass \"end\" is"));
}

/// A variable b that is fixed, as uncertain parameters are, places the load.
const std::vector<std::string> load_at_b = {
    R"(/variables/b={"start": 0.5, "lower": 0.5, "upper": 0.5})", "/scene/loads/push/at/0== b*1 m"};

/// A node follows what lies between the ends; what begins at an end stays there. a is the length of the
/// tube with all at its end.
TEST(PlaceOfALoad, IsFollowedBetweenTheEndsOfAnElasticBeam) {
  EXPECT_FALSE(find_point_moved_along(cantilever(load_at_b).scene, {1.0, 0.5}, 1));
  EXPECT_FALSE(find_point_moved_along(cantilever(load_at_b).scene, {1.0, 0.5}, 0));
  const ProblemFile end =
      cantilever({"/scene/bodies/tube/to/0== a*1 m", "/scene/loads/push/at/0== a*1 m",
                  "/scene/bodies/end/at/0== a*1 m", "/scene/joints/tip/at/0== a*1 m"});
  EXPECT_FALSE(find_point_moved_along(end.scene, {1.0, 0.5}, 0));
  const ProblemFile leaves_the_end = cantilever(
      {R"(/variables/b={"start": 1, "lower": 1, "upper": 1})", "/scene/loads/push/at/0== b*1 m"});
  const auto found = find_point_moved_along(leaves_the_end.scene, {1.0, 1.0}, 1);
  ASSERT_TRUE(found);
  EXPECT_THAT(*found, HasSubstr("moves /scene/loads/push/at along the elastic body \"tube\""));
}

/// Frames of a divided beam end at nodes, which places are not moved across.
TEST(PlaceOfALoad, IsNotFollowedOnADividedBeam) {
  std::vector<std::string> divided = load_at_b;
  divided.emplace_back("/scene/bodies/tube/frames=2");
  EXPECT_TRUE(find_point_moved_along(cantilever(divided).scene, {1.0, 0.5}, 1));
}

/// Two loads that begin at one place have one node.
TEST(PlaceOfALoad, IsNotFollowedAwayFromWhatIsThere) {
  std::vector<std::string> two = load_at_b;
  two.emplace_back(R"(/scene/loads/other={"type": "force", "body": "tube", "at": [0.5, 0, 0],
                      "direction": [0, 1, 0], "value": 1})");
  EXPECT_TRUE(find_point_moved_along(cantilever(two).scene, {1.0, 0.5}, 1));
  two.back() = R"(/scene/loads/other={"type": "force", "body": "tube", "at": ["= b*1 m", 0, 0],
                  "direction": [0, 1, 0], "value": 1})";
  EXPECT_FALSE(find_point_moved_along(cantilever(two).scene, {1.0, 0.5}, 1));
}

/// Else the model would take the other one along.
TEST(PlaceOfALoad, MayNotBeWhereOneThatMovesStarts) {
  for (const char* place : {"0.5", "0.50004"}) {
    const std::string other = fmt::format(
        R"(/scene/loads/other={{"type": "force", "body": "tube", "at": [{}, 0, 0],
           "direction": [0, 1, 0], "value": 1}})",
        place);
    EXPECT_THAT(thrown<InputError>([&] {
                  cantilever({other, "/scene/loads/push/at/0== b*1 m"});
                }),
                HasSubstr("/scene/loads/other/at must stay with what moves from its place"))
        << place;
  }
}

TEST(PlaceOfALoad, KeepsItsOrderAlongAnElasticBeam) {
  const ProblemFile problem =
      cantilever({R"(/scene/loads/first={"type": "force", "body": "tube", "at": ["= a*0.3 m", 0, 0],
          "direction": [0, 1, 0], "value": 1})",
                  "/scene/loads/push/at/0== b*1 m"});
  const Design<double> start = {1.0, 0.5};
  EXPECT_FALSE(find_impossible(problem.scene, start, {1.5, 0.5}));
  const auto found = find_impossible(problem.scene, start, {1.5, 0.4});
  ASSERT_TRUE(found);
  EXPECT_THAT(
      *found,
      HasSubstr(
          "/scene/loads/push/at must not come nearer to the place of \"first\" "
          "of the beam \"tube\" than a hundredth of its distance at the start, which is 0.2"));
}

TEST(PlaceOfALoad, DoesNotScatterAlongAnElasticBeamFromItsEnd) {
  EXPECT_THAT(thrown<InputError>([&] {
                cantilever({R"(/variables/b={"start": 1, "lower": 1, "upper": 1})",
                            "/scene/loads/push/at/0== b*1 m",
                            R"(/uncertainty={"parameters": {"b": {"deviation": 0.01}}})"});
              }),
              HasSubstr("/uncertainty/parameters/b moves /scene/loads/push/at"));
}

// Bounds that allow bodies which cannot be.

/// The good problem with a tube for a crank: its wall is a variable beside the outer diameter.
Json with_tube() {
  Json document = edited(
      "/scene/bodies/crank/section",
      R"({"type": "tube", "outer_diameter": {"variable": "width"}, "thickness": {"variable": "wall"}})");
  document["variables"]["wall"] =
      Json::parse(R"({"start": "1 mm", "lower": "1 mm", "upper": "6 mm"})");
  document["constraints"].erase("slender");
  return document;
}

TEST(ImpossibleCorners, AreNamedWithTheConstraintThatKeepsOffThem) {
  const auto notes = impossible_corners(read(with_tube()));
  ASSERT_EQ(notes.size(), 1);
  EXPECT_EQ(notes.front(),
            "the bounds allow an impossible body \"crank\" (its section's thickness must not "
            "exceed the radius 0.002 [m] of the tube, got 0.006, at width = 0.004, wall = 0.006); "
            "such designs cannot be evaluated: give other bounds, or a constraint {\"linear\": "
            "{\"width\": -0.5, \"wall\": 1}, \"upper\": 0}");
}

TEST(ImpossibleCorners, AreSilentWhereTheBoundsOrALinearConstraintExcludeThem) {
  EXPECT_TRUE(impossible_corners(read(good_json())).empty());
  Json narrow = with_tube();
  narrow["variables"]["wall"]["upper"] = "2 mm";  // half of the least diameter
  EXPECT_TRUE(impossible_corners(read(narrow)).empty());
  Json constrained = with_tube();
  constrained["constraints"]["fits"] =
      Json::parse(R"({"linear": {"width": -0.5, "wall": 1}, "upper": 0})");
  EXPECT_TRUE(impossible_corners(read(constrained)).empty());
  // No width below 4.5 mm is allowed with a diameter above 10 mm, whatever the diameter is; a wall
  // of 2.2 mm fits into that.
  Json elsewhere = with_tube();
  elsewhere["variables"]["wall"]["upper"] = "2.2 mm";
  ASSERT_EQ(impossible_corners(read(elsewhere)).size(), 1);
  elsewhere["constraints"]["slender"] = good_json()["constraints"]["slender"];
  EXPECT_TRUE(impossible_corners(read(elsewhere)).empty());
}

TEST(ImpossibleCorners, OfAnInertiaTensorAreNamed) {
  Json document =
      edited("/scene/bodies/wheel/inertia", R"([0.1, 0.1, {"variable": "polar"}, 0, 0, 0])");
  document["variables"]["polar"] =
      Json::parse(R"({"start": "0.2 kg m^2", "lower": "0.1 kg m^2", "upper": "0.3 kg m^2"})");
  const auto notes = impossible_corners(read(document));
  ASSERT_EQ(notes.size(), 1);
  EXPECT_EQ(notes.front(),
            "the bounds allow an impossible body \"wheel\" (its inertia must have no principal "
            "moment above the sum of the other two (0.3 > 0.1 + 0.1 kg m^2), at polar = 0.3); such "
            "designs cannot be evaluated: give other bounds");
}

/// A plate has equality, written numbers are rounded, and a rod may say nothing about its own axis,
/// a wheel of a planar mechanism nothing but that.
TEST(Inertia, MayLieOnTheEdgeOfWhatIsPossible) {
  for (const char* inertia :
       {"[0.1, 0.1, 0.2, 0, 0, 0]", "[0.123, 0.457, 0.581, 0, 0, 0]", "[0, 0.1, 0.1, 0, 0, 0]",
        "[0, 0, 0.1, 0, 0, 0]", "[0.5, 0.5, 1, 0.5, 0, 0]"}) {
    EXPECT_EQ(complaint(edited("/scene/bodies/wheel/inertia", inertia)), "") << inertia;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/scene/bodies/arm/frame | "mean-axes" | ~ must be "tangent", "tangent-end", "chord" or "mean-axis", got "mean-axes"; did you mean "mean-axis"?
/scene/bodies/strut/rigid | "yes" | ~ must be true or false, got "yes"
/scene/bodies/strut/damping | {} | ~ is not for a rigid beam
/scene/bodies/strut/reduction | {"modes": 2} | ~ is not for a rigid beam
/scene/bodies/strut/shear | true | ~ is not for a rigid beam
/scene/bodies/arm/shear | 1 | ~ must be true or false, got 1
/scene/bodies/arm/reduction | {} | ~ needs "modes" or "frequency"
/scene/bodies/arm/reduction/frequency | 100 | ^ has both "modes" and "frequency"
/scene/bodies/arm/reduction/modes | -1 | ~ must be a whole number from 0 to 1000, got -1
/scene/bodies/arm/reduction/modes | 1.5 | ~ must be a whole number from 0 to 1000, got 1.5
/scene/bodies/arm/reduction/mode | 1 | ^ has the unknown key "mode"; did you mean "modes"?
/scene/bodies/rod/reduction/frequency | 0 | ~ must be positive [Hz], got 0
/scene/bodies/rod/reduction/frequency | "2 rad" | ~ must be a frequency [Hz], got "2 rad": "rad" measures something else
/scene/bodies/rod/reduction/frequency | {"variable": "speed"} | ~ must be a frequency [Hz]: a number in SI units, a text with unit or a formula, got {"variable":"speed"}
/scene/bodies/arm/reduction | remove | /scene/bodies/arm/damping/modal is for beams with a "reduction" only
/scene/bodies/arm/damping/mass | 0 | ^ has both "modal" and "mass"
/scene/bodies/arm/damping/stiffness | 0 | ^ has both "modal" and "stiffness"
/scene/bodies/arm/damping/modal | 1 | ~ must be at least 0 and less than 1, got 1
/scene/bodies/arm/damping/modal | -0.1 | ~ must be at least 0 and less than 1, got -0.1
/scene/bodies/ball/angular_velocity | [0, 0, 1] | ~ is not for a point mass, which does not turn
/scene/bodies/block/velocity/1 | "1 m" | ~ must be a speed [m/s], got "1 m": "m" measures something else
/scene/bodies/block/velocity | 3 | ~ must be a list of 3 values, got 3
/scene/bodies/block/angular_velocity/0 | "1 Hz" | ~ must be an angular speed [rad/s], got "1 Hz": "Hz" names no angle; write rad/s, deg/s or rpm
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Joints, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/scene/joints/shoulder/axis | remove | ^ is missing the key "axis"
/scene/joints/floor/axis | remove | ^ is missing the key "axis"
/scene/joints/elbow/axis | remove | ^ is missing the key "axis"
/scene/joints/elbow/second_axis | remove | ^ is missing the key "second_axis"
/scene/joints/elbow/second_axis | [0, 1, 1e-8] | ~ must be normal to "axis", got [0,1,1e-08]
/scene/joints/elbow/second_axis | [0, 0, 0] | ~ must not be zero, got [0,0,0]
/scene/joints/floor/second_axis | [1, 0, 0] | ~ is for universal joints only
/scene/joints/wrist/axis | [1, 0, 0] | ~ is not for a spherical joint, which has no axis
/scene/joints/tie/axis | [1, 0, 0] | ~ is not for a distance joint, which has no axis
/scene/joints/tie/to | remove | ^ is missing the key "to"
/scene/joints/wrist/to | [1, 0, 0] | ~ is for distance joints only
/scene/joints/tie/to | [1.25, 0, 0] | ~ must not be the same point as "at", got [1.25,0,0]
/scene/joints/tie/to/0 | "1" | ~ must be a length [m], got "1": a number in quotes needs its unit
/scene/joints/tie/at | [1.25, 0.1, 0] | ~ must be on the axis of the beam "rod", the nearest point is (1.25, 0, 0) [m], got (1.25, 0.1, 0)
/scene/joints/wrist/at/0 | 2.1 | ^ must be on the axis of the beam "rod", the nearest point is (2, 0, 0) [m], got (2.1, 0, 0)
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Drives, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/scene/joints/wrist/drive | {"type": "constant-speed", "speed": 1} | ~ needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal", "planar" or "distance", but "wrist" is of the type "spherical"
/scene/joints/shoulder/drive/coordinate | remove | ^ is missing the key "coordinate"
/scene/joints/shoulder/drive/coordinate | "turn" | ~ must be "angle" or "displacement", got "turn"
/scene/joints/elbow/drive/coordinate | "displacement" | ~ must be "angle" for a joint of the type "universal", got "displacement"
/scene/joints/line/drive/coordinate | "angle" | ~ must be "displacement" for a joint of the type "point-on-line", got "angle"
/scene/joints/shoulder/drive/coordinate | "displacement" | /scene/joints/shoulder/drive/coefficients/1 must be a speed [m/s], got "60 rpm": "rpm" measures something else
/scene/joints/line/drive/speed | "20 rad/s" | ~ must be a speed [m/s], got "20 rad/s": "rad/s" measures something else
/scene/joints/line/drive | 3 | ~ must be an object {…}, got 3
/scene/joints/line/drive/type | "sine" | ~ must be "constant-speed", "ramp-to-speed", "constant", "polynomial", "harmonic", "table", "step", "ramp", "trapezoid" or "expression", got "sine"
/scene/joints/line/drive/sped | 1 | ^ has the unknown key "sped"; did you mean "speed"?
/scene/joints/shoulder/drive/coefficients | [] | ~ must have from 1 to 11 coefficients, got 0
/scene/joints/shoulder/drive/coefficients | [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11] | ~ must have from 1 to 11 coefficients, got 12
/scene/joints/shoulder/drive/coefficients/2 | "1 rad/s" | ~ must be a coefficient of t^2 [rad/s^2], got "1 rad/s": "rad/s" measures something else
/scene/joints/elbow/drive/frequency | remove | ^ is missing the key "frequency"
/scene/joints/elbow/drive/frequency | 0 | ~ must be positive [rad/s], got 0
/scene/joints/elbow/drive/frequency | "10 1/s" | ~ must be a frequency [rad/s], got "10 1/s": "1/s" names no angle; write rad/s, deg/s or rpm
/scene/joints/elbow/drive/phase | "1 s" | ~ must be an angle [rad], got "1 s": "s" measures something else
/scene/joints/tie/drive/times | [0] | ~ must have at least two times, got [0]
/scene/joints/tie/drive/times | [0, 0.1, 0.1] | ~/2 must be later than the time before it, got 0.1
/scene/joints/tie/drive/values | [0, 1] | ~ must be a list of 3 values, got [0,1]
/scene/joints/tie/drive/values/1 | "1 deg" | ~ must be a length [m], got "1 deg": "deg" measures something else
/scene/joints/floor/bodies/1 | "ball" | /scene/joints/floor/drive needs two bodies that can turn, but "ball" is a point mass
/scene/joints/second_shoulder | {"type": "revolute", "bodies": ["arm", "ground"], "at": [0.5, 0, 0], "axis": [0, 0, -1], "drive": {"type": "constant-speed", "speed": 1}} | ~/drive prescribes the same motion as the drive of the joint "shoulder"
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Loads, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/scene/loads/push/type | "weight" | ~ must be "force", "torque", "spring" or "joint", got "weight"
/scene/loads/push | 7 | ~ must be an object {…}, got 7
/scene/loads | [] | ~ must be an object {…}, got []
/scene/loads/push/place | [0, 0, 0] | ^ has the unknown key "place"; known are "type", "body", "at", "direction", "value", "follows" and "to"
/scene/loads/push/body | "ground" | ~ must name a body that can move, got "ground"
/scene/loads/push/body | "arn" | ~ names the unknown body "arn"; did you mean "arm"?
/scene/loads/push/at | remove | ^ is missing the key "at"
/scene/loads/push/at | [0.37, 0, 0.1] | ~ must be on the axis of the beam "arm", the nearest point is (0.37, 0, 0) [m], got (0.37, 0, 0.1)
/scene/loads/pull/at | [4, 1, 0] | ~ must be where the point mass "ball" is, (4, 0, 0) [m], got (4, 1, 0)
/scene/loads/push/at/0 | {"variable": "speed", "factor": 0.37} | ~ uses the variable "speed" as a length [m], but /scene/bodies/ball/velocity/0 uses it as a speed [m/s]
/scene/loads/push/direction | [0, 0, 0] | ~ must not be zero, got [0,0,0]
/scene/loads/push/direction/0 | "1 m" | ~ must be a number, got "1 m"
/scene/loads/push/value | "2 kg" | ~ must be a force [N], got "2 kg": "kg" measures something else
/scene/loads/push/value | null | ~ must be a force [N]: a number in SI units, a text with unit, a formula "= …" or {"variable": name}, got null
/scene/loads/push/value | {} | ~ is missing the key "type"
/scene/loads/push/value | {"type": "constant-speed", "speed": 1} | ~/type must be "constant", "polynomial", "harmonic", "table", "step", "ramp", "half-sine", "trapezoid" or "expression", got "constant-speed"
/scene/loads/push/value | {"type": "constant", "value": 1, "coordinate": "angle"} | ~ has the unknown key "coordinate"; known are "type" and "value"
/scene/loads/push/value | {"type": "constant"} | ~ is missing the key "value"
/scene/loads/push/value | {"variable": "fource"} | ~/variable names the unknown variable "fource"; did you mean "force"?
/scene/loads/push/follows | 1 | ~ must be true or false, got 1
/scene/loads/twist/body | "ball" | ~ must name a body that can turn, but "ball" is a point mass
/scene/loads/twist/value | "3 N" | ~ must be a torque [N m], got "3 N": "N" measures something else
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(ForceElements, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/scene/loads/strap/bodies | ["ground", "ground"] | ~ must name two bodies, got "ground" twice
/scene/loads/strap/bodies/1 | "bal" | ~ names the unknown body "bal"; did you mean "ball"?
/scene/loads/strap/at | [[4, 0, 0]] | ~ must be a list of 2 values, got [[4,0,0]]
/scene/loads/strap/at | [[4, 0, 0], [4, 0, 0]] | ~ must be two different points where "free_length" is not 0, got [[4,0,0],[4,0,0]]
/scene/loads/strap/at/1/0 | 4.5 | ^ must be where the point mass "ball" is, (4, 0, 0) [m], got (4.5, 0, 0)
/scene/loads/cord/at/0/1 | 1 | ^ must be on the axis of the beam "arm", the nearest point is (0.123, 0, 0) [m], got (0.123, 1, 0)
/scene/loads/strap/stiffness | remove | ^ needs "stiffness" or "resistance"
/scene/loads/strap/stiffness | -1 | ~ must not be negative [N/m], got -1
/scene/loads/strap/damping | "1 N m s" | ~ must be a damping constant [N s/m], got "1 N m s": "N m s" measures something else
/scene/loads/strap/free_length | "-1 mm" | ~ must not be negative [m], got "-1 mm"
/scene/loads/hinge/joint | "elbo" | ~ names the unknown joint "elbo"; did you mean "elbow"?
/scene/loads/hinge/joint | "tie" | ~ needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal" or "planar", but "tie" is of the type "distance"
/scene/loads/hinge/joint | "wrist" | ~ needs a joint of the type "revolute", "prismatic", "point-on-line", "cylindrical", "universal" or "planar", but "wrist" is of the type "spherical"
/scene/loads/hinge | {"type": "joint", "joint": "elbow"} | ~ needs "stiffness", "damping", "resistance" or "motor"
/scene/loads/hinge/rest | 0.1 | ~ is the rest position of a spring, and needs "stiffness" or "resistance"
/scene/loads/hinge/coordinate | "displacement" | ~ must be "angle" for a joint of the type "universal", got "displacement"
/scene/loads/stopper/coordinate | remove | ^ is missing the key "coordinate"
/scene/loads/hinge/motor | 1 | ~ would have no effect: the joint "elbow" is driven
/scene/loads/hinge/damping | "1 N s/m" | ~ must be a torsional damping constant [N m s/rad], got "1 N s/m": "N s/m" measures something else
/scene/loads/bush/motor | "1 N m" | ~ must be a force [N], got "1 N m": "N m" measures something else
/scene/loads/stopper/stiffness | -1 | ~ must not be negative [N/m], got -1
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Responses, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/responses/speed/type | "velocty" | ~ must be "mass", "stress", "deflection", "position", "velocity", "acceleration", "drive-torque", "drive-force", "drive-power", "reaction-force", "reaction-moment", "frequency", "buckling", "kinetic-energy", "elastic-energy", "energy-balance", "constraint-drift", "expression", "section-force", "angular-velocity", "joint-position", "joint-velocity", "spring-length", "spring-force", "motor-power", "damper-power", "angle", "angular-acceleration", "fatigue", "shear-stress", "fatigue-damage", "lateral-buckling", "jerk", "angular-jerk", "joint-acceleration", "damping-ratio", "growth-rate" or "transmission-angle", got "velocty"; did you mean "velocity"?
/responses/time | {"type": "mass"} | ~ has a name that files of histories need for their own columns: "time" and "…:error"
/responses/speed:error | {"type": "mass"} | ~ has a name that files of histories need for their own columns: "time" and "…:error"
/responses/speed/at | remove | ^ is missing the key "at"
/responses/speed/direction | "norm" | ~ must be "x", "y", "z" or "magnitude", got "norm"
/responses/speed/type | "position" | /responses/speed/direction must be "x", "y" or "z", got "magnitude"
/responses/jolt/at | 1 | ~ is for beams only, but "block" is none
/responses/energy/joint | "wrist" | ~ names the joint "wrist", which has no drive
/responses/effort/joint | "tie" | ~ names the joint "tie", whose drive has a drive-force
/responses/thrust/joint | "elbow" | ~ names the joint "elbow", whose drive has a drive-torque
/responses/bearing/joint | "pivt" | ~ names the unknown joint "pivt"; did you mean "pivot"?
/responses/bearing/direction | remove | ^ is missing the key "direction"
/responses/tone/mode | 0 | ~ must be a whole number from 1 to 1000, got 0
/responses/tone/body | "strut" | ~ must name an elastic beam, but "strut" is rigid
/responses/tone/body | "block" | ~ must name a beam, but "block" is none
/responses/tone/over_time | "max" | ~ is not for a frequency, which does not change in time
/constraints/resonance/lower | "100 1/s" | ~ must be a frequency [rad/s], got "100 1/s": "1/s" names no angle; write rad/s, deg/s or rpm
/responses/stability/over_time | remove | ^ is missing the key "over_time"
/responses/stability/body | "strut" | ~ must name an elastic beam, but "strut" is rigid
/responses/axial/body | "strut" | ~ must name an elastic beam, but "strut" is rigid
/responses/axial/part | "tension" | ~ must be "von-mises", "normal", "axial", "bending", "shear" or "utilization", got "tension"
/responses/shear/at | 0.5 | ^ has both "segment" and "at"
/responses/swing/body | "blok" | ~ names the unknown body "blok"; did you mean "block"?
/responses/spring/body | "strut" | ~ must name an elastic beam, but "strut" is rigid
/responses/motion/over_time | remove | ^ is missing the key "over_time"
/responses/missing/over_time | "max" | ~ is not for an energy-balance, which compares two times
/responses/drift/level | "speed" | ~ must be "position" or "velocity", got "speed"
/responses/normal/at | 1.1 | ~ must be a place along the beam from 0 to 1, got 1.1
/responses/normal/at | "0.2 m" | ~ must be a place along the beam from 0 to 1, got "0.2 m"
/responses/life | {"type": "fatigue", "body": "arm", "criterion": "goodmann"} | ~/criterion must be "goodman", "gerber" or "soderberg", got "goodmann"; did you mean "goodman"?
/responses/life | {"type": "fatigue", "body": "arm", "criterion": "gerber"} | ~/criterion needs the "endurance_limit" of the material "steel", which has none: give it in /scene/materials
/responses/life | {"type": "fatigue", "body": "arm", "criterion": "gerber", "over_time": "max"} | ~/over_time is not for a fatigue, which looks at the largest and the smallest stress of cycles
/responses/life | {"type": "fatigue", "body": "strut", "criterion": "gerber"} | ~/body must name an elastic beam, but "strut" is rigid
/responses/life | {"type": "fatigue-damage", "body": "arm", "criterion": "goodman"} | ~/criterion needs the "fatigue_strength" of the material "steel", which has none: give it in /scene/materials
/responses/tau | {"type": "shear-stress", "body": "arm", "at": 2, "over_time": "max"} | ~/at must be a place along the beam from 0 to 1, got 2
/responses/sideways | {"type": "lateral-buckling", "body": "strut", "over_time": "max"} | ~/body must name an elastic beam, but "strut" is rigid
/responses/force | {"type": "section-force", "body": "arm", "at": 0.5, "part": "axial", "side": "left", "over_time": "max"} | ~/side must be "before" or "behind", got "left"
/responses/bow | {"type": "deflection", "body": "arm", "at": 0.5, "chord": ["a", "b"], "against": "chord", "over_time": "max"} | ~/chord is for imported bodies with "against": "chord"; that of a beam is through its ends
/scene/materials/steel/endurance_limit | "100 N" | ~ must be a stress [Pa], got "100 N": "N" measures something else
/scene/materials/steel/fatigue_exponent | -8 | ~ must be positive, got -8
/scene/materials/steel/fatigue_exponent | 0.1 | ~ must be at least 1 (k of Basquin's line, 5 to 15 for metals; its slope b is -1/k), got 0.1
/scene/materials/steel/ultimate_strength | "100 MPa" | /scene/materials/steel/strength must not be more than the "ultimate_strength", got "250 MPa"
/responses/use/body | "rod" | /responses/use/part needs the strength of the material "glass", which has none
/constraints/strength/upper | "80 MPa" | ~ must be a number without unit, got "80 MPa": "MPa" measures something else
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Windows, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/responses/jolt/from | -0.01 | ~ must not be negative [s], got -0.01
/responses/jolt/from | 0.1 | ~ must be before the end of the simulation, 0.1 [s], got 0.1
/responses/jolt/to | "101 ms" | ~ must not be after the end of the simulation, 0.1 [s], got "101 ms"
/responses/jolt/to | 0.02 | ~ must be later than "from", got 0.02
/responses/effort/to | 0 | ~ must be positive [s], got 0
/responses/jolt/from | "1 m" | ~ must be a time [s], got "1 m": "m" measures something else
/simulation/end_time | 0.05 | /responses/jolt/to must not be after the end of the simulation, 0.05 [s], got 0.1 | 3
)rows")),
                         named_by(&BadEdit::pointer));

INSTANTIATE_TEST_SUITE_P(Settings, BadMechanismFile, testing::ValuesIn(bad_edits(R"rows(
/effects/elasticity | 1 | ~ must be "auto", "on" or "off", got 1
/effects/rotary_inertia | "offf" | ~ must be "auto", "on" or "off", got "offf"; did you mean "off"?
/effects/tolerance | 1 | ~ must be at least 0 and less than 1, got 1
/effects/tolerance | -1e-3 | ~ must be at least 0 and less than 1, got -0.001
/effects/tolerance | "1 %" | ~ must be a number, got "1 %"
/simulation/initial_state | "static" | ~ must be "consistent", "quasi-static" or "periodic", got "static"
/simulation/initial_state | {"type": "steady"} | ~/type must be "consistent", "quasi-static" or "periodic", got "steady"
/simulation/initial_state | {"type": "periodic", "turns": 2} | ~ has the unknown key "turns"; known are "type" and "period"
/simulation/initial_state | {"type": "quasi-static", "period": "0.1 s"} | ~/period is for the initial state "periodic" only
/simulation/initial_state | {"type": "periodic", "period": "0.04 s"} | ~/period must fit into /simulation/end_time a whole number of times, and does so 2.5 times, got "0.04 s"
/simulation/initial_state | {"type": "periodic", "period": "0.1 kg"} | ~/period must be a time [s], got "0.1 kg": "kg" measures something else
)rows")),
                         named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::scene_rules_test
