#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/problem_file.hpp"

/// Load cases: one design in several scenes or settings.
namespace pleuel {

/// OfCase::load_case of a number that is made from those of several cases.
inline constexpr std::size_t several_cases = static_cast<std::size_t>(-1);

inline bool is_of_several(const OfCase& number) {
  return number.load_case == several_cases;
}

/// Whether a list of names means a case: by its own name or that of its range; an empty one all.
bool is_in_case(const std::vector<std::string>& names, const ProblemFile& load_case);

/// "peak [slow]"
std::string name_in_case(const std::string& name, const std::string& load_case);

/// The problem of one case as a problem of its own.
/// @throws InputError if there is no case of this name
ProblemFile problem_of_case(const ProblemFile& problem, const std::string& name);

/// Names of the cases, as in a sentence: `"slow", "fast" and "payload"`.
std::string case_list(const ProblemFile& problem);

/// The problems that are simulated: those of the cases, or the problem itself.
template <class Problem>
std::vector<Problem*> simulated_problems(Problem& problem) {
  std::vector<Problem*> problems;
  for (auto& one : problem.cases) problems.push_back(&one);
  if (problems.empty()) problems.push_back(&problem);
  return problems;
}

/// Where a response of a problem is simulated; itself where there are no cases.
OfCase case_of_response(const ProblemFile& problem, std::size_t response);
OfCase case_of_constraint(const ProblemFile& problem, std::size_t constraint);

/// Whether a response is made from those of several cases: that of an objective over cases, or an
/// expression that names cases. It is an expression of responses of the joined problem.
bool is_over_cases(const ProblemFile& problem, std::size_t response);

/// The response of the joined problem that a response of a case is.
std::size_t joined_response(const ProblemFile& problem, const OfCase& of_case);

}  // namespace pleuel
