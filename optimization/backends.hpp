#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"
#include "optimization/evaluation_cache.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

/// What a backend sees at y.
struct ScaledEvaluation {
  double objective = 0.0;
  Eigen::VectorXd inequalities;  ///< g ≤ 0
  Eigen::VectorXd equalities;    ///< h = 0
  Eigen::VectorXd objective_gradient;
  Eigen::MatrixXd inequality_jacobian;  ///< inequalities × variables
  Eigen::MatrixXd equality_jacobian;    ///< equalities × variables
};

/// The problem as the backends see it, with numbers of order one and limits in the form they want:
///
///     y = x / s,   f(y) = f / F,   g(y) = ±(c − limit) / C ≤ 0,   h(y) = (c − limit) / C = 0
///
/// with the magnitudes s, F, C of scaling.hpp. A constraint with two limits gives two rows, one
/// without any gives none; a fixed variable is no variable here. It also says when to stop.
class ScaledProblem {
 public:
  struct Budget {
    int iterations = 0;            ///< of the cache, counted since the start of the run
    int evaluations = 0;           ///< likewise
    int consecutive_failures = 0;  ///< after this many the region is hopeless
    int line_search = 0;           ///< evaluations without gradients in a row: no way down is found
    int patience = 0;              ///< iterations without a better design; 0: any number
  };

  /// @param around   the design whose magnitudes scale the problem, and where the backend starts;
  ///                 with gradients.
  /// @param factors  of s, one a variable, positive; empty: 1.
  ScaledProblem(EvaluationCache& cache, const EvaluatedDesign& around, Budget budget,
                const Eigen::VectorXd& factors = {});

  int variables() const { return int_size(free_); }
  int inequalities() const { return int_size(inequalities_); }
  int equalities() const { return int_size(equalities_); }
  Eigen::VectorXd start() const { return to_scaled(around_); }
  Eigen::VectorXd lower() const { return scaled_bounds(&Variable::lower); }
  Eigen::VectorXd upper() const { return scaled_bounds(&Variable::upper); }

  /// nullopt if the evaluation failed or if the backend should stop. Never throws, since it is
  /// called through C: a fault of the program is kept for rethrow().
  std::optional<ScaledEvaluation> evaluate(const Eigen::VectorXd& y, Request request) noexcept;

  /// The budget is used up or something was thrown: no more evaluations are made.
  bool should_stop() const { return should_stop_; }
  /// The backend asked for a design that is not a number: it has lost its way, and stops.
  bool has_left_numbers() const { return has_left_numbers_; }
  /// Why the last evaluation has no numbers; empty: it has.
  const std::string& failure() const { return cache_.history().back().failure; }
  /// Throws what an evaluation threw, if it did.
  void rethrow() const;

  /// The design of y, exactly within its bounds.
  Eigen::VectorXd to_design(const Eigen::VectorXd& y) const;

 private:
  Eigen::VectorXd scaled_bounds(double Variable::*bound) const;
  void update_stop();
  void see_progress();
  Eigen::VectorXd to_scaled(const Eigen::VectorXd& x) const;
  Eigen::VectorXd values(const std::vector<LimitSide>& rows, const Evaluation& evaluation) const;
  Eigen::MatrixXd jacobian(const std::vector<LimitSide>& rows, const Evaluation& evaluation) const;
  ScaledEvaluation scale(const Evaluation& evaluation) const;

  EvaluationCache& cache_;
  int iterations_ = 0;   ///< of the cache, when gradients were last computed here
  int evaluations_ = 0;  ///< likewise
  /// The best so far, from the start of the run on, and the iteration that found it.
  double best_objective_, best_violation_;
  int best_iteration_ = 0;
  Eigen::VectorXd around_;
  Budget budget_;
  std::vector<Eigen::Index> free_;  ///< the variables that are not fixed
  std::vector<LimitSide> inequalities_, equalities_;
  Eigen::VectorXd variable_scales_;
  double objective_scale_;
  bool should_stop_ = false;
  bool has_left_numbers_ = false;
  std::exception_ptr exception_;
};

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

/// Runs a backend on a problem that is scaled by a design (backends.hpp).
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
