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
  source.read(numbers, function, source.value);
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

Number number_or(const LawSource& source, const char* key, double otherwise,
                 NumberReader& numbers) {
  const auto node = source.node.find(key);
  return node ? numbers.designable(*node, source.value) : Number(otherwise);
}

/// A fixed time [s].
double time_or(const LawSource& source, const char* key, double otherwise, Range range,
               const NumberReader& numbers) {
  const auto node = source.node.find(key);
  return node ? numbers.fixed(*node, quantities::time, range) : otherwise;
}

/// A duration that a drive must have: it cannot move in no time.
double duration_of_drive(const LawSource& source, const char* key, const NumberReader& numbers) {
  if (source.purpose == LawPurpose::drive) {
    return numbers.fixed(source.node.at(key), quantities::time, Range::positive);
  }
  return time_or(source, key, 0.0, Range::not_negative, numbers);
}

/// @param longest  what it must be at least [s]
double read_period(const LawSource& source, double longest, const NumberReader& numbers) {
  const auto node = source.node.find("period");
  if (!node) return 0.0;
  const double period = numbers.fixed(*node, quantities::time, Range::positive);
  if (period < longest * (1.0 - 1e-9)) {
    node->fail_with_value(
        fmt::format("must be at least as long as what is repeated, {:g} s", longest));
  }
  return period;
}

/// From one value to another at a time; with "rise" by a quintic without rate and acceleration at
/// its ends, which drives need.
TableFunction read_step(const LawSource& source, NumberReader& numbers) {
  source.allow_keys({"from", "to", "time", "rise"});
  TableFunction table;
  table.values = {number_or(source, "from", 0.0, numbers),
                  numbers.designable(source.node.at("to"), source.value)};
  const double time = time_or(source, "time", 0.0, Range::any, numbers);
  const double rise = duration_of_drive(source, "rise", numbers);
  table.interpolation = rise > 0.0 ? Interpolation::resting : Interpolation::step;
  table.times = {time, time + rise};
  // Of a jump the first point only says what was before.
  if (rise == 0.0) table.times = {std::min(time, 0.0) - 1.0, time};
  return table;
}

/// With "rounding" twice differentiable, which drives need.
RampFunction read_ramp(const LawSource& source, NumberReader& numbers) {
  RampFunction ramp;
  source.read(numbers, ramp, source.value);
  ramp.rounding = duration_of_drive(source, "rounding", numbers);
  const double most = 0.5 * (ramp.end - ramp.begin);
  if (ramp.rounding > most * (1.0 + 1e-9)) {
    source.node.at("rounding")
        .fail_with_value(fmt::format("must be at most half of the duration, {:g} s", most));
  }
  return ramp;
}

HalfSineFunction read_half_sine(const LawSource& source, NumberReader& numbers) {
  HalfSineFunction wave;
  source.read(numbers, wave, source.value);
  wave.period = read_period(source, wave.duration, numbers);
  return wave;
}

/// Up, a hold, and down. Flanks are straight, or quintics as those of a step, which drives need.
TableFunction read_trapezoid(const LawSource& source, NumberReader& numbers) {
  source.allow_keys({"value", "base", "begin", "rise", "hold", "fall", "flanks", "period"});
  const bool is_drive = source.purpose == LawPurpose::drive;
  const Number base = number_or(source, "base", 0.0, numbers);
  const Number value = numbers.designable(source.node.at("value"), source.value);
  const double begin = time_or(source, "begin", 0.0, Range::any, numbers);
  const double rise = numbers.fixed(source.node.at("rise"), quantities::time, Range::positive);
  const double hold = time_or(source, "hold", 0.0, Range::not_negative, numbers);
  const double fall = time_or(source, "fall", rise, Range::positive, numbers);
  TableFunction table;
  table.interpolation = is_drive ? Interpolation::resting : Interpolation::linear;
  if (const auto flanks = source.node.find("flanks")) {
    table.interpolation = read_choice<Interpolation>(
        *flanks, {{"straight", Interpolation::linear}, {"smooth", Interpolation::resting}});
    if (is_drive && table.interpolation == Interpolation::linear) {
      flanks->fail_with_value("must be \"smooth\" of a drive, whose speed would jump");
    }
  }
  table.times = {begin, begin + rise};
  table.values = {base, value};
  const auto add = [&](double duration, const Number& number) {
    table.times.push_back(table.times.back() + duration);
    table.values.push_back(number);
  };
  if (hold > 0.0) add(hold, value);
  add(fall, base);
  const double duration = rise + hold + fall, period = read_period(source, duration, numbers);
  if (period == 0.0) return table;
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

FrictionLaw read_friction(const LawSource& source, NumberReader& numbers) {
  FrictionLaw law;
  source.read(numbers, law, along(source.value));
  return law;
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
      {"half-sine", load, read_half_sine},
      {"trapezoid", motion | load, read_trapezoid},
      {"expression", motion | load | resistance, read_expression_object},
      {"friction", resistance, read_friction},
      {"clearance", resistance, read_clearance}};
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
