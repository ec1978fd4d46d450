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
  KnownNumber facts;
  facts.dimension = dimension_of(position, operation, first, second);
  const bool has_cycles = fact(first).counts_cycles || (second >= 0 && fact(second).counts_cycles);
  facts.counts_cycles = has_cycles && facts.dimension.powers[3] == 0.0;
  if (operation == Operation::times || operation == Operation::over) {
    check_no_ratio_of_frequencies(position, facts, first, second);
  }
  const bool is_constant = fact(first).constant && (second < 0 || fact(second).constant);
  const int step = add({operation, 0.0, first, second}, facts);
  if (is_constant) fold(position, step);
  return step;
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
  alone.steps = {{Operation::constant, *fact(first).constant},
                 {Operation::constant, second < 0 ? 0.0 : *fact(second).constant},
                 {operation, 0.0, 0, second < 0 ? -1 : 1}};
  const double value = evaluate(alone, {}).value;
  if (!std::isfinite(value)) fail(position, "the result is no finite number");
  facts_[step].constant = value;
}

Dimension ExpressionBuilder::dimension_of(std::size_t position, Operation operation, int first,
                                          int second) const {
  switch (operation) {
    case Operation::plus:
      return common(position, first, second, "+");
    case Operation::minus:
      return common(position, first, second, "-");
    case Operation::smaller:
    case Operation::larger:
      return common(position, first, second, "compared with");
    case Operation::arc_tangent_2:
      common(position, first, second, "over");
      return Dimension::angle();
    case Operation::times:
      return fact(first).dimension * fact(second).dimension;
    case Operation::over:
      return fact(first).dimension / fact(second).dimension;
    case Operation::power:
      return power(position, first, second);
    case Operation::square_root:
      return fact(first).dimension.to_the(0.5);
    case Operation::sine:
    case Operation::cosine:
    case Operation::tangent:
      if (!fact(first).dimension.is_angle() && !fact(first).is_zero()) {
        fail(position, fmt::format("needs an angle, got {}; give a number its unit, as in "
                                   "\"30 deg\" or \"pi rad\"",
                                   described(first)));
      }
      return {};
    case Operation::exponential:
    case Operation::logarithm:
    case Operation::hyperbolic_tangent:
      check_number(position, first);
      return {};
    case Operation::arc_sine:
    case Operation::arc_cosine:
    case Operation::arc_tangent:
      check_number(position, first);
      return Dimension::angle();
    default:
      return fact(first).dimension;
  }
}

/// f/(60 Hz) looks like a ratio, but would be 2π times as large, as an angle [rad] whose unit no
/// limit asks for; so would f*(1/(60 Hz)), and (60 Hz)/f as much smaller.
void ExpressionBuilder::check_no_ratio_of_frequencies(std::size_t position,
                                                      const KnownNumber& result, int first,
                                                      int second) const {
  const double angles = result.dimension.powers[3];
  const bool is_angle = angles != 0.0 && result.dimension == Dimension::angle().to_the(angles);
  if (!is_angle || fact(first).counts_cycles == fact(second).counts_cycles) return;
  const KnownNumber& cycles = fact(first).counts_cycles ? fact(first) : fact(second);
  if (cycles.dimension.is_number()) return;  // cycles themselves, which "1 rad" makes an angle
  fail(position, fmt::format("{} and {} make no ratio but an angle: frequencies are angular ones "
                             "here, and Hz counts cycles; write \"rev/s\" in place of \"Hz\"",
                             described(first), described(second)));
}

void ExpressionBuilder::check_number(std::size_t position, int step) const {
  if (fact(step).dimension.is_number()) return;
  fail(position, fmt::format("needs a number without unit, got {}", described(step)));
}

Dimension ExpressionBuilder::common(std::size_t position, int first, int second,
                                    const char* what) const {
  if (fact(first).dimension == fact(second).dimension) return fact(first).dimension;
  if (fact(first).is_zero()) return fact(second).dimension;
  if (fact(second).is_zero()) return fact(first).dimension;
  const bool is_plain = fact(first).dimension.is_number() || fact(second).dimension.is_number();
  const Dimension ratio = fact(first).dimension / fact(second).dimension;
  const bool differs_by_angle = ratio.is_angle() || (Dimension{} / ratio).is_angle();
  std::string more;
  if (differs_by_angle) {
    more =
        "; angles never come or go silently: multiply or divide by 1 rad (a cycle is 1 rev, and Hz "
        "counts cycles)";
  } else if (is_plain) {
    more = "; here a number needs its unit, as in \"5 mm\"";
  }
  fail(position,
       fmt::format("units differ: {} {} {}{}", described(first), what, described(second), more));
}

Dimension ExpressionBuilder::power(std::size_t position, int base, int exponent) const {
  if (!fact(exponent).dimension.is_number()) {
    fail(position, fmt::format("an exponent has no unit, got {}", described(exponent)));
  }
  if (fact(base).dimension.is_number()) return {};
  if (!fact(exponent).constant) {
    fail(position, fmt::format("the exponent of {} must be a fixed number", described(base)));
  }
  return fact(base).dimension.to_the(*fact(exponent).constant);
}

std::vector<std::string> ExpressionBuilder::cases_with(const std::string& name) const {
  std::vector<std::string> cases;
  for (const Symbol& symbol : symbols_) {
    const auto split = split_case(symbol.name);
    if (split && split->name == name) cases.push_back(split->load_case);
  }
  return cases;
}

std::vector<std::string> ExpressionBuilder::names_with_cases() const {
  std::vector<std::string> names;
  for (const Symbol& symbol : symbols_) {
    const auto split = split_case(symbol.name);
    if (split && std::ranges::find(names, split->name) == names.end()) {
      names.push_back(split->name);
    }
  }
  return names;
}

void ExpressionBuilder::fail_unknown_case(std::size_t position, const NameInCase& wanted) const {
  const auto& [name, load_case] = wanted;
  const std::vector<std::string> names = names_with_cases();
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
  const std::vector<std::string> cases = cases_with(name);
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
  const std::vector<std::string> cases = cases_with(name);
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
