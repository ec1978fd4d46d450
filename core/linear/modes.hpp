#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/linear/linearization.hpp"

/// Small vibrations of a whole mechanism about an instant of its motion.
namespace pleuel {

/// The axes in which the small motions of a mechanism are counted.
class MotionAxes {
 public:
  enum class Kind {
    standing,  ///< that stand still
    /// That turn with a rotor of elastic bodies at a constant speed, as its damping does, if coefficients
    /// are constant there: what stands still is alike in all directions across the axis. Else standing.
    rotor
  };
  MotionAxes(const Mechanism& mechanism, const State& state, Kind kind);

  Kind kind() const { return kind_; }  ///< that was found
  /// At a state close by.
  Turning at(const State& state) const;

 private:
  bool is_constant(const State& state) const;

  const Mechanism& mechanism_;
  Kind kind_;
  std::size_t rotor_ = 0;  ///< which of turning_bodies()
};

/// [ s²M + sG + K  κΦ_qᵀ ; κΦ_q  0 ], singular where s is an eigenvalue. κ makes the multipliers as
/// large as the stiffness, for the sake of round-off; they are μ/κ.
struct Pencil {
  Eigen::MatrixXcd matrix;
  double kappa = 1.0;
};
Pencil pencil_at(const Linearization& linearized, std::complex<double> s);

/// Eigenvalues s of the modes: first the motions that grow without vibrating, s real and positive,
/// the fastest first; then the vibrations, those with positive imaginary part ω, the natural
/// angular frequency [rad/s], ascending in it. Their real part vanishes in equilibrium; about a
/// motion, where K is not symmetric, they may grow or decay. On the free motions y = Z z (Φ_q Z =
/// 0, Zᵀ M Z = 1) with F = (σ² + σ G + K)⁻¹ the eigenvalues θ = 1/(s − σ) are those of
///     [ −F (G + σ)  −σF ; −F (G + σ) + 1/σ  −σF ]
/// The inverse, taken from the pencil, keeps low frequencies exact beside high ones: in K itself
/// they are below round-off. Where damping counts, motions that decay without vibrating are among them,
/// ordered by their rate. σ is 1e-4 of the largest frequency without damping. Without gyroscopic forces, where K
/// is symmetric, the eigenvalues 1/(σ² + ω²) of F itself are enough. Free motions without stiffness
/// (|s| < 1e-4 σ) are not among the modes.
/// @throws SimulationError if a free motion has no inertia, or if it has neither that nor stiffness
Eigen::VectorXcd modes_of(const Linearization& linearized);

/// The natural angular frequency of a mode [rad/s]; of a motion that grows as exp(γt) it is −γ.
double frequency_of(std::complex<double> s);

/// Whether a mode vibrates.
bool vibrates(std::complex<double> s);

/// The mode with damping that grows fastest, if one grows by more than round-off.
std::optional<std::complex<double>> growing_mode(const Mechanism& mechanism, const State& state);

/// Natural angular frequencies [rad/s], ascending; growing modes first and negative: drives and joints
/// hold, loads and gravity count. Exact for a mechanism at rest in equilibrium; about a motion, an
/// approximation for frequencies that are high against its rates, since coefficients are frozen.
Eigen::VectorXd frequencies_of(const Linearization& linearized);

}  // namespace pleuel
