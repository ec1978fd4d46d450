#include "core/scene/load_cases.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

bool is_in_case(const std::vector<std::string>& names, const ProblemFile& load_case) {
  return names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
           return name == load_case.load_case || name == load_case.case_range;
         });
}

bool depends_on_masses_only(const ProblemFile& problem, std::size_t response) {
  const std::vector<std::size_t> parts = parts_of(problem, response);
  return std::all_of(parts.begin(), parts.end(), [&](std::size_t part) {
    return problem.responses[part].type == ResponseType::mass;
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

std::vector<const ProblemFile*> simulated_problems(const ProblemFile& problem) {
  std::vector<const ProblemFile*> problems;
  for (const ProblemFile& one : problem.cases) problems.push_back(&one);
  if (problems.empty()) problems.push_back(&problem);
  return problems;
}

std::vector<ProblemFile*> simulated_problems(ProblemFile& problem) {
  std::vector<ProblemFile*> problems;
  for (ProblemFile& one : problem.cases) problems.push_back(&one);
  if (problems.empty()) problems.push_back(&problem);
  return problems;
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

namespace {

std::size_t index_of(const ProblemFile& problem, const std::string& response) {
  return index_of_named(problem.responses, response).value();
}

void add_responses(ProblemFile& joined, const std::vector<bool>& is_same) {
  const std::vector<ResponseSettings> responses = std::move(joined.responses);
  joined.responses.clear();
  for (std::size_t i = 0; i < responses.size(); ++i) {
    for (std::size_t c = 0; c < (is_same[i] ? 1 : joined.cases.size()); ++c) {
      const ProblemFile& one = joined.cases[c];
      joined.responses.push_back(one.responses[i]);
      if (!is_same[i]) {
        joined.responses.back().name = name_in_case(one.responses[i].name, one.load_case);
      }
      joined.case_responses.push_back({c, i});
    }
  }
}

/// Formulas name responses by their indices: from here on those of the joined problem.
void renumber_formulas(ProblemFile& joined) {
  for (std::size_t i = 0; i < joined.responses.size(); ++i) {
    ResponseSettings& response = joined.responses[i];
    if (!response.expression) continue;
    Expression expression = *response.expression;
    for (ExpressionArgument& argument : expression.arguments) {
      if (argument.kind != ExpressionArgument::Kind::response) continue;
      argument.index =
          joined_response(joined, {joined.case_responses[i].load_case, argument.index});
    }
    response.expression = std::make_shared<const Expression>(std::move(expression));
  }
}

void add_constraint(ProblemFile& joined, const OfCase& of_case) {
  const ProblemFile& one = joined.cases[of_case.load_case];
  ConstraintSettings constraint = one.constraints[of_case.index];
  if (!constraint.response.empty()) {
    const std::size_t response = index_of(one, constraint.response);
    const std::size_t here = joined_response(joined, {of_case.load_case, response});
    const bool is_of_case = joined.responses[here].name != constraint.response;
    constraint.response = joined.responses[here].name;
    if (is_of_case) constraint.name = name_in_case(constraint.name, one.load_case);
  }
  joined.constraints.push_back(std::move(constraint));
  joined.case_constraints.push_back(of_case);
}

bool is_same_in_all(const ConstraintSettings& constraint, const ProblemFile& first,
                    const std::vector<bool>& is_same) {
  return constraint.response.empty() || is_same[index_of(first, constraint.response)];
}

/// Limit by limit; indices are those of the cases' problems with the limits that are meant there.
void add_constraints(ProblemFile& joined, const std::vector<bool>& is_same) {
  const std::vector<ConstraintSettings> all = std::move(joined.constraints);
  joined.constraints.clear();
  for (ProblemFile& one : joined.cases) {
    std::erase_if(one.constraints, [&](const ConstraintSettings& constraint) {
      const bool is_constant = is_same_in_all(constraint, one, is_same);
      return !is_constant && !is_in_case(constraint.cases, one);
    });
  }
  for (const ConstraintSettings& constraint : all) {
    const bool is_once = is_same_in_all(constraint, joined.cases.front(), is_same);
    for (std::size_t c = 0; c < (is_once ? 1 : joined.cases.size()); ++c) {
      const auto index = index_of_named(joined.cases[c].constraints, constraint.name);
      if (index) add_constraint(joined, {c, *index});
    }
  }
}

void join_objective(ProblemFile& joined) {
  Objective& objective = *joined.objective;
  if (objective.over_cases == OverCases::same) {
    const std::size_t index = index_of(joined.cases.front(), objective.response);
    objective.response = joined.responses[joined_response(joined, {0, index})].name;
  } else {
    set_objective(joined, goal_of_problem(joined, objective));
  }
}

}  // namespace

ProblemFile joined_cases(std::vector<ProblemFile> cases, const std::vector<bool>& is_same) {
  ProblemFile joined = cases.front();
  joined.load_case.clear();
  joined.case_range.clear();
  joined.cases = std::move(cases);
  for (ProblemFile& one : joined.cases) {
    // The trajectories of all cases are kept at a time.
    one.sensitivity.memory /= static_cast<double>(joined.cases.size());
  }
  add_responses(joined, is_same);
  renumber_formulas(joined);
  add_constraints(joined, is_same);
  if (joined.objective) join_objective(joined);
  return joined;
}

}  // namespace pleuel
