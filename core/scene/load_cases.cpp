#include "core/scene/load_cases.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/reading/suggestion.hpp"

namespace pleuel {

bool is_in_case(const std::vector<std::string>& names, const ProblemFile& load_case) {
  return names.empty() || std::ranges::any_of(names, [&](const std::string& name) {
           return name == load_case.load_case || name == load_case.case_range;
         });
}

std::string name_in_case(const std::string& name, const std::string& load_case) {
  return fmt::format("{} [{}]", name, load_case);
}

ProblemFile problem_of_case(const ProblemFile& problem, const std::string& name) {
  std::vector<std::string> names;
  for (const ProblemFile& one : problem.cases) {
    names.push_back(one.load_case);
    if (one.load_case != name) continue;
    ProblemFile found = one;
    found.name = name_in_case(problem.name, name);
    found.sensitivity.memory = problem.sensitivity.memory;
    if (found.objective) found.objective->over_cases = OverCases::same;
    return found;
  }
  throw InputError(names.empty()
                       ? fmt::format("there is no case \"{}\": the problem has no \"cases\"", name)
                       : fmt::format("/cases has no case \"{}\"{}", name, hint(name, names)));
}

std::string case_list(const ProblemFile& problem) {
  std::vector<std::string> names;
  for (const ProblemFile& one : problem.cases) names.push_back(one.load_case);
  return quoted_list(names, "and");
}

OfCase case_of_response(const ProblemFile& problem, std::size_t response) {
  return problem.has_cases() ? problem.case_responses[response] : OfCase{0, response};
}

OfCase case_of_constraint(const ProblemFile& problem, std::size_t constraint) {
  return problem.has_cases() ? problem.case_constraints[constraint] : OfCase{0, constraint};
}

bool is_over_cases(const ProblemFile& problem, std::size_t response) {
  return problem.has_cases() && is_of_several(problem.case_responses[response]);
}

std::size_t joined_response(const ProblemFile& problem, const OfCase& of_case) {
  if (!problem.has_cases()) return of_case.index;
  // One that is the same in all cases stands once, as of the first.
  std::size_t same = problem.case_responses.size();
  for (std::size_t i = 0; i < problem.case_responses.size(); ++i) {
    const OfCase& here = problem.case_responses[i];
    if (is_of_several(here) || here.index != of_case.index) continue;
    if (here.load_case == of_case.load_case) return i;
    if (here.load_case == 0) same = i;
  }
  return same;
}

}  // namespace pleuel
