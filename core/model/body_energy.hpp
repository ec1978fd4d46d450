#pragma once

#include <vector>

#include "core/model/model.hpp"

namespace pleuel {

/// What a body holds and loses in one instant.
struct BodyEnergy {
  double kinetic = 0.0;  ///< T [J]
  double elastic = 0.0;  ///< ½ q_fᵀ K q_f [J], without geometric stiffening
  double weight = 0.0;   ///< −g · ∫ρ r [J], zero where the centre of mass is at the origin
  double dissipation = 0.0;  ///< q̇_fᵀ D q̇_f [W]

  double total() const { return kinetic + elastic + weight; }
};

/// Weights of a sum of what a body holds and loses.
struct EnergyWeights {
  double kinetic = 0.0, elastic = 0.0, weight = 0.0, dissipation = 0.0;

  double sum(const BodyEnergy& energy) const {
    return kinetic * energy.kinetic + elastic * energy.elastic + weight * energy.weight +
           dissipation * energy.dissipation;
  }
};

/// From the invariants (core/beam/invariants.hpp), in a formula that shares nothing with the
/// residual of the body: with ṙ in body axes and p = p₀ + S q_f,
///     T = ½ m ṙ² + ṙ · (ω × c + S̄ q̇_f) + ½ ω · I ω + ω · ∫ρ p × ṗ + ½ q̇_fᵀ S_ff q̇_f
/// (Shabana, Dynamics of Multibody Systems, ch. 5), c = c₀ + S̄ q_f and I = tr(M) 1 − M from the
/// second moment M = ∫ρ p pᵀ.
/// All of it is linear in the invariants: with their derivatives in place of them it returns its
/// own explicit design derivative.
/// @param invariants  of the body, or their derivatives
/// @param gravity     [m/s²], global axes
BodyEnergy body_energy(const BodyModel& body, const Invariants<double>& invariants,
                       const Eigen::Vector3d& gravity, const State& state);

/// q, v += ∂(weighted sum of the energies of a body)/∂(q, v).
void add_energy_gradient(const BodyModel& body, const Eigen::Vector3d& gravity, const State& state,
                         const EnergyWeights& weights, Eigen::VectorXd& q, Eigen::VectorXd& v);

/// The sum over all bodies.
BodyEnergy energy_of_bodies(const Model& model, const State& state);

/// The terms whose forces body_energy() does not count. They contain no inertia, so that −vᵀ R is
/// their power.
struct TermsBesidesBodies {
  std::vector<Term*> stiffening;  ///< geometric stiffening: stores elastic energy, too
  std::vector<Term*> acting;      ///< joints with their drives, loads, springs and dampers
};

TermsBesidesBodies terms_besides_bodies(const Model& model);

}  // namespace pleuel
