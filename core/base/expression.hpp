#pragma once

/// Values in a row as a smooth function of their number: what lies between the sizes of a list.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/dual.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

struct PathPoint {
  double value = 0.0, slope = 0.0;
};

/// The value at 0, 1, 2 … and, between them, a cubic that never leaves the range of the two values
/// beside it; once differentiable. Slopes at the inner values are harmonic means of the differences
/// before and after, zero where these differ in sign (Fritsch & Butland 1984); at the ends those of
/// the parabola through three values, kept from overshooting (Fritsch & Carlson 1980). Beyond the
/// ends it goes on straight.
/// @param values  at least one; a single one is constant
/// @param at      from 0 to the number of values less one
PathPoint path_point(const std::vector<double>& values, double at);

/// What a step of an expression computes from its operands a and b.
enum class Operation {
  constant,
  argument,
  plus,
  minus,
  times,
  over,
  power,
  negated,
  square_root,
  exponential,
  logarithm,
  hyperbolic_tangent,
  sine,
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  arc_tangent_2,  ///< atan2(a, b): the angle of the point (b, a)
  smaller,
  larger,
  magnitude,
  path  ///< through the values of Expression::path: the first at 0, the next at 1, …
};

/// One operation on the results of earlier steps.
struct ExpressionStep {
  Operation operation = Operation::constant;
  double constant = 0.0;        ///< of a constant [SI]
  int first = -1, second = -1;  ///< operands: earlier steps; of an argument `first` is its index
  bool operator==(const ExpressionStep&) const = default;
};

/// What an expression depends on.
struct ExpressionArgument {
  enum class Kind {
    variable,    ///< of the design
    response,    ///< of the file
    time,        ///< t, of laws (core/base/time_law.hpp)
    coordinate,  ///< what a law acts along: an angle, a displacement, an elongation
    rate         ///< of that
  };
  Kind kind = Kind::variable;
  std::size_t index = 0;  ///< of the design variable, or of the response in the file
  bool operator==(const ExpressionArgument&) const = default;
};

/// A formula of the problem file, taken apart: its value is the result of the last step. In SI
/// units; that they fit was checked when it was read.
struct Expression {
  std::string text;      ///< as the user wrote it
  std::string quantity;  ///< what its value measures: "a length"
  std::string unit;      ///< SI unit of it
  std::vector<ExpressionArgument> arguments;
  std::vector<ExpressionStep> steps;
  std::vector<double> path = {};  ///< what Operation::path goes through [SI]
};

struct ExpressionValue {
  double value = 0.0;
  std::vector<double> derivatives;  ///< by each argument
};

/// Value and exact derivatives (reverse accumulation). min, max and abs have kinks: there the
/// derivatives are those of the side that counts; where both sides are equal, their mean.
/// @param arguments  values in the order of Expression::arguments [SI]
/// @returns numbers that are not finite where the formula has none there, as 1/0 or sqrt(-1)
ExpressionValue evaluate(const Expression& expression, const std::vector<double>& arguments);

// Functions of time with their first two derivatives, in any scalar type.

/// f, ḟ, f̈. Sums, products and functions follow the chain rule, so that the derivatives are exact.
template <class Scalar>
struct TimeValue {
  Scalar value, rate, acceleration;
};

namespace jet_detail {

/// g(x) from its value and its slope, exact in the first derivatives that the scalar carries.
template <class Scalar>
Scalar lifted(const Scalar& x, double value, double slope) {
  if constexpr (std::is_same_v<Scalar, double>) return value;
  return Scalar(value + slope * (x - value_of(x)));
}

template <class Scalar>
Scalar exponential(const Scalar& x) {
  const double value = std::exp(value_of(x));
  return lifted(x, value, value);
}

template <class Scalar>
Scalar logarithm(const Scalar& x) {
  return lifted(x, std::log(value_of(x)), 1.0 / value_of(x));
}

/// xⁿ; with n = 0 also where x = 0.
template <class Scalar>
Scalar raised(const Scalar& x, const Scalar& n) {
  const double a = value_of(x), b = value_of(n), value = std::pow(a, b);
  const Scalar by_base = lifted(x, value, b == 0.0 ? 0.0 : b * std::pow(a, b - 1.0));
  if constexpr (std::is_same_v<Scalar, double>) return by_base;
  const bool has_logarithm = a > 0.0;  // elsewhere exponents that change have no value
  return has_logarithm ? Scalar(by_base + value * std::log(a) * (n - b)) : by_base;
}

/// g(f) from g, g', g'' at f:  g,  g' ḟ,  g' f̈ + g'' ḟ²
template <class Scalar>
TimeValue<Scalar> composed(const TimeValue<Scalar>& f, const Scalar& g, const Scalar& slope,
                           const Scalar& curvature) {
  return {g, Scalar(slope * f.rate), Scalar(slope * f.acceleration + curvature * f.rate * f.rate)};
}

}  // namespace jet_detail

template <class Scalar>
TimeValue<Scalar> operator+(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  return {Scalar(f.value + g.value), Scalar(f.rate + g.rate),
          Scalar(f.acceleration + g.acceleration)};
}
template <class Scalar>
TimeValue<Scalar> operator-(const TimeValue<Scalar>& f) {
  return {Scalar(-f.value), Scalar(-f.rate), Scalar(-f.acceleration)};
}
template <class Scalar>
TimeValue<Scalar> operator-(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  return f + (-g);
}
template <class Scalar>
TimeValue<Scalar> operator*(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  return {Scalar(f.value * g.value), Scalar(f.rate * g.value + f.value * g.rate),
          Scalar(f.acceleration * g.value + 2.0 * f.rate * g.rate + f.value * g.acceleration)};
}
template <class Scalar>
TimeValue<Scalar> operator/(const TimeValue<Scalar>& f, const TimeValue<Scalar>& g) {
  const Scalar ratio = f.value / g.value, rate = (f.rate - ratio * g.rate) / g.value;
  return {ratio, rate,
          Scalar((f.acceleration - ratio * g.acceleration - 2.0 * rate * g.rate) / g.value)};
}

