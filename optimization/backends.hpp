#pragma once

#include <functional>
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

using OptimizerMaker = std::function<std::unique_ptr<Optimizer>(const BackendOptions& options)>;

/// The names that make_optimizer() knows.
std::vector<std::string> optimizer_names();

/// From now on make_optimizer() knows one more, or has another one of this name.
/// @throws InputError if the name is that of one below, or not made of letters, digits, '-' and '_'
void add_optimizer(const std::string& name, OptimizerMaker make);

/// Forgets one that was added. @throws InputError if none of this name was
void remove_optimizer(const std::string& name);

/// nlopt-mma and nlopt-ccsaq (Svanberg 2002: conservative convex approximations; many variables,
/// inequalities only), nlopt-slsqp (Kraft 1988: sequential quadratic programming; few variables),
/// ipopt (Wächter & Biegler 2006: interior point, here with a limited-memory Hessian).
/// @throws InputError for an unknown name; the message lists the names there are.
std::unique_ptr<Optimizer> make_optimizer(const std::string& name, const BackendOptions& options);

/// Where a backend comes to from a design.
struct BackendEnd {
  Eigen::VectorXd x;                                          ///< within the bounds
  std::string reason = "nothing, since no variable is free";  ///< that it gives
  bool has_left_numbers = false;  ///< it asked for a design that is not a number
};

/// Runs a backend on a problem that is scaled by a design (scaled_problem.hpp).
/// @param factors  of the magnitudes of the variables, positive
BackendEnd run_backend(EvaluationCache& cache, const EvaluatedDesign& from, const std::string& name,
                       double tolerance, const ScaledProblem::Budget& budget,
                       const Eigen::VectorXd& factors);

// The backends of Pleuel itself (backends.hpp).

std::unique_ptr<Optimizer> make_nlopt_mma(const BackendOptions& options);
std::unique_ptr<Optimizer> make_nlopt_ccsaq(const BackendOptions& options);
std::unique_ptr<Optimizer> make_nlopt_slsqp(const BackendOptions& options);
std::unique_ptr<Optimizer> make_ipopt(const BackendOptions& options);

}  // namespace pleuel
