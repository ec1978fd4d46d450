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
  int elements = 0;   ///< of every segment of every beam; 0: `factor` times those of the file
  double factor = 1.0;
};

/// The problem divided like that. A rounded number of elements is rounded up.
ProblemFile discretized(ProblemFile problem, const Discretization& settings);

/// A design at one discretization.
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
};

/// Of some runs the fastest simulation whose errors of the responses that count are small enough.
struct Recommendation {
  double target = 0.0;                   ///< relative error
  std::optional<std::size_t> values;     ///< index of a run
  std::optional<std::size_t> gradients;  ///< the same if errors of gradients count as well
};

struct AccuracyStudy {
  /// Half the finest step, twice the most elements; its errors are estimates.
  AccuracyRun reference;
  std::vector<AccuracyRun> runs;
  std::vector<std::size_t> counted;  ///< responses that are minimized or limited; else all
  /// For the target of the file, and for smaller ones by tens.
  std::vector<Recommendation> recommendations;
  bool is_interrupted = false;  ///< some runs are missing; then nothing is recommended
};

/// Sees the reference first, then each run as it is done.
using AccuracyObserver = std::function<void(const AccuracyRun&)>;

/// Steps and elements that are tried where the file names none: four times to half the step, half
/// to twice the elements.
std::vector<Discretization> accuracy_grid(const ProblemFile& problem);

/// Work–precision study at a design: every step with every number of elements against a
/// finer reference, values and gradients; see relative_error.hpp. The error of the reference itself
/// is estimated from another run with 4/3 of its step and 3/4 of its elements (Richardson, order 2:
/// difference / ((4/3)² − 1)). What is sampled in space converges unevenly: a run may be closer to
/// the reference than that by luck, and is not called better.
/// @throws InputError if the problem has no responses
/// @throws SimulationError if the reference fails; a failing run is only marked
/// @throws Stopped if a stop was asked for before the reference was done
AccuracyStudy accuracy_study(const ProblemFile& problem, const Eigen::VectorXd& x,
                             const AccuracyObserver& observer = {});

}  // namespace pleuel
