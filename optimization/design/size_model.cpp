#include "optimization/design/size_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// dy / dx of what is linear in 1 / x, over that of what is linear in x.
double reciprocal(const SizeLists& lists, std::size_t k, double from, double to) {
  const bool is_size = lists.value(k, 0) > 0.0 && to > 0.0;
  return is_size ? from / to : 1.0;
}

/// Where slopes vanish, as at an optimum between the sizes, the nearer size is the better guess.
double distance_cost(double gap, double change, double objective) {
  if (gap == 0.0) return 0.0;
  return 1e-3 * std::abs(objective) * (change / gap) * (change / gap);
}

/// Rows of constraints, and their limits; without options.
LinearChoiceModel model_at(const Problem& problem, const Evaluation& at, Eigen::Index rows,
                           const Eigen::VectorXd& scales) {
  LinearChoiceModel model;
  model.objective = at.objective;
  model.constraints = at.constraints.head(rows);
  model.lower.resize(rows);
  model.upper.resize(rows);
  model.scales = scales.head(rows);
  for (Eigen::Index j = 0; j < rows; ++j) {
    model.lower(j) = problem.constraints()[j].lower;
    model.upper(j) = problem.constraints()[j].upper;
  }
  return model;
}

}  // namespace

LinearChoiceModel size_model(const SizeLists& lists, const Problem& problem,
                             const Eigen::VectorXd& x, const Result& at, const Sizes& around,
                             const Eigen::VectorXd& scales, const SizeModelSettings& settings) {
  const Eigen::Index rows = settings.is_reduced ? 0 : at.evaluation.constraints.size();
  LinearChoiceModel model = model_at(problem, at.evaluation, rows, scales);
  Eigen::VectorXd slope = at.evaluation.objective_gradient;
  if (settings.is_reduced && at.constraint_multipliers.size() > 0) {
    slope += at.evaluation.constraint_jacobian.transpose() * at.constraint_multipliers;
  }
  for (std::size_t k = 0; k < lists.count(); ++k) {
    const Eigen::Index i = lists.variable(k);
    const double gap = settings.is_reduced ? lists.mean_gap(k) : 0.0;
    const int first = std::max(0, around[k] + settings.down);
    const int last = std::min(lists.sizes(k) - 1, around[k] + settings.up);
    std::vector<LinearOption> options;
    for (int size = first; size <= last; ++size) {
      const double change = lists.value(k, size) - x(i);
      Eigen::VectorXd constraints = at.evaluation.constraint_jacobian.col(i).head(rows) * change;
      for (Eigen::Index j = 0; j < rows; ++j) {
        if (constraints(j) * change < 0.0) {
          constraints(j) *= reciprocal(lists, k, x(i), lists.value(k, size));
        }
      }
      options.push_back({size,
                         slope(i) * change + distance_cost(gap, change, settings.relaxed_objective),
                         std::move(constraints)});
    }
    model.options.push_back(std::move(options));
  }
  return model;
}

}  // namespace pleuel
