#pragma once

#include "core/trust/finding.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

/// How finely space and time are divided.
struct Discretization {
  double step = 0.0;  ///< [s]
  int elements = 0;   ///< of every segment of every beam; 0: `factor` times those of the file
  double factor = 1.0;
};

/// In the record of a study.
std::string name_of(const Discretization& settings);

/// The problem divided like that. A rounded number of elements is rounded up.
ProblemFile discretized(ProblemFile problem, const Discretization& settings);

/// Steps and elements that are tried: those of the file; where it names none, four times to half
/// the step, half to twice the elements.
std::vector<Discretization> accuracy_grid(const ProblemFile& problem);

/// Half the finest step of a grid, twice its most elements; more where those are the same mesh, since
/// frames divide the beams anyway.
Discretization finer_than(const ProblemFile& problem, const std::vector<Discretization>& grid);

/// 4/3 of the step, 3/4 of the elements.
Discretization slightly_coarser(Discretization settings);

/// Errors of second order between a division and a slightly coarser one tell so much of the error
/// of the finer one (Richardson): 1 / ((4/3)² − 1).
inline constexpr double richardson_share = 1.0 / (16.0 / 9.0 - 1.0);

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
