#pragma once

#include "core/beam/invariant_vector.hpp"
#include "core/effects/body_equations.hpp"

namespace pleuel {

/// What a virtual displacement μ of a body multiplies its inertia, elastic and damping forces with.
struct BodyMultipliers {
  Eigen::Vector3d force;                      ///< of f, body axes
  Eigen::Vector3d moment;                     ///< of T, body axes
  Eigen::Ref<const Eigen::VectorXd> elastic;  ///< of F (n)
};

/// sums += ∂(μᵀR)/∂I: the residual of a body (floating_frame_residual.hpp) is linear in its
/// invariants, μᵀR = Σ sums · I. The same chain of formulas, backwards.
/// @param layout    of the body's invariants; `sums` has so many entries
/// @param motion    of the body
void add_invariant_sums(const Invariants<double>& body, const InvariantLayout& layout,
                        const BodyMotion& motion, const BodyMultipliers& mu, double* sums);

}  // namespace pleuel
