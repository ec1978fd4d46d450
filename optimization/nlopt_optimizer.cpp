#include <algorithm>
#include <new>
#include <stdexcept>
#include <type_traits>

#include <fmt/format.h>
#include <nlopt.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"

namespace pleuel {

namespace {

using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)>;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// How much worse than all that was seen a failed evaluation looks. Finite, since with a NaN
/// NLopt's MMA drops the constraint and reports success; of order one, so that the cubic line
/// search of SLSQP and the conservative factors of MMA still compute a sensible shorter step.
constexpr double failure_penalty = 10.0;

/// Violations, in units of the limit, up to which a design counts as feasible for the backend. It
/// answers with the best feasible design, so that a tighter value would lose a good end to noise.
constexpr double row_tolerance = 1e-6;

/// Price K of elasticity, of order-one objective per relative violation: above the sum of the
/// multipliers of any sensibly limited design, so that z ends at 0 (exact penalty).
constexpr double elastic_price = 100.0;

/// Steps in a row below the tolerance after which there is nothing left to be gained. One or two
/// may be cautious ones that longer steps follow.
constexpr int most_tiny_steps = 3;

/// Watches for steps that are too short to matter. NLopt's MMA and CCSAQ ask for the tolerance only
/// after a conservative step, and near an optimum the noise of values lets none look conservative:
/// they shorten it down to rounding.
class TinySteps {
 public:
  /// @param tolerance  of ‖Δy‖∞
  explicit TinySteps(double tolerance) : tolerance_(tolerance) {}

  void see(const Eigen::VectorXd& y) {
    if (y.size() == last_.size() && y == last_) return;  // another question about the same design
    const bool is_tiny =
        y.size() == last_.size() && (y - last_).lpNorm<Eigen::Infinity>() < tolerance_;
    count_ = is_tiny ? count_ + 1 : 0;
    last_ = y;
  }
  bool are_too_many() const { return count_ >= most_tiny_steps; }

 private:
  double tolerance_;
  Eigen::VectorXd last_;
  int count_ = 0;
};

/// What the C callbacks of one run share. The variables of NLopt are y or, if elastic, (y, z).
struct Bridge {
  ScaledProblem& problem;
  nlopt_opt handle;
  TinySteps tiny_steps;
  Eigen::Index elastic_variables = 0;  ///< 0 or 1
  double worst_objective = 0.0;
  double worst_row = 0.0;

  std::optional<ScaledEvaluation> evaluate(unsigned n, const double* y, const double* gradient) {
    const Request request = gradient == nullptr ? Request::values : Request::values_and_gradients;
    const Eigen::Map<const Eigen::VectorXd> design(y, static_cast<int>(n) - elastic_variables);
    auto evaluation = problem.evaluate(design, request);
    tiny_steps.see(design);
    if (problem.should_stop() || tiny_steps.are_too_many()) nlopt_force_stop(handle);
    return evaluation;
  }

