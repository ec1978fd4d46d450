#pragma once

#include <memory>
#include <optional>

#include "core/base/dense_solvers.hpp"
#include "core/integration/stacked_states.hpp"
#include "core/integration/trajectory.hpp"
#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// The derivative M of the end of a period with respect to its beginning (the monodromy matrix),
/// and with it (1 − M)⁻¹, which tells how the beginning of a motion that repeats itself depends on
/// anything (Nayfeh & Balachandran 1995, ch. 5).
///
/// States are columns without units (stacked_states.hpp). What a step makes of the old state is
/// history · y (scheme.hpp), and the history has no more than three independent rows. With V, an
/// orthonormal basis of them,
///     M = M V Vᵀ,   (1 − M)⁻¹ = 1 + M V (1 − Vᵀ M V)⁻¹ Vᵀ
/// so that M V, at most 3n columns of direct differentiation, tells all. The constraints of the old
/// state, which the stabilized index 2 keeps in its shift, are left out of M: so small a part that
/// whoever solves with the map can make up for it by repeating, as for a map of another motion
/// close by.
class PeriodMap {
 public:
  /// @param trajectory  begins with a period
  /// @param steps       of the period
  PeriodMap(Mechanism& mechanism, const Trajectory& trajectory, int steps);

  /// What its columns are.
  const StackedStates& states() const { return states_; }

  /// (1 − M)⁻¹ columns.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& columns) const;
  /// (1 − M)⁻ᵀ columns, of derivatives with respect to states.
  Eigen::MatrixXd solve_transposed(const Eigen::MatrixXd& columns) const;

  /// By what a disturbance grows in a period, in the long run: the spectral radius of M. Below 1 the
  /// motion is stable.
  double growth() const;
  /// Estimate of 1/condition of 1 − Vᵀ M V, however its rows and columns are scaled: zero where
  /// something moves freely.
  double reciprocal_condition() const { return rest_->reciprocal_condition(); }
  /// The coordinate that moves most in the motion that the period brings back most closely.
  Eigen::Index freest_coordinate() const;

 private:
  Eigen::MatrixXd project(Eigen::MatrixXd columns) const;           ///< Vᵀ
  Eigen::MatrixXd unproject(const Eigen::MatrixXd& reduced) const;  ///< V
  /// (1 − Vᵀ M V)⁻¹ b
  Eigen::MatrixXd solve_rest(const Eigen::MatrixXd& b) const;
  /// V without the rotations of the first step.
  Eigen::MatrixXd combine(const Eigen::MatrixXd& reduced) const;
  /// M V.
  Eigen::MatrixXd differentiate(Mechanism& mechanism, const Trajectory& trajectory, int steps);

  int n_;
  std::vector<int> rotations_;
  StackedStates states_;
  Eigen::VectorXd increment_;  ///< of q in the first step
  Eigen::MatrixXd basis_;      ///< of the rows of the history, 4 × r
  Eigen::MatrixXd map_;        ///< M V, 4n × r n
  Eigen::MatrixXd reduced_;    ///< Vᵀ M V
  Eigen::VectorXd row_scale_, column_scale_;
  std::optional<DenseLu> rest_;  ///< of 1 − Vᵀ M V, with its rows and columns scaled
};

class PeriodMap;

/// How the start of a motion that repeats itself was found.
struct PeriodicStart {
  double period = 0.0;  ///< [s]
  int steps = 0;        ///< of the trajectory that make the first period
  /// For the derivatives of the start; of this motion or of one close by.
  std::shared_ptr<const PeriodMap> map;
  int simulations = 0;       ///< of a period
  int differentiations = 0;  ///< of a period, for the map
  double gap = 0.0;  ///< that is left after a period: of each coordinate relative to its scale
  /// By what a disturbance grows in a period, in the long run (PeriodMap::growth).
  double growth = 0.0;
};

}  // namespace pleuel
