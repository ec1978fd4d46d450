#include "core/scene/reading/expression_response_reader.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/scene/reading/scene_reader.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/response_quantity.hpp"

namespace pleuel {

namespace {

using Kind = ExpressionArgument::Kind;

bool is_frequency(const ResponseSettings& response) {
  const Quantity quantity = quantity_of(response);
  return quantity.name == quantities::angular_frequency.name &&
         quantity.unit == quantities::angular_frequency.unit;
}

/// Of responses that are read: an expression without formula is not.
std::vector<Symbol> symbols_of(const std::vector<ResponseSettings>& responses,
                               const NumberReader& numbers) {
  std::vector<Symbol> symbols;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const bool is_read = responses[i].type != ResponseType::expression || responses[i].expression;
    if (!is_read) continue;
    symbols.push_back({responses[i].name, numbers.dimension_of(quantity_of(responses[i])),
                       std::nullopt, ExpressionArgument{Kind::response, i}});
  }
  return symbols;
}

/// rad/s made from frequencies is a frequency: limits on it take Hz, as on its parts.
void name_frequency(Expression& expression, const std::vector<ResponseSettings>& known) {
  if (expression.unit != quantities::angular_frequency.unit) return;
  const bool is_one =
      std::any_of(expression.arguments.begin(), expression.arguments.end(),
                  [&](const ExpressionArgument& argument) {
                    return argument.kind == Kind::response && is_frequency(known[argument.index]);
                  });
  if (is_one) expression.quantity = quantities::angular_frequency.name;
}

ResponseSettings make_response(const std::string& name, const JsonNode& value,
                               const std::vector<ResponseSettings>& known, NumberReader& numbers) {
  Expression expression = *numbers.formula(value, symbols_of(known, numbers)).expression;
  name_frequency(expression, known);
  if (expression.arguments.empty()) {
    value.fail_with_value("must depend on a response or on a design variable");
  }
  ResponseSettings response;
  response.name = name;
  response.type = ResponseType::expression;
  response.expression = std::make_shared<const Expression>(std::move(expression));
  return response;
}

/// "= a - b" → "a - b"
std::string formula_name(const JsonNode& node) {
  const std::string text = node.text();
  const std::size_t first = text.find_first_not_of(" =");
  return first == std::string::npos ? text : text.substr(first);
}

}  // namespace

ResponseSettings read_expression_response(const std::string& name, const JsonNode& node,
                                          const std::vector<ResponseSettings>& known,
                                          NumberReader& numbers) {
  node.allow_keys({"type", "value", "unit", "over_time"});
  if (const auto over_time = node.find("over_time")) {
    over_time->fail(
        "is not for an expression, which is made from responses that are reduced over time");
  }
  ResponseSettings response = make_response(name, node.at("value"), known, numbers);
  if (const auto unit = node.find("unit")) {
    response.unit = unit->text();
    try {
      response.unit_scale = numbers.scale(response.unit, quantity_of(response));
    } catch (const UnitError& error) {
      unit->fail_with_value(fmt::format("must be a unit of {}, which the formula is",
                                        describe(quantity_of(response))),
                            fmt::format(": {}", error.what()));
    }
  }
  return response;
}

const ResponseSettings& read_response_or_formula(const JsonNode& node,
                                                 std::vector<ResponseSettings>& responses,
                                                 NumberReader& numbers) {
  if (!is_formula(node)) {
    return *find_named(responses, read_known_name(node, "response", names_of(responses)));
  }
  const std::string name = formula_name(node);
  if (const ResponseSettings* known = find_named(responses, name)) {
    if (known->type == ResponseType::expression) return *known;
  }
  responses.push_back(make_response(name, node, responses, numbers));
  return responses.back();
}

}  // namespace pleuel
