#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"
#include "core/trust/doubt.hpp"

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
  Eigen::MatrixXd gradients;   ///< responses × variables [SI]
  Eigen::VectorXd magnitudes;  ///< largest absolute value of each response's history
  /// Of each response, relative to the reference, and never below the reference's own error.
  Eigen::VectorXd errors;
  Eigen::VectorXd gradient_errors;  ///< empty without variables
  double simulation_seconds = 0.0;  ///< the fastest of a few, one thread
  double gradient_seconds = 0.0;    ///< direct differentiation of all responses, on top
  int steps = 0, newton_iterations = 0, factorizations = 0;
  std::vector<Doubt> doubts;  ///< about the values

  double seconds() const { return simulation_seconds + gradient_seconds; }
  double largest_error() const;
};

struct AccuracyStudy {
  /// Half the finest step, twice the most elements; its errors are estimates.
  AccuracyRun reference;
  std::vector<AccuracyRun> runs;
  std::optional<std::size_t> recommended;  ///< the fastest whose errors are all small enough
  bool is_interrupted = false;             ///< some runs are missing; then nothing is recommended
};

/// Sees the reference first, then each run as it is done.
using AccuracyObserver = std::function<void(const AccuracyRun&)>;

/// Work–precision study at the start design: every step with every number of elements against a
/// finer reference, values and gradients; see relative_error.hpp. The error of the reference itself
/// is estimated from another run with 4/3 of its step and 3/4 of its elements (Richardson, order 2:
/// difference / ((4/3)² − 1)). What is sampled in space converges unevenly: a run may be closer to
/// the reference than that by luck, and is not called better.
/// @throws InputError if the problem has no accuracy settings
/// @throws SimulationError if the reference fails; a failing run is only marked
/// @throws Stopped if a stop was asked for before the reference was done
AccuracyStudy accuracy_study(const ProblemFile& problem, const AccuracyObserver& observer = {});

}  // namespace pleuel
