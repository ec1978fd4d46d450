#pragma once

#include <string>

#include <Eigen/Core>

#include "optimization/scaled_problem.hpp"

namespace pleuel {

/// How accurately a backend works before it thinks it is done.
struct BackendOptions {
  /// Relative change of the objective and of the scaled variables (NLopt), or error of the scaled
  /// optimality conditions (Ipopt), at which the backend stops. In (0, 1). Choose it above the
  /// noise of the simulation.
  double tolerance = 1e-6;
};

/// Where a backend stopped and what it says of it. Nobody believes it: see verdict.hpp.
struct BackendResult {
  Eigen::VectorXd y;
  std::string reason;
};

/// The door to a local, gradient-based method of constrained optimization.
class Optimizer {
 public:
  virtual ~Optimizer() = default;

  virtual bool takes_equalities() const = 0;

  /// Goes downhill from problem.start(). A failed evaluation is a wall that it steps back from; it
  /// ends soon after problem.should_stop().
  virtual BackendResult minimize(ScaledProblem& problem) = 0;
};

}  // namespace pleuel
