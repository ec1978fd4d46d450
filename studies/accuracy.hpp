#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// How finely space and time are divided.
struct Discretization {
  double step = 0.0;  ///< [s]
  int elements = 0;   ///< of every segment of every beam
};

/// Start design at one discretization.
struct AccuracyRun {
  Discretization settings;
  std::string failure;  ///< empty: it succeeded; else nothing below is known
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;        ///< responses × variables [SI]
  Eigen::VectorXd magnitudes;       ///< largest absolute value of each response's history
  Eigen::VectorXd errors;           ///< of each response, relative to the reference
  Eigen::VectorXd gradient_errors;  ///< empty without variables
  double simulation_seconds = 0.0;  ///< the fastest of a few, one thread
  double gradient_seconds = 0.0;    ///< direct differentiation of all responses, on top
  int steps = 0, newton_iterations = 0, factorizations = 0;

  double seconds() const { return simulation_seconds + gradient_seconds; }
  double largest_error() const;
};

struct AccuracyStudy {
  AccuracyRun reference;  ///< half the finest step, twice the most elements
  std::vector<AccuracyRun> runs;
  std::optional<std::size_t> recommended;  ///< the fastest whose errors are all small enough
};

/// Sees the reference first, then each run as it is done.
using AccuracyObserver = std::function<void(const AccuracyRun&)>;

/// Work–precision study at the start design: every step with every number of elements against a
/// finer reference, values and gradients; see relative_error.hpp. The error of the reference itself
/// stays in the differences: errors far below (finest step / 2)² of the coarsest are not resolved.
/// @throws InputError if the problem has no accuracy settings
/// @throws SimulationError if the reference fails; a failing run is only marked
AccuracyStudy accuracy_study(const ProblemFile& problem, const AccuracyObserver& observer = {});

}  // namespace pleuel
