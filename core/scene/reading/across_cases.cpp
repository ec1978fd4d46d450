#include "core/scene/reading/across_cases.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/expression_response_reader.hpp"
#include "core/scene/reading/goal_reader.hpp"
#include "core/scene/reading/number_reader.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "core/scene/reading/variable_reader.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

namespace {

/// A name as a formula has it, and whether the formula gives it a case: `bow[fast]`, 'bow [fast]'.
struct MentionedName {
  std::string name;
  bool has_case = false;
};

/// All words that could be names. Whatever is wrong with the formula is for the parser to say.
std::vector<MentionedName> names_in(const std::string& formula) {
  std::vector<MentionedName> names;
  std::size_t at = 0;
  while (at < formula.size()) {
    std::size_t end = at + 1;
    std::string name;
    if (formula[at] == '\'') {
      const std::size_t close = std::min(formula.find('\'', end), formula.size());
      name = formula.substr(end, close - end);
      end = std::min(close + 1, formula.size());
    } else if (is_name_character(formula[at])) {
      while (end < formula.size() && is_name_character(formula[end])) ++end;
      name = formula.substr(at, end - at);
    }
    if (!name.empty()) {
      const auto suffix = case_suffix(formula, end);
      if (suffix) end = suffix->end;
      names.push_back({name, suffix.has_value()});
    }
    at = end;
  }
  return names;
}

const Json* member(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) return nullptr;
  return &object[key];
}

bool is_text(const Json* value) {
  return value != nullptr && value->is_string();
}

bool is_formula_text(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first != std::string::npos && text[first] == '=';
}

/// Finds what is made from several cases.
class Finder {
 public:
  explicit Finder(const Json& document) : document_(document) {
    if (const Json* responses = member(document, "responses")) {
      if (responses->is_object()) responses_ = responses;
    }
  }

  AcrossCases find() {
    while (find_more_responses()) {
    }
    const Json* limits = member(document_, "constraints");
    if (limits != nullptr && limits->is_object()) {
      for (const auto& [name, limit] : limits->items()) {
        const Json* response = member(limit, "response");
        if (is_text(response) && is_across(*response)) found_.constraints.insert(name);
      }
    }
    if (const Json* objective = member(document_, "objective")) {
      for (const char* key : {"minimize", "maximize"}) {
        const Json* response = member(*objective, key);
        if (is_text(response) && is_across(*response)) found_.has_objective = true;
      }
    }
    return std::move(found_);
  }

 private:
  bool is_response(const std::string& name) const {
    return responses_ != nullptr && responses_->contains(name);
  }

  bool is_across_name(const std::string& name) const {
    if (found_.responses.contains(name)) return true;
    return split_case(name).has_value() && !is_response(name);
  }

  bool is_across_formula(const std::string& formula) const {
    const std::vector<MentionedName> names = names_in(formula);
    return std::any_of(names.begin(), names.end(), [&](const MentionedName& one) {
      return one.has_case || is_across_name(one.name);
    });
  }

  /// A name, or a formula "= …".
  bool is_across(const Json& text) const {
    const auto& written = text.get_ref<const std::string&>();
    return is_formula_text(written) ? is_across_formula(written) : is_across_name(written);
  }

  /// @returns whether there are more than before: expressions of expressions take several rounds
  bool find_more_responses() {
    if (responses_ == nullptr) return false;
    bool is_more = false;
    for (const auto& [name, response] : responses_->items()) {
      const Json *type = member(response, "type"), *value = member(response, "value");
      const bool is_expression = is_text(type) && *type == "expression" && is_text(value);
      if (!is_expression || !is_across_formula(value->get<std::string>())) continue;
      is_more = found_.responses.insert(name).second || is_more;
    }
    return is_more;
  }

  const Json& document_;
  const Json* responses_ = nullptr;
  AcrossCases found_;
};

/// Whether a study of the file names something that no case has.
bool names_across(const Json& pareto, const AcrossCases& across) {
  const auto is_across = [&](const Json& name) {
    if (!name.is_string()) return false;
    const auto text = name.get<std::string>();
    return across.responses.contains(text) || across.constraints.contains(text) ||
           split_case(text).has_value();
  };
  if (const Json* constraint = member(pareto, "constraint")) {
    if (across.has_objective || is_across(*constraint)) return true;
  }
  const Json* goals = member(pareto, "responses");
  if (goals == nullptr || !goals->is_array()) return false;
  return std::any_of(goals->begin(), goals->end(), [&](const Json& goal) {
    const Json *least = member(goal, "minimize"), *most = member(goal, "maximize");
    return is_across(goal) || (least && is_across(*least)) || (most && is_across(*most));
  });
}

/// Of one case there is nothing to be put together.
void forget_over_cases(Json& pareto) {
  if (!pareto.is_object() || !pareto.contains("responses")) return;
  for (Json& goal : pareto["responses"]) {
    if (goal.is_object()) goal.erase("over_cases");
  }
}

void add_variables(const Json& document, const std::string& formula, std::set<std::string>& names) {
  const Json* variables = member(document, "variables");
  if (variables == nullptr || !variables->is_object()) return;
  for (const MentionedName& one : names_in(formula)) {
    if (variables->contains(one.name)) names.insert(one.name);
  }
}

std::set<std::string> variables_in(const Json& document, const AcrossCases& across) {
  std::set<std::string> names;
  for (const std::string& name : across.responses) {
    add_variables(document, document["responses"][name]["value"].get<std::string>(), names);
  }
  for (const std::string& name : across.constraints) {
    add_variables(document, document["constraints"][name]["response"].get<std::string>(), names);
  }
  if (!across.has_objective) return names;
  for (const char* key : {"minimize", "maximize"}) {
    const Json* formula = member(document["objective"], key);
    if (is_text(formula)) add_variables(document, formula->get<std::string>(), names);
  }
  return names;
}

