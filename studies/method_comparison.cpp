#include "studies/method_comparison.hpp"

#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/base/stop.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/sampled_gradients.hpp"

namespace pleuel {

namespace {

constexpr double compared_steps[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};

class MethodStudy {
 public:
  MethodStudy(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
              const MethodComparisonOptions& options)
      : problem_(with_steps_of(analysis.trajectory, problem)),
        x_(x),
        analysis_(analysis),
        options_(options),
        magnitudes_(values_of(analysis).cwiseAbs()) {}

  std::vector<ComparedMethod> run() {
    compare_exact();
    try {
      for (const double step : compared_steps) compare_differences(step);
    } catch (const Stopped&) {
    }
    for (const GradientMethod method :
         {GradientMethod::central_difference, GradientMethod::forward_difference}) {
      take_median(method);
    }
    return std::move(compared_);
  }

 private:
  void compare_exact() {
    const auto by = [&](ExactMethod method) {
      return sampled_gradients(analysis_, response_values(analysis_), method);
    };
    Eigen::MatrixXd adjoint;
    const std::vector<ComparedTime> times = compare_times(
        {[&] { direct_ = by(ExactMethod::direct); }, [&] { adjoint = by(ExactMethod::adjoint); }});
    const Eigen::VectorXd distances = errors(adjoint);
    compared_.push_back({GradientMethod::direct, 0.0, times[0].seconds, {}, distances});
    compared_.push_back({GradientMethod::adjoint, 0.0, times[1].seconds, times[1], distances});
  }

  void take_median(GradientMethod method) {
    std::vector<double> seconds;
    for (const ComparedMethod& one : compared_) {
      if (one.method == method) seconds.push_back(one.seconds);
    }
    if (seconds.empty()) return;
    const auto middle = seconds.begin() + std::ssize(seconds) / 2;
    std::ranges::nth_element(seconds, middle);
    for (ComparedMethod& one : compared_) {
      if (one.method == method) one.seconds = *middle;
    }
  }

  void compare_differences(double step) {
    options_.see_step(step);
    const auto add = [&](GradientMethod method, const auto& compute) {
      const Stopwatch stopwatch;
      const Eigen::MatrixXd gradients = compute();
      compared_.push_back({method, step, stopwatch.seconds(), {}, errors(gradients)});
    };
    try {
      add(GradientMethod::central_difference,
          [&] { return central_differences(problem_, x_, step, options_.threads); });
      add(GradientMethod::forward_difference,
          [&] { return forward_differences(problem_, x_, analysis_, step, options_.threads); });
    } catch (const SimulationError&) {
      return;  // so large a step leads where nothing can be simulated
    }
  }

  Eigen::VectorXd errors(const Eigen::MatrixXd& gradients) const {
    Eigen::VectorXd errors(gradients.rows());
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      errors(i) = gradient_error(gradients.row(i), direct_.row(i), x_, magnitudes_(i));
    }
    return errors;
  }

  ProblemFile problem_;  ///< with the steps of the analysis
  const Eigen::VectorXd& x_;
  Analysis& analysis_;
  const MethodComparisonOptions& options_;
  Eigen::VectorXd magnitudes_;
  Eigen::MatrixXd direct_;
  std::vector<ComparedMethod> compared_;
};

}  // namespace

std::vector<ComparedMethod> compare_methods(const ProblemFile& problem, const Eigen::VectorXd& x,
                                            Analysis& analysis,
                                            const MethodComparisonOptions& options) {
  return MethodStudy(problem, x, analysis, options).run();
}

}  // namespace pleuel
