#pragma once

#include <vector>

#include "core/integration/simulation_options.hpp"
#include "core/integration/trajectory.hpp"
#include "core/model/body_energy.hpp"
#include "core/model/model.hpp"
#include "core/response/response.hpp"

/// A simulation that came to its end may still hold what is no answer: numbers that are not finite,
/// joints that are pulled apart. It has failed then, like one that stopped.
namespace pleuel {

/// Looks at joints and drives while the mechanism is simulated, in some instants. What a
/// formulation puts into its equations (positions of all but index 1) it keeps to what Newton's
/// method leaves, unless lengths are so different that round-off of the long ones moves the short
/// ones. Index 1 without projection promises nothing of the kind; its drift is watched by the time
/// loop in each step.
class ConstraintGuard {
 public:
  /// @param model  must outlive this
  ConstraintGuard(const Model& model, const SimulationOptions& options);

  /// @throws SimulationError naming the joint, the time and how far it is apart
  void see(int step, const State& state);

 private:
  const Model& model_;
  TermsBesidesBodies terms_;
  bool is_watching_;
  int interval_;
  double largest_drift_;  ///< [m], [rad]
  Eigen::VectorXd residual_;
};

/// @throws SimulationError naming the response and the time, where a history is not finite: of
///         several, the first in time
void require_finite(const std::vector<Response>& responses, const Histories& histories,
                    const Trajectory& trajectory);
/// @throws SimulationError naming the response whose value is not finite
void require_finite(const std::vector<Response>& responses,
                    const std::vector<Reduction>& reductions);

}  // namespace pleuel
