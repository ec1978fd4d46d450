#include "core/trust/ranking.hpp"

#include <algorithm>
#include <tuple>

namespace pleuel {

namespace {

/// The highest class in which something is wrong; the lowest where nothing is.
Cause speaking_cause(const std::vector<Finding>& findings) {
  Cause cause = Cause::left_out;
  for (const Finding& finding : findings) {
    if (finding.is_serious || finding.cause == Cause::unit) cause = std::min(cause, finding.cause);
  }
  return cause;
}

}  // namespace

void rank_findings(std::vector<Finding>& findings) {
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return std::tuple(a.cause, !a.is_serious) < std::tuple(b.cause, !b.is_serious);
  });
}

int count_consequences(const std::vector<Finding>& findings) {
  const Cause speaking = speaking_cause(findings);
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const Finding& finding) { return finding.cause > speaking; }));
}

}  // namespace pleuel
