#include "core/scene/reading/case_reader.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/base/plain_file_name.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/goal_reader.hpp"
#include "core/scene/reading/override.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "core/scene/response_parts.hpp"
#include "core/scene/units.hpp"

namespace pleuel {
namespace {

constexpr int most_cases = 1000;

/// Blocks that a case may change.
constexpr std::array changeable = {"/scene", "/simulation", "/effects", "/constants"};

/// Whether a pointer is this place, or leads into it.
bool leads_into(const std::string& pointer, std::string_view place) {
  return pointer.starts_with(place) &&
         (pointer.size() == place.size() || pointer[place.size()] == '/');
}

void check_pointer(const std::string& pointer, const JsonNode& node) {
  if (!pointer.starts_with("/")) {
    node.fail("must be a JSON pointer such as \"/scene/gravity\", or \"range\"");
  }
  const bool is_changeable = std::ranges::any_of(
      changeable, [&](const char* place) { return leads_into(pointer, place); });
  if (!is_changeable) {
    node.fail(
        "must lead into /scene, /simulation, /effects or /constants: variables, responses, "
        "objective and limits are the same in all cases");
  }
}

WrittenQuantity read_end(const JsonNode& node) {
  if (node.value().is_number()) return {node.number(), ""};
  try {
    return split_quantity(node.text());
  } catch (const UnitError&) {
    node.fail_with_value("must be a number, or a number with a unit such as \"300 rpm\"");
  }
}

std::string text_of(const WrittenQuantity& quantity) {
  const std::string unit = quantity.unit.empty() ? "" : " " + quantity.unit;
  return fmt::format("{:.6g}{}", quantity.value, unit);
}

Json value_of(const WrittenQuantity& quantity) {
  if (quantity.unit.empty()) return quantity.value;
  return fmt::format("{} {}", quantity.value, quantity.unit);
}

/// The values of one number, at equal distances.
std::vector<WrittenQuantity> read_range(const JsonNode& node) {
  node.allow_keys({"from", "to", "count"});
  const WrittenQuantity from = read_end(node.at("from")), to = read_end(node.at("to"));
  if (from.unit != to.unit) {
    node.at("to").fail_with_value(fmt::format("must have the unit of \"from\", \"{}\"", from.unit));
  }
  if (from.value == to.value) node.at("to").fail_with_value("must differ from \"from\"");
  const int count = node.at("count").whole_number(2, most_cases);
  std::vector<WrittenQuantity> values;
  for (int i = 0; i < count; ++i) {
    const double share = double(i) / double(count - 1);
    values.push_back(
        {i + 1 == count ? to.value : from.value + share * (to.value - from.value), from.unit});
  }
  return values;
}

/// One case for each value; of several numbers together the first one names them.
std::vector<CaseChanges> read_ranges(const JsonNode& node, const CaseChanges& common) {
  std::vector<CaseChanges> cases;
  for (const auto& [pointer, range] : node.members()) {
    check_pointer(pointer, range);
    const std::vector<WrittenQuantity> values = read_range(range);
    if (cases.empty()) {
      cases.assign(values.size(), common);
      for (std::size_t i = 0; i < values.size(); ++i) {
        cases[i].range = common.name;
        cases[i].name += " " + text_of(values[i]);
      }
    }
    if (values.size() != cases.size()) {
      range.at("count").fail_with_value(
          fmt::format("must be {}, as of the other numbers of this range", cases.size()));
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      cases[i].values.emplace_back(pointer, value_of(values[i]));
    }
  }
  if (cases.empty()) node.fail("must have at least one number");
  return cases;
}

void check_case_name(const std::string& name, const JsonNode& node) {
  if (name == "worst" || name == "sum" || name == "weighted") {
    node.fail(fmt::format("must have another name: \"{}\" stands for all cases", name));
  }
  if (name.find_first_of("[]") != std::string::npos || name.front() == ' ' || name.back() == ' ') {
    node.fail(
        "must have another name, without brackets and without blanks at its ends: formulas name "
        "cases as in \"bow[fast]\"");
  }
  if (name == "." || name == "..") {
    node.fail("must have another name: folders of runs are named after cases");
  }
}

/// What replaces a place would undo what an earlier pointer has changed in it.
void check_order(const JsonNode& node, const CaseChanges& changes) {
  for (auto later = changes.values.begin(); later != changes.values.end(); ++later) {
    for (auto earlier = changes.values.begin(); earlier != later; ++earlier) {
      if (!leads_into(earlier->first, later->first)) continue;
      node.fail(fmt::format(
          "replaces \"{}\" with what \"{}\" has changed in it: put the longer pointer last, or "
          "keep one of them",
          later->first, earlier->first));
    }
  }
}

std::vector<CaseChanges> read_case(const std::string& name, const JsonNode& node) {
  check_case_name(name, node);
  CaseChanges changes{name, "", {}};
  for (const auto& [pointer, value] : node.members()) {
    if (pointer == "range") continue;
    check_pointer(pointer, value);
    changes.values.emplace_back(pointer, value.value());
  }
  std::vector<CaseChanges> cases = {changes};
  if (const auto range = node.find("range")) cases = read_ranges(*range, changes);
  check_order(node, cases.front());
  return cases;
}

void check_limit_names(const JsonNode& root, const std::vector<ProblemFile>& cases) {
  const std::vector<std::string> known = names_of_cases(cases);
  for (const ConstraintSettings& constraint : cases.front().constraints) {
    if (constraint.cases.empty()) continue;
    const JsonNode names = root.at("constraints").at(constraint.name).at("cases");
    for (const JsonNode& name : names.items()) read_known_name(name, "case", known);
  }
}

/// Names with a case behind them are those of numbers of single cases.
void forbid_names_in_cases(const JsonNode& root) {
  for (const char* block : {"constants", "variables", "responses", "constraints"}) {
    const auto node = root.find(block);
    if (!node || !node->value().is_object()) continue;
    for (const auto& [name, member] : node->members()) {
      if (!split_case(name)) continue;
      member.fail(
          "must have another name, without brackets at its end, as the file has load cases: "
          "\"bow [fast]\" is the bow in the case \"fast\"");
    }
  }
}

/// Each has files and a folder of its own.
void check_file_name(const JsonNode& node, const std::string& name,
                     const std::vector<CaseChanges>& others) {
  for (const CaseChanges& other : others) {
    if (plain_file_name(other.name) != plain_file_name(name)) continue;
    node.fail(fmt::format(
        "must have another name: files of the case \"{}\" would be named as those of \"{}\", "
        "\"{}\"",
        name, other.name, plain_file_name(name)));
  }
}

/// Whether a text in a value has one of the names: formulas that use it do.
bool mentions_any(const Json& value, const std::set<std::string>& names) {
  if (value.is_string()) {
    const std::string& text = value.get_ref<const std::string&>();
    return std::ranges::any_of(names,
                               [&](const std::string& name) { return has_word(text, name); });
  }
  return value.is_structured() &&
         std::ranges::any_of(value, [&](const Json& inner) { return mentions_any(inner, names); });
}

/// What the masses of these bodies (none: of all) follow from, besides constants. The lengths of segments
/// may go by the numbers of their elements, the length of a beam does not.
Json masses_in(const Json& document, const std::vector<std::string>& bodies) {
  Json scene = document["scene"];
  for (const char* massless : {"joints", "loads", "gravity"}) scene.erase(massless);
  Json counted = Json::object();
  for (const auto& [name, body] : scene["bodies"].items()) {
    if (!bodies.empty() && std::ranges::find(bodies, name) == bodies.end()) continue;
    counted[name] = body;
    counted[name].erase("elements");
  }
  scene["bodies"] = std::move(counted);
  return scene;
}

/// Whether the value of a response is the same in all cases at each design.
/// @param constants  that differ from case to case
bool is_same_response(const ProblemFile& problem, std::size_t response, const Json& document,
                      const std::vector<Json>& of_cases, const std::set<std::string>& constants) {
  if (!depends_on_masses_only(problem, response)) return false;
  const auto is_used_in = [&](const char* place) {
    const Json::json_pointer pointer(place);
    return document.contains(pointer) && mentions_any(document.at(pointer), constants);
  };
  if (is_used_in("/constraints")) return false;  // there may be another limit in each case
  const bool is_formula = problem.responses[response].is<ExpressionResponse>();
  if (is_formula && is_used_in("/responses")) return false;
  return std::ranges::all_of(parts_of(problem, response), [&](std::size_t part) {
    const std::vector<std::string> bodies = bodies_of(problem.responses[part]);
    const Json masses = masses_in(of_cases.front(), bodies);
    return !mentions_any(masses, constants) && std::ranges::all_of(of_cases, [&](const Json& one) {
      return masses_in(one, bodies) == masses;
    });
  });
}

std::vector<bool> same_responses(const ProblemFile& problem, const Json& document,
                                 const std::vector<Json>& of_cases,
                                 const std::set<std::string>& constants) {
  std::vector<bool> is_same;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    is_same.push_back(is_same_response(problem, i, document, of_cases, constants));
  }
  // Who says how the masses of cases with other constants count may say so.
  const bool is_said = problem.objective && problem.objective->over_cases != OverCases::same;
  if (is_said && !constants.empty()) {
    is_same[index_of_named(problem.responses, problem.objective->response).value()] = false;
  }
  return is_same;
}

void check_objective(const JsonNode& root, const ProblemFile& problem,
                     const std::vector<bool>& is_same) {
  const Objective& objective = *problem.objective;
  const std::size_t index = index_of_named(problem.responses, objective.response).value();
  const JsonNode node = root.at("objective");
  if (is_same[index] && objective.over_cases != OverCases::same) {
    node.at("over_cases")
        .fail(fmt::format(
            "is for a response that differs from case to case; \"{}\" is the same in all",
            objective.response));
  }
  if (!is_same[index] && objective.over_cases == OverCases::same) {
    node.fail(fmt::format(
        "needs \"over_cases\", as \"{}\" may differ from case to case: "
        "\"worst\", \"sum\", or weights such as {{\"{}\": 1}}; or take the number of one "
        "case, as in \"{}[{}]\"",
        objective.response, problem.load_case, objective.response, problem.load_case));
  }
}

}  // namespace

