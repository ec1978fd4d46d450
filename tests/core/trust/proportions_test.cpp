#include "core/base/eager_matrices.hpp"
#include "core/trust/check_list.hpp"
#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

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
      sample_problem("slider_crank", {"/simulation/end_time=0.1 ms", GetParam().override_text});
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
    StartRun start(sample_problem("slider_crank", {"/simulation/end_time=0.1 ms"}));
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
                       "value": {"type": "constant", "value": "100 N"}}}
  },
  "simulation": {"end_time": 0.05, "step": 0.001},
  "variables": {"d": {"start": "10 mm", "lower": "5 mm", "upper": "30 mm"}},
  "responses": {
    "mass": {"type": "mass"},
    "sag": {"type": "deflection", "body": "beam", "at": 1, "direction": "y", "over_time": "max"},
    "low": {"type": "deflection", "body": "beam", "at": 1, "direction": "y", "over_time": "min"},
    "far": {"type": "deflection", "body": "beam", "at": 1, "direction": "y", "over_time": "max-abs"},
    "early": {"type": "deflection", "body": "beam", "at": 1, "direction": "y",
              "over_time": "max-abs", "to": 0.01},
    "moment": {"type": "section-force", "body": "beam", "at": 0.01, "part": "moment-z",
               "over_time": "min"},
    "axial": {"type": "section-force", "body": "beam", "at": 0.01, "part": "axial",
              "over_time": "max"},
    "height": {"type": "position", "body": "beam", "at": 1, "direction": "y", "over_time": "max"}
  },
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

}  // namespace
}  // namespace pleuel::test::proportions_test
