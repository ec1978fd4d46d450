#include "core/trust/finding.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/load_cases.hpp"

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
  std::ranges::stable_sort(findings, [](const Finding& a, const Finding& b) {
    return std::tuple(a.cause, !a.is_serious) < std::tuple(b.cause, !b.is_serious);
  });
}

int count_consequences(const std::vector<Finding>& findings) {
  const Cause speaking = speaking_cause(findings);
  return static_cast<int>(std::ranges::count_if(
      findings, [&](const Finding& finding) { return finding.cause > speaking; }));
}

namespace {

/// A finding, and the cases that have it.
struct SharedFinding {
  Finding finding;
  std::vector<std::size_t> cases;
};

std::string prefix_of(const ProblemFile& problem, const std::vector<std::size_t>& cases) {
  if (cases.size() == problem.cases.size()) return "in all cases: ";
  std::string names;
  for (const std::size_t c : cases) {
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", problem.cases[c].load_case);
  }
  return fmt::format("in the case{} {}: ", cases.size() > 1 ? "s" : "", names);
}

Finding named_finding(const ProblemFile& problem, const SharedFinding& shared) {
  Finding finding = shared.finding;
  finding.text = prefix_of(problem, shared.cases) + finding.text;
  finding.responses.clear();
  for (const std::size_t c : shared.cases) {
    const std::vector<ResponseSettings>& all = problem.cases[c].responses;
    for (const std::string& name : shared.finding.responses) {
      if (const auto i = index_of_named(all, name)) {
        finding.responses.push_back(problem.responses[joined_response(problem, {c, *i})].name);
      }
    }
  }
  return finding;
}

}  // namespace

std::vector<Finding> joined_findings(const ProblemFile& problem,
                                     const std::vector<std::vector<Finding>>& of_cases) {
  if (!problem.has_cases()) return of_cases.front();
  std::vector<SharedFinding> all;
  for (std::size_t c = 0; c < of_cases.size(); ++c) {
    for (const Finding& finding : of_cases[c]) {
      const auto known = std::ranges::find_if(
          all, [&](const SharedFinding& one) { return one.finding.text == finding.text; });
      if (known == all.end()) {
        all.push_back({finding, {c}});
      } else if (known->cases.back() != c) {
        known->cases.push_back(c);
        known->finding.is_serious = known->finding.is_serious || finding.is_serious;
      }
    }
  }
  std::vector<Finding> findings;
  for (const SharedFinding& one : all) findings.push_back(named_finding(problem, one));
  rank_findings(findings);
  return findings;
}

}  // namespace pleuel
