#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"
#include "core/trust/finding.hpp"
#include "studies/accuracy_grid.hpp"

namespace pleuel {

/// A design, simulated and differentiated with one setting.
struct AccuracyRun {
  Discretization settings;
  std::string failure;  ///< empty: it succeeded; else nothing below is known
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;   ///< responses × variables [SI]
  Eigen::VectorXd magnitudes;  ///< largest absolute value of each response's history
  /// Of each response, relative to the reference, and never below the reference's own error.
  Eigen::VectorXd errors;
  Eigen::VectorXd gradient_errors;  ///< empty without variables
  /// What the setting makes of the optimum against the reference, by the envelope theorem [unit of
  /// the objective]; where the design is one.
  std::optional<double> optimum_change;
  double simulation_seconds = 0.0;  ///< the fastest of a few, one thread
  double gradient_seconds = 0.0;    ///< direct differentiation of all responses, on top
  int steps = 0, unknowns = 0, newton_iterations = 0, factorizations = 0;
  std::vector<Finding> findings;  ///< about the values

  bool has_failed() const { return !failure.empty(); }
  double seconds() const { return simulation_seconds + gradient_seconds; }
};

/// Whether simulations have the same steps, iterations and factorizations of as many unknowns: then their
/// times are equal, whatever a clock says.
bool is_same_work(const AccuracyRun& one, const AccuracyRun& other);

/// How its times are taken: of a single run, or as the least of several after a first one.
enum class Timing { once, least };

/// Processor time of some work [s]; what else runs on the machine does not count.
double processor_seconds(const std::function<void()>& work);

/// The least of several, up to a quarter of a second in total: caches that others filled only add
/// time.
double least_seconds(const std::function<void()>& work);

/// Runs a problem at a design. The checks of its resolution are left out.
/// @throws SimulationError, InputError where a window of time has no steps
AccuracyRun measure_run(ProblemFile problem, const Eigen::VectorXd& x, Timing timing);

/// The same; a run that fails says why.
AccuracyRun try_to_measure(const ProblemFile& problem, const Eigen::VectorXd& x, Timing timing);

/// Sets the errors of a run against a better one; see relative_error.hpp.
void compare(const AccuracyRun& reference, const Eigen::VectorXd& x, AccuracyRun& run);

}  // namespace pleuel
