#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/integration/simulate.hpp"
#include "core/mobility/rigid_path.hpp"
#include "core/model/model.hpp"
#include "core/response/full_mechanism.hpp"
#include "core/response/histories.hpp"
#include "core/response/response.hpp"

namespace pleuel {

/// One simulated design: everything that values and gradients are made from.
struct Analysis {
  Eigen::VectorXd x;  ///< design variables [SI]
  Model model;
  RigidPath rigid_path;  ///< how far rigid bodies follow the drives
  Trajectory trajectory;
  BrokenInstants breaks;  ///< of the trajectory, where something that acts jumps or has a kink
  std::vector<Response> responses;
  std::vector<Reduction> reductions;  ///< one a response
  Histories histories;
  /// With all modes, where natural frequencies are asked for and the model leaves some out; else
  /// null.
  std::unique_ptr<FullMechanism> full;
  /// Why natural frequencies are those of the model, though it leaves modes out; else empty.
  std::string modes_left_out;
  /// The state about which the mechanism vibrates, where its frequencies are asked for.
  std::optional<VibrationState> vibrating;
  /// Natural frequencies of the whole mechanism, where a response asks for one
  /// (core/linear/modes.hpp).
  Eigen::VectorXd mechanism_frequencies;
  /// Which of them a response asks for, or of the damped modes, one a response; of those that ask for none,
  /// 0.
  std::vector<int> mechanism_modes;
  /// Eigenvalues of its modes with damping, where a response asks for one [1/s].
  Eigen::VectorXcd damped_modes;
  /// The same without elasticity, where a response is measured against it; else null.
  std::unique_ptr<Analysis> rigid;
};

/// The model whose natural frequencies those of the mechanism are.
const Model& model_of_modes(const Analysis& analysis);

/// One a response [SI].
Eigen::VectorXd values_of(const Analysis& analysis);

/// Histories of responses are held as a whole, whatever the memory for states is: to be asked before
/// anything goes through the instants.
/// @throws InputError if the machine cannot hold them
void require_memory(const ProblemFile& problem);

/// What a response is whose window of time holds less than two steps.
enum class ShortWindow {
  refused,
  unknown  ///< not a number: of runs in larger steps than those of the file, which judge it
};

struct AnalysisOptions {
  /// A motion of another division, beside which one is looked for (SimulationOptions); or null.
  const Trajectory* similar = nullptr;
  ShortWindow short_window = ShortWindow::refused;
  /// Of the model and its responses, by the design variables. Values do not depend on it, but their
  /// time does: of 200 variables derivatives are two thirds of a short simulation.
  bool has_derivatives = true;
};

/// Builds and simulates the mechanism of a problem at a design, and reduces its responses.
/// @param problem  with what its tolerance of effects leaves out (effect_measurement.hpp)
/// @param x        design variables [SI]
/// @throws SimulationError
/// @throws InputError for a window with less than two steps, where it is refused
/// @throws std::logic_error for a problem with load cases, which are simulated one by one
std::unique_ptr<Analysis> analyze(const ProblemFile& problem, const Eigen::VectorXd& x,
                                  const AnalysisOptions& options = {});

/// Only values are asked for.
inline constexpr AnalysisOptions values_only{.has_derivatives = false};

/// An analysis with the derivatives that it was made without; one that has them stays as it is. Where its
/// states are simulated again when they are asked for, it is made anew.
/// @param problem  that it was made of
std::unique_ptr<Analysis> with_derivatives(const ProblemFile& problem,
                                           std::unique_ptr<Analysis> analysis);

/// The problem with the steps of a trajectory in place of those that the control of the local error
/// or the windows of responses would ask for: so that values at neighbouring designs differ smoothly.
/// Where neither changes the steps, the problem as it is.
ProblemFile with_steps_of(const Trajectory& trajectory, ProblemFile problem);

/// The start values of the design variables.
Eigen::VectorXd start_design(const ProblemFile& problem);

}  // namespace pleuel
