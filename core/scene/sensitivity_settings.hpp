#pragma once

#include <string>

#include "core/scene/kind_table.hpp"

namespace pleuel {

enum class GradientMethod {
  automatic,  ///< direct or adjoint, whichever is cheaper (sensitivity/method_choice.hpp)
  direct,
  adjoint,
  forward_difference,
  central_difference
};

inline constexpr Choice<GradientMethod> gradient_methods[] = {
    {"auto", GradientMethod::automatic},
    {"direct", GradientMethod::direct},
    {"adjoint", GradientMethod::adjoint},
    {"forward-difference", GradientMethod::forward_difference},
    {"central-difference", GradientMethod::central_difference}};

std::string to_string(GradientMethod method);

/// @throws InputError for an unknown name; the message lists the names there are.
GradientMethod gradient_method(const std::string& name);

/// How the derivatives of a body's invariants with respect to the design come about.
enum class InvariantDerivatives {
  exact,         ///< dual numbers
  complex_step,  ///< the same arithmetic as that of dual numbers
  central,       ///< differences of the invariants of two changed designs
  forward        ///< of one changed design and this one
};
inline constexpr Choice<InvariantDerivatives> invariant_derivatives[] = {
    {"exact", InvariantDerivatives::exact},
    {"complex-step", InvariantDerivatives::complex_step},
    {"central", InvariantDerivatives::central},
    {"forward", InvariantDerivatives::forward}};

struct InvariantDifferentiation {
  InvariantDerivatives derivatives = InvariantDerivatives::exact;
  /// Of differences, relative: Δx = step · |x|. 0: as large as balances truncation and round-off.
  double step = 0.0;
};

struct SensitivitySettings {
  GradientMethod method = GradientMethod::automatic;
  /// Of gradients by differences of simulations, relative: Δx = step · |x|.
  double difference_step = 1e-5;
  InvariantDifferentiation invariants;
  /// What the states of a trajectory may take [byte]; where they do not fit, stretches of it are
  /// simulated again when they are needed.
  double memory = 4e9;
};

}  // namespace pleuel
