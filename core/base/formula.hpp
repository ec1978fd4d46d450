#pragma once

#include <cassert>
#include <cmath>

#include "core/base/expression.hpp"
#include "core/base/int_size.hpp"
#include "core/base/jet.hpp"

/// Expressions as functions of time: values with two derivatives, in any scalar type.
namespace pleuel {

/// An expression at an instant. The arguments are functions of time; `argument(i)` gives the one of
/// Expression::arguments[i]. Nothing is stored: the steps of an expression form a tree. min, max
/// and abs have kinks; where both sides are equal, the mean of both counts, as in evaluate().
template <class Scalar, class Argument>
class Formula {
 public:
  Formula(const Expression& expression, const Argument& argument)
      : expression_(expression), argument_(argument) {}

  TimeValue<Scalar> value() const { return at(int_size(expression_.steps) - 1); }

 private:
  using Value = TimeValue<Scalar>;

  static Value constant(double value) { return {Scalar(value), Scalar(0), Scalar(0)}; }

  Value at(int index) const {
    const ExpressionStep& step = expression_.steps[index];
    if (step.operation == Operation::constant) return constant(step.constant);
    if (step.operation == Operation::argument) return argument_(step.first);
    if (step.operation == Operation::power) return power_of(step);
    assert(step.operation != Operation::path);  // of sections only
    const Value first = at(step.first);
    return step.second < 0 ? of_one(step.operation, first)
                           : of_two(step.operation, first, at(step.second));
  }

  static Value of_one(Operation operation, const Value& f) {
    switch (operation) {
      case Operation::square_root:
        return sqrt(f);
      case Operation::exponential:
        return exp(f);
      case Operation::logarithm:
        return log(f);
      case Operation::hyperbolic_tangent:
        return tanh(f);
      case Operation::sine:
        return sin(f);
      case Operation::cosine:
        return cos(f);
      case Operation::tangent:
        return sin(f) / cos(f);
      case Operation::arc_sine:
        return atan2(f, sqrt(constant(1.0) - f * f));
      case Operation::arc_cosine:
        return atan2(sqrt(constant(1.0) - f * f), f);
      case Operation::arc_tangent:
        return atan2(f, constant(1.0));
      case Operation::magnitude:
        return magnitude(f);
      default:
        return -f;
    }
  }

  static Value of_two(Operation operation, const Value& f, const Value& g) {
    switch (operation) {
      case Operation::plus:
        return f + g;
      case Operation::minus:
        return f - g;
      case Operation::times:
        return f * g;
      case Operation::over:
        return f / g;
      case Operation::arc_tangent_2:
        return atan2(f, g);
      case Operation::smaller:
        return chosen(f, g, f.value < g.value);
      default:
        return chosen(f, g, f.value > g.value);
    }
  }

  static Value chosen(const Value& f, const Value& g, bool is_first) {
    if (value_of(f.value) == value_of(g.value)) return constant(0.5) * (f + g);
    return is_first ? f : g;
  }

  static Value magnitude(const Value& f) {
    if (value_of(f.value) == 0.0) return constant(0.0);
    return value_of(f.value) > 0.0 ? f : -f;
  }

  Value power_of(const ExpressionStep& step) const {
    const Value base = at(step.first), exponent = at(step.second);
    if (!changes(step.second)) return raised(base, exponent.value);
    return exp(exponent * log(base));
  }

  /// Whether it depends on anything but the design.
  bool changes(int index) const {
    const ExpressionStep& step = expression_.steps[index];
    if (step.operation == Operation::constant) return false;
    if (step.operation == Operation::argument) {
      return expression_.arguments[step.first].kind != ExpressionArgument::Kind::variable;
    }
    return changes(step.first) || (step.second >= 0 && changes(step.second));
  }

  const Expression& expression_;
  const Argument& argument_;
};

template <class Scalar, class Argument>
TimeValue<Scalar> evaluate_formula(const Expression& expression, const Argument& argument) {
  return Formula<Scalar, Argument>(expression, argument).value();
}

}  // namespace pleuel
