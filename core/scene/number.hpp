#pragma once

#include <array>
#include <vector>

namespace pleuel {

/// A number of the scene in SI units, fixed or bound to a design variable:
///     value = constant + factor · x[variable]
struct Number {
  double constant = 0.0;
  int variable = -1;  ///< index into the design variables; −1 = fixed
  double factor = 0.0;

  Number() = default;
  Number(double fixed) : constant(fixed) {}  // NOLINT: a plain number is a Number
  static Number bound(int variable, double factor = 1.0) {
    Number number;
    number.variable = variable;
    number.factor = factor;
    return number;
  }
  bool is_bound() const { return variable >= 0; }
};

using Point = std::array<Number, 3>;  ///< [m], global axes

/// The values of the design variables, in the scalar type of the computation: double for a value,
/// a dual number with one seeded entry for a derivative.
template <class Scalar>
using Design = std::vector<Scalar>;

template <class Scalar>
Scalar resolve(const Number& number, const Design<Scalar>& design) {
  Scalar value(number.constant);
  if (number.is_bound()) value += number.factor * design[static_cast<std::size_t>(number.variable)];
  return value;
}

}  // namespace pleuel
