#include "core/scene/reading/time_function_reader.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "core/scene/reading/symbols.hpp"

namespace pleuel {

namespace {

constexpr std::size_t most_coefficients = 11;  // per_time() knows ten derivatives

/// A function that its table of keys says all of.
template <class Function>
Function read_by_keys(const LawSource& source, NumberReader& numbers) {
  Function function;
  source.read(numbers, [&](Keys& keys) { describe(keys, function, source.value); });
  return function;
}

/// The same of what acts along a coordinate.
template <class Function>
Function read_along(const LawSource& source, NumberReader& numbers) {
  Function function;
  source.read(numbers, [&](Keys& keys) { describe(keys, function, along(source.value)); });
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

// Laws that have a shape: steps, ramps, pulses.

/// A duration [s] that a drive must have: it cannot move in no time.
void duration_of_drive(Keys& keys, const char* word, const LawSource& source, double& duration) {
  const bool is_drive = source.purpose == LawPurpose::drive;
  const Range range = is_drive ? Range::positive : Range::not_negative;
  keys.fixed({word, is_drive}, duration, {quantities::time, range}, "");
}

/// From one value to another at a time; with "rise" by a quintic without rate and acceleration at
/// its ends, which drives need.
TableFunction read_step(const LawSource& source, NumberReader& numbers) {
  TableFunction table;
  Number from = 0.0, to;
  double time = 0.0, rise = 0.0;
  source.read(numbers, [&](Keys& keys) {
    keys.number(optional_key("from"), from, {source.value}, "");
    keys.number("to", to, {source.value}, "");
    keys.fixed(optional_key("time"), time, {quantities::time}, "");
    duration_of_drive(keys, "rise", source, rise);
  });
  table.values = {from, to};
  table.interpolation = rise > 0.0 ? Interpolation::resting : Interpolation::step;
  table.times = {time, time + rise};
  // Of a jump the first point only says what was before.
  if (rise == 0.0) table.times = {std::min(time, 0.0) - 1.0, time};
  return table;
}

/// With "rounding" twice differentiable, which drives need.
RampFunction read_ramp(const LawSource& source, NumberReader& numbers) {
  RampFunction ramp;
  source.read(numbers, [&](Keys& keys) {
    describe(keys, ramp, source.value);
    duration_of_drive(keys, "rounding", source, ramp.rounding);
    const double most = 0.5 * (ramp.end - ramp.begin);
    keys.must("rounding", ramp.rounding <= most * (1.0 + 1e-9),
              fmt::format("must be at most half of the duration, {:g} s", most),
              Shown::rule_and_value);
  });
  return ramp;
}

constexpr Choice<Interpolation> flanks[] = {{"straight", Interpolation::linear},
                                            {"smooth", Interpolation::resting}};

/// Up, a hold, and down. Flanks are straight, or quintics as those of a step, which drives need.
TableFunction read_trapezoid(const LawSource& source, NumberReader& numbers) {
  constexpr Measure flank = {quantities::time, Range::positive};
  const bool is_drive = source.purpose == LawPurpose::drive;
  TableFunction table;
  table.interpolation = is_drive ? Interpolation::resting : Interpolation::linear;
  Number base = 0.0, value;
  double begin = 0.0, rise = 0.0, hold = 0.0, fall = 0.0, period = 0.0;
  source.read(numbers, [&](Keys& keys) {
    keys.number("value", value, {source.value}, "");
    keys.number(optional_key("base"), base, {source.value}, "");
    keys.fixed(optional_key("begin"), begin, {quantities::time}, "");
    keys.fixed("rise", rise, flank, "");
    keys.fixed(optional_key("hold"), hold, {quantities::time, Range::not_negative}, "");
    fall = rise;
    keys.fixed(optional_key("fall"), fall, flank, "");
    keys.choice(optional_key("flanks"), table.interpolation, flanks, "");
    keys.must("flanks", !is_drive || table.interpolation == Interpolation::resting,
              "must be \"smooth\" of a drive, whose speed would jump", Shown::rule_and_value);
    describe_period(keys, period, rise + hold + fall);
  });
  table.times = {begin, begin + rise};
  table.values = {base, value};
  const auto add = [&](double duration, const Number& number) {
    table.times.push_back(table.times.back() + duration);
    table.values.push_back(number);
  };
  if (hold > 0.0) add(hold, value);
  add(fall, base);
  if (period == 0.0) return table;
  const double duration = rise + hold + fall;
  table.repetition = Repetition::periodic;
  if (period > duration * (1.0 + 1e-9)) add(period - duration, base);
  return table;
}

// Formulas.

using ArgumentKind = ExpressionArgument::Kind;

/// t, and the state where there is one.
std::vector<Symbol> law_symbols(const LawSource& source) {
  const auto symbol = [&](std::string_view name, const Quantity& quantity, ArgumentKind kind) {
    return Symbol{std::string(name), dimension_of(quantity), std::nullopt,
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
  const ReadExpression read = numbers.formula_of(node, source.value, law_symbols(source));
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

struct LawKind {
  enum Use : unsigned { motion = 1, load = 2, resistance = 4 };

  std::string_view word;
  unsigned uses;  ///< sum of Use
  std::function<TimeFunction(const LawSource&, NumberReader&)> read;
};

/// By the type of the function, one of those that are for this use.
TimeFunction read_law(const LawSource& source, NumberReader& numbers, LawKind::Use use) {
  using enum LawKind::Use;
  static const LawKind kinds[] = {
      {"constant-speed", motion, read_by_keys<ConstantSpeedDrive>},
      {"ramp-to-speed", motion, read_by_keys<RampToSpeedDrive>},
      {"constant", motion | load, read_by_keys<ConstantFunction>},
      {"polynomial", motion | load, read_polynomial},
      {"harmonic", motion | load, read_by_keys<HarmonicFunction>},
      {"table", motion | load | resistance, read_table_law},
      {"step", motion | load, read_step},
      {"ramp", motion | load, read_ramp},
      {"half-sine", load, read_by_keys<HalfSineFunction>},
      {"trapezoid", motion | load, read_trapezoid},
      {"expression", motion | load | resistance, read_expression_object},
      {"friction", resistance, read_along<FrictionLaw>},
      {"clearance", resistance, read_along<ClearanceLaw>}};
  std::vector<LawKind> for_use;
  std::ranges::copy_if(kinds, std::back_inserter(for_use),
                       [use](const LawKind& kind) { return (kind.uses & use) != 0; });
  return read_row(source.node.at("type"), for_use).read(source, numbers);
}

}  // namespace

TimeFunction read_drive_function(const JsonNode& node, const Quantity& value,
                                 NumberReader& numbers) {
  return read_law({node, value, LawPurpose::drive, std::nullopt, {"coordinate"}}, numbers,
                  LawKind::motion);
}

TimeFunction read_target(const JsonNode& node, const Quantity& value, NumberReader& numbers) {
  return read_law({node, value, LawPurpose::drive}, numbers, LawKind::motion);
}

TimeFunction read_load_function(const LawSource& source, NumberReader& numbers) {
  const JsonNode& node = source.node;
  if (is_formula(node)) return read_expression_law(node, source, numbers);
  const bool is_binding = node.value().is_object() && node.find("variable").has_value();
  if (!node.value().is_object() || is_binding) {
    return ConstantFunction{numbers.designable(node, source.value)};
  }
  return read_law(source, numbers, LawKind::load);
}

TimeFunction read_resistance(const LawSource& source, NumberReader& numbers) {
  if (is_formula(source.node)) return read_expression_law(source.node, source, numbers);
  return read_law(source, numbers, LawKind::resistance);
}

}  // namespace pleuel
