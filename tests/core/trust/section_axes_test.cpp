#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/trust/lint.hpp"
#include "tests/core/trust/findings_of.hpp"

/// A post of 0.5 m along z whose tip a variable moves aside, pushed along y: 10 N · 0.5 m over W of 10 × 30 mm
/// is 3.33 MPa about its strong axis and 10 MPa about the weak one.
namespace pleuel::test::section_axes_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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
    const std::vector<Finding> findings = findings_of(post(aside), check_section_axes);
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_TRUE(findings[0].is_serious);
    EXPECT_THAT(findings[0].text, HasSubstr("the variable \"aside\" turns it"));
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
}  // namespace pleuel::test::section_axes_test
