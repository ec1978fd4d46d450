#pragma once

#include <memory>
#include <string>
#include <vector>

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
struct BackendEnd {
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
  virtual BackendEnd minimize(ScaledProblem& problem) = 0;
};

/// The names that make_optimizer() knows.
std::vector<std::string> optimizer_names();

/// nlopt-mma and nlopt-ccsaq (Svanberg 2002: conservative convex approximations; many variables,
/// inequalities only), nlopt-slsqp (Kraft 1988: sequential quadratic programming; few variables),
/// ipopt (Wächter & Biegler 2006: interior point, here with a limited-memory Hessian).
/// @throws InputError for an unknown name; the message lists the names there are.
std::unique_ptr<Optimizer> make_optimizer(const std::string& name, const BackendOptions& options);

}  // namespace pleuel
