#include "core/scene/reading/time_function_reader.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/scene/reading/pulse_reader.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/reading/table_law_reader.hpp"

namespace pleuel {
namespace {

constexpr std::size_t most_coefficients = 11;  // per_time() knows ten derivatives

enum class FunctionType {
  constant,
  constant_speed,
  ramp_to_speed,
  polynomial,
  harmonic,
  table,
  step,
  ramp,
  half_sine,
  trapezoid,
  expression,
  friction,
  clearance
};

/// A function that its table of keys says all of.
template <class Function, class Measures>
Function read_keys_of(const LawSource& source, NumberReader& numbers, const Measures& measures) {
  Function function;
  source.read(numbers, function, measures);
  return function;
}

PolynomialFunction read_polynomial(const LawSource& source, NumberReader& numbers) {
  source.allow_keys({"coefficients"});
  const JsonNode list = source.node.at("coefficients");
  const std::vector<JsonNode> items = list.items();
  if (items.empty() || items.size() > most_coefficients) {
    list.fail(fmt::format("must have from 1 to {} coefficients, got {}", most_coefficients,
                          items.size()));
  }
  PolynomialFunction polynomial;
  Quantity quantity = source.value;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) quantity = per_time(quantity);
    polynomial.coefficients.push_back(numbers.designable(items[i], quantity));
  }
  return polynomial;
}

// Formulas.

using ArgumentKind = ExpressionArgument::Kind;

/// t, and the state where there is one.
std::vector<Symbol> law_symbols(const LawSource& source, const NumberReader& numbers) {
  const auto symbol = [&](std::string_view name, const Quantity& quantity, ArgumentKind kind) {
    return Symbol{std::string(name), numbers.dimension_of(quantity), std::nullopt,
                  ExpressionArgument{kind, 0}};
  };
  std::vector<Symbol> symbols = {symbol("t", quantities::time, ArgumentKind::time)};
  if (!source.state) return symbols;
  const StateNames& state = *source.state;
  symbols.push_back(symbol(state.coordinate, state.coordinate_quantity, ArgumentKind::coordinate));
  symbols.push_back(symbol("speed", state.rate_quantity, ArgumentKind::rate));
  return symbols;
}

/// A design variable as a formula.
Number number_of(const ExpressionArgument& variable, const std::string& text) {
  Expression alone;
  alone.text = text;
  alone.arguments = {variable};
  alone.steps = {{Operation::argument, 0.0, 0}};
  return Number::bound(std::make_shared<const Expression>(std::move(alone)));
}

TimeFunction read_expression_law(const JsonNode& node, const LawSource& source,
                                 NumberReader& numbers) {
  const ReadExpression read = numbers.formula_of(node, source.value, law_symbols(source, numbers));
  if (read.constant) return ConstantFunction{*read.constant};
  ExpressionFunction function{read.expression, {}};
  bool is_number = true;
  for (const ExpressionArgument& argument : read.expression->arguments) {
    if (argument.kind == ArgumentKind::variable) {
      function.variables.push_back(number_of(argument, read.expression->text));
    } else {
      is_number = false;
    }
  }
  if (is_number) return ConstantFunction{numbers.designable(node, source.value)};
  return function;
}

TimeFunction read_expression_object(const LawSource& source, NumberReader& numbers) {
  source.allow_keys({"value"});
  const JsonNode value = source.node.at("value");
  if (!is_formula(value)) value.fail_with_value("must be a formula \"= …\"");
  return read_expression_law(value, source, numbers);
}

// Laws of springs and dampers.

ClearanceLaw read_clearance(const LawSource& source, NumberReader& numbers) {
  constexpr double never = 1e30;
  const auto lower = source.node.find("lower"), upper = source.node.find("upper");
  ClearanceLaw law{-never, never, {}, {}};
  source.read(numbers, law, along(source.value));
  if (lower && upper && !law.lower.is_bound() && !law.upper.is_bound() &&
      law.lower.constant > law.upper.constant) {
    upper->fail_with_value("must not be less than \"lower\"");
  }
  return law;
}