std::vector<CaseChanges> read_cases(const JsonNode& root) {
  const auto found = root.find("cases");
  if (!found) return {};
  forbid_names_in_cases(root);
  const JsonNode& node = *found;
  std::vector<CaseChanges> cases;
  for (const auto& [name, one] : node.members()) {
    for (CaseChanges& changes : read_case(name, one)) {
      const bool is_known = std::ranges::any_of(cases, [&](const CaseChanges& other) {
        return other.name == changes.name || other.range == changes.name;
      });
      if (is_known) one.fail(fmt::format("gives the case \"{}\" a second time", changes.name));
      check_file_name(one, changes.name, cases);
      cases.push_back(std::move(changes));
    }
  }
  if (cases.empty()) node.fail("must have at least one case");
  if (cases.size() > most_cases) {
    node.fail(fmt::format("has {} cases; at most {} are taken", cases.size(), most_cases));
  }
  return cases;
}

/// A constant that the file does not have would change nothing.
void check_constant(const Json& document, const std::string& pointer, const std::string& place,
                    const std::string& file) {
  constexpr std::string_view constants = "/constants/";
  if (!pointer.starts_with(constants)) return;
  const std::vector<std::string> names = keys_of(document, "constants");
  const std::string name = pointer.substr(constants.size());
  if (std::ranges::find(names, name) != names.end()) return;
  throw InputError(fmt::format("{}: {} names the unknown constant \"{}\"{}", file, place, name,
                               hint(name, names)));
}

