#include "studies/derivative_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/kinks.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "studies/noise.hpp"

namespace pleuel {

namespace {

constexpr double first_steps[] = {1e-5, 1e-4, 1e-6, 1e-3}, further_steps[] = {1e-7, 1e-2, 1e-8};

/// Where newton_tolerance is suspected to be too loose: the tightest that Newton's method reaches.
constexpr double tight_tolerances[] = {1e-12, 1e-10};
/// A derivative that is computed anew at the same design is the same to this.
constexpr double same_derivative = 1e-6;

class Check {
 public:
  Check(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
        const DerivativeCheckOptions& options)
      : problem_(with_steps_of(analysis.trajectory, problem)),
        x_(x),
        options_(options),
        magnitudes_(values_of(analysis).cwiseAbs()),
        direct_(gradients_by(analysis, ExactMethod::direct)),
        adjoint_(gradients_by(analysis, ExactMethod::adjoint)),
        noise_(response_noise(problem_, x, options.threads)),
        has_kink_(problem.responses.size(), false) {
    for (const Kink& kink : find_kinks(analysis, problem.variables))
      has_kink_[kink.response] = true;
  }

  std::vector<DerivativeCheck> run() {
    for (const double step : first_steps) add_differences(step);
    for (const double step : further_steps) {
      if (!steps_.empty() && is_settled()) break;
      add_differences(step);
    }
    if (steps_.empty()) throw SimulationError(failure_);
    return judge();
  }

 private:
  struct Step {
    double step;
    Eigen::MatrixXd differences;  ///< responses × variables
  };

  static Eigen::MatrixXd gradients_by(Analysis& analysis, ExactMethod method) {
    return sampled_gradients(analysis, response_values(analysis), method);
  }

  void add_differences(double step) {
    options_.see_step(step);
    try {
      steps_.push_back({step, central_differences(problem_, x_, step, options_.threads)});
    } catch (const SimulationError& error) {
      failure_ = error.what();
    }
  }

  bool is_settled() const {
    const auto agrees = [](const DerivativeCheck& check) {
      return check.verdict() == DerivativeVerdict::agrees;
    };
    const std::vector<DerivativeCheck> checks = judge();
    return std::all_of(checks.begin(), checks.end(), agrees);
  }

  std::vector<DerivativeCheck> judge() const {
    std::vector<DerivativeCheck> checks;
    for (Eigen::Index i = 0; i < direct_.rows(); ++i) checks.push_back(judge(i));
    return checks;
  }

  DerivativeCheck judge(Eigen::Index i) const {
    DerivativeCheck check;
    check.error = std::numeric_limits<double>::infinity();
    for (const Step& step : steps_) {
      const double error =
          gradient_error(direct_.row(i), step.differences.row(i), x_, magnitudes_(i));
      if (error < check.error) std::tie(check.error, check.step) = std::tie(error, step.step);
    }
    check.adjoint_error = gradient_error(adjoint_.row(i), direct_.row(i), x_, magnitudes_(i));
    check.noise = noise_.floor()(i);
    const double relative = check.noise == 0.0      ? 0.0
                            : magnitudes_(i) == 0.0 ? 1.0
                                                    : check.noise / magnitudes_(i);
    check.relative_noise = std::max(relative, std::numeric_limits<double>::epsilon());
    for (Eigen::Index j = 0; j < direct_.cols(); ++j) check.variables.push_back(judge(i, j));
    return check;
  }

  JudgedDerivative judge(Eigen::Index i, Eigen::Index j) const {
    const double size = step_scale(problem_.variables[j], x_(j));
    std::vector<CentralDifference> curve;
    for (const Step& step : steps_) curve.push_back({step.step, step.differences(i, j)});
    return judge_derivative(
        {direct_(i, j), size, magnitudes_(i), noise_.scatter(i), noise_.remainder(i), has_kink_[i]},
        std::move(curve));
  }

  ProblemFile problem_;  ///< with the steps of the analysis
  const Eigen::VectorXd& x_;
  const DerivativeCheckOptions& options_;
  Eigen::VectorXd magnitudes_;
  Eigen::MatrixXd direct_, adjoint_;
  ResponseNoise noise_;
  std::vector<bool> has_kink_;
  std::vector<Step> steps_;
  std::string failure_;  ///< of the last step that failed
};

bool any_differs(const std::vector<DerivativeCheck>& checks) {
  return std::any_of(checks.begin(), checks.end(), [](const DerivativeCheck& check) {
    return check.verdict() == DerivativeVerdict::differs;
  });
}

/// The same checks with Newton's method carried further; empty where it does not come so far.
std::vector<DerivativeCheck> tight_checks(ProblemFile problem, const Eigen::VectorXd& x,
                                          const DerivativeCheckOptions& options) {
  for (const double tolerance : tight_tolerances) {
    if (problem.simulation.newton_tolerance <= tolerance) continue;
    ProblemFile tight = problem;
    tight.simulation.newton_tolerance = tolerance;
    try {
      const auto analysis = analyze(tight, x);
      return Check(tight, x, *analysis, options).run();
    } catch (const SimulationError&) {
      continue;
    }
  }
  return {};
}

/// See check_derivatives().
void excuse_loose_newton(std::vector<DerivativeCheck>& checks, const ProblemFile& problem,
                         const Eigen::VectorXd& x, const DerivativeCheckOptions& options) {
  const auto here = analyze(problem, x);
  const Eigen::MatrixXd again =
      sampled_gradients(*here, response_values(*here), ExactMethod::direct);
  const std::vector<DerivativeCheck> tight = tight_checks(problem, x, options);
  for (std::size_t i = 0; i < tight.size(); ++i) {
    for (std::size_t j = 0; j < checks[i].variables.size(); ++j) {
      JudgedDerivative& loose = checks[i].variables[j];
      const JudgedDerivative& judged = tight[i].variables[j];
      if (loose.verdict != DerivativeVerdict::differs) continue;
      if (judged.verdict == DerivativeVerdict::differs) continue;
      const double repeated = again(i, j);
      const double change = std::abs(repeated - loose.derivative);
      if (change > same_derivative * std::abs(loose.derivative)) continue;
      loose.verdict = DerivativeVerdict::noise;
      loose.tight_error = judged.error;
    }
  }
}

}  // namespace

std::size_t DerivativeCheck::worst_variable() const {
  const auto is_better = [](const JudgedDerivative& a, const JudgedDerivative& b) {
    return std::tie(a.verdict, a.error) < std::tie(b.verdict, b.error);
  };
  const auto worst = std::max_element(variables.begin(), variables.end(), is_better);
  return static_cast<std::size_t>(worst - variables.begin());
}

std::vector<DerivativeCheck> check_derivatives(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               Analysis& analysis,
                                               const DerivativeCheckOptions& options) {
  std::vector<DerivativeCheck> checks = Check(problem, x, analysis, options).run();
  if (any_differs(checks)) {
    excuse_loose_newton(checks, with_steps_of(analysis.trajectory, problem), x, options);
  }
  return checks;
}

}  // namespace pleuel
