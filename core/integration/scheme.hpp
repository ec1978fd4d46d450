#pragma once

#include <Eigen/Core>

#include "core/base/time_integration.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// A one-step scheme for second-order systems as data: with y = (q, v, a, w) — w an algorithmic
/// acceleration — and the unknown z of the new step (the correction of q),
///     y⁺ = history · y + correction z
/// Newton, direct differentiation and the adjoint are written once for all such schemes.
struct Scheme {
  double step = 0.0;           ///< h [s]
  Eigen::Matrix4d history;     ///< rows: new q, v, a, w; columns: old q, v, a, w
  Eigen::Vector4d correction;  ///< (1, γ', β', …): weights of the tangent, too
  /// c h³ of the local error  q⁺ − q(t⁺) = c h³ q⃛ + O(h⁴) [s³]; 0 where it is of another order.
  double local_error = 0.0;
  /// w = a(t + delay) + O(h²) [s]: (α_m − α_f) h of generalized-α.
  double delay = 0.0;

  /// Scale of the dynamic rows and of λ that keeps the step matrix well conditioned as h → 0.
  double dynamic_scale() const { return 1.0 / correction(2); }
};

/// Generalized-α (Chung & Hulbert 1993; for constrained systems Arnold & Brüls 2007), second order,
///     (1−α_m) w⁺ + α_m w = (1−α_f) a⁺ + α_f a,
///     q⁺ = q + h v + h²(½−β) w + h²β w⁺,   v⁺ = v + h(1−γ) w + hγ w⁺
/// @param spectral_radius  ρ∞ in [0, 1]: 1 keeps high frequencies, 0 removes them in one step
Scheme generalized_alpha(double step, double spectral_radius);

/// Newmark's scheme (Newmark 1959), of second order only for ρ∞ = 1 (average acceleration):
///     γ = ½ + α,  β = ¼ (1 + α)²,  α = (1 − ρ∞)/(1 + ρ∞);  w = a
Scheme newmark(double step, double spectral_radius);

/// q⁺ = q + h v⁺, v⁺ = v + h a⁺: first order, damps all that vibrates.
Scheme implicit_euler(double step);

Scheme make_scheme(SchemeType type, double step, double spectral_radius);

/// The step after a change of the step size: w belongs to an instant that depends on the step, so
/// it is not used. Interpolated linearly, with δ = α_m − α_f,
///     w = a + δ (a⁺ − a),   w⁺ = a⁺ + δ (a⁺ − a)
/// which makes this step of generalized-α Newmark's with γ = ½, β = ¼ (1 + δ²): stable however
/// often the size changes.
Scheme make_restarting_scheme(SchemeType type, double step, double spectral_radius);

/// All that the next step of a scheme depends on.
struct SchemeState : State {
  Eigen::VectorXd w;  ///< algorithmic acceleration of the scheme (n)
};

}  // namespace pleuel
