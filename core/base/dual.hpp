#pragma once

#include <cmath>
#include <compare>
#include <complex>

#include <Eigen/Core>

#include "core/base/small_matrices.hpp"

/// Forward-mode dual numbers: value and derivatives in `Slots` directions, exact to round-off.
namespace pleuel {

/// a + a'ε with ε² = 0. Every operation is evaluated at once: expression templates of scalars
/// within Eigen's of matrices are dear to compile and no faster.
template <int Slots>
class DualOf {
 public:
  using Derivatives = Eigen::Matrix<double, Slots, 1>;

  DualOf() = default;  ///< undefined, as a double is
  DualOf(double value) : derivatives_(Derivatives::Zero()), value_(value) {}
  DualOf(double value, const Derivatives& derivatives) : derivatives_(derivatives), value_(value) {}

  double value() const { return value_; }
  const Derivatives& derivatives() const { return derivatives_; }
  Derivatives& derivatives() { return derivatives_; }

  DualOf operator-() const { return scaled(-value_, -1.0); }
  DualOf& operator+=(const DualOf& b) { return *this = *this + b; }
  DualOf& operator-=(const DualOf& b) { return *this = *this - b; }
  DualOf& operator*=(const DualOf& b) { return *this = *this * b; }
  DualOf& operator/=(const DualOf& b) { return *this = *this / b; }

  friend DualOf operator+(const DualOf& a, const DualOf& b) {
    return combined(a.value_ + b.value_, 1.0, a, 1.0, b);
  }
  friend DualOf operator-(const DualOf& a, const DualOf& b) {
    return combined(a.value_ - b.value_, 1.0, a, -1.0, b);
  }
  friend DualOf operator*(const DualOf& a, const DualOf& b) {
    return combined(a.value_ * b.value_, b.value_, a, a.value_, b);
  }
  friend DualOf operator/(const DualOf& a, const DualOf& b) {
    const double quotient = a.value_ / b.value_, inverse = 1.0 / b.value_;
    return combined(quotient, inverse, a, -quotient * inverse, b);
  }

  friend DualOf operator+(const DualOf& a, double b) { return {a.value_ + b, a.derivatives_}; }
  friend DualOf operator+(double a, const DualOf& b) { return {a + b.value_, b.derivatives_}; }
  friend DualOf operator-(const DualOf& a, double b) { return {a.value_ - b, a.derivatives_}; }
  friend DualOf operator-(double a, const DualOf& b) { return b.scaled(a - b.value_, -1.0); }
  friend DualOf operator*(const DualOf& a, double b) { return a.scaled(a.value_ * b, b); }
  friend DualOf operator*(double a, const DualOf& b) { return b.scaled(a * b.value_, a); }
  friend DualOf operator/(const DualOf& a, double b) { return a.scaled(a.value_ / b, 1.0 / b); }
  friend DualOf operator/(double a, const DualOf& b) {
    const double quotient = a / b.value_;
    return b.scaled(quotient, -quotient / b.value_);
  }

  friend bool operator==(const DualOf& a, const DualOf& b) { return a.value_ == b.value_; }
  friend auto operator<=>(const DualOf& a, const DualOf& b) { return a.value_ <=> b.value_; }

  friend DualOf sqrt(const DualOf& a) {
    const double root = std::sqrt(a.value_);
    return a.scaled(root, 0.5 / root);
  }
  friend DualOf sin(const DualOf& a) { return a.scaled(std::sin(a.value_), std::cos(a.value_)); }
  friend DualOf cos(const DualOf& a) { return a.scaled(std::cos(a.value_), -std::sin(a.value_)); }
  friend DualOf tanh(const DualOf& a) {
    const double value = std::tanh(a.value_);
    return a.scaled(value, 1.0 - value * value);
  }
  friend DualOf exp(const DualOf& a) {
    const double value = std::exp(a.value_);
    return a.scaled(value, value);
  }
  friend DualOf atan2(const DualOf& y, const DualOf& x) {
    const double square = x.value_ * x.value_ + y.value_ * y.value_;
    return combined(std::atan2(y.value_, x.value_), x.value_ / square, y, -y.value_ / square, x);
  }
  friend DualOf abs(const DualOf& a) { return a.value_ < 0.0 ? -a : a; }

