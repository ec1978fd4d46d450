#include "core/trust/case_doubts.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/load_cases.hpp"
#include "core/trust/ranking.hpp"

namespace pleuel {

namespace {

/// A doubt, and the cases that have it.
struct SharedDoubt {
  Doubt doubt;
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

Doubt named_doubt(const ProblemFile& problem, const SharedDoubt& shared) {
  Doubt doubt = shared.doubt;
  doubt.text = prefix_of(problem, shared.cases) + doubt.text;
  doubt.responses.clear();
  for (const std::size_t c : shared.cases) {
    const std::vector<ResponseSettings>& all = problem.cases[c].responses;
    for (const std::string& name : shared.doubt.responses) {
      if (const auto i = index_of_named(all, name)) {
        doubt.responses.push_back(problem.responses[joined_response(problem, {c, *i})].name);
      }
    }
  }
  return doubt;
}

}  // namespace

std::vector<Doubt> joined_doubts(const ProblemFile& problem,
                                 const std::vector<std::vector<Doubt>>& of_cases) {
  if (!problem.has_cases()) return of_cases.front();
  std::vector<SharedDoubt> all;
  for (std::size_t c = 0; c < of_cases.size(); ++c) {
    for (const Doubt& doubt : of_cases[c]) {
      const auto known = std::find_if(all.begin(), all.end(), [&](const SharedDoubt& one) {
        return one.doubt.text == doubt.text;
      });
      if (known == all.end()) {
        all.push_back({doubt, {c}});
      } else if (known->cases.back() != c) {
        known->cases.push_back(c);
        known->doubt.is_serious = known->doubt.is_serious || doubt.is_serious;
      }
    }
  }
  std::vector<Doubt> doubts;
  for (const SharedDoubt& one : all) doubts.push_back(named_doubt(problem, one));
  rank_doubts(doubts);
  return doubts;
}

}  // namespace pleuel
