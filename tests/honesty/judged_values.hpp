#pragma once

#include <string>
#include <vector>

#include "core/base/error_bar.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel::test {

/// How coarse a simulation is: times the step and the elements of a file.
struct Coarseness {
  double step = 1.0, elements = 1.0;
};

}  // namespace pleuel::test

/// Error bars beside errors that finer simulations show.

namespace pleuel::test {

/// One response of one simulation, with its bar and what is true.
struct JudgedValue {
  std::string scene, response;
  AnyResponse what;
  OverTime over_time = OverTime::max;
  Coarseness coarseness;
  double value = 0.0;
  double magnitude = 0.0;  ///< largest number of its history
  ErrorBar bar;
  double error = 0.0;            ///< reference − value, [its unit] as all below
  double step_error = 0.0;       ///< the part that finer steps alone remove
  double reference_error = 0.0;  ///< what half the fineness changes of the reference

  bool is_resolved() const;
  /// Whether nothing is left but round-off.
  bool is_exact() const;
  bool is_covered() const;
  double element_error() const { return error - step_error; }
  /// Of the bar over the error.
  double ratio() const;
};

/// A design of a problem, and what is simulated of it.
struct JudgedScene {
  std::string name;
  ProblemFile file;
  Eigen::VectorXd x;
  std::vector<Coarseness> coarseness;
};

/// All responses that have bars at all coarsenesses that can be simulated. The reference of all has
/// an eighth of the file's step, four times its elements, and two modes more of reduced beams. None
/// if that fails.
std::vector<JudgedValue> judged_values(const JudgedScene& scene);

}  // namespace pleuel::test
