#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// How a body turns: its axes, and its angular velocity and acceleration in them [rad/s, rad/s²]. In
/// a plane all are counted in the directions of the plane, whose normal is the third.
struct BodyTurn {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d omega = Eigen::Vector3d::Zero(), alpha = Eigen::Vector3d::Zero();
};

/// A body that is no point mass.
struct TurningBody {
  int first;     ///< coordinate of its frame
  int rotation;  ///< the first that turns the frame
  int elastic;   ///< behind those of its frame
  BodyTurn turn;
};

std::vector<TurningBody> turning_bodies(const Mechanism& mechanism, const State& state);

/// How many coordinates each of Mechanism::points has: three in space, two in a plane.
int translations_of_points(const Mechanism& mechanism);

/// Of the body that turns fastest.
BodyTurn fastest_turn(const Mechanism& mechanism, const State& state);

/// Small motions y of a mechanism, as counted in axes A that turn with its bodies: how changes of
/// coordinates, rates and accelerations follow from them,
///     δq = T y,   δv = T ẏ + V y,   δa = T ÿ + P ẏ + Q y
/// With ω and α of a body in its axes δr = A y_r, δω = ẏ_θ + ω × y_θ,
///     δr̈ = A (ÿ_r + 2 ω × ẏ_r + (ω̃ω̃ + α̃) y_r),   δα = ÿ_θ + ω × ẏ_θ + α × y_θ;
/// elastic coordinates turn with their body anyway, and so does the angle of a frame in a plane. A
/// point mass takes the axes of the body that turns fastest. Where the whole mechanism turns alike
/// the coefficients of y are constant.
struct Turning {
  Eigen::SparseMatrix<double> T, V, P, Q;  ///< n × n
};

/// Axes that stand still and are those of the bodies at the state: of rotation vectors y is a right
/// perturbation ψ, and as the body turns on δω = ψ̇ and δα = ψ̈ − ω × ψ̇, so that P = −ω̃ in rotations.
Turning standing_axes(const Mechanism& mechanism, const State& state);

Turning turning_of(const Mechanism& mechanism, const State& state);

/// The same with all bodies in axes that turn with one of them: what stands still beside
/// a rotor, as the block of a bearing, has constant coefficients there, if it is alike in all
/// directions across the axis.
Turning rotor_turning(const Mechanism& mechanism, const State& state, const BodyTurn& rotor);
/// With that which turns fastest.
Turning rotor_turning(const Mechanism& mechanism, const State& state);

/// Small motions y of a mechanism about a state, with coefficients as they are there:
///     M ÿ + G ẏ + K y + Φᵀ μ = 0,   Φ y = 0
/// counted in axes δq = T y, δv = T ẏ + V y, δa = T ÿ + P ẏ + Q y, in which, with the
/// share of λ in R_q,
///     M = Tᵀ R_a T,  G = Tᵀ (R_a P + R_v T),  K = Tᵀ (R_a Q + R_v V + R_q T),  Φ = Φ_q T
/// All tangents are those of the terms: of forces that follow, damping, stress, gyroscopic forces.
struct Linearization {
  Eigen::MatrixXd M, G, K;  ///< n × n
  Eigen::MatrixXd phi;      ///< m × n
  bool is_damped = false;   ///< whether G has what is symmetric in it, as damping
  /// Rows of Φ that follow from the others: they are zero, and so are their multipliers.
  std::vector<int> left_out;
};

/// @param axes       in which y is counted
/// @param is_damped  else G is its skew part, as of natural frequencies, which are undamped
Linearization linearize(const Mechanism& mechanism, const State& state, const Turning& axes,
                        bool is_damped);

/// In axes that stand still (standing_axes()).
Linearization linearize(const Mechanism& mechanism, const State& state, bool is_damped = false);

}  // namespace pleuel
