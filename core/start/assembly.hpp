#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/base/sparse_rows.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// Initial values together with what their derivatives need.
struct InitialState {
  State state;
  /// μ of  W (q − q̂) + Φ_qᵀ μ = 0  and of  W (v − v̂) + Φ_qᵀ μ = 0; zero if the guess is consistent.
  Eigen::VectorXd position_multipliers, velocity_multipliers;
  /// Whether elastic coordinates are in equilibrium (equilibrium.hpp).
  bool is_equilibrium = false;
};

/// W d, one change of the coordinates a column.
Eigen::MatrixXd assembly_forces(const Mechanism& mechanism, const Eigen::MatrixXd& changes);

/// [ W  Φ_qᵀ ; Φ_q  0 ] at a state, with the assembly weights alone as W: the matrix of projections.
void projection_matrix(const Mechanism& mechanism, const State& state, System::Matrix& matrix);

/// The same with the whole W: the matrix of assembly, up to curvature.
void assembly_matrix(const Mechanism& mechanism, const State& state, System::Matrix& matrix);

/// Φ_q with respect to coordinates over a scale, m × n: also of constraints that are left out, but
/// nothing of coordinates whose scale is zero.
SparseRows scaled_constraints(const Mechanism& mechanism, const State& state,
                              const Eigen::VectorXd& scale);

/// Closes some of the constraints by the least motion in coordinates over a scale; those whose scale is
/// zero stay. @returns whether that succeeds
/// @param rows       of the constraints
/// @param tolerance  of each [rad, m]
bool close_constraints(const Mechanism& mechanism, const Eigen::VectorXd& scale,
                       const std::vector<int>& rows, double tolerance, State& state);

/// Factorizes a matrix of the start. @throws SimulationError if it is singular
/// @param what  is solved for, for the message: "positions"
void factorize_for_start(LinearSolver& solver, const System::Matrix& matrix, const char* what);

/// The positions closest to the guess of the mechanism with Φ = 0, and the velocities closest to it with
/// Φ̇ = 0; without accelerations and multipliers.
/// @param matrix  of the system's pattern, with its solver
/// @throws SimulationError if the mechanism cannot be assembled or is singular
InitialState assemble(Mechanism& mechanism, LinearSolver& solver, System::Matrix& matrix);

}  // namespace pleuel
