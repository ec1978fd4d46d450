#include "optimization/nlopt_optimizer.hpp"

#include <algorithm>
#include <type_traits>

#include <fmt/format.h>
#include <nlopt.h>

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

/// What the C callbacks of one run share.
struct Bridge {
  ScaledProblem& problem;
  nlopt_opt handle;
  double worst_objective = 0.0;
  double worst_row = 0.0;

  std::optional<ScaledEvaluation> evaluate(unsigned n, const double* y, const double* gradient) {
    const Request request = gradient == nullptr ? Request::values : Request::values_and_gradients;
    auto evaluation = problem.evaluate(Eigen::Map<const Eigen::VectorXd>(y, n), request);
    if (problem.should_stop()) nlopt_force_stop(handle);
    return evaluation;
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
    Eigen::Map<Eigen::VectorXd>(gradient, n) = evaluation->objective_gradient;
  }
  return evaluation->objective;
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
  Eigen::Map<Eigen::VectorXd>(result, m) = values;
  if (gradient != nullptr) Eigen::Map<RowMajor>(gradient, m, n) = (*evaluation).*Jacobian;
}

void add_rows(Bridge& bridge) {
  using E = ScaledEvaluation;
  const auto count = [](int rows) { return static_cast<unsigned>(rows); };
  const int inequalities = bridge.problem.inequalities();
  const int equalities = bridge.problem.equalities();
  const std::vector<double> tolerances(std::max(inequalities, equalities), row_tolerance);
  if (inequalities > 0) {
    nlopt_add_inequality_mconstraint(bridge.handle, count(inequalities),
                                     evaluate_rows<&E::inequalities, &E::inequality_jacobian>,
                                     &bridge, tolerances.data());
  }
  if (equalities > 0) {
    nlopt_add_equality_mconstraint(bridge.handle, count(equalities),
                                   evaluate_rows<&E::equalities, &E::equality_jacobian>, &bridge,
                                   tolerances.data());
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

class NloptOptimizer : public Optimizer {
 public:
  NloptOptimizer(nlopt_algorithm algorithm, const BackendOptions& options)
      : algorithm_(algorithm), options_(options) {}

  bool takes_equalities() const override { return algorithm_ == NLOPT_LD_SLSQP; }

  BackendEnd minimize(ScaledProblem& problem) override {
    const Handle handle(nlopt_create(algorithm_, static_cast<unsigned>(problem.variables())),
                        &nlopt_destroy);
    Bridge bridge{problem, handle.get()};
    nlopt_set_min_objective(handle.get(), evaluate_objective, &bridge);
    nlopt_set_lower_bounds(handle.get(), problem.lower().data());
    nlopt_set_upper_bounds(handle.get(), problem.upper().data());
    add_rows(bridge);
    nlopt_set_ftol_rel(handle.get(), options_.tolerance);
    nlopt_set_xtol_rel(handle.get(), options_.tolerance);

    Eigen::VectorXd y = problem.start();
    double objective = 0.0;
    const nlopt_result result = nlopt_optimize(handle.get(), y.data(), &objective);
    return {y, describe(result)};
  }

 private:
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
