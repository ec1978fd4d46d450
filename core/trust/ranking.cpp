#include "core/trust/ranking.hpp"

#include <algorithm>
#include <tuple>

namespace pleuel {

namespace {

/// The highest class in which something is wrong; the lowest where nothing is.
Cause speaking_cause(const std::vector<Doubt>& doubts) {
  Cause cause = Cause::left_out;
  for (const Doubt& doubt : doubts) {
    if (doubt.is_serious || doubt.cause == Cause::unit) cause = std::min(cause, doubt.cause);
  }
  return cause;
}

}  // namespace

void rank_doubts(std::vector<Doubt>& doubts) {
  std::stable_sort(doubts.begin(), doubts.end(), [](const Doubt& a, const Doubt& b) {
    return std::tuple(a.cause, !a.is_serious) < std::tuple(b.cause, !b.is_serious);
  });
}

int count_consequences(const std::vector<Doubt>& doubts) {
  const Cause speaking = speaking_cause(doubts);
  return static_cast<int>(std::count_if(
      doubts.begin(), doubts.end(), [&](const Doubt& doubt) { return doubt.cause > speaking; }));
}

}  // namespace pleuel
