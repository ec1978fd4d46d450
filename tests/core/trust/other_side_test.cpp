#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/start_positions.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::other_side_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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
  const auto findings = findings_with_limits(R"({"stiff": {"response": "sag", "upper": "1 mm"}})");
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_THAT(findings[0].text, HasSubstr("holds \"sag\" at 1 mm to one side only"));
  EXPECT_THAT(findings[0].text, HasSubstr("comes to -"));
  EXPECT_FALSE(findings[0].is_serious);
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
}  // namespace pleuel::test::other_side_test
