#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "core/mechanism/mechanism.hpp"
#include "core/scene/mode_choice.hpp"

/// Small vibrations of a whole mechanism about an instant of its motion.
namespace pleuel {

/// Matrices of the equations of motion at a state, frozen there:
///     M ÿ + G ẏ + K y + Φ_qᵀ μ = 0,   Φ_q y = 0
/// M = R_a and K = R_q with the share of λ. Of rotation vectors y is a right perturbation ψ, the
/// components of a rotation in axes that stand still and are those of the body at the instant. As
/// the body turns on, its angular velocity, which is in axes of the body, changes by ψ̇ and its
/// angular acceleration by ψ̈ − ω × ψ̇: G is the skew part of R_v − R_a W, W = diag(ω×) in
/// rotations, which makes −(J ω)× of a rigid body, its gyroscopic moments. What is symmetric, as
/// damping, is left out of natural frequencies, which are undamped, like those of a body; where
/// damping counts, G is all of R_v − R_a W.
struct FrozenMechanism {
  Eigen::MatrixXd M, G, K;  ///< n × n
  bool is_damped = false;   ///< whether damping counts
  Eigen::MatrixXd phi;      ///< Φ_q, m × n
  /// Rows of Φ_q that follow from the others: they are zero, and so are their multipliers.
  std::vector<int> left_out;
};

FrozenMechanism freeze(const Mechanism& mechanism, const State& state, bool is_damped = false);

/// W y with ω × in the rows of rotation vectors, zero in the others.
/// @param y  n × any number
Eigen::MatrixXcd turned_by_motion(const Mechanism& mechanism, const State& state,
                                  const Eigen::MatrixXcd& y);

/// [ s²M + sG + K  κΦ_qᵀ ; κΦ_q  0 ], singular where s is an eigenvalue. κ makes the multipliers as
/// large as the stiffness, for the sake of round-off; they are μ/κ.
struct Pencil {
  Eigen::MatrixXcd matrix;
  double kappa = 1.0;
};
Pencil pencil_at(const FrozenMechanism& frozen, std::complex<double> s);

/// Eigenvalues s of the modes: first the motions that grow without vibrating, s real and positive,
/// the fastest first; then the vibrations, those with positive imaginary part ω, the natural
/// angular frequency [rad/s], ascending in it. Their real part vanishes in equilibrium; about a
/// motion, where K is not symmetric, they may grow or decay. On the free motions y = Z z (Φ_q Z =
/// 0, Zᵀ M Z = 1) with F = (σ² + σ G + K)⁻¹ the eigenvalues θ = 1/(s − σ) are those of
///     [ −F (G + σ)  −σF ; −F (G + σ) + 1/σ  −σF ]
/// The inverse, taken from the pencil, keeps low frequencies exact beside high ones: in K itself
/// they are below round-off. Where damping counts, motions that decay without vibrating are among them,
/// ordered by their rate. σ is 1e-4 of the largest frequency. Without gyroscopic forces, where K
/// is symmetric, the eigenvalues 1/(σ² + ω²) of F itself are enough. Free motions without stiffness
/// (|s| < 1e-4 σ) are not among the modes.
/// @throws SimulationError if a free motion has no inertia, or if it has neither that nor stiffness
Eigen::VectorXcd modes_of(const FrozenMechanism& frozen);

/// The natural angular frequency of a mode [rad/s]; of a motion that grows as exp(γt) it is −γ.
double frequency_of(std::complex<double> s);

/// Whether a mode vibrates.
bool vibrates(std::complex<double> s);

/// What is asked for of a mode, and its derivative with respect to s along a change of it.
double number_of(ModeNumber of, std::complex<double> s);
double change_of_number(ModeNumber of, std::complex<double> s, std::complex<double> change);

/// The mode with damping that grows fastest, if one grows by more than round-off.
std::optional<std::complex<double>> growing_mode(const Mechanism& mechanism, const State& state);

/// Natural angular frequencies of a mechanism about a state [rad/s], ascending, unstable modes
/// first and negative: drives and joints hold, loads and gravity count. Exact for a mechanism at
/// rest in equilibrium; about a motion, an approximation for frequencies that are high against its
/// rates, since coefficients are frozen.
Eigen::VectorXd mechanism_frequencies(const Mechanism& mechanism, const State& state);

}  // namespace pleuel
