#include <limits>

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"

namespace pleuel {

namespace {

using Ipopt::Index;
using Ipopt::Number;

/// What Ipopt takes for "no limit".
constexpr double unlimited = 2e19;

/// ScaledProblem in Ipopt's words: rows g then h, a dense Jacobian. An evaluation that fails
/// returns false; Ipopt then shortens its step.
class TranslatedProblem : public Ipopt::TNLP {
 public:
  explicit TranslatedProblem(ScaledProblem& problem) : problem_(problem), end_(problem.start()) {}

  const Eigen::VectorXd& end() const { return end_; }

  bool get_nlp_info(Index& n, Index& m, Index& nonzeros, Index& hessian_nonzeros,
                    IndexStyleEnum& index_style) override {
    n = problem_.variables();
    m = problem_.inequalities() + problem_.equalities();
    nonzeros = n * m;
    hessian_nonzeros = 0;
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* y_lower, Number* y_upper, Index m, Number* lower,
                       Number* upper) override {
    Eigen::Map<Eigen::VectorXd>(y_lower, n) = problem_.lower().cwiseMax(-unlimited);
    Eigen::Map<Eigen::VectorXd>(y_upper, n) = problem_.upper().cwiseMin(unlimited);
    Eigen::Map<Eigen::VectorXd>(upper, m).setZero();
    Eigen::Map<Eigen::VectorXd>(lower, m).setZero();
    Eigen::Map<Eigen::VectorXd>(lower, problem_.inequalities()).setConstant(-unlimited);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* y, bool, Number*, Number*, Index, bool,
                          Number*) override {
    Eigen::Map<Eigen::VectorXd>(y, n) = problem_.start();
    return true;
  }

  bool eval_f(Index n, const Number* y, bool, Number& objective) override {
    const auto evaluation = evaluate(n, y, Request::values);
    if (evaluation) objective = evaluation->objective;
    return evaluation.has_value();
  }

  bool eval_grad_f(Index n, const Number* y, bool, Number* gradient) override {
    const auto evaluation = evaluate(n, y, Request::values_and_gradients);
    if (evaluation) Eigen::Map<Eigen::VectorXd>(gradient, n) = evaluation->objective_gradient;
    return evaluation.has_value();
  }

  bool eval_g(Index n, const Number* y, bool, Index m, Number* rows) override {
    const auto evaluation = evaluate(n, y, Request::values);
    if (!evaluation) return false;
    Eigen::Map<Eigen::VectorXd>(rows, m) << evaluation->inequalities, evaluation->equalities;
    return true;
  }

  bool eval_jac_g(Index n, const Number* y, bool, Index m, Index, Index* row, Index* column,
                  Number* values) override {
    if (values == nullptr) {
      for (Index k = 0; k < n * m; ++k) {
        row[k] = k % m;
        column[k] = k / m;
      }
      return true;
    }
    const auto evaluation = evaluate(n, y, Request::values_and_gradients);
    if (!evaluation) return false;
    Eigen::Map<Eigen::MatrixXd> jacobian(values, m, n);
    jacobian.topRows(problem_.inequalities()) = evaluation->inequality_jacobian;
    jacobian.bottomRows(problem_.equalities()) = evaluation->equality_jacobian;
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* y, const Number*,
                         const Number*, Index, const Number*, const Number*, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    end_ = Eigen::Map<const Eigen::VectorXd>(y, n);
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index, Number, Number, Number, Number, Number,
                             Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    return !problem_.should_stop();
  }

 private:
  std::optional<ScaledEvaluation> evaluate(Index n, const Number* y, Request request) {
    return problem_.evaluate(Eigen::Map<const Eigen::VectorXd>(y, n), request);
  }

  ScaledProblem& problem_;
  Eigen::VectorXd end_;
};

void set_options(Ipopt::OptionsList& list, const BackendOptions& options) {
  list.SetIntegerValue("print_level", 0);
  list.SetStringValue("sb", "yes");
  list.SetStringValue("option_file_name", "");
  list.SetStringValue("hessian_approximation", "limited-memory");
  // The problem comes scaled; a second scaling would only blur the tolerance.
  list.SetStringValue("nlp_scaling_method", "none");
  list.SetNumericValue("tol", options.tolerance);
  // The iterations are counted by the problem, over all restarts.
  list.SetIntegerValue("max_iter", std::numeric_limits<Index>::max());
}

std::string describe(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
      return "its optimality conditions hold";
    case Ipopt::Infeasible_Problem_Detected:
      return "it finds the limits contradictory near here";
    case Ipopt::User_Requested_Stop:
      return "it was stopped";
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return "there are more equalities than variables";
    case Ipopt::Invalid_Number_Detected:
      return "it could not step back from a failed evaluation";
    default:
      return fmt::format("Ipopt ended with code {}", static_cast<int>(status));
  }
}

class IpoptOptimizer : public Optimizer {
 public:
  explicit IpoptOptimizer(const BackendOptions& options) : options_(options) {}

  bool takes_equalities() const override { return true; }

  BackendResult minimize(ScaledProblem& problem) override {
    const Ipopt::SmartPtr<TranslatedProblem> translated = new TranslatedProblem(problem);
    const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
    set_options(*application->Options(), options_);
    Ipopt::ApplicationReturnStatus status = application->Initialize();
    if (status == Ipopt::Solve_Succeeded) {
      status = application->OptimizeTNLP(Ipopt::GetRawPtr(translated));
    }
    return {translated->end(), describe(status)};
  }

 private:
  BackendOptions options_;
};

}  // namespace

std::unique_ptr<Optimizer> make_ipopt(const BackendOptions& options) {
  return std::make_unique<IpoptOptimizer>(options);
}

}  // namespace pleuel
