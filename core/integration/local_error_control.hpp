#pragma once

#include "core/integration/scheme.hpp"
#include "core/integration/simulation_options.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// Divides regular steps into parts of 2^-level of them, each beginning at a multiple of its size,
/// where the level follows the local error.
class LocalErrorControl {
 public:
  LocalErrorControl(const Mechanism& mechanism, const SimulationOptions& options);

  /// The smallest parts of a regular step.
  int parts() const { return 1 << finest_level_; }
  /// The end of the part that begins here, counted in smallest parts. The level rises until a part
  /// may begin here.
  int end_of_part(int begin);

  /// Local errors of a regular step in such parts, c h³ q⃛ each with q⃛ ≈ (a⁺ − a)/h, relative to
  /// what is allowed.
  double relative_error(const State& old, const State& found, const Scheme& scheme) const;
  /// The coordinate with the largest error.
  Eigen::Index worst_coordinate(const State& old, const State& found, const Scheme& scheme) const;

  /// Takes smaller parts. @returns false where there are none
  [[nodiscard]] bool refine();
  /// After a part with this relative error: larger parts, if it is that small.
  void accept(double relative_error);

  int level() const { return level_; }
  void set_level(int level) { level_ = level; }

 private:
  const Eigen::VectorXd& scale_;
  double allowed_;
  int finest_level_, level_ = 0;
};

}  // namespace pleuel
