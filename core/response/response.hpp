#pragma once

#include <memory>
#include <optional>
#include <string>

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

/// @throws InputError `the response "…" cannot be computed: …`
[[noreturn]] void refuse_response(const std::string& name, const std::string& why);

}  // namespace pleuel
