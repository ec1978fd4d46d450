#include "core/scene/joined_cases.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/base/find_named.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"

namespace pleuel {

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
