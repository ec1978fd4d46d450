#include "core/scene/reading/goal_reader.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/mistakes.hpp"
#include "core/scene/reading/response_reader.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {
namespace {

/// The quantity that the terms have in common: that of the first variable bound in the scene.
Quantity quantity_of(const std::vector<std::pair<int, double>>& linear,
                     const NumberReader& numbers) {
  for (const auto& [variable, coefficient] : linear) {
    if (const auto quantity = numbers.quantity_of(variable)) return *quantity;
  }
  return quantities::pure_number;
}

Quantity read_linear(const JsonNode& node, ConstraintSettings& constraint, NumberReader& numbers) {
  const JsonMembers members = node.members();
  for (const auto& [name, coefficient] : members) {
    if (coefficient.number() == 0.0) coefficient.fail_with_value("must not be zero");
    constraint.linear.emplace_back(numbers.variable(coefficient, name), coefficient.number());
  }
  if (members.empty()) node.fail("must have at least one variable");
  const bool is_used = std::ranges::any_of(constraint.linear, [&](const auto& term) {
    return numbers.quantity_of(term.first).has_value();
  });
  // The scene of one load case may not use what that of another does: their units tell.
  for (const auto& [variable, coefficient] : constraint.linear) {
    if (!is_used) numbers.count_as_used(variable);
  }
  const Quantity quantity = quantity_of(constraint.linear, numbers);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto& [variable, coefficient] = constraint.linear[i];
    numbers.add_use(
        {Number::bound(variable, coefficient), quantity, Range::any, members[i].second});
  }
  return quantity;
}

void read_limits(const JsonNode& node, const Quantity& quantity, const NumberReader& numbers,
                 ConstraintSettings& constraint) {
  const std::optional<JsonNode> lower = node.find("lower"), upper = node.find("upper");
  if (!lower && !upper) node.fail("has no limit; it needs \"upper\", \"lower\" or both");
  if (lower) constraint.lower = numbers.fixed(*lower, quantity);
  if (upper) constraint.upper = numbers.fixed(*upper, quantity);
  if (lower && upper && *constraint.lower > *constraint.upper) {
    lower->fail_with_value("must not be above the upper limit");
  }
  if (const auto deviations = node.find("deviations")) {
    constraint.deviations = deviations->number();
    if (constraint.deviations <= 0.0) deviations->fail_with_value("must be positive");
    if (lower && upper) deviations->fail("is for one limit; this constraint has two");
  }
}

/// People see a response in the unit of its first limit, unless it says its own.
void show_as_limited(const JsonNode& node, ResponseSettings& response) {
  for (const char* key : {"upper", "lower"}) {
    const std::optional<JsonNode> limit = node.find(key);
    if (!limit || !response.unit.empty()) continue;
    response.unit = written_unit({*limit});
    if (response.unit.empty()) continue;
    response.unit_scale = unit_scale(response.unit, quantity_of(response));
  }
}

/// What {"minimize": …} or {"maximize": …} names.
std::pair<JsonNode, Aim> read_aim(const JsonNode& node) {
  node.allow_keys({"minimize", "maximize", "over_cases"});
  const auto largest = node.find("maximize");
  if (!largest) return {node.at("minimize"), Aim::minimize};
  if (node.find("minimize")) node.fail("has both \"minimize\" and \"maximize\"");
  return {*largest, Aim::maximize};
}

std::vector<std::string> read_case_names(const JsonNode& node) {
  std::vector<std::string> names;
  for (const JsonNode& name : node.items()) names.push_back(name.text());
  if (names.empty()) node.fail("must name at least one case");
  return names;
}

void read_over_cases(const JsonNode& node, Objective& objective) {
  if (node.value().is_object()) {
    objective.over_cases = OverCases::weighted;
    for (const auto& [name, weight] : node.members()) {
      if (weight.number() <= 0.0) weight.fail_with_value("must be positive");
      objective.weights.emplace_back(name, weight.number());
    }
    if (objective.weights.empty()) node.fail("must give at least one case a weight");
    return;
  }
  static constexpr Choice<OverCases> choices[] = {{"worst", OverCases::worst},
                                                  {"sum", OverCases::weighted}};
  objective.over_cases = read_choice(node, choices);
}

