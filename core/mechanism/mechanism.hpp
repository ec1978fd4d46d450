#pragma once

/// Configurations q whose rotation vectors are composed, not added. `rotations` lists the first
/// coordinate of each (Mechanism::rotations); everything else in q is an ordinary coordinate.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "core/system/system.hpp"

namespace pleuel {

/// A body whose elastic coordinates start in a given shape. Where joints ask for another one, it is
/// that of least elastic energy beside the given one, and places that are given move last.
struct BentStart {
  int offset;  ///< of its first elastic coordinate
  Eigen::SparseMatrix<double>
      weight;  ///< W, in place of the assembly weights: its scaled stiffness
  std::vector<std::pair<int, Eigen::SparseMatrix<double>>> weight_x;  ///< by design variables
  Eigen::MatrixXd rows;  ///< of the displacements that are given, in its elastic coordinates
};

/// Equations of motion together with where they start from and how large their unknowns are.
struct Mechanism {
  std::unique_ptr<System> system;
  /// Positions and velocities to start from; made consistent with the constraints by assembly.
  State guess;
  /// First coordinates of the rotation vectors in q (three each, behind the translations of their
  /// frames): their rates are angular velocities in body axes, and their changes are right
  /// perturbations (core/base/rotation_vector.hpp).
  std::vector<int> rotations;
  /// First coordinates of point masses (three each in space, two in a plane).
  std::vector<int> points;
  /// Coordinates that are angles of frames in a plane: whole turns change nothing but their number.
  std::vector<int> angles;
  /// What each equation of the system belongs to, for messages: "the body \"rod\"", "the joint …";
  /// may be empty.
  std::vector<std::string> equation_names;
  /// Those of the system's terms that are springs, dampers and motors.
  std::vector<Term*> springs;
  /// Those that are loads besides: forces and torques that the file gives.
  std::vector<Term*> loads;
  /// Accelerations at which weight is no load, as all bodies fall; zero without gravity.
  Eigen::VectorXd free_fall;
  /// Whether forces are laws of the motion, as friction, stops and tables over a coordinate are: they
  /// may change within a step in a way that the steps before tell nothing of.
  bool has_laws_of_motion = false;
  /// Elastic coordinates.
  std::vector<int> elastic;
  /// Whether the elastic coordinates start in equilibrium instead of at the guess.
  bool starts_in_equilibrium = false;
  /// Derivatives of guess.q and guess.v with respect to the design variables, n × variables.
  Eigen::MatrixXd guess_q_x, guess_v_x;
  /// Typical magnitude of each coordinate: lengths [m] or 1 [rad].
  Eigen::VectorXd scale;
  /// Weights of the distance to the guess in the assembly; elastic coordinates weigh most, so that
  /// assembly moves frames rather than deforms bodies.
  Eigen::VectorXd assembly_weight;
  std::vector<BentStart> bent_starts;
  /// What the square of each multiplier weighs in the norm of the reactions (redundancy.hpp): 1 for
  /// forces, one over the square of a length [1/m²] for moments.
  Eigen::VectorXd reaction_weight;
};

using Rotations = std::vector<int>;

/// q = start ⊕ increment. q is not start.
void advance(const Rotations& rotations, const Eigen::VectorXd& start,
             const Eigen::VectorXd& increment, Eigen::VectorXd& q);

/// The increment that leads from start to q.
Eigen::VectorXd difference(const Rotations& rotations, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& start);

/// The step increments Δ change q by right perturbations T(Δ) δΔ: adds q_weight · R_q (T − I) to a
/// step matrix.
/// @param R_q  tangent with weight one on q
void add_increment_tangent(const Rotations& rotations, const Eigen::VectorXd& increment,
                           const System::Matrix& R_q, double q_weight, System::Matrix& matrix);

// Sensitivities of q⁺ = q ⊕ Δ:  s_q⁺ = exp(−Δ̃) s_q + T(Δ) s_Δ = T(Δ) (T(Δ)⁻ᵀ s_q + s_Δ).

/// s ← T(Δ)⁻ᵀ s in the rows of each rotation.
void pull_back(const Rotations& rotations, const Eigen::VectorXd& increment, Eigen::MatrixXd& s);

/// s ← T(Δ) s in the rows of each rotation.
void push_forward(const Rotations& rotations, const Eigen::VectorXd& increment, Eigen::MatrixXd& s);

// And the transposed ones, for adjoints: s ← T(Δ)⁻¹ s, s ← T(Δ)ᵀ s.
void pull_back_transposed(const Rotations& rotations, const Eigen::VectorXd& increment, Columns s);
void push_forward_transposed(const Rotations& rotations, const Eigen::VectorXd& increment,
                             Columns s);

}  // namespace pleuel
