#include "optimization/objective_bend.hpp"

#include <algorithm>

#include "core/base/eager_matrices.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

double objective_bend(const Problem& problem, const Eigen::VectorXd& x, const Evaluation& at,
                      const EvaluateBeside& evaluate) {
  constexpr double step = 1e-3;
  const Eigen::VectorXd s = variable_scales(problem, x);
  Eigen::VectorXd moved = x;
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    const double way = x[i] + step * s[i] <= variable.upper ? step * s[i] : -step * s[i];
    moved[i] = std::clamp(x[i] + way, variable.lower, variable.upper);
  }
  const Evaluation* there = evaluate(moved);
  if (there == nullptr) return 0.0;
  const Eigen::VectorXd change =
      scaled_objective_gradient(problem, *there, s) - scaled_objective_gradient(problem, at, s);
  return change.lpNorm<Eigen::Infinity>() / step;
}

}  // namespace pleuel