/// The constants that are the same in all cases by their names, others with a case behind them.
std::vector<Symbol> symbols_across(const std::vector<Json>& documents, const ProblemFile& joined,
                                   const std::string& file, const UnitSystem& units) {
  std::vector<std::vector<Symbol>> of_cases;
  for (const Json& document : documents) {
    of_cases.push_back(read_symbols(JsonNode(document, file), units));
  }
  std::vector<Symbol> all;
  for (std::size_t c = 0; c < of_cases.size(); ++c) {
    for (Symbol& symbol : of_cases[c]) {
      const auto is_same = [&](const std::vector<Symbol>& other) {
        const Symbol* there = find_named(other, symbol.name);
        return there != nullptr && there->constant == symbol.constant &&
               there->dimension == symbol.dimension;
      };
      if (symbol.argument || std::all_of(of_cases.begin(), of_cases.end(), is_same)) {
        if (c == 0) all.push_back(symbol);
        continue;
      }
      Symbol of_case = symbol;
      of_case.name = name_in_case(symbol.name, joined.cases[c].load_case);
      all.push_back(std::move(of_case));
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

void read_across_responses(const JsonNode& root, const AcrossCases& across, NumberReader& numbers,
                           ProblemFile& joined) {
  for (const auto& [name, node] : root.at("responses").members()) {
    if (!across.responses.contains(name)) continue;
    if (find_named(joined.responses, name) != nullptr) {
      node.fail("has the name that another response has in one of the cases");
    }
    joined.responses.push_back(read_expression_response(name, node, joined.responses, numbers));
  }
}

void read_across_constraints(const JsonNode& root, const AcrossCases& across, NumberReader& numbers,
                             ProblemFile& joined) {
  for (const auto& [name, node] : root.at("constraints").members()) {
    if (!across.constraints.contains(name)) continue;
    forbid(node, "cases");
    joined.constraints.push_back(read_constraint(name, node, joined.responses, numbers));
    joined.case_constraints.push_back({several_cases, 0});
  }
}

/// Variables are what the cases use them as.
void check_mentions(const NumberReader& numbers, const std::vector<Symbol>& symbols,
                    const UnitSystem& units, const ProblemFile& joined) {
  for (const VariableMention& mention : numbers.mentions()) {
    const DesignVariable& variable = joined.variables[mention.variable];
    const Dimension dimension = find_named(symbols, variable.name)->dimension;
    if (!variable.quantity || dimension == numbers.dimension_of(*variable.quantity)) continue;
    mention.node.fail(fmt::format(
        "takes the variable \"{}\" for {}, as its start is written, but the scene uses it as {}; "
        "give the start of the variable its unit",
        variable.name, describe(dimension, units), describe(*variable.quantity)));
  }
}

/// What is minimized or limited over several cases has to be accurate in each of them.
void ask_for_goals(ProblemFile& joined, const AcrossCases& across) {
  const auto ask = [&](const std::string& name) {
    ask_for_accuracy(joined, static_cast<std::size_t>(find_named(joined.responses, name) -
                                                      joined.responses.data()));
  };
  if (across.has_objective) ask(joined.objective->response);
  for (const std::string& name : across.constraints) {
    ask(find_named(joined.constraints, name)->response);
  }
}

}  // namespace

AcrossCases across_cases(const Json& document) {
  return Finder(document).find();
}

Json without_across_cases(Json document) {
  const AcrossCases across = across_cases(document);
  const std::set<std::string> variables = variables_in(document, across);
  if (!variables.empty()) document["mentioned"] = variables;
  for (const std::string& name : across.responses) document["responses"].erase(name);
  for (const std::string& name : across.constraints) document["constraints"].erase(name);
  if (across.has_objective) document.erase("objective");
  if (const Json* pareto = member(document, "pareto")) {
    if (names_across(*pareto, across)) {
      document.erase("pareto");
    } else {
      forget_over_cases(document["pareto"]);
    }
  }
  const Json* accuracy = member(document, "accuracy");
  if (accuracy == nullptr || !accuracy->is_object() || !accuracy->contains("responses")) {
    return document;
  }
  Json& listed = document["accuracy"]["responses"];
  if (!listed.is_array()) return document;
  for (std::size_t i = listed.size(); i-- > 0;) {
    if (listed[i].is_string() && across.responses.contains(listed[i].get<std::string>())) {
      listed.erase(i);
    }
  }
  return document;
}

void read_across_cases(const JsonNode& root, const std::vector<Json>& documents,
                       const UnitSystem& units, ProblemFile& joined) {
  const AcrossCases across = across_cases(root.value());
  NumberReader numbers(units, variable_names(root));
  const std::vector<Symbol> symbols = symbols_across(documents, joined, root.file(), units);
  numbers.declare(symbols);
  if (!across.responses.empty()) read_across_responses(root, across, numbers, joined);
  if (across.has_objective) {
    forbid(root.at("objective"), "over_cases");
    joined.objective = read_objective(root.at("objective"), joined.responses, numbers);
  }
  if (!across.constraints.empty()) read_across_constraints(root, across, numbers, joined);
  joined.case_responses.resize(joined.responses.size(), {several_cases, 0});
  check_mentions(numbers, symbols, units, joined);
  joined.pareto.reset();
  if (const auto pareto = root.find("pareto"))
    joined.pareto = read_pareto(*pareto, joined, numbers);
  ask_for_goals(joined, across);
}

}  // namespace pleuel
