#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/integration/simulate.hpp"
#include "core/model/model.hpp"
#include "core/response/reduction.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// A number that the user asks for: a signal reduced over time, or a constant of the design.
struct Response {
  std::string name;
  std::string unit;  ///< SI
  OverTime over_time = OverTime::max;
  std::unique_ptr<Signal> signal;  ///< null: a constant
  double constant = 0.0;
  Eigen::VectorXd constant_x;  ///< its derivatives, one a design variable
  /// Of a frequency of the whole mechanism: its mode, from 0. A constant, too, but one of the
  /// initial state: analyze() sets it, and its derivatives take those of that state.
  std::optional<int> mechanism_mode;
  /// Of a deflection against the rigid mechanism: which response of Analysis::rigid is taken off.
  std::optional<std::size_t> rigid_response;
  bool is_balance = false;         ///< of energy: reduced by reduce_balance() instead
  std::optional<double> from, to;  ///< window of time that is reduced [s]

  /// The steps of a simulation that are reduced.
  /// @throws InputError if the window holds less than two
  StepRange steps(const Eigen::VectorXd& time) const;
};

/// Builds the responses of a model, which must outlive them.
std::vector<Response> make_responses(const std::vector<ResponseSettings>& settings,
                                     const Model& model);

/// The history of a signal, channels × (steps + 1).
Eigen::MatrixXd observe(Signal& signal, const Trajectory& trajectory);

/// One simulated design: everything that values and gradients are made from.
struct Analysis {
  Model model;
  Trajectory trajectory;
  std::vector<Response> responses;
  std::vector<Reduction> reductions;       ///< one a response
  std::vector<Eigen::MatrixXd> histories;  ///< one a response; empty for constants
  /// The same without elasticity, where a response is measured against it; else null.
  std::unique_ptr<Analysis> rigid;
};

/// One a response [SI].
Eigen::VectorXd values_of(const Analysis& analysis);

/// Builds and simulates the mechanism of a problem at a design, and reduces its responses.
/// @param x  design variables [SI]
/// @throws SimulationError
std::unique_ptr<Analysis> analyze(const ProblemFile& problem, const Eigen::VectorXd& x);

/// The problem with the steps of a trajectory in place of those that the control of the local error
/// would find: so that values at neighbouring designs differ smoothly. Without control, as it is.
ProblemFile with_steps_of(const Trajectory& trajectory, ProblemFile problem);

/// The start values of the design variables.
Eigen::VectorXd start_design(const ProblemFile& problem);

}  // namespace pleuel
