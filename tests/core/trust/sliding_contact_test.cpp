/// What slides along beams.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/not_modelled.hpp"
#include "tests/core/trust/findings_of.hpp"

namespace pleuel::test::sliding_contact_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A mass that is moved along a horizontal arm of 1 m, or beyond its end.
std::string scene_of_trolley(double from, double way, const std::string& arm) {
  return fmt::format(
      R"({{"gravity": [0, -9.81, 0], "bodies": {{
            "arm": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                     "section": {{"type": "circle", "diameter": 0.03}}, "elements": 5{}}},
            "trolley": {{"type": "point-mass", "at": [{}, 0, 0], "mass": 1}}}},
          "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]}},
                      "rail": {{"type": "point-on-line", "bodies": ["arm", "trolley"], "at": [{}, 0, 0],
                                "axis": [1, 0, 0], "drive": {{"type": "table", "times": [0, 0.2],
                                                              "values": [0, {}]}}}}}}}})",
      arm, from, from, way);
}

ProblemFile trolley(double from, double way, const std::string& arm) {
  return read_scene(
      fmt::format(R"({{"scene": {}, "simulation": {{"end_time": 0.2, "step": 0.01}}}})",
                  scene_of_trolley(from, way, arm)));
}

/// A carriage whose line goes past the tip of the arm: its force stays at the tip.
TEST(SlidingContact, IsNoneWhereTheLineBelongsToTheOtherBody) {
  const ProblemFile problem = read_scene(
      R"({"scene": {"gravity": [0, -9.81, 0], "bodies": {
            "arm": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                    "section": {"type": "circle", "diameter": 0.03}, "elements": 5},
            "carriage": {"type": "rigid", "at": [1, 0, 0], "mass": 1,
                         "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}},
          "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]},
                     "rail": {"type": "prismatic", "bodies": ["ground", "carriage"],
                              "at": [1, 0, 0], "axis": [1, 0, 0],
                              "drive": {"type": "table", "times": [0, 0.2], "values": [0, -0.6]}},
                     "slot": {"type": "point-on-line", "bodies": ["carriage", "arm"],
                              "at": [1, 0, 0], "axis": [1, 0, 0]}}},
          "simulation": {"end_time": 0.2, "step": 0.01}})");
  EXPECT_THAT(findings_of(problem, check_sliding_contacts), IsEmpty());
}

/// What moves has no bar then; the mass has.
TEST(SlidingContact, LeavesNumbersWithoutABar) {
  for (const bool is_elastic : {true, false}) {
    const ProblemFile problem =
        read_scene(fmt::format(R"({{"scene": {}, "simulation": {{"end_time": 0.2, "step": 0.01}},
                        "responses": {{"mass": {{"type": "mass"}},
                                       "force": {{"type": "drive-force", "joint": "rail", "over_time": "max"}}}}}})",
                               scene_of_trolley(0.2, 0.6, is_elastic ? "" : R"(, "rigid": true)")));
    const Trust trust = judge_run(StartRun(problem).run());
    EXPECT_TRUE(trust.errors[0]->is_modelled);
    EXPECT_EQ(trust.errors[1]->is_modelled, !is_elastic);
    EXPECT_FALSE(is_elastic && trust.errors[1]->is_resolved());
  }
}

TEST(SlidingContact, IsADoubtWhereItTravelsOverAnElasticBeam) {
  const std::vector<Finding> findings = findings_of(trolley(0.2, 0.6, ""), check_sliding_contacts);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_THAT(findings[0].text,
              HasSubstr("\"trolley\" slides 0.6 m along the elastic beam \"arm\""));
  EXPECT_THAT(findings_of(trolley(0.2, 0.6, R"(, "frames": 2)"), check_sliding_contacts),
              SizeIs(1));
  EXPECT_THAT(findings_of(trolley(0.2, 0.01, ""), check_sliding_contacts), IsEmpty());
  EXPECT_THAT(findings_of(trolley(1.0, 0.6, ""), check_sliding_contacts), IsEmpty());
  EXPECT_THAT(findings_of(trolley(0.2, 0.6, R"(, "rigid": true)"), check_sliding_contacts),
              IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::sliding_contact_test
