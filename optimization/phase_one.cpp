#include "optimization/phase_one.hpp"

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
/// Parts of the way from the start to the middle of the bounds.
constexpr std::array<double, 4> parts_to_the_middle = {0.25, 0.5, 0.75, 1.0};

Eigen::VectorXd middle_of(const Problem& problem) {
  Eigen::VectorXd middle = start_of(problem);
  for (Eigen::Index i = 0; i < middle.size(); ++i) {
    const Variable& variable = problem.variables()[i];
    const double centre = 0.5 * (variable.lower + variable.upper);
    if (std::isfinite(centre)) middle[i] = centre;
  }
  return middle;
}

std::vector<Eigen::VectorXd> samples_that_break_least(const LimitRows& rows, const Problem& limits,
                                                      const Eigen::VectorXd& magnitudes) {
  std::vector<std::pair<double, Eigen::VectorXd>> rated;
  for (Eigen::VectorXd& x : latin_hypercube(limits.variables(), samples, seed)) {
    const Attempt attempt = attempt_evaluation(*rows.problem, x, Request::values);
    if (!attempt.evaluation) continue;
    const Eigen::VectorXd values =
        worst_values(rows.constraint_of_row, attempt.evaluation->constraints, limits.constraints());
    rated.emplace_back(max_violation(limits, values, magnitudes), std::move(x));
  }
  std::ranges::stable_sort(rated, {}, [](const auto& one) { return one.first; });
  std::vector<Eigen::VectorXd> designs;
  for (std::size_t i = 0; i < std::min(best_samples, rated.size()); ++i) {
    designs.push_back(std::move(rated[i].second));
  }
  return designs;
}

}  // namespace

ConstraintOfRow own_constraints(const Problem& problem) {
  ConstraintOfRow rows;
  for (std::size_t i = 0; i < problem.constraints().size(); ++i) rows.emplace_back(i);
  return rows;
}

Eigen::VectorXd worst_values(const ConstraintOfRow& constraint_of_row, const Eigen::VectorXd& rows,
                             const std::vector<Constraint>& limits) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(limits.size());
  std::vector<bool> is_set(limits.size(), false);
  for (std::size_t row = 0; row < constraint_of_row.size(); ++row) {
    if (!constraint_of_row[row]) continue;
    const std::size_t i = *constraint_of_row[row];
    const double value = rows[row];
    if (!is_set[i] || limits[i].excess(value) > limits[i].excess(values[i])) values[i] = value;
    is_set[i] = true;
  }
  return values;
}

std::optional<Eigen::VectorXd> evaluable_design(Problem& problem) {
  const Eigen::VectorXd start = start_of(problem);
  const Eigen::VectorXd middle = middle_of(problem);
  std::vector<Eigen::VectorXd> designs;
  for (const double part : parts_to_the_middle) designs.push_back(start + part * (middle - start));
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
  if (auto inside = restore_limits(*rows.problem, best)) return inside;
  for (const Eigen::VectorXd& x : samples_that_break_least(rows, limits, magnitudes)) {
    if (auto inside = restore_limits(*rows.problem, x, sample_budget)) return inside;
  }
  return std::nullopt;
}

}  // namespace pleuel