 private:
  /// f(a) from its value and its slope there.
  DualOf scaled(double value, double slope) const {
    DualOf result;
    result.value_ = value;
    for (int i = 0; i < Slots; ++i) result.derivatives_[i] = slope * derivatives_[i];
    return result;
  }

  /// f(a, b) from its value and its two slopes there.
  static DualOf combined(double value, double slope_a, const DualOf& a, double slope_b,
                         const DualOf& b) {
    DualOf result;
    result.value_ = value;
    for (int i = 0; i < Slots; ++i) {
      result.derivatives_[i] = slope_a * a.derivatives_[i] + slope_b * b.derivatives_[i];
    }
    return result;
  }

  Derivatives derivatives_;
  double value_;
};

/// One direction: the model is built once for each design variable, with that variable seeded.
using Dual = DualOf<1>;

/// As many directions as a marker has coordinates. Formulas with more of them take these in groups:
/// each width of dual numbers has the compiler make all kinematics anew.
inline constexpr int wide_slots = 12;
using WideDual = DualOf<wide_slots>;

/// Seeds a group of wide_slots directions, from the first one on.
class SeedGroup {
 public:
  explicit SeedGroup(int first) : first_(first) {}

  /// Makes the number that of a direction, if it belongs to the group.
  void operator()(WideDual& number, int direction) const {
    const int slot = direction - first_;
    if (slot >= 0 && slot < wide_slots) number.derivatives()[slot] = 1.0;
  }

 private:
  int first_;
};

/// The derivatives of a number in `directions` directions.
/// @param formula  what the number is, as a WideDual, for a SeedGroup that it seeds its variables with
template <int directions, class Formula>
Eigen::Matrix<double, directions, 1> derivatives_of(const Formula& formula) {
  Eigen::Matrix<double, directions, 1> derivatives;
  for (int first = 0; first < directions; first += wide_slots) {
    const WideDual number = formula(SeedGroup(first));
    for (int i = 0; i < wide_slots && first + i < directions; ++i) {
      derivatives[first + i] = number.derivatives()[i];
    }
  }
  return derivatives;
}

inline double value_of(double number) {
  return number;
}
inline double value_of(const std::complex<double>& number) {
  return number.real();
}
template <int Slots>
double value_of(const DualOf<Slots>& number) {
  return number.value();
}

/// d(number)/d(direction); zero for a plain number.
inline double derivative_of(double, int = 0) {
  return 0.0;
}
template <int Slots>
double derivative_of(const DualOf<Slots>& number, int direction = 0) {
  return number.derivatives()[direction];
}

/// Entry by entry derivative of a matrix of dual numbers in their one direction.
template <class Derived>
auto derivative_matrix(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.unaryExpr([](const Dual& number) { return number.derivatives()[0]; }).eval();
}

template <class Derived>
auto value_matrix(const Eigen::MatrixBase<Derived>& matrix) {
  return matrix.unaryExpr([](const auto& number) { return value_of(number); }).eval();
}

}  // namespace pleuel

/// What Eigen asks of a scalar.
namespace Eigen {

template <int Slots>
struct NumTraits<pleuel::DualOf<Slots>> : NumTraits<double> {
  using Real = pleuel::DualOf<Slots>;
  using NonInteger = pleuel::DualOf<Slots>;
  using Nested = pleuel::DualOf<Slots>;
  enum { ReadCost = 1 + Slots, AddCost = 1 + Slots, MulCost = 1 + 2 * Slots };
};

template <int Slots, class Operation>
struct ScalarBinaryOpTraits<pleuel::DualOf<Slots>, double, Operation> {
  using ReturnType = pleuel::DualOf<Slots>;
};
template <int Slots, class Operation>
struct ScalarBinaryOpTraits<double, pleuel::DualOf<Slots>, Operation> {
  using ReturnType = pleuel::DualOf<Slots>;
};

}  // namespace Eigen
