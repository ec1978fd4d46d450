#include "core/trust/lint.hpp"

#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::lint_test {
namespace {

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
  return findings_of(read_scene(fmt::format(R"j({{"scene": {{
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 4,
      "section": {{"type": "circle", "diameter": "40 mm"}}}}}},
    "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{"push": {{"type": "force", "body": "bar", "at": ["{}", 0, 0], "direction": [0, -1, 0], "value": 1}}}}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms"}},
  "responses": {{"mass": {{"type": "mass"}}}}}})j",
                                            place)),
                     check_lost_places);
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
  return read_scene(fmt::format(
      R"j({{"scene": {{"gravity": [0, 0, 0],
        "bodies": {{"post": {{"type": "beam", "from": [0, 0, 0], "to": [0, "= aside", 0.5],
          "material": "steel", "elements": 2, {1}
          "section": {{"type": "rectangle", "width": {2}, "height": 0.03}}}}}},
        "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "post"], "at": [0, 0, 0]}}}},
        "loads": {{"push": {{"type": "force", "body": "post", "at": [0, "= aside", 0.5],
                           "direction": [0, 1, 0], "value": 10}}}}}},
      "simulation": {{"end_time": 0.01, "step": 0.005, "initial_state": "quasi-static"}},
      "variables": {{"aside": {{"start": "{0} m", "lower": "-0.1 m", "upper": "0.1 m"}}}},
      "responses": {{"stress": {{"type": "stress", "body": "post", "over_time": "max"}}}}}})j",
      aside, more, width));
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
  EXPECT_THAT(findings_of(post(0.0, R"("reference": [0, 1, 0],)"), check_section_axes), IsEmpty());
  EXPECT_THAT(findings_of(post(0.0, "", 0.03), check_section_axes), IsEmpty());
  ProblemFile fixed = post(0.0);
  fixed.variables[0].lower = fixed.variables[0].upper = 0.0;
  EXPECT_THAT(findings_of(fixed, check_section_axes), IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::lint_test
