#include "optimization/designs_to_try.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "optimization/restoration.hpp"
#include "optimization/scaling.hpp"
#include "optimization/starts.hpp"

namespace pleuel {

namespace {

/// Designs between the bounds that are tried where all else fails, and how many of the best of them
/// a restoration begins at.
constexpr int samples = 8;
constexpr std::size_t best_samples = 2;
constexpr RestorationBudget sample_budget{12, 30};
constexpr unsigned seed = 20;
/// Shares of the way from the start to the middle of the bounds.
constexpr std::array<double, 4> ways_to_the_middle = {0.25, 0.5, 0.75, 1.0};

Eigen::VectorXd middle_of(const Problem& problem) {
  Eigen::VectorXd middle = start_of(problem);
  for (Eigen::Index i = 0; i < middle.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    const double centre = 0.5 * (variable.lower + variable.upper);
    if (std::isfinite(centre)) middle[i] = centre;
  }
  return middle;
}

std::optional<Eigen::VectorXd> restored_from(Problem& rows, const Eigen::VectorXd& x,
                                             const RestorationBudget& budget = {}) {
  const std::optional<Restored> restored = restore_limits(rows, x, budget);
  if (!restored || !restored->keeps_limits) return std::nullopt;
  return restored->design.x;
}

std::vector<Eigen::VectorXd> samples_that_break_least(const LimitRows& rows, const Problem& limits,
                                                      const Eigen::VectorXd& magnitudes) {
  std::vector<std::pair<double, Eigen::VectorXd>> rated;
  for (Eigen::VectorXd& x : latin_hypercube(limits.variables(), samples, seed)) {
    const Attempt attempt = attempt_evaluation(*rows.problem, x, Request::values);
    if (!attempt.evaluation) continue;
    const Eigen::VectorXd values = rows.fold(attempt.evaluation->constraints, limits.constraints());
    rated.emplace_back(max_violation(limits, values, magnitudes), std::move(x));
  }
  std::stable_sort(rated.begin(), rated.end(),
                   [](const auto& one, const auto& other) { return one.first < other.first; });
  std::vector<Eigen::VectorXd> designs;
  for (std::size_t i = 0; i < std::min(best_samples, rated.size()); ++i) {
    designs.push_back(std::move(rated[i].second));
  }
  return designs;
}

}  // namespace

Eigen::VectorXd start_of(const Problem& problem) {
  Eigen::VectorXd start(problem.variables().size());
  for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = problem.variables()[i].start;
  return start;
}

std::optional<Eigen::VectorXd> evaluable_design(Problem& problem) {
  const Eigen::VectorXd start = start_of(problem);
  const Eigen::VectorXd middle = middle_of(problem);
  std::vector<Eigen::VectorXd> designs;
  for (const double share : ways_to_the_middle) {
    designs.push_back(start + share * (middle - start));
  }
  for (Eigen::VectorXd& x : latin_hypercube(problem.variables(), samples, seed)) {
    designs.push_back(std::move(x));
  }
  for (const Eigen::VectorXd& x : designs) {
    if (attempt_evaluation(problem, x, Request::values_and_gradients).evaluation) return x;
  }
  return std::nullopt;
}

std::optional<Eigen::VectorXd> design_within_limits(const LimitRows& rows, const Problem& limits,
                                                    const Eigen::VectorXd& magnitudes,
                                                    const Eigen::VectorXd& best) {
  if (const auto inside = restored_from(*rows.problem, best)) return inside;
  for (const Eigen::VectorXd& x : samples_that_break_least(rows, limits, magnitudes)) {
    if (const auto inside = restored_from(*rows.problem, x, sample_budget)) return inside;
  }
  return std::nullopt;
}

}  // namespace pleuel