  double elasticity(unsigned n, const double* y) const {
    return elastic_variables == 0 ? 0.0 : y[n - 1];
  }
};

double evaluate_objective(unsigned n, const double* y, double* gradient, void* data) {
  auto& bridge = *static_cast<Bridge*>(data);
  const auto evaluation = bridge.evaluate(n, y, gradient);
  if (!evaluation) {
    if (gradient != nullptr) std::fill_n(gradient, n, 0.0);
    return bridge.worst_objective + failure_penalty;
  }
  bridge.worst_objective = std::max(bridge.worst_objective, evaluation->objective);
  if (gradient != nullptr) {
    Eigen::Map<Eigen::VectorXd> all(gradient, n);
    all.setConstant(elastic_price);
    all.head(n - bridge.elastic_variables) = evaluation->objective_gradient;
  }
  return evaluation->objective + elastic_price * bridge.elasticity(n, y);
}

/// Rows of g or h, chosen by the members of ScaledEvaluation that hold them.
template <auto Values, auto Jacobian>
void evaluate_rows(unsigned m, double* result, unsigned n, const double* y, double* gradient,
                   void* data) {
  auto& bridge = *static_cast<Bridge*>(data);
  const auto evaluation = bridge.evaluate(n, y, gradient);
  if (!evaluation) {
    std::fill_n(result, m, bridge.worst_row + failure_penalty);
    if (gradient != nullptr) std::fill_n(gradient, m * n, 0.0);
    return;
  }
  const Eigen::VectorXd& values = (*evaluation).*Values;
  bridge.worst_row = std::max(bridge.worst_row, values.maxCoeff());
  Eigen::Map<Eigen::VectorXd>(result, m) = values.array() - bridge.elasticity(n, y);
  if (gradient == nullptr) return;
  Eigen::Map<RowMajor> jacobian(gradient, m, n);
  jacobian.setConstant(-1.0);
  jacobian.leftCols(n - bridge.elastic_variables) = (*evaluation).*Jacobian;
}

/// What NLopt refuses would be optimized without.
void check(nlopt_result result) {
  if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
  if (result < 0) throw std::logic_error("NLopt refuses what it is given");
}

void add_rows(Bridge& bridge) {
  using E = ScaledEvaluation;
  const auto count = [](int rows) { return static_cast<unsigned>(rows); };
  const int inequalities = bridge.problem.inequalities();
  const int equalities = bridge.problem.equalities();
  const std::vector<double> tolerances(std::max(inequalities, equalities), row_tolerance);
  if (inequalities > 0) {
    check(nlopt_add_inequality_mconstraint(bridge.handle, count(inequalities),
                                           evaluate_rows<&E::inequalities, &E::inequality_jacobian>,
                                           &bridge, tolerances.data()));
  }
  if (equalities > 0) {
    check(nlopt_add_equality_mconstraint(bridge.handle, count(equalities),
                                         evaluate_rows<&E::equalities, &E::equality_jacobian>,
                                         &bridge, tolerances.data()));
  }
}

std::string describe(nlopt_result result) {
  switch (result) {
    case NLOPT_FTOL_REACHED:
      return "the objective no longer changes";
    case NLOPT_XTOL_REACHED:
      return "the variables no longer change";
    case NLOPT_FORCED_STOP:
      return "it was stopped";
    case NLOPT_ROUNDOFF_LIMITED:
      return "rounding errors limit the progress";
    case NLOPT_SUCCESS:
      return "it reports success";
    default:
      return fmt::format("NLopt ended with code {}", static_cast<int>(result));
  }
}

/// MMA and CCSAQ find no way into the limits from a start far outside. There they solve Svanberg's
/// elastic form (Svanberg 1987), which keeps all its limits from the first design on:
///
///     minimize f(y) + K z   subject to   g(y) ≤ z,   z ≥ 0
class NloptOptimizer : public Optimizer {
 public:
  NloptOptimizer(nlopt_algorithm algorithm, const BackendOptions& options)
      : algorithm_(algorithm), options_(options) {}

  bool takes_equalities() const override { return algorithm_ == NLOPT_LD_SLSQP; }

  BackendResult minimize(ScaledProblem& problem) override {
    const double violation = elastic_violation(problem);
    Eigen::VectorXd lower = problem.lower(), upper = problem.upper(), y = problem.start();
    if (violation > 0.0) {
      append(lower, 0.0);
      append(upper, 2.0 * violation);
      append(y, violation);
    }
    const Handle handle(nlopt_create(algorithm_, static_cast<unsigned>(y.size())), &nlopt_destroy);
    if (!handle) throw std::bad_alloc();
    const double tiny = takes_equalities() ? 0.0 : options_.tolerance;
    Bridge bridge{problem, handle.get(), TinySteps(tiny), y.size() - problem.variables()};
    check(nlopt_set_min_objective(handle.get(), evaluate_objective, &bridge));
    check(nlopt_set_lower_bounds(handle.get(), lower.data()));
    check(nlopt_set_upper_bounds(handle.get(), upper.data()));
    add_rows(bridge);
    check(nlopt_set_ftol_rel(handle.get(), options_.tolerance));
    check(nlopt_set_xtol_rel(handle.get(), options_.tolerance));

    double objective = 0.0;
    const nlopt_result result = nlopt_optimize(handle.get(), y.data(), &objective);
    const bool is_idle = bridge.tiny_steps.are_too_many();
    return {y.head(problem.variables()),
            is_idle ? "its steps have become too short to matter" : describe(result)};
  }

 private:
  static void append(Eigen::VectorXd& vector, double entry) {
    vector.conservativeResize(vector.size() + 1);
    vector[vector.size() - 1] = entry;
  }

  /// Largest g at the start where MMA needs elasticity, else 0.
  double elastic_violation(ScaledProblem& problem) const {
    if (takes_equalities() || problem.inequalities() == 0) return 0.0;
    const auto start = problem.evaluate(problem.start(), Request::values);
    const double violation = start ? start->inequalities.maxCoeff() : 0.0;
    return violation > row_tolerance ? violation : 0.0;
  }

  nlopt_algorithm algorithm_;
  BackendOptions options_;
};

}  // namespace

std::unique_ptr<Optimizer> make_nlopt_mma(const BackendOptions& options) {
  return std::make_unique<NloptOptimizer>(NLOPT_LD_MMA, options);
}

std::unique_ptr<Optimizer> make_nlopt_ccsaq(const BackendOptions& options) {
  return std::make_unique<NloptOptimizer>(NLOPT_LD_CCSAQ, options);
}

std::unique_ptr<Optimizer> make_nlopt_slsqp(const BackendOptions& options) {
  return std::make_unique<NloptOptimizer>(NLOPT_LD_SLSQP, options);
}

}  // namespace pleuel
