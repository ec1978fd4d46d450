#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <set>

#include "core/base/eager_matrices.hpp"
#include "optimization/phase_one.hpp"
#include "optimization/scaling.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

namespace {

constexpr std::size_t most_limits = 6;  ///< whose own change is searched for
/// Of the sum of all multipliers: less holds nothing.
constexpr double least_weight = 1e-3;
/// ψ further below the largest one is not at it.
constexpr double near_the_largest = 1e-3;
/// Backends one after the other, until one of them proves its answer.
constexpr std::array<const char*, 2> proving_backends = {"nlopt-slsqp", "ipopt"};
/// Iterations without progress after which nothing more is expected.
constexpr int elastic_patience = 15;

class LeastViolationSearch {
 public:
  LeastViolationSearch(const LimitRows& rows, const std::vector<Constraint>& limits,
                       const Eigen::VectorXd& start, int iterations)
      : rows_(rows), limits_(limits), iterations_(iterations), x_(start) {}

  LeastViolation find() {
    LeastViolation least;
    least.x = x_;
    const auto at_start = evaluated();
    if (!at_start) return least;
    magnitudes_ = constraint_scales(*rows_.problem, *at_start, variable_scales(*rows_.problem, x_));
    PhaseOneProblem problem = elastic([](std::size_t) { return true; }, *at_start);
    const Result result = solved(problem);
    least.x = x_ = problem.design_of(result.x);
    least.is_proven = result.status == Status::verified;
    const auto at_least = evaluated();
    if (!at_least) return least;
    at_x_ = *at_least;
    values_ = worst_values(rows_.constraint_of_row, at_x_.constraints, limits_);
    least.violation = max_violation(*rows_.problem, at_x_.constraints, magnitudes_);
    const std::vector<std::size_t> conflict = conflicting(problem, result);
    for (const std::size_t constraint : conflict) {
      ExceededLimit limit = exceeded(constraint);
      limit.is_in_conflict = true;
      if (least.limits.size() < most_limits) limit.alone = value_alone(constraint);
      least.limits.push_back(limit);
    }
    std::set<std::size_t> broken;
    for (const LimitSide& side : problem.sides()) {
      if (side.violation(at_x_.constraints) > Tolerances().violation) broken.insert(limit_of(side));
    }
    for (const std::size_t constraint : broken) {
      if (std::ranges::count(conflict, constraint) == 0) {
        least.limits.push_back(exceeded(constraint));
      }
    }
    return least;
  }

 private:
  std::optional<Evaluation> evaluated() {
    return attempt_evaluation(*rows_.problem, x_, Request::values_and_gradients).evaluation;
  }

  template <class IsElastic>
  PhaseOneProblem elastic(const IsElastic& is_elastic, const Evaluation& at_x) {
    std::vector<bool> rows;
    for (const auto& constraint : rows_.constraint_of_row) rows.push_back(is_elastic(*constraint));
    return {*rows_.problem, rows, x_, at_x, magnitudes_};
  }

  std::size_t limit_of(const LimitSide& side) const {
    return *rows_.constraint_of_row[side.constraint];
  }

  SolveOptions options(const char* backend) const {
    return {.backend = backend,
            .max_iterations = iterations_,
            .max_restarts = 1,
            .max_escapes = 1,
            .patience = elastic_patience};
  }

  /// By the first backend that proves its answer; else the answer with the least violation.
  Result solved(Problem& problem) const {
    const auto violation = [](const Result& result) {
      return result.evaluation.has_gradients() ? result.evaluation.objective + result.max_violation
                                               : infinity;
    };
    Result best;
    for (const char* backend : proving_backends) {
      Result result = solve(problem, options(backend));
      if (result.status == Status::verified) return result;
      if (best.history.empty() || violation(result) < violation(best)) best = std::move(result);
    }
    return best;
  }

  /// Constraints with a multiplier; without multipliers those that are exceeded as much as the
  /// worst.
  std::vector<std::size_t> conflicting(const PhaseOneProblem& problem, const Result& result) const {
    std::vector<double> weights(limits_.size(), 0.0);
    for (Eigen::Index row = 0; row < result.constraint_multipliers.size(); ++row) {
      weights[limit_of(problem.sides()[row])] += std::max(0.0, result.constraint_multipliers[row]);
    }
    double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (sum == 0.0) {
      weights = weights_of_the_worst(problem);
      sum = 1.0;
    }
    std::vector<std::size_t> constraints;
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      if (weights[i] > least_weight * sum) constraints.push_back(i);
    }
    std::ranges::stable_sort(constraints, std::greater(),
                             [&](std::size_t i) { return weights[i]; });
    return constraints;
  }

  /// 1 or 0.
  std::vector<double> weights_of_the_worst(const PhaseOneProblem& problem) const {
    const auto damped = [&](const LimitSide& side) {
      return damped_violation(side.violation(at_x_.constraints));
    };
    double largest = 0.0;
    for (const LimitSide& side : problem.sides()) largest = std::max(largest, damped(side));
    std::vector<double> weights(limits_.size(), 0.0);
    for (const LimitSide& side : problem.sides()) {
      if (damped(side) >= largest - near_the_largest) weights[limit_of(side)] = 1.0;
    }
    return weights;
  }

  ExceededLimit exceeded(std::size_t constraint) const {
    const double value = values_[constraint];
    const Constraint& limits = limits_[constraint];
    ExceededLimit one;
    one.constraint = constraint;
    one.is_upper = value - limits.upper >= limits.lower - value;
    one.limit = one.is_upper ? limits.upper : limits.lower;
    one.together = value;
    return one;
  }

  /// The value that a constraint has to have if all others hold.
  std::optional<double> value_alone(std::size_t constraint) {
    for (const char* backend : proving_backends) {
      PhaseOneProblem problem =
          elastic([&](std::size_t limit) { return limit == constraint; }, at_x_);
      const Result result = search(problem, options(backend));
      const bool has_design = result.x.size() > 0 && !result.history.front().has_failed();
      if (!has_design || result.max_violation > Tolerances().violation) continue;
      const Attempt there =
          attempt_evaluation(*rows_.problem, problem.design_of(result.x), Request::values);
      if (!there.evaluation) continue;
      return worst_values(rows_.constraint_of_row, there.evaluation->constraints,
                          limits_)[constraint];
    }
    return std::nullopt;
  }

  const LimitRows& rows_;
  const std::vector<Constraint>& limits_;
  int iterations_;
  Eigen::VectorXd x_;
  Eigen::VectorXd magnitudes_;  ///< row by row
  Evaluation at_x_;             ///< where limits are broken least
  Eigen::VectorXd values_;      ///< of the constraints there
};

}  // namespace

LeastViolation find_least_violation(const LimitRows& rows, const std::vector<Constraint>& limits,
                                    const Eigen::VectorXd& start, int iterations) {
  return LeastViolationSearch(rows, limits, start, iterations).find();
}

}  // namespace pleuel