Json document_of_case(Json document, const CaseChanges& changes, const std::string& file) {
  const std::string place =
      child_pointer("/cases", changes.range.empty() ? changes.name : changes.range);
  for (const auto& [pointer, value] : changes.values) {
    check_constant(document, pointer, child_pointer(place, pointer), file);
    replace_at(document, pointer, value, child_pointer(place, pointer), file);
  }
  document.erase("cases");
  document[case_key] = {changes.name, changes.range};
  return document;
}

void keep_case(ProblemFile& problem) {
  std::erase_if(problem.constraints, [&](const ConstraintSettings& constraint) {
    return !is_in_case(constraint.cases, problem);
  });
  if (problem.objective) problem.objective->over_cases = OverCases::same;
  // A study of a limit that does not hold in the case is none of its.
  if (!problem.pareto || problem.pareto->constraint.empty()) return;
  if (!find_named(problem.constraints, problem.pareto->constraint)) problem.pareto.reset();
}

ProblemFile join_cases(const JsonNode& root, const std::vector<Json>& documents,
                       const std::set<std::string>& constants, std::vector<ProblemFile> cases) {
  check_limit_names(root, cases);
  const ProblemFile& first = cases.front();
  const std::vector<bool> is_same = same_responses(first, root.value(), documents, constants);
  if (first.objective) {
    check_objective(root, first, is_same);
    const auto& weights = first.objective->weights;
    if (!weights.empty()) check_weights(root.at("objective").at("over_cases"), weights, cases);
  }
  return joined_cases(std::move(cases), is_same);
}

void forbid_case_names(const JsonNode& root, const ProblemFile& problem) {
  constexpr const char* rule = "names cases, and the problem has none (\"cases\")";
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (constraint.cases.empty()) continue;
    root.at("constraints").at(constraint.name).at("cases").fail(rule);
  }
  if (problem.objective && problem.objective->over_cases != OverCases::same) {
    root.at("objective").at("over_cases").fail(rule);
  }
}

}  // namespace pleuel
