#include "core/scene/reading/across_cases.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/goal_reader.hpp"
#include "core/scene/reading/response_reader.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "core/scene/reading/variable_reader.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

namespace {

/// The constants that are the same in all cases by their names, others with a case behind them.
std::vector<Symbol> symbols_across(const std::vector<std::vector<Symbol>>& of_cases,
                                   const ProblemFile& joined) {
  const std::set<std::string> differing = differing_constants(of_cases);
  std::vector<Symbol> all;
  for (std::size_t c = 0; c < of_cases.size(); ++c) {
    for (Symbol symbol : of_cases[c]) {
      const bool differs = differing.contains(symbol.name);
      if (differs) symbol.name = name_in_case(symbol.name, joined.cases[c].load_case);
      if (differs || c == 0) all.push_back(std::move(symbol));
    }
  }
  return all;
}

/// A limit or a response cannot say again in which cases it is meant.
void forbid(const JsonNode& node, const char* key) {
  if (const auto found = node.find(key)) {
    found->fail("is for a response that each case has; this one names its cases itself");
  }
}

/// Whether no case has what is called so.
template <class Named>
bool is_across(const ProblemFile& joined, const std::string& name,
               std::vector<Named> ProblemFile::*named) {
  return std::ranges::none_of(joined.cases, [&](const ProblemFile& one) {
    return find_named(one.*named, name) != nullptr;
  });
}

void read_across_responses(const JsonNode& node, NumberReader& numbers, ProblemFile& joined) {
  for (const auto& [name, response] : node.members()) {
    if (!is_across(joined, name, &ProblemFile::responses)) continue;
    if (find_named(joined.responses, name) != nullptr) {
      response.fail("has the name that another response has in one of the cases");
    }
    joined.responses.push_back(read_expression_response(name, response, joined.responses, numbers));
  }
}

void read_across_constraints(const JsonNode& node, NumberReader& numbers, ProblemFile& joined) {
  for (const auto& [name, limit] : node.members()) {
    if (!is_across(joined, name, &ProblemFile::constraints)) continue;
    forbid(limit, "cases");
    joined.constraints.push_back(read_constraint(name, limit, joined.responses, numbers));
    joined.case_constraints.push_back({several_cases, 0});
  }
}

/// Variables are what the cases use them as.
void add_uses(const JsonNode& root, const ProblemFile& joined, NumberReader& numbers) {
  const JsonNode scene(root.value(), root.file(), "", "the scene");
  for (int i = 0; i < int_size(joined.variables); ++i) {
    numbers.add_use({Number::bound(i), joined.variables[i].quantity, Range::any, scene});
  }
}

/// What is minimized or limited over several cases, or said to count, has to be accurate in each of them.
void ask_for_accuracies(const JsonNode& root, ProblemFile& joined) {
  const auto accuracy = root.find("accuracy");
  if (const auto listed = accuracy ? accuracy->find("responses") : std::nullopt) {
    for (const JsonNode& name : listed->items()) {
      const auto index = index_of_named(joined.responses, spaced_case(name.text()));
      const bool is_of_one = split_case(name.text()).has_value();
      if (!index && is_of_one) {
        fail_unknown_name(name, "response", name.text(), names_of(joined.responses));
      }
      if (index && (is_of_one || is_over_cases(joined, *index))) ask_for_accuracy(joined, *index);
    }
  }
  const auto ask = [&](const std::string& name) {
    ask_for_accuracy(joined, index_of_named(joined.responses, name).value());
  };
  if (joined.objective && !joined.cases.front().objective) ask(joined.objective->response);
  for (std::size_t i = 0; i < joined.constraints.size(); ++i) {
    if (is_of_several(joined.case_constraints[i])) ask(joined.constraints[i].response);
  }
}

}  // namespace

void read_across_cases(const JsonNode& root, const std::vector<std::vector<Symbol>>& of_cases,
                       ProblemFile& joined) {
  NumberReader numbers(variable_names(root));
  numbers.declare(symbols_across(of_cases, joined));
  add_uses(root, joined, numbers);
  if (const auto node = root.find("responses")) read_across_responses(*node, numbers, joined);
  const auto objective = root.find("objective");
  if (objective && !joined.objective) {
    forbid(*objective, "over_cases");
    joined.objective = read_objective(*objective, joined.responses, numbers);
  }
  if (const auto node = root.find("constraints")) read_across_constraints(*node, numbers, joined);
  joined.case_responses.resize(joined.responses.size(), {several_cases, 0});
  for (const VariableMention& mention : numbers.mentions()) numbers.check_mention(mention);
  joined.pareto.reset();
  if (const auto pareto = root.find("pareto"))
    joined.pareto = read_pareto(*pareto, joined, numbers);
  ask_for_accuracies(root, joined);
}

}  // namespace pleuel
