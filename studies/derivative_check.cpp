#include "studies/derivative_check.hpp"

#include <algorithm>

#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "studies/relative_error.hpp"

namespace pleuel {

std::vector<DerivativeCheck> check_derivatives(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               Analysis& analysis,
                                               const std::function<void(double step)>& see_step) {
  const Eigen::MatrixXd direct = direct_gradients(analysis);
  const ProblemFile repeated = with_steps_of(analysis.trajectory, problem);
  std::vector<DerivativeCheck> checks(analysis.responses.size(), {1e300, 0.0});
  for (const double step : {1e-5, 1e-6, 1e-4, 1e-7}) {
    see_step(step);
    const Eigen::MatrixXd differences = central_differences(repeated, x, step);
    for (std::size_t i = 0; i < checks.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double error = gradient_error(direct.row(row), differences.row(row), x,
                                          std::abs(analysis.reductions[i].value));
      if (error < checks[i].error) checks[i] = {error, step};
    }
    const auto agrees = [](const DerivativeCheck& check) { return check.error <= 1e-8; };
    if (std::all_of(checks.begin(), checks.end(), agrees)) break;
  }
  return checks;
}

}  // namespace pleuel
