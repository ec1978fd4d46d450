#include "core/scene/reading/across_cases.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/case_goals.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/goal_reader.hpp"
#include "core/scene/reading/number_reader.hpp"
#include "core/scene/reading/response_reader.hpp"
#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/reading/unit_scanner.hpp"
#include "core/scene/reading/variable_reader.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

namespace {

/// A name as a formula has it, and the case that the formula gives it: `bow[fast]`.
struct MentionedName {
  std::string name;
  std::optional<std::string> load_case;
};

bool is_number(const std::string& word) {
  return is_digit_character(word.front()) && std::all_of(word.begin(), word.end(), [](char c) {
           return is_digit_character(c) || c == 'e' || c == 'E';
         });
}

/// Behind the words that follow a number, which are its unit.
std::size_t behind_unit(const std::string& formula, std::size_t at) {
  return at + unit_length(std::string_view(formula).substr(at),
                          [](const std::string&) { return false; });
}

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
    if (!name.empty() && is_number(name)) {
      end = behind_unit(formula, end);
    } else if (!name.empty()) {
      const auto suffix = case_suffix(formula, end);
      names.push_back({name, std::nullopt});
      if (suffix) {
        end = suffix->end;
        names.back().load_case = suffix->load_case;
      }
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
      return one.load_case || is_across_name(one.name);
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
void forget_over_cases(Json& document) {
  Json& pareto = document["pareto"];
  if (!pareto.is_object() || !pareto.contains("responses")) return;
  std::vector<Json> names;
  bool is_over_cases = false;
  for (Json& goal : pareto["responses"]) {
    if (!goal.is_object()) continue;
    is_over_cases = goal.erase("over_cases") > 0 || is_over_cases;
    names.push_back(goal.value("minimize", goal.value("maximize", Json())));
  }
  // Two ways to put one response together: a single case has no such front.
  const bool is_one = names.size() == 2 && names[0] == names[1];
  if (is_over_cases && is_one) document.erase("pareto");
}

/// What an accuracy is asked for, as one case has it: of a number over cases its parts there.
class AccurateParts {
 public:
  AccurateParts(const Json& responses, const AcrossCases& across, const std::string& load_case)
      : responses_(responses), across_(across), load_case_(load_case) {}

  void add(const std::string& name) {
    if (across_.responses.contains(name)) {
      for (const MentionedName& one : names_in(responses_[name]["value"].get<std::string>())) {
        add_mention(one);
      }
    } else if (const auto split = split_case(name)) {
      if (split->load_case == load_case_) add_once(split->name);
    } else {
      add_once(name);
    }
  }

  Json take() { return std::move(parts_); }

 private:
  /// Constants, variables and functions are no responses.
  void add_mention(const MentionedName& one) {
    if (one.load_case) {
      if (*one.load_case == load_case_ && responses_.contains(one.name)) add_once(one.name);
    } else if (responses_.contains(one.name) || split_case(one.name)) {
      add(one.name);
    }
  }

  void add_once(const std::string& name) {
    if (std::find(parts_.begin(), parts_.end(), name) == parts_.end()) parts_.push_back(name);
  }

  const Json& responses_;
  const AcrossCases& across_;
  const std::string& load_case_;
  Json parts_ = Json::array();
};

/// Names of the list that are no texts are for its reader to complain about.
void ask_for_parts(Json& document, const AcrossCases& across, const std::string& load_case) {
  const Json *accuracy = member(document, "accuracy"), *responses = member(document, "responses");
  const Json* listed = accuracy == nullptr ? nullptr : member(*accuracy, "responses");
  if (listed == nullptr || !listed->is_array() || responses == nullptr) return;
  if (!responses->is_object()) return;
  AccurateParts parts(*responses, across, load_case);
  for (const Json& name : *listed) {
    if (!name.is_string()) return;
    parts.add(name.get<std::string>());
  }
  document["accuracy"]["responses"] = parts.take();
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

/// Those of cases are known by the documents of these only.
void check_accurate_names(const JsonNode& root, const ProblemFile& joined) {
  const auto accuracy = root.find("accuracy");
  const auto listed = accuracy ? accuracy->find("responses") : std::nullopt;
  if (!listed) return;
  for (const JsonNode& name : listed->items()) {
    if (!split_case(name.text())) continue;
    if (find_named(joined.responses, spaced_case(name.text())) != nullptr) continue;
    fail_unknown_name(name, "response", name.text(), names_of(joined.responses));
  }
}

/// What is minimized or limited over several cases has to be accurate in each of them.
void ask_for_goals(ProblemFile& joined, const AcrossCases& across) {
  const auto ask = [&](const std::string& name) {
    ask_for_accuracy(joined, index_of_named(joined.responses, name).value());
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

Json without_across_cases(Json document, const std::string& load_case) {
  const AcrossCases across = across_cases(document);
  ask_for_parts(document, across, load_case);
  const std::set<std::string> variables = variables_in(document, across);
  if (!variables.empty()) document[mentioned_key] = variables;
  for (const std::string& name : across.responses) document["responses"].erase(name);
  for (const std::string& name : across.constraints) document["constraints"].erase(name);
  if (across.has_objective) document.erase("objective");
  if (const Json* pareto = member(document, "pareto")) {
    if (names_across(*pareto, across)) {
      document.erase("pareto");
    } else {
      forget_over_cases(document);
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
  check_accurate_names(root, joined);
  ask_for_goals(joined, across);
}

}  // namespace pleuel
