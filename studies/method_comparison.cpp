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

struct MethodStudy {
  const ProblemFile problem;  ///< with the steps of the analysis
  const Eigen::VectorXd& x;
  Analysis& analysis;
  const MethodComparisonOptions& options;
  Eigen::VectorXd magnitudes = values_of(analysis).cwiseAbs();
  Eigen::MatrixXd direct = {};
  std::vector<ComparedMethod> compared = {};

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
    return std::move(compared);
  }

 private:
  void compare_exact() {
    const auto by = [&](ExactMethod method) {
      return sampled_gradients(analysis, response_values(analysis), method);
    };
    Eigen::MatrixXd adjoint;
    const std::vector<ComparedTime> times = compare_times(
        {[&] { direct = by(ExactMethod::direct); }, [&] { adjoint = by(ExactMethod::adjoint); }});
    const Eigen::VectorXd distances = errors(adjoint);
    compared.push_back({GradientMethod::direct, 0.0, times[0].seconds, {}, distances});
    compared.push_back({GradientMethod::adjoint, 0.0, times[1].seconds, times[1], distances});
  }

  void take_median(GradientMethod method) {
    std::vector<double> seconds;
    for (const ComparedMethod& one : compared) {
      if (one.method == method) seconds.push_back(one.seconds);
    }
    if (seconds.empty()) return;
    const auto middle = seconds.begin() + std::ssize(seconds) / 2;
    std::ranges::nth_element(seconds, middle);
    for (ComparedMethod& one : compared) {
      if (one.method == method) one.seconds = *middle;
    }
  }

  void compare_differences(double step) {
    options.see_step(step);
    const auto add = [&](GradientMethod method, const auto& compute) {
      const Stopwatch stopwatch;
      const Eigen::MatrixXd gradients = compute();
      compared.push_back({method, step, stopwatch.seconds(), {}, errors(gradients)});
    };
    try {
      add(GradientMethod::central_difference,
          [&] { return central_differences(problem, x, step, options.threads); });
      add(GradientMethod::forward_difference,
          [&] { return forward_differences(problem, x, analysis, step, options.threads); });
    } catch (const SimulationError&) {
      return;  // so large a step leads where nothing can be simulated
    }
  }

  Eigen::VectorXd errors(const Eigen::MatrixXd& gradients) const {
    Eigen::VectorXd errors(gradients.rows());
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      errors(i) = gradient_error(gradients.row(i), direct.row(i), x, magnitudes(i));
    }
    return errors;
  }
};

}  // namespace

std::vector<ComparedMethod> compare_methods(const ProblemFile& problem, const Eigen::VectorXd& x,
                                            Analysis& analysis,
                                            const MethodComparisonOptions& options) {
  return MethodStudy{with_steps_of(analysis.trajectory, problem), x, analysis, options}.run();
}

}  // namespace pleuel
