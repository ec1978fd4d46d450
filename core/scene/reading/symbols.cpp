#include "core/scene/reading/symbols.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/find_named.hpp"

namespace pleuel {

namespace {

/// A constant, or the dimension of a bound of a variable.
KnownNumber read_text(const JsonNode& node, const std::vector<Symbol>& symbols) {
  if (is_formula(node)) {
    const ReadExpression read = read_formula(node, symbols);
    if (!read.constant) node.fail_with_value("must not depend on design variables");
    return read;
  }
  const WrittenQuantity written = split_quantity(node.value().get<std::string>());
  if (written.unit.empty()) return {{}, written.value};
  const MeasuredUnit unit = measure_unit(written.unit);
  return {unit.dimension, written.value * unit.scale, is_of_cycles(written.unit)};
}

Symbol read_constant(const std::string& name, const JsonNode& node,
                     const std::vector<Symbol>& symbols) {
  if (node.value().is_number()) return {name, {}, node.value().get<double>()};
  if (!node.value().is_string()) {
    node.fail_with_value("must be a number, a text with unit, or a formula \"= …\"");
  }
  try {
    const KnownNumber written = read_text(node, symbols);
    return {name, written.dimension, written.constant, std::nullopt, written.counts_cycles};
  } catch (const UnitError& error) {
    node.fail_with_value("must be a number, a text with unit, or a formula \"= …\"",
                         fmt::format(": {}{}", error.what(),
                                     formula_hint(node.value().get<std::string>(), symbols)));
  }
}

/// What is wrong with the text of a bound is said where it is read.
Dimension dimension_of_variable(const JsonNode& node, const std::vector<Symbol>& symbols) {
  if (!node.value().is_object()) return {};
  std::vector<JsonNode> bounds;
  for (const char* key : {"start", "lower", "upper"}) {
    if (const auto bound = node.find(key)) bounds.push_back(*bound);
  }
  const auto choices = node.find("choices");
  if (choices && choices->value().is_array()) {
    for (const JsonNode& choice : choices->items()) bounds.push_back(choice);
  }
  for (const JsonNode& bound : bounds) {
    if (!bound.value().is_string()) continue;
    try {
      const Dimension dimension = read_text(bound, symbols).dimension;
      if (!dimension.is_number()) return dimension;
    } catch (const UnitError&) {
    }
  }
  return {};
}

}  // namespace

std::string formula_hint(const std::string& text, const std::vector<Symbol>& symbols) {
  const std::size_t sign = std::min({text.find_first_of("*("), text.find(" + "), text.find(" - ")});
  if (find_named(symbols, text))
    return fmt::format("; a formula begins with \"=\": \"= {}\"", text);
  if (sign == std::string::npos) return "";
  return fmt::format(
      "; with the sign at column {} it looks like a formula, which begins with \"=\": "
      "\"= {}\"",
      text.find_first_not_of(' ', sign) + 1, text);
}

bool is_formula(const JsonNode& node) {
  if (!node.value().is_string()) return false;
  const auto& text = node.value().get_ref<const std::string&>();
  const std::size_t first = text.find_first_not_of(' ');
  return first != std::string::npos && text[first] == '=';
}

std::string written_unit(std::initializer_list<JsonNode> nodes) {
  for (const JsonNode& node : nodes) {
    if (!node.value().is_string() || is_formula(node)) continue;
    const std::string unit = split_quantity(node.value().get<std::string>()).unit;
    if (!unit.empty()) return unit;
  }
  return "";
}

ReadExpression read_formula(const JsonNode& node, const std::vector<Symbol>& symbols) {
  const std::string text = node.text();
  const auto rule_of = [&](const ExpressionError& error) {
    return fmt::format("has an error at column {} of \"{}\": {}", error.column(), text,
                       error.what());
  };
  try {
    return read_expression(text, symbols);
  } catch (const CaseExpressionError& error) {
    throw NamesCases(node.message(rule_of(error)), text);
  } catch (const ExpressionError& error) {
    node.fail(rule_of(error));
  }
}

std::vector<Symbol> read_symbols(const JsonNode& root) {
  std::vector<Symbol> constants, variables;
  const auto list = root.find("variables");
  if (const auto node = root.find("constants")) {
    for (const auto& [name, member] : node->members()) {
      if (name == "pi") member.fail("has a name that is taken: pi is 3.14159…");
      if (list && list->find(name)) member.fail("has the name of a design variable");
      constants.push_back(read_constant(name, member, constants));
    }
  }
  std::vector<Symbol> all = constants;
  if (!list) return all;
  std::size_t index = 0;
  for (const auto& [name, member] : list->members()) {
    all.push_back({name, dimension_of_variable(member, constants), std::nullopt,
                   ExpressionArgument{ExpressionArgument::Kind::variable, index++}});
  }
  return all;
}

std::set<std::string> differing_constants(const std::vector<std::vector<Symbol>>& documents) {
  std::set<std::string> names;
  const auto compare = [&](const std::vector<Symbol>& one, const std::vector<Symbol>& other) {
    for (const Symbol& symbol : one) {
      const Symbol* there = find_named(other, symbol.name);
      const bool is_same = there != nullptr && there->constant == symbol.constant &&
                           there->dimension == symbol.dimension;
      if (symbol.constant && !is_same) names.insert(symbol.name);
    }
  };
  for (const std::vector<Symbol>& one : documents) {
    compare(one, documents.front());
    compare(documents.front(), one);
  }
  return names;
}

}  // namespace pleuel
