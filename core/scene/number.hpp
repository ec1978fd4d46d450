#pragma once

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/dual.hpp"
#include "core/base/expression.hpp"
#include "core/scene/kind_table.hpp"

namespace pleuel {

/// A number of the scene in SI units, fixed or bound to design variables:
///     value = constant + factor · x[variable]    or    constant + factor · expression(x)
struct Number {
  double constant = 0.0;
  int variable = -1;  ///< index into the design variables; −1 = none
  double factor = 0.0;
  std::shared_ptr<const Expression> expression = {};  ///< of design variables only; null = none

  Number() = default;
  Number(double fixed) : constant(fixed) {}  // NOLINT: a plain number is a Number
  static Number bound(int variable, double factor = 1.0) {
    Number number;
    number.variable = variable;
    number.factor = factor;
    return number;
  }
  static Number bound(std::shared_ptr<const Expression> expression) {
    Number number;
    number.expression = std::move(expression);
    number.factor = 1.0;
    return number;
  }
  bool is_bound() const { return variable >= 0 || expression != nullptr; }

  /// The design variables that it depends on.
  std::vector<int> variables() const;
  bool depends_on(int design_variable) const;
};

using Point = std::array<Number, 3>;  ///< [m], global axes

/// The values of the design variables, in the scalar type of the computation: double for a value,
/// a dual number with one seeded entry for a derivative.
template <class Scalar>
using Design = std::vector<Scalar>;

/// Exact in the first derivatives that the scalar type carries.
template <class Scalar>
Scalar resolve(const Expression& expression, const Design<Scalar>& design) {
  const auto argument = [&](std::size_t i) -> const Scalar& {
    return design[expression.arguments[i].index];
  };
  std::vector<double> arguments;
  for (std::size_t i = 0; i < expression.arguments.size(); ++i) {
    arguments.push_back(value_of(argument(i)));
  }
  const ExpressionValue at = evaluate(expression, arguments);
  Scalar value(at.value);
  if constexpr (!std::is_same_v<Scalar, double>) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      value += at.derivatives[i] * (argument(i) - arguments[i]);
    }
  }
  return value;
}

template <class Scalar>
Scalar resolve(const Number& number, const Design<Scalar>& design) {
  Scalar value(number.constant);
  if (number.variable >= 0) {
    value += number.factor * design[number.variable];
  }
  if (number.expression) value += number.factor * resolve(*number.expression, design);
  return value;
}

/// ∂(number)/∂x[variable]
double derivative_by(int variable, const Number& number, const Design<double>& design);

/// What a number must be beyond its physical quantity.
enum class Range {
  any,
  positive,
  not_negative,
  poisson,
  fraction,   ///< from 0 to 1
  below_one,  ///< from 0 to less than 1
  tolerance   ///< a relative error: 0 would ask for too much, 1 for nothing
};

struct RangeKind {
  Range type;
  bool (*holds)(double);
  const char* rule;    ///< what a number must
  const char* limits;  ///< of plain numbers, in a JSON schema
};

/// In the order of Range.
inline constexpr RangeKind range_kinds[] = {
    {Range::any, [](double) { return true; }, "be", "{}"},
    {Range::positive, [](double x) { return x > 0.0; }, "be positive",
     R"({"exclusiveMinimum": 0})"},
    {Range::not_negative, [](double x) { return x >= 0.0; }, "not be negative",
     R"({"minimum": 0})"},
    {Range::poisson, [](double x) { return x > -1.0 && x < 0.5; },
     "be greater than -1 and less than 0.5",
     R"({"exclusiveMinimum": -1, "exclusiveMaximum": 0.5})"},
    {Range::fraction, [](double x) { return x >= 0.0 && x <= 1.0; }, "be from 0 to 1",
     R"({"minimum": 0, "maximum": 1})"},
    {Range::below_one, [](double x) { return x >= 0.0 && x < 1.0; },
     "be at least 0 and less than 1", R"({"minimum": 0, "exclusiveMaximum": 1})"},
    {Range::tolerance, [](double x) { return x > 0.0 && x < 1.0; },
     "be greater than 0 and less than 1", R"({"exclusiveMinimum": 0, "exclusiveMaximum": 1})"}};
static_assert(are_in_order(range_kinds));

constexpr const RangeKind& kind_of(Range range) {
  return range_kinds[static_cast<std::size_t>(range)];
}

/// Whether the value is finite and keeps to the range.
bool is_within(Range range, double value);

/// A formula of design variables whose values are not free. The bounds of the variables do not say
/// what it can be: it has to be looked at for each design.
struct RangedFormula {
  Number number;
  Range range = Range::any;
  std::string place;  ///< "/scene/bodies/rod/section/width"
  std::string rule;   ///< "must be positive [m]"
};

}  // namespace pleuel
