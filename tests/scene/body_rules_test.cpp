/// Bounds that allow bodies which cannot be.
#include "core/scene/body_rules.hpp"

#include <gtest/gtest.h>

#include "tests/scene/good_problem.hpp"

namespace pleuel::test::body_rules_test {
namespace {

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
}  // namespace pleuel::test::body_rules_test
