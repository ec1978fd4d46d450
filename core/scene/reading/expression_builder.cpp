#include "core/scene/reading/expression_builder.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/kind_table.hpp"
#include "core/scene/reading/suggestion.hpp"

namespace pleuel {

namespace {

/// "m ^ 2" → "m^2"
std::string without_blanks_at_powers(const std::string& unit) {
  std::string text;
  for (const char c : unit) {
    if (c == '^') text.erase(text.find_last_not_of(' ') + 1);
    if (c != ' ' || !text.ends_with('^')) text += c;
  }
  return text;
}

std::string described(const KnownNumber& number) {
  return describe(number.dimension);
}

// What operations make of units. What is wrong is a UnitError.

Dimension common(const KnownNumber& a, const KnownNumber& b, const char* what) {
  if (a.dimension == b.dimension) return a.dimension;
  if (a.is_zero()) return b.dimension;
  if (b.is_zero()) return a.dimension;
  const bool is_plain = a.dimension.is_number() || b.dimension.is_number();
  const Dimension ratio = a.dimension / b.dimension;
  const bool differs_by_angle = ratio.is_angle() || (Dimension{} / ratio).is_angle();
  std::string more;
  if (differs_by_angle) {
    more =
        "; angles never come or go silently: multiply or divide by 1 rad (a cycle is 1 rev, and Hz "
        "counts cycles)";
  } else if (is_plain) {
    more = "; here a number needs its unit, as in \"5 mm\"";
  }
  throw UnitError(fmt::format("units differ: {} {} {}{}", described(a), what, described(b), more));
}

Dimension power(const KnownNumber& base, const KnownNumber& exponent) {
  if (!exponent.dimension.is_number()) {
    throw UnitError(fmt::format("an exponent has no unit, got {}", described(exponent)));
  }
  if (base.dimension.is_number()) return {};
  if (!exponent.constant) {
    throw UnitError(fmt::format("the exponent of {} must be a fixed number", described(base)));
  }
  return base.dimension.to_the(*exponent.constant);
}

void require_number(const KnownNumber& number) {
  if (number.dimension.is_number()) return;
  throw UnitError(fmt::format("needs a number without unit, got {}", described(number)));
}

Dimension dimension_of(Operation operation, const KnownNumber& a, const KnownNumber& b) {
  switch (operation) {
    case Operation::plus:
      return common(a, b, "+");
    case Operation::minus:
      return common(a, b, "-");
    case Operation::smaller:
    case Operation::larger:
      return common(a, b, "compared with");
    case Operation::arc_tangent_2:
      common(a, b, "over");
      return Dimension::angle();
    case Operation::times:
      return a.dimension * b.dimension;
    case Operation::over:
      return a.dimension / b.dimension;
    case Operation::power:
      return power(a, b);
    case Operation::square_root:
      return a.dimension.to_the(0.5);
    case Operation::sine:
    case Operation::cosine:
    case Operation::tangent:
      if (a.dimension.is_angle() || a.is_zero()) return {};
      throw UnitError(
          fmt::format("needs an angle, got {}; give a number its unit, as in "
                      "\"30 deg\" or \"pi rad\"",
                      described(a)));
    case Operation::exponential:
    case Operation::logarithm:
    case Operation::hyperbolic_tangent:
      require_number(a);
      return {};
    case Operation::arc_sine:
    case Operation::arc_cosine:
    case Operation::arc_tangent:
      require_number(a);
      return Dimension::angle();
    default:
      return a.dimension;
  }
}

/// f/(60 Hz) looks like a ratio, but would be 2π times as large, as an angle [rad] whose unit no
/// limit asks for; so would f*(1/(60 Hz)), and (60 Hz)/f as much smaller.
void check_no_ratio_of_frequencies(const KnownNumber& a, const KnownNumber& b,
                                   const Dimension& result) {
  const double angles = result.powers[3];
  const bool is_angle = angles != 0.0 && result == Dimension::angle().to_the(angles);
  if (!is_angle || a.counts_cycles == b.counts_cycles) return;
  const KnownNumber& cycles = a.counts_cycles ? a : b;
  if (cycles.dimension.is_number()) return;  // cycles themselves, which "1 rad" makes an angle
  throw UnitError(
      fmt::format("{} and {} make no ratio but an angle: frequencies are angular ones "
                  "here, and Hz counts cycles; write \"rev/s\" in place of \"Hz\"",
                  described(a), described(b)));
}

/// Of one operand `b` is `a`.
KnownNumber result_of(Operation operation, const KnownNumber& a, const KnownNumber& b) {
  KnownNumber result{dimension_of(operation, a, b)};
  result.counts_cycles = (a.counts_cycles || b.counts_cycles) && result.dimension.powers[3] == 0.0;
  if (operation == Operation::times || operation == Operation::over) {
    check_no_ratio_of_frequencies(a, b, result.dimension);
  }
  return result;
}

/// Load cases that a name is known with: "fast" where there is a symbol "bow [fast]".
std::vector<std::string> cases_with(const std::string& name, const std::vector<Symbol>& symbols) {
  std::vector<std::string> cases;
  for (const Symbol& symbol : symbols) {
    const auto split = split_case(symbol.name);
    if (split && split->name == name) cases.push_back(split->load_case);
  }
  return cases;
}

/// "bow", where there are symbols "bow [fast]" …
std::vector<std::string> names_with_cases(const std::vector<Symbol>& symbols) {
  std::vector<std::string> names;
  for (const Symbol& symbol : symbols) {
    const auto split = split_case(symbol.name);
    if (split && std::ranges::find(names, split->name) == names.end()) {
      names.push_back(split->name);
    }
  }
  return names;
}

}  // namespace

std::size_t ExpressionBuilder::column_of(std::size_t position) const {
  std::size_t column = 1;
  for (std::size_t i = 0; i < std::min(position, text_.size()); ++i) {
    if ((static_cast<unsigned char>(text_[i]) & 0xC0U) != 0x80U) ++column;
  }
  return column;
}

int ExpressionBuilder::add_quantity(std::size_t position, double value, const std::string& unit) {
  MeasuredUnit measured;
  try {
    if (!unit.empty()) measured = measure_unit(without_blanks_at_powers(unit));
  } catch (const UnitError& error) {
    const bool is_product = find(unit) != nullptr || unit == "pi";
    fail(position, is_product ? std::string("a product needs its *") : error.what());
  }
  const double si = value * measured.scale;
  if (!std::isfinite(si)) fail(position, "the number is out of range");
  return add_constant({measured.dimension, si, is_of_cycles(unit)});
}

int ExpressionBuilder::add_name(std::size_t position, const std::string& name) {
  const Symbol* symbol = find(name);
  if (symbol == nullptr) fail_unknown(position, name);
  const bool is_of_two = name == "pi" || std::ranges::count_if(symbols_, [&](const Symbol& one) {
                                           return one.name == name;
                                         }) > 1;
  if (is_of_two) {
    fail(position, fmt::format("the name \"{}\" stands for two things; rename one of them", name));
  }
  if (!symbol->constant && !symbol->argument) {
    throw CaseExpressionError(column_of(position), "is made from several load cases");
  }
  return add_symbol(*symbol);
}

int ExpressionBuilder::apply(std::size_t position, Operation operation, int first, int second) {
  const KnownNumber &a = facts_[first], &b = facts_[second < 0 ? first : second];
  const bool is_constant = a.constant && b.constant;
  try {
    const int step = add({operation, 0.0, first, second}, result_of(operation, a, b));
    if (is_constant) fold(position, step);
    return step;
  } catch (const UnitError& error) {
    fail(position, error.what());
  }
}

bool ExpressionBuilder::is_unit(const std::string& name) const {
  try {
    measure_unit(name);
    return true;
  } catch (const UnitError&) {
    return false;
  }
}

ReadExpression ExpressionBuilder::take() {
  expression_.text = std::string(text_);
  const auto quantity = find_quantity(facts_.back().dimension);
  expression_.quantity = quantity ? quantity->name : "a quantity";
  expression_.unit = quantity ? std::string(quantity->unit) : base_units(facts_.back().dimension);
  return {facts_.back(), std::make_shared<const Expression>(std::move(expression_))};
}

int ExpressionBuilder::add(const ExpressionStep& step, const KnownNumber& facts) {
  expression_.steps.push_back(step);
  facts_.push_back(facts);
  return int_size(facts_) - 1;
}

int ExpressionBuilder::add_constant(const KnownNumber& known) {
  return add({Operation::constant, *known.constant}, known);
}

int ExpressionBuilder::add_symbol(const Symbol& symbol) {
  if (symbol.constant) {
    return add_constant({symbol.dimension, symbol.constant, symbol.counts_cycles});
  }
  std::vector<ExpressionArgument>& all = expression_.arguments;
  const auto known = std::ranges::find(all, *symbol.argument);
  const auto index = static_cast<int>(known - all.begin());
  if (known == all.end()) all.push_back(*symbol.argument);
  return add({Operation::argument, 0.0, index}, {symbol.dimension, std::nullopt});
}

void ExpressionBuilder::fold(std::size_t position, int step) {
  const auto& [operation, unused, first, second] = expression_.steps[step];
  Expression alone;
  alone.steps = {{Operation::constant, *facts_[first].constant},
                 {Operation::constant, second < 0 ? 0.0 : *facts_[second].constant},
                 {operation, 0.0, 0, second < 0 ? -1 : 1}};
  const double value = evaluate(alone, {}).value;
  if (!std::isfinite(value)) fail(position, "the result is no finite number");
  facts_[step].constant = value;
}

void ExpressionBuilder::fail_unknown_case(std::size_t position, const NameInCase& wanted) const {
  const auto& [name, load_case] = wanted;
  const std::vector<std::string> names = names_with_cases(symbols_);
  if (names.empty()) {
    throw CaseExpressionError(
        column_of(position),
        fmt::format("\"[{}]\" names a load case: only responses, limits and the objective of a "
                    "file with \"cases\" can do so",
                    load_case));
  }
  if (find(name) != nullptr) {
    fail(position,
         fmt::format("\"{}\" is no number of one load case: leave \"[{}]\" out", name, load_case));
  }
  const std::vector<std::string> cases = cases_with(name, symbols_);
  if (cases.empty()) fail(position, fmt::format("unknown name \"{}\"{}", name, hint(name, names)));
  fail(position,
       fmt::format("\"{}\" has no case \"{}\"{}", name, load_case, hint(load_case, cases)));
}

void ExpressionBuilder::fail_unknown(std::size_t position, const std::string& name) const {
  for (const char* sign : {"·", "²", "³"}) {  // of units only
    if (name.find(sign) != std::string::npos) {
      fail(position, fmt::format("\"{}\": a product is written \"*\", a power \"^\"", name));
    }
  }
  if (const auto split = split_case(name)) fail_unknown_case(position, *split);
  const std::vector<std::string> cases = cases_with(name, symbols_);
  if (!cases.empty()) {
    fail(position, fmt::format("\"{}\" differs from case to case: name one of them, as in "
                               "\"{}[{}]\"; there are {}",
                               name, name, cases.front(), quoted_list(cases, "and")));
  }
  std::string more = hint(name, names_of(symbols_));
  if (is_unit(name)) {
    more += fmt::format(". If the unit is meant: it stands right behind its number, as in \"1 {}\"",
                        name);
  }
  fail(position, fmt::format("unknown name \"{}\"{}", name, more));
}

}  // namespace pleuel