TimeFunction read_function(FunctionType type, const LawSource& source, NumberReader& numbers) {
  switch (type) {
    case FunctionType::constant:
      return read_keys_of<ConstantFunction>(source, numbers, source.value);
    case FunctionType::constant_speed:
      return read_keys_of<ConstantSpeedDrive>(source, numbers, source.value);
    case FunctionType::ramp_to_speed:
      return read_keys_of<RampToSpeedDrive>(source, numbers, source.value);
    case FunctionType::polynomial:
      return read_polynomial(source, numbers);
    case FunctionType::harmonic:
      return read_keys_of<HarmonicFunction>(source, numbers, source.value);
    case FunctionType::step:
      return read_step(source, numbers);
    case FunctionType::ramp:
      return read_ramp(source, numbers);
    case FunctionType::half_sine:
      return read_half_sine(source, numbers);
    case FunctionType::trapezoid:
      return read_trapezoid(source, numbers);
    case FunctionType::expression:
      return read_expression_object(source, numbers);
    case FunctionType::friction:
      return read_keys_of<FrictionLaw>(source, numbers, along(source.value));
    case FunctionType::clearance:
      return read_clearance(source, numbers);
    case FunctionType::table:
      break;
  }
  return read_table(source, numbers);
}

TimeFunction read_motion(const LawSource& source, NumberReader& numbers) {
  const auto type = read_choice<FunctionType>(source.node.at("type"),
                                              {{"constant-speed", FunctionType::constant_speed},
                                               {"ramp-to-speed", FunctionType::ramp_to_speed},
                                               {"constant", FunctionType::constant},
                                               {"polynomial", FunctionType::polynomial},
                                               {"harmonic", FunctionType::harmonic},
                                               {"table", FunctionType::table},
                                               {"step", FunctionType::step},
                                               {"ramp", FunctionType::ramp},
                                               {"trapezoid", FunctionType::trapezoid},
                                               {"expression", FunctionType::expression}});
  return read_function(type, source, numbers);
}

}  // namespace

TimeFunction read_drive_function(const JsonNode& node, const Quantity& value,
                                 NumberReader& numbers) {
  return read_motion({node, value, LawPurpose::drive, std::nullopt, {"coordinate"}}, numbers);
}

TimeFunction read_target(const JsonNode& node, const Quantity& value, NumberReader& numbers) {
  return read_motion({node, value, LawPurpose::drive}, numbers);
}

TimeFunction read_load_function(const LawSource& source, NumberReader& numbers) {
  const JsonNode& node = source.node;
  if (is_formula(node)) return read_expression_law(node, source, numbers);
  const bool is_binding = node.value().is_object() && node.find("variable").has_value();
  if (!node.value().is_object() || is_binding) {
    return ConstantFunction{numbers.designable(node, source.value)};
  }
  const auto type =
      read_choice<FunctionType>(node.at("type"), {{"constant", FunctionType::constant},
                                                  {"polynomial", FunctionType::polynomial},
                                                  {"harmonic", FunctionType::harmonic},
                                                  {"table", FunctionType::table},
                                                  {"step", FunctionType::step},
                                                  {"ramp", FunctionType::ramp},
                                                  {"half-sine", FunctionType::half_sine},
                                                  {"trapezoid", FunctionType::trapezoid},
                                                  {"expression", FunctionType::expression}});
  return read_function(type, source, numbers);
}

TimeFunction read_resistance(const LawSource& source, NumberReader& numbers) {
  if (is_formula(source.node)) return read_expression_law(source.node, source, numbers);
  const auto type =
      read_choice<FunctionType>(source.node.at("type"), {{"table", FunctionType::table},
                                                         {"expression", FunctionType::expression},
                                                         {"friction", FunctionType::friction},
                                                         {"clearance", FunctionType::clearance}});
  return read_function(type, source, numbers);
}

}  // namespace pleuel