/// Of a limit that holds in several cases the first of them.
const ConstraintSettings& read_varied_constraint(const JsonNode& node, const ProblemFile& problem,
                                                 const NumberReader& numbers, std::string& name) {
  name = node.text();
  std::vector<std::size_t> rows = constraints_of_limit(problem, name);
  if (rows.empty() && problem.has_cases()) {
    name = spaced_case(name);
    rows = constraints_of_limit(problem, name);
  }
  if (rows.empty()) {
    numbers.require_here(node);
    std::vector<std::string> known = names_of(problem.constraints);
    for (const ProblemFile& one : problem.cases) {
      for (const ConstraintSettings& limit : one.constraints) {
        if (std::ranges::find(known, limit.name) == known.end()) {
          known.push_back(limit.name);
        }
      }
    }
    fail_unknown_name(node, "constraint", node.text(), known);
  }
  const ConstraintSettings& constraint = problem.constraints[rows.front()];
  if (constraint.lower && constraint.upper) {
    node.fail(fmt::format("must name a constraint with one limit, but \"{}\" has two", name));
  }
  return constraint;
}

Quantity quantity_of(const ConstraintSettings& constraint, const ProblemFile& problem) {
  const ResponseSettings* response = find_named(problem.responses, constraint.response);
  return response ? quantity_of(*response)
                  : problem.variables[constraint.linear.front().first].quantity;
}

}  // namespace

ConstraintSettings read_constraint(const std::string& name, const JsonNode& node,
                                   std::vector<ResponseSettings>& responses,
                                   NumberReader& numbers) {
  node.allow_keys({"response", "linear", "lower", "upper", "deviations", "cases"});
  ConstraintSettings constraint;
  constraint.name = name;
  if (const auto cases = node.find("cases")) constraint.cases = read_case_names(*cases);
  const std::optional<JsonNode> linear = node.find("linear");
  if (linear && node.find("response")) node.fail("has both \"response\" and \"linear\"");
  if (linear) {
    if (!constraint.cases.empty()) {
      node.at("cases").fail("is for a limit on a response: variables are the same in all cases");
    }
    read_limits(node, read_linear(*linear, constraint, numbers), numbers, constraint);
    return constraint;
  }
  ResponseSettings& response = read_response_or_formula(node.at("response"), responses, numbers);
  constraint.response = response.name;
  read_limits(node, quantity_of(response), numbers, constraint);
  show_as_limited(node, response);
  return constraint;
}

Objective read_objective(const JsonNode& node, std::vector<ResponseSettings>& responses,
                         NumberReader& numbers) {
  const auto [name, aim] = read_aim(node);
  Objective objective{read_response_or_formula(name, responses, numbers).name, aim};
  if (const auto over_cases = node.find("over_cases")) read_over_cases(*over_cases, objective);
  return objective;
}

std::vector<ConstraintSettings> read_constraints(const JsonNode& node,
                                                 std::vector<ResponseSettings>& responses,
                                                 NumberReader& numbers) {
  std::vector<ConstraintSettings> constraints;
  read_each(node, [&](const std::string& name, const JsonNode& constraint) {
    numbers.read_or_leave_out(name, [&] {
      constraints.push_back(read_constraint(name, constraint, responses, numbers));
    });
  });
  return constraints;
}

std::vector<std::string> names_of_cases(const std::vector<ProblemFile>& cases) {
  std::vector<std::string> names;
  for (const ProblemFile& one : cases) {
    const bool is_new = std::ranges::find(names, one.case_range) == names.end();
    if (is_new && !one.case_range.empty()) names.push_back(one.case_range);
  }
  for (const ProblemFile& one : cases) names.push_back(one.load_case);
  return names;
}

void check_weights(const JsonNode& node, const CaseWeights& weights,
                   const std::vector<ProblemFile>& cases) {
  const std::vector<std::string> known = names_of_cases(cases);
  for (const auto& [name, weight] : weights) {
    if (std::ranges::find(known, name) == known.end()) {
      fail_unknown_name(node.at(name), "case", name, known);
    }
  }
  for (const ProblemFile& one : cases) {
    std::string before;
    for (const auto& [name, weight] : weights) {
      if (!is_in_case({name}, one)) continue;
      if (!before.empty()) {
        node.at(name).fail(fmt::format(
            "gives the case \"{}\" a second weight, beside that of \"{}\": give weights to a "
            "range or to its cases, not to both",
            one.load_case, before));
      }
      before = name;
    }
  }
}

