#include "core/trust/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleuel::test::ranking_test {
namespace {

Doubt doubt(const std::string& text, Cause cause, bool is_serious) {
  Doubt one;
  one.text = text;
  one.cause = cause;
  one.is_serious = is_serious;
  return one;
}

std::string order_of(const std::vector<Doubt>& doubts) {
  std::string order;
  for (const Doubt& one : doubts) order += one.text;
  return order;
}

/// The unit is told, what is wrong with it follows.
TEST(Ranking, TellsTheCauseFirst) {
  std::vector<Doubt> doubts = {
      doubt("a", Cause::left_out, true), doubt("b", Cause::not_converged, false),
      doubt("c", Cause::not_converged, true), doubt("d", Cause::unit, false)};
  rank_doubts(doubts);
  EXPECT_EQ(order_of(doubts), "dcba");
  EXPECT_EQ(count_consequences(doubts), 3);
}

/// What only hangs there is no cause; it folds nothing.
TEST(Ranking, FoldsNothingBehindWhatIsNotSerious) {
  std::vector<Doubt> doubts = {doubt("a", Cause::left_out, true),
                               doubt("b", Cause::mobility, false)};
  rank_doubts(doubts);
  EXPECT_EQ(order_of(doubts), "ba");
  EXPECT_EQ(count_consequences(doubts), 0);
  doubts.push_back(doubt("c", Cause::unstable, true));
  rank_doubts(doubts);
  EXPECT_EQ(order_of(doubts), "bca");
  EXPECT_EQ(count_consequences(doubts), 1);
}

}  // namespace
}  // namespace pleuel::test::ranking_test
