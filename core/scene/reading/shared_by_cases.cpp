#include "core/scene/reading/shared_by_cases.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/find_named.hpp"
#include "core/scene/reading/catalogue.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {
namespace {

/// Where the file has a change.
JsonNode node_of_change(const JsonNode& root, const CaseChanges& changes,
                        const std::string& pointer) {
  const JsonNode cases = root.at("cases");
  if (changes.range.empty()) return cases.at(changes.name).at(pointer);
  const JsonNode of_range = cases.at(changes.range);
  const auto own = of_range.find(pointer);
  return own ? *own : of_range.at("range").at(pointer);
}

/// A plain 0 is as well no length, no mass, …
bool is_plain_zero(const Symbol& symbol) {
  return symbol.constant == 0.0 && symbol.dimension.is_number();
}

void check_dimensions(const JsonNode& changed, const std::string& pointer,
                      const std::vector<Symbol>& base, const std::vector<Symbol>& of_case) {
  for (const Symbol& symbol : of_case) {
    const Symbol* before = find_named(base, symbol.name);
    const bool is_changed =
        pointer == "/constants" || pointer == child_pointer("/constants", symbol.name);
    if (!is_changed || before == nullptr || symbol.argument || is_plain_zero(symbol) ||
        is_plain_zero(*before) || symbol.dimension == before->dimension) {
      continue;
    }
    changed.fail(fmt::format(
        "must leave the constant \"{}\" what it is in the rest of the file, {}, but makes it {}",
        symbol.name, describe(before->dimension), describe(symbol.dimension)));
  }
}

void check_constants(const JsonNode& root, const CaseChanges& changes,
                     const std::vector<Symbol>& of_case) {
  for (const auto& [pointer, value] : changes.values) {
    if (!pointer.starts_with("/constants")) continue;
    check_dimensions(node_of_change(root, changes, pointer), pointer, read_symbols(root), of_case);
  }
}

void check_catalogue(const JsonNode& root, const CaseChanges& changes, const Json& document) {
  for (const auto& [pointer, value] : changes.values) {
    if (pointer != "/scene/catalogue") continue;
    const std::vector<std::string> chosen = section_variables(document);
    if (chosen.empty()) return;
    node_of_change(root, changes, pointer)
        .fail(fmt::format("must not change the catalogue, as the variable \"{}\" is chosen from it "
                          "and must be the same in all cases",
                          chosen.front()));
  }
}

/// Of the member of the node, or of the node itself where it has none.
void require_same(bool is_same, const JsonNode& node, const char* key, const ProblemFile& other) {
  if (is_same) return;
  const auto member = node.find(key);
  (member ? *member : node)
      .fail(fmt::format("must be the same in all cases, but follows from a constant that the case "
                        "\"{}\" changes: "
                        "write a number, or a constant that no case changes",
                        other.load_case));
}

void check_variables(const JsonNode& root, const ProblemFile& first, const ProblemFile& other) {
  for (std::size_t i = 0; i < first.variables.size(); ++i) {
    const DesignVariable &one = first.variables[i], &two = other.variables[i];
    const JsonNode node = root.at("variables").at(one.name);
    require_same(one.choices == two.choices, node, "choices", other);
    require_same(one.start == two.start, node, "start", other);
    require_same(one.lower == two.lower, node, "lower", other);
    require_same(one.upper == two.upper, node, "upper", other);
    if (!(one.quantity == two.quantity)) {
      node.fail(fmt::format(
          "must stand for the same in all cases, but is {} in the case \"{}\" and {} in \"{}\"",
          describe(one.quantity), first.load_case, describe(two.quantity), other.load_case));
    }
  }
}

/// Those that stand once: of variables only, or of a response that is the same in all cases.
void check_limits(const JsonNode& root, const ProblemFile& joined, const ProblemFile& other) {
  const ProblemFile& first = joined.cases.front();
  for (const ConstraintSettings& one : first.constraints) {
    const bool is_once =
        one.response.empty() || find_named(joined.responses, one.response) != nullptr;
    if (!is_once) continue;
    const ConstraintSettings* two = find_named(other.constraints, one.name);
    const JsonNode node = root.at("constraints").at(one.name);
    require_same(one.lower == two->lower, node, "lower", other);
    require_same(one.upper == two->upper, node, "upper", other);
  }
}

void check_uncertainty(const JsonNode& root, const ProblemFile& first, const ProblemFile& other) {
  if (!first.uncertainty || !other.uncertainty) return;
  const JsonNode parameters = root.at("uncertainty").at("parameters");
  for (std::size_t i = 0; i < first.uncertainty->parameters.size(); ++i) {
    const UncertainParameter& one = first.uncertainty->parameters[i];
    const UncertainParameter& two = other.uncertainty->parameters[i];
    const JsonNode node = parameters.at(first.variables[one.variable].name);
    require_same(one.deviation == two.deviation, node, "deviation", other);
    require_same(one.interval == two.interval, node, "interval", other);
  }
}

void check_starts(const JsonNode& root, const ProblemFile& first, const ProblemFile& other) {
  const auto &one = first.optimizer.given_starts, &two = other.optimizer.given_starts;
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (std::size_t j = 0; j < first.variables.size(); ++j) {
      if (one[i][j] == two[i][j]) continue;
      require_same(false, root.at("optimizer").at("starts").items()[i],
                   first.variables[j].name.c_str(), other);
    }
  }
}

/// Where the file has a response, which may be the formula of an objective or of a limit.
JsonNode node_of_response(const JsonNode& root, const ProblemFile& problem,
                          const std::string& name) {
  if (const auto responses = root.find("responses")) {
    if (const auto node = responses->find(name)) return *node;
  }
  if (problem.objective && problem.objective->response == name) return root.at("objective");
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (constraint.response == name) return root.at("constraints").at(constraint.name);
  }
  return root;
}

void check_quantities(const JsonNode& root, const ProblemFile& first, const ProblemFile& other) {
  for (std::size_t i = 0; i < first.responses.size(); ++i) {
    const Quantity one = quantity_of(first.responses[i]), two = quantity_of(other.responses[i]);
    if (one == two || dimension_of(one) == dimension_of(two)) continue;
    node_of_response(root, first, first.responses[i].name)
        .fail(fmt::format(
            "must measure the same in all cases, but is {} in the case \"{}\" and {} in \"{}\"",
            describe(one), first.load_case, describe(two), other.load_case));
  }
}

}  // namespace

void check_shared_documents(const JsonNode& root, const std::vector<CaseChanges>& changes,
                            const std::vector<Json>& documents,
                            const std::vector<std::vector<Symbol>>& of_cases) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    check_constants(root, changes[i], of_cases[i]);
    check_catalogue(root, changes[i], documents[i]);
  }
}

void check_shared_numbers(const JsonNode& root, const std::vector<ProblemFile>& cases) {
  const ProblemFile& first = cases.front();
  for (const ProblemFile& other : cases) {
    check_variables(root, first, other);
    check_uncertainty(root, first, other);
    check_starts(root, first, other);
    check_quantities(root, first, other);
  }
}

void check_shared_limits(const JsonNode& root, const ProblemFile& joined) {
  for (const ProblemFile& other : joined.cases) check_limits(root, joined, other);
}

}  // namespace pleuel
