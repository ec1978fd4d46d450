#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/mechanism/mechanism.hpp"

/// How a mechanism can deform without breaking its joints, in coordinates relative to
/// Mechanism::scale, and what resists that.
namespace pleuel {

/// Eigenvalues below this share of the largest are round-off.
inline constexpr double eigenvalue_round_off = 1e-13;

/// S R_q S and Φ_q S, dense; of other weights the sums that they stand for.
Eigen::MatrixXd scaled_tangent(const Mechanism& mechanism, const State& state,
                               const Weights& weights);

Eigen::MatrixXd symmetric_part(const Eigen::MatrixXd& matrix);

/// @param asymmetry  what of the matrix counts as not symmetric
bool is_symmetric(const Eigen::MatrixXd& matrix, double asymmetry);

/// The rows of constraints, normalised: of lengths, directions and angles none counts more.
void normalize_rows(const Mechanism& mechanism, Eigen::MatrixXd& phi);

/// Φ_q S, normalised.
Eigen::MatrixXd constraint_rows(const Mechanism& mechanism, const State& state);

/// Constraint rows, with others that leave some coordinates where they are.
Eigen::MatrixXd with_fixed(const Eigen::MatrixXd& phi, const std::vector<int>& fixed);

/// The columns of {x : Φ_q x = 0} without elastic deformation, where Φ_q x = 0 are these rows.
Eigen::MatrixXd rigid_motions(const Mechanism& mechanism, const Eigen::MatrixXd& phi);

/// What constraints allow, normal to some motions.
Eigen::MatrixXd deformations_beside(const Eigen::MatrixXd& phi, const Eigen::MatrixXd& motions);

/// S R_q S of springs alone: of each what resists. One that presses pushes what it presses aside, which
/// takes nothing away from what the others hold.
Eigen::MatrixXd resistance_of_springs(const Mechanism& mechanism, const State& state);

/// S R_q S of loads alone.
Eigen::MatrixXd stiffness_of_loads(const Mechanism& mechanism, const State& state);

/// The motions as rigid bodies that springs resist, and the others.
/// @param motions  orthonormal columns
std::pair<Eigen::MatrixXd, Eigen::MatrixXd> parted_by_springs(const Eigen::MatrixXd& resistance,
                                                              const Eigen::MatrixXd& motions);

/// Deformations that joints and drives allow, normal to the motions of the mechanism as rigid
/// bodies that no spring holds: columns Z in coordinates relative to Mechanism::scale, Φ_q S Z = 0.
/// @param fixed  coordinates that stay where they are
Eigen::MatrixXd free_deformations(const Mechanism& mechanism, const State& state,
                                  const std::vector<int>& fixed = {});

/// The stiffness R_q of the deformations at a state, Zᵀ S R_q S Z; loads, weight, inertia forces
/// and multipliers take part.
Eigen::MatrixXd deformation_stiffness(const Mechanism& mechanism, const State& state,
                                      const Eigen::MatrixXd& deformations);

/// A mass matrix of deformations, of which some may move none: with round-off of its largest entry on the
/// diagonal it is positive definite.
Eigen::MatrixXd regular_mass(Eigen::MatrixXd mass);

/// What the largest entry of a deformation belongs to: "the body \"rod\"".
std::string owner_of(const Mechanism& mechanism, const Eigen::VectorXd& deformation);

}  // namespace pleuel
