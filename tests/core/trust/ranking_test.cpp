#include "core/trust/finding.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::ranking_test {
namespace {

Finding finding(const std::string& text, Cause cause, bool is_serious) {
  Finding one{.text = text, .is_serious = is_serious, .cause = cause};
  return one;
}

std::string order_of(const std::vector<Finding>& findings) {
  std::string order;
  for (const Finding& one : findings) order += one.text;
  return order;
}

/// The unit is told, what is wrong with it follows.
TEST(Ranking, TellsTheCauseFirst) {
  std::vector<Finding> findings = {
      finding("a", Cause::left_out, true), finding("b", Cause::not_converged, false),
      finding("c", Cause::not_converged, true), finding("d", Cause::unit, false)};
  rank_findings(findings);
  EXPECT_EQ(order_of(findings), "dcba");
  EXPECT_EQ(count_consequences(findings), 3);
}

/// What only hangs there is no cause; it folds nothing.
TEST(Ranking, FoldsNothingBehindWhatIsNotSerious) {
  std::vector<Finding> findings = {finding("a", Cause::left_out, true),
                                   finding("b", Cause::mobility, false)};
  rank_findings(findings);
  EXPECT_EQ(order_of(findings), "ba");
  EXPECT_EQ(count_consequences(findings), 0);
  findings.push_back(finding("c", Cause::unstable, true));
  rank_findings(findings);
  EXPECT_EQ(order_of(findings), "bca");
  EXPECT_EQ(count_consequences(findings), 1);
}

}  // namespace
}  // namespace pleuel::test::ranking_test
