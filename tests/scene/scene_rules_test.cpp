#include "core/scene/scene_rules.hpp"

#include "core/base/error.hpp"
#include "core/scene/body_rules.hpp"
#include "tests/scene/good_problem.hpp"
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
                         "value": "10 N"}}
    },
    "simulation": {"end_time": "2 ms", "step": "1 ms"},
    "variables": {"a": {"start": 1, "lower": 0.6, "upper": 1.5}, "b": {"start": 0.5, "lower": 0.4, "upper": 0.9}},
    "responses": {"mass": {"type": "mass"}},
    "objective": {"minimize": "= mass + 0 kg*(a + b)"
}
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

}  // namespace
}  // namespace pleuel::test::scene_rules_test
