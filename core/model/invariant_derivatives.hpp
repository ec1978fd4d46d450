#pragma once

#include <cmath>

#include "core/beam/beam_invariants.hpp"
#include "core/model/build_context.hpp"

namespace pleuel {

/// Entry by entry.
Invariants<double> derivative_of(const Invariants<Dual>& invariants);

/// (a − b)/dx of all numbers of invariants on one pattern.
Invariants<double> difference_quotient(const Invariants<double>& a, const Invariants<double>& b,
                                       double dx);

/// The relative step of differences: as given, else that which balances truncation and round-off
/// of a smooth function, ε^(1/3) for central and ε^(1/2) for forward ones.
double relative_step(const InvariantDifferentiation& differentiation);

/// Derivative of a body's invariants with respect to a variable, in the way that is asked for:
///     dI/dx = Im I(x + iδ)/δ,  (I(x + Δ) − I(x − Δ))/2Δ,  (I(x + Δ) − I(x))/Δ
/// or by dual numbers. The complex step is taken in these, too: with a δ as small as it has (1e-40)
/// δ² is less than round-off of everything, and complex arithmetic is that of dual numbers.
/// @param invariants_at  invariants at a design of any scalar type
template <class Function>
Invariants<double> differentiate_invariants(const BuildContext& context, int variable,
                                            const Function& invariants_at) {
  const InvariantDifferentiation& how = *context.differentiation;
  if (how.derivatives == InvariantDerivatives::exact ||
      how.derivatives == InvariantDerivatives::complex_step) {
    return derivative_of(invariants_at(context.seeded(variable)));
  }
  const double x = context.design[variable];
  const double change = relative_step(how) * (x == 0.0 ? 1.0 : std::abs(x));
  const bool is_central = how.derivatives == InvariantDerivatives::central;
  Design<double> upper = context.design, lower = context.design;
  upper[variable] += change;
  if (is_central) lower[variable] -= change;
  return difference_quotient(invariants_at(upper), invariants_at(lower),
                             upper[variable] - lower[variable]);
}

}  // namespace pleuel
