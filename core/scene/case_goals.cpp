#include "core/scene/case_goals.hpp"

#include <algorithm>
#include <memory>

#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

std::size_t index_of(const ProblemFile& problem, const std::string& response) {
  return index_of_named(problem.responses, response).value();
}

std::string word_of(const Objective& goal) {
  if (goal.over_cases == OverCases::worst) return "worst";
  return goal.weights.empty() ? "sum" : "weighted";
}

double weight_of(const Objective& goal, const ProblemFile& load_case) {
  if (goal.over_cases == OverCases::worst || goal.weights.empty()) return 1.0;
  double weight = 0.0;
  for (const auto& [name, value] : goal.weights) {
    if (is_in_case({name}, load_case)) weight = value;
  }
  return weight;
}

/// Puts a number together from those of the cases: their largest or smallest, or a weighted sum.
Expression formula_over_cases(const ProblemFile& joined, const Objective& goal, std::size_t index) {
  const Operation operation = goal.over_cases == OverCases::weighted ? Operation::plus
                              : goal.aim == Aim::maximize            ? Operation::smaller
                                                                     : Operation::larger;
  Expression whole;
  const auto add = [&](const ExpressionStep& step) {
    whole.steps.push_back(step);
    return int_size(whole.steps) - 1;
  };
  std::optional<int> last;
  for (std::size_t c = 0; c < joined.cases.size(); ++c) {
    const double weight = weight_of(goal, joined.cases[c]);
    if (weight == 0.0) continue;
    whole.arguments.push_back(
        {ExpressionArgument::Kind::response, joined_response(joined, {c, index})});
    int term = add({Operation::argument, 0.0, int_size(whole.arguments) - 1});
    if (weight != 1.0) {
      term = add({Operation::times, 0.0, add({Operation::constant, weight}), term});
    }
    last = last ? add({operation, 0.0, *last, term}) : term;
  }
  return whole;
}

ResponseSettings response_over_cases(const ProblemFile& joined, const Objective& goal,
                                     std::size_t index) {
  const ResponseSettings& first = joined.responses[joined_response(joined, {0, index})];
  const Quantity quantity = quantity_of(first);
  ResponseSettings over_cases;
  over_cases.name = name_in_case(goal.response, word_of(goal));
  over_cases.unit = first.unit;
  over_cases.unit_scale = first.unit_scale;
  Expression formula = formula_over_cases(joined, goal, index);
  formula.text = over_cases.name;
  formula.quantity = quantity.name;
  formula.unit = quantity.unit;
  over_cases.what = ExpressionResponse{std::make_shared<const Expression>(std::move(formula))};
  return over_cases;
}

bool is_same(const Expression& one, const Expression& other) {
  return one.steps == other.steps && one.arguments == other.arguments;
}

ConstraintSettings limit_on(const Objective& goal, double value, const std::string& name,
                            const std::string& response) {
  ConstraintSettings constraint;
  constraint.name = name;
  constraint.response = response;
  (goal.aim == Aim::minimize ? constraint.upper : constraint.lower) = value;
  return constraint;
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
    const Expression* formula = formula_of(response);
    if (formula == nullptr) continue;
    Expression expression = *formula;
    for (ExpressionArgument& argument : expression.arguments) {
      if (argument.kind != ExpressionArgument::Kind::response) continue;
      argument.index =
          joined_response(joined, {joined.case_responses[i].load_case, argument.index});
    }
    response.what = ExpressionResponse{std::make_shared<const Expression>(std::move(expression))};
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

Objective goal_of_problem(ProblemFile& problem, Objective goal) {
  if (!problem.has_cases() || goal.over_cases == OverCases::same) return goal;
  const std::size_t index = index_of(problem.cases.front(), goal.response);
  ResponseSettings over_cases = response_over_cases(problem, goal, index);
  const ResponseSettings* known = find_named(problem.responses, over_cases.name);
  while (known != nullptr && !is_same(*formula_of(*known), *formula_of(over_cases))) {
    over_cases.name += " (other weights)";
    known = find_named(problem.responses, over_cases.name);
  }
  goal.response = over_cases.name;
  if (known != nullptr) return goal;
  problem.responses.push_back(std::move(over_cases));
  problem.case_responses.push_back({several_cases, index});
  return goal;
}

void set_objective(ProblemFile& problem, const Objective& goal) {
  problem.objective = goal;
  if (!problem.has_cases()) return;
  const std::size_t response = index_of(problem, goal.response);
  problem.case_weights.clear();
  for (ProblemFile& one : problem.cases) {
    one.objective.reset();
    if (goal.over_cases == OverCases::same) continue;
    one.objective = goal;
    one.objective->response = one.responses[problem.case_responses[response].index].name;
    problem.case_weights.push_back(weight_of(goal, one));
  }
  if (goal.over_cases == OverCases::same) ask_for_accuracy(problem, response);
}

void add_limit(ProblemFile& problem, const Objective& goal, double value, const std::string& name) {
  if (!problem.has_cases()) {
    problem.constraints.push_back(limit_on(goal, value, name, goal.response));
    return;
  }
  const std::size_t response = index_of(problem, goal.response);
  if (goal.over_cases != OverCases::worst) {
    problem.constraints.push_back(limit_on(goal, value, name, goal.response));
    problem.case_constraints.push_back({several_cases, 0});
    ask_for_accuracy(problem, response);
    return;
  }
  const std::size_t index = problem.case_responses[response].index;
  for (std::size_t c = 0; c < problem.cases.size(); ++c) {
    ProblemFile& one = problem.cases[c];
    const std::string& joined = problem.responses[joined_response(problem, {c, index})].name;
    problem.constraints.push_back(limit_on(goal, value, name_in_case(name, one.load_case), joined));
    problem.case_constraints.push_back({c, one.constraints.size()});
    one.constraints.push_back(limit_on(goal, value, name, one.responses[index].name));
  }
}

void remove_limit(ProblemFile& problem, const std::string& name) {
  std::vector<std::size_t> rows = constraints_of_limit(problem, name);
  std::ranges::reverse(rows);
  for (const std::size_t row : rows) {
    if (problem.has_cases()) {
      const OfCase of_case = problem.case_constraints[row];
      if (!is_of_several(of_case)) problem.cases[of_case.load_case].constraints.pop_back();
      problem.case_constraints.erase(problem.case_constraints.begin() + row);
    }
    problem.constraints.erase(problem.constraints.begin() + row);
  }
}

const std::string& limit_name(const ProblemFile& problem, std::size_t constraint) {
  const OfCase of_case = case_of_constraint(problem, constraint);
  if (!problem.has_cases() || is_of_several(of_case)) return problem.constraints[constraint].name;
  return problem.cases[of_case.load_case].constraints[of_case.index].name;
}

std::vector<std::size_t> constraints_of_limit(const ProblemFile& problem, const std::string& name) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    if (problem.constraints[i].name == name || limit_name(problem, i) == name) rows.push_back(i);
  }
  return rows;
}

void ask_for_accuracy(ProblemFile& problem, std::size_t response) {
  for (const std::size_t part : parts_in_cases(problem, response)) {
    const OfCase of_case = problem.case_responses[part];
    ProblemFile& one = problem.cases[of_case.load_case];
    const std::string& name = one.responses[of_case.index].name;
    std::vector<std::string>& asked = one.accuracy.responses;
    if (std::ranges::find(asked, name) == asked.end()) asked.push_back(name);
  }
}

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
