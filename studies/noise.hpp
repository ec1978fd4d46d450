#pragma once

#include <cstdint>
#include <numbers>
#include <random>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

/// How much of a computed value is noise: what round-off and unfinished iterations add to it.
namespace pleuel {

/// Standard deviation of the noise of a function from its values at equidistant points on a line
/// (Moré & Wild 2011, "Estimating computational noise", ECnoise). Differences of order k of the
/// smooth part vanish with the spacing, those of independent noise ε grow:
///     Δᵏε has the variance σ² (2k)!/(k!)²   ⇒   σ_k² = (k!)²/(2k)! · mean of (Δᵏf)²
/// The first σ_k that agrees with the next two up to a factor of 4, where Δᵏf changes its sign, is
/// the noise. If there is none, the smallest σ_k: what the smooth part leaves is counted as noise.
/// @param values  at least 6, in the order of the points
double noise_of(const Eigen::VectorXd& values);

/// A direction from a design: entries of generic size and sign relative to the variables, the same in
/// every run.
Eigen::VectorXd generic_direction(const ProblemFile& problem, const Eigen::VectorXd& x);

/// Noise of all responses at a design [SI].
struct ResponseNoise {
  /// Standard deviation, the largest along three lines of 8 designs: of relative spacing 1e-11,
  /// where only round-off differs, and 1e-6 and 1e-4, where iterations may end differently.
  Eigen::VectorXd scatter;
  /// What Newton's method leaves: the change of the value with a thousandth of its tolerance. It is
  /// smooth while all iterations end alike, and jumps where one does not.
  Eigen::VectorXd remainder;

  /// What an optimizer has to expect: the larger one.
  Eigen::VectorXd floor() const { return scatter.cwiseMax(remainder); }
};

/// Costs 26 simulations. A line or change of which a simulation fails is left out.
/// @throws SimulationError if none of the lines is left
/// @param threads  simulations at a time
ResponseNoise response_noise(const ProblemFile& problem, const Eigen::VectorXd& x, int threads = 1);

/// Random numbers that are the same with every standard library, to rounding of log and cos: the
/// engine is prescribed by the standard, its distributions are not.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1): the upper 53 bits.
  double uniform() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }

  /// Mean 0, deviation 1 (Box & Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace pleuel
