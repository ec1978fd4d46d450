#include "core/model/invariant_derivatives.hpp"

#include <limits>

namespace pleuel {

Invariants<double> difference_quotient(const Invariants<double>& a, const Invariants<double>& b,
                                       double dx) {
  Invariants<double> result = a;
  result.mass = (a.mass - b.mass) / dx;
  const auto set = [&](auto member) {
    result.*member -= b.*member;
    result.*member /= dx;
  };
  set(&Invariants<double>::first_moment);
  set(&Invariants<double>::second_moment);
  set(&Invariants<double>::shape);
  set(&Invariants<double>::mixed);
  set(&Invariants<double>::moments);
  set(&Invariants<double>::mass_matrix);
  set(&Invariants<double>::stiffness);
  set(&Invariants<double>::damping);
  return result;
}

double relative_step(const InvariantDifferentiation& differentiation) {
  if (differentiation.step > 0.0) return differentiation.step;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  return differentiation.derivatives == InvariantDerivatives::central ? std::cbrt(epsilon)
                                                                      : std::sqrt(epsilon);
}

Invariants<double> derivative_of(const Invariants<Dual>& invariants) {
  return transform_invariants<double>(invariants,
                                      [](const Dual& number) { return derivative_of(number); });
}

}  // namespace pleuel