template <class Scalar>
TimeValue<Scalar> sqrt(const TimeValue<Scalar>& f) {
  using std::sqrt;
  const Scalar g = sqrt(f.value), slope = 0.5 / g;
  return jet_detail::composed<Scalar>(f, g, slope, Scalar(-0.5 * slope / f.value));
}
template <class Scalar>
TimeValue<Scalar> exp(const TimeValue<Scalar>& f) {
  const Scalar g = jet_detail::exponential(f.value);
  return jet_detail::composed<Scalar>(f, g, g, g);
}
template <class Scalar>
TimeValue<Scalar> log(const TimeValue<Scalar>& f) {
  const Scalar slope = 1.0 / f.value;
  return jet_detail::composed<Scalar>(f, jet_detail::logarithm(f.value), slope,
                                      Scalar(-slope * slope));
}
template <class Scalar>
TimeValue<Scalar> tanh(const TimeValue<Scalar>& f) {
  using std::tanh;
  const Scalar g = tanh(f.value), slope = 1.0 - g * g;
  return jet_detail::composed<Scalar>(f, g, slope, Scalar(-2.0 * g * slope));
}
template <class Scalar>
TimeValue<Scalar> sin(const TimeValue<Scalar>& f) {
  using std::cos;
  using std::sin;
  const Scalar g = sin(f.value);
  return jet_detail::composed<Scalar>(f, g, Scalar(cos(f.value)), Scalar(-g));
}
template <class Scalar>
TimeValue<Scalar> cos(const TimeValue<Scalar>& f) {
  using std::cos;
  using std::sin;
  const Scalar g = cos(f.value);
  return jet_detail::composed<Scalar>(f, g, Scalar(-sin(f.value)), Scalar(-g));
}

/// The angle of the point (x, y):  θ̇ = (x ẏ − y ẋ)/r²,  θ̈ = (x ÿ − y ẍ)/r² − 2 θ̇ (x ẋ + y ẏ)/r²
template <class Scalar>
TimeValue<Scalar> atan2(const TimeValue<Scalar>& y, const TimeValue<Scalar>& x) {
  using std::atan2;
  const Scalar squared = x.value * x.value + y.value * y.value;
  const Scalar rate = (x.value * y.rate - y.value * x.rate) / squared;
  const Scalar growth = 2.0 * (x.value * x.rate + y.value * y.rate) / squared;
  return {Scalar(atan2(y.value, x.value)), rate,
          Scalar((x.value * y.acceleration - y.value * x.acceleration) / squared - rate * growth)};
}

/// fⁿ with an exponent that does not change with time.
template <class Scalar>
TimeValue<Scalar> raised(const TimeValue<Scalar>& f, const Scalar& n) {
  const Scalar less = n - 1.0, least = n - 2.0, factor = n * less;
  const bool is_zero = value_of(f.value) == 0.0;  // 0 times an infinite power is 0
  const auto times_power = [&](const Scalar& by, const Scalar& exponent) {
    return is_zero && value_of(by) == 0.0 ? Scalar(0)
                                          : Scalar(by * jet_detail::raised(f.value, exponent));
  };
  const Scalar slope = times_power(n, less), curvature = times_power(factor, least);
  return jet_detail::composed<Scalar>(f, jet_detail::raised(f.value, n), slope, curvature);
}

// Expressions as functions of time: values with two derivatives, in any scalar type.

/// What the functions of formulas make of functions of time. min, max and abs have kinks: where both
/// sides are equal but for their round-off, the mean of both counts.
template <class Scalar>
class FormulaFunctions {
 public:
  using Value = TimeValue<Scalar>;

  static Value constant(double value) { return {Scalar(value), Scalar(0), Scalar(0)}; }

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

 private:
  /// As the frequencies of a square section along two axes.
  static bool is_tie(double a, double b) {
    constexpr double round_off = 1e-12;
    const double apart = std::abs(a - b);
    return apart <= round_off * std::max(std::abs(a), std::abs(b)) && std::isfinite(apart);
  }

  static Value chosen(const Value& f, const Value& g, bool is_first) {
    if (is_tie(value_of(f.value), value_of(g.value))) return constant(0.5) * (f + g);
    return is_first ? f : g;
  }

  static Value magnitude(const Value& f) {
    if (value_of(f.value) == 0.0) return constant(0.0);
    return value_of(f.value) > 0.0 ? f : -f;
  }
};

/// An expression at an instant. The arguments are functions of time; `argument(i)` gives the one of
/// Expression::arguments[i]. Nothing is stored: the steps of an expression form a tree.
template <class Scalar, class Argument>
class Formula {
 public:
  Formula(const Expression& expression, const Argument& argument)
      : expression_(expression), argument_(argument) {}

  TimeValue<Scalar> value() const { return at(int_size(expression_.steps) - 1); }

 private:
  using Functions = FormulaFunctions<Scalar>;
  using Value = TimeValue<Scalar>;

  Value at(int index) const {
    const ExpressionStep& step = expression_.steps[index];
    if (step.operation == Operation::constant) return Functions::constant(step.constant);
    if (step.operation == Operation::argument) return argument_(step.first);
    if (step.operation == Operation::power) return power_of(step);
    assert(step.operation != Operation::path);  // of sections only
    const Value first = at(step.first);
    return step.second < 0 ? Functions::of_one(step.operation, first)
                           : Functions::of_two(step.operation, first, at(step.second));
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
