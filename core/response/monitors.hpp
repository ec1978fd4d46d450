#pragma once

#include <string>
#include <vector>

#include "core/integration/simulate.hpp"
#include "core/model/model.hpp"

namespace pleuel {

/// How far a trajectory is from what the equations of motion promise. Nothing of it is needed for
/// the simulation: it is evidence for whoever reads the results.
struct Monitors {
  /// Largest |Φ(q, t)| of any constraint in any instant, as the joints state it: [m], [rad], or
  /// the cosine between directions that shall stay normal.
  double position_drift = 0.0;
  double velocity_drift = 0.0;  ///< the same of dΦ/dt [1/s]
  /// Largest |E(t) − E(0) − W(t)| over the largest of kinetic energy, elastic energy, change of
  /// weight's potential and |W| in any instant, or 1e-12 of that potential; zero if all are.
  double energy_error = 0.0;
  /// The same |E(t) − E(0) − W(t)| over the largest elastic energy: a heavy body that moves hides
  /// an error of elastic ones in the ratio above. Zero without elastic energy.
  double elastic_energy_error = 0.0;
  /// Largest rotation of a node of a beam against its body frame [rad], and that beam. Deformation
  /// is taken to be small: beyond some 0.2 rad results mean little.
  double elastic_rotation = 0.0;
  std::string most_bent;
  Eigen::VectorXd energy;  ///< E: kinetic, elastic, of weight [J]; one entry an instant
  Eigen::VectorXd work;    ///< W: of all other forces since t = 0 [J]
};

/// Constraints and energy along a trajectory, with
///     E = Σ T + ½ q_fᵀ K q_f − g · ∫ρ r + ∫ vᵀ R_stiffening dt   of the bodies
///     W = ∫ −vᵀ R_acting − Σ q̇_fᵀ D q̇_f dt   joints and drives, loads, springs, dampers; damping
/// (core/model/body_energy.hpp). What geometric stiffening stores is found as the work against it:
/// ½ q_fᵀ K q_f alone is no energy of a beam that bends far, since bending shortens it. Rotation
/// vectors have angular velocities as rates and moments as forces (Mechanism::rotations), so that
/// vᵀR is a power in space, too.
///
/// The trapezoidal rule sums the work, O(h²) as the trajectory: half the step leaves a quarter of
/// the error, which is that of both together. Cubics through four instants were measured not to do
/// better: they take off up to a third on slider-cranks, but fall behind by up to ten times where
/// the step does not resolve what vibrates.
///
/// Costs 4 to 10 µs a step, 5 to 35 % of a simulation: nothing for optimizations.
/// @param trajectory  of the mechanism of the model
Monitors monitor(const Model& model, const Trajectory& trajectory);

/// Joints that hold the same motion almost twice.
struct Misalignment {
  std::vector<std::string> joints;  ///< their names, in the order of the file
  std::vector<std::string> bodies;  ///< that the blocked motion would move
  double size = 0.0;                ///< [rad], or of the mechanism's size

  /// "the joints … are out of line by …": what, where and what to do about it.
  std::string text() const;
};

/// By nearly_redundant_constraints(); one entry for each set of joints, the smallest misalignment.
std::vector<Misalignment> find_misalignments(const Model& model, const State& state,
                                             double largest);

}  // namespace pleuel