namespace {

/// A response that each case has by itself: the worst, unless the goal or the objective says more.
void read_goal_over_cases(const std::optional<JsonNode>& node, const ProblemFile& problem,
                          Objective& goal) {
  goal.over_cases = OverCases::worst;
  if (node) {
    read_over_cases(*node, goal);
    return check_weights(*node, goal.weights, problem.cases);
  }
  const auto& objective = problem.cases.front().objective;
  if (!objective || objective->response != goal.response || !problem.objective ||
      problem.objective->over_cases == OverCases::same) {
    return;
  }
  goal.over_cases = problem.objective->over_cases;
  goal.weights = problem.objective->weights;
}

/// "mass", {"minimize": "mass"} or {"maximize": "speed"}; with load cases also a response of one of
/// them, "bow[fast]", or of all, {"minimize": "bow", "over_cases": "sum"}.
Objective read_goal(const JsonNode& node, const ProblemFile& problem, const NumberReader& numbers) {
  std::vector<std::string> known = names_of(problem.responses);
  std::optional<JsonNode> over_cases;
  JsonNode name = node;
  Aim aim = Aim::minimize;
  if (node.value().is_object()) {
    std::tie(name, aim) = read_aim(node);
    over_cases = node.find("over_cases");
  }
  const std::string written = problem.has_cases() ? spaced_case(name.text()) : name.text();
  if (find_named(problem.responses, written) != nullptr) {
    if (over_cases && !numbers.is_of_case()) {
      over_cases->fail(problem.has_cases() ? "is for a response that differs from case to case"
                                           : "names cases, and the problem has none (\"cases\")");
    }
    return {written, aim};
  }
  numbers.require_here(name);
  if (problem.has_cases()) {
    for (const std::string& one : names_of(problem.cases.front().responses)) known.push_back(one);
  }
  Objective goal{read_known_name(name, "response", known), aim};
  read_goal_over_cases(over_cases, problem, goal);
  return goal;
}

constexpr int points_before_gaps = 3;

/// How many points, and where more of them come.
void read_spacing(const JsonNode& node, const NumberReader& numbers, ParetoSettings& pareto) {
  const auto gap = node.find("gap");
  if (gap) {
    pareto.gap = numbers.fixed(*gap, quantities::pure_number);
    if (pareto.gap < 0.001 || pareto.gap >= 1.0) {
      gap->fail_with_value("must be at least 0.001 and less than 1");
    }
    pareto.points = points_before_gaps;
  }
  if (const auto points = node.find("points")) pareto.points = points->whole_number(2, 10000);
  pareto.most_points = std::max(pareto.most_points, pareto.points);
  if (const auto most = node.find("most_points")) {
    if (!gap) most->fail("is for points that \"gap\" asks for");
    pareto.most_points = most->whole_number(pareto.points, 10000);
  }
}

ParetoSettings read_front_between(const JsonNode& node, const JsonNode& responses,
                                  const ProblemFile& problem, const NumberReader& numbers) {
  node.allow_keys({"responses", "points", "gap", "most_points"});
  ParetoSettings pareto;
  for (const JsonNode& goal : responses.items(2)) {
    pareto.goals.push_back(read_goal(goal, problem, numbers));
  }
  const Objective &first = pareto.goals[0], &second = pareto.goals[1];
  if (first.response == second.response && first.over_cases == second.over_cases &&
      first.weights == second.weights) {
    numbers.fail_or_leave_out(responses,
                              "must be two different responses");  // over cases they may be
  }
  read_spacing(node, numbers, pareto);
  return pareto;
}

}  // namespace

ParetoSettings read_pareto(const JsonNode& node, const ProblemFile& problem,
                           const NumberReader& numbers) {
  if (const auto responses = node.find("responses")) {
    return read_front_between(node, *responses, problem, numbers);
  }
  node.allow_keys({"constraint", "from", "to", "points", "gap", "most_points", "responses"});
  if (!problem.objective) {
    numbers.fail_or_leave_out(node, "needs an objective, and the problem has none");
  }
  ParetoSettings pareto;
  const ConstraintSettings& constraint =
      read_varied_constraint(node.at("constraint"), problem, numbers, pareto.constraint);
  const Quantity quantity = quantity_of(constraint, problem);
  pareto.from = numbers.fixed(node.at("from"), quantity);
  pareto.to = numbers.fixed(node.at("to"), quantity);
  if (pareto.from == pareto.to) node.at("to").fail_with_value("must differ from \"from\"");
  read_spacing(node, numbers, pareto);
  return pareto;
}

}  // namespace pleuel
