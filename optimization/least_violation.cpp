#include "optimization/least_violation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "optimization/evaluation_cache.hpp"
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

/// 0.0713 of 0.07124 for an upper limit: what is named suffices.
double rounded_outward(double value, bool is_upper) {
  if (value == 0.0) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3.0);
  const double slack = 1e-4 * unit;  // 0.5 is not to become 0.5001 by rounding errors
  return unit * (is_upper ? std::ceil((value - slack) / unit) : std::floor((value + slack) / unit));
}

class LeastViolationSearch {
 public:
  LeastViolationSearch(const LimitRows& rows, const std::vector<Constraint>& limits,
                       const Eigen::VectorXd& start, int iterations)
      : rows_(rows), limits_(limits), iterations_(iterations), x_(start) {}

  LeastViolation find() {
    LeastViolation least;
    least.x = x_;
    const auto at_start = evaluated(x_);
    if (!at_start) return least;
    magnitudes_ = constraint_scales(*rows_.problem, *at_start, variable_scales(*rows_.problem, x_));
    const std::vector<bool> all(rows_.constraint_of_row.size(), true);
    ElasticProblem problem = elastic(all, *at_start);
    const Result result = solved(problem);
    least.x = x_ = problem.design_of(result.x);
    least.is_proven = result.status == Status::verified;
    at_least_ = evaluated(x_);
    if (!at_least_) return least;
    least.violation = max_violation(*rows_.problem, at_least_->constraints, magnitudes_);
    const std::vector<std::size_t> conflict = conflicting(problem, result);
    for (const std::size_t constraint : conflict) {
      ExceededLimit limit = broken(constraint);
      limit.is_in_conflict = true;
      if (least.limits.size() < most_limits) limit.alone = value_alone(constraint);
      least.limits.push_back(limit);
    }
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      if (std::find(conflict.begin(), conflict.end(), i) == conflict.end() && is_broken(i)) {
        least.limits.push_back(broken(i));
      }
    }
    return least;
  }

 private:
  std::optional<Evaluation> evaluated(const Eigen::VectorXd& x) {
    return attempt_evaluation(*rows_.problem, x, Request::values_and_gradients).evaluation;
  }

  ElasticProblem elastic(const std::vector<bool>& is_elastic, const Evaluation& at_x) {
    return {*rows_.problem, is_elastic, x_, at_x, magnitudes_};
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
    Result best;
    for (const char* backend : proving_backends) {
      Result result = solve(problem, options(backend));
      const bool is_first = best.history.empty();
      if (is_first || result.status == Status::verified || is_better(result, best)) {
        best = std::move(result);
      }
      if (best.status == Status::verified) break;
    }
    return best;
  }

  static bool is_better(const Result& one, const Result& other) {
    if (!one.evaluation.has_gradients()) return false;
    if (!other.evaluation.has_gradients()) return true;
    return one.evaluation.objective + one.max_violation <
           other.evaluation.objective + other.max_violation;
  }

  /// Constraints with a multiplier; without multipliers those that are exceeded as much as the
  /// worst.
  std::vector<std::size_t> conflicting(const ElasticProblem& problem, const Result& result) const {
    std::vector<double> weights(limits_.size(), 0.0);
    double sum = 0.0;
    for (std::size_t row = 0; row < problem.sides().size(); ++row) {
      const double multiplier = result.constraint_multipliers.size() > 0
                                    ? std::max(0.0, result.constraint_multipliers[row])
                                    : 0.0;
      weights[rows_.constraint_of_row[problem.sides()[row].constraint]] += multiplier;
      sum += multiplier;
    }
    if (sum == 0.0) weights = weights_of_the_worst(problem, sum);
    std::vector<std::size_t> constraints;
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      if (weights[i] > least_weight * sum) constraints.push_back(i);
    }
    std::stable_sort(constraints.begin(), constraints.end(),
                     [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
    return constraints;
  }

  std::vector<double> weights_of_the_worst(const ElasticProblem& problem, double& sum) const {
    std::vector<double> weights(limits_.size(), 0.0);
    double largest = 0.0;
    for (const LimitSide& side : problem.sides()) {
      largest = std::max(largest, damped_violation(side.violation(at_least_->constraints)));
    }
    for (const LimitSide& side : problem.sides()) {
      const double damped = damped_violation(side.violation(at_least_->constraints));
      if (damped < largest - near_the_largest) continue;
      weights[rows_.constraint_of_row[side.constraint]] = sum = 1.0;
    }
    return weights;
  }

  ExceededLimit broken(std::size_t constraint) const {
    const double value = folded(*at_least_)[constraint];
    const Constraint& limits = limits_[constraint];
    ExceededLimit one;
    one.constraint = constraint;
    one.is_upper = value - limits.upper >= limits.lower - value;
    one.limit = one.is_upper ? limits.upper : limits.lower;
    one.together = value;
    return one;
  }

  bool is_broken(std::size_t constraint) const {
    const double value = folded(*at_least_)[constraint];
    return limits_[constraint].excess(value) > Tolerances().violation * magnitude_of(constraint);
  }

  double magnitude_of(std::size_t constraint) const {
    for (std::size_t row = 0; row < rows_.constraint_of_row.size(); ++row) {
      if (rows_.constraint_of_row[row] == constraint) {
        return magnitudes_[row];
      }
    }
    return 1.0;
  }

  /// The value that a constraint has to have if all others hold.
  std::optional<double> value_alone(std::size_t constraint) {
    for (const char* backend : proving_backends) {
      if (const auto value = value_alone(constraint, backend)) return value;
    }
    return std::nullopt;
  }

  std::optional<double> value_alone(std::size_t constraint, const char* backend) {
    std::vector<bool> is_elastic;
    for (const std::size_t of_row : rows_.constraint_of_row) {
      is_elastic.push_back(of_row == constraint);
    }
    ElasticProblem problem = elastic(is_elastic, *at_least_);
    const Result result = search(problem, options(backend));
    const bool has_design = result.x.size() > 0 && !result.history.front().has_failed();
    if (!has_design || result.max_violation > Tolerances().violation) return std::nullopt;
    const Attempt there =
        attempt_evaluation(*rows_.problem, problem.design_of(result.x), Request::values);
    if (!there.evaluation) return std::nullopt;
    return folded(*there.evaluation)[constraint];
  }

  Eigen::VectorXd folded(const Evaluation& evaluation) const {
    return rows_.fold(evaluation.constraints, limits_);
  }

  const LimitRows& rows_;
  const std::vector<Constraint>& limits_;
  int iterations_;
  Eigen::VectorXd x_;
  Eigen::VectorXd magnitudes_;  ///< row by row
  std::optional<Evaluation> at_least_;
};

std::string limit_text(const Problem& problem, const ExceededLimit& one, double value) {
  return fmt::format("{} {} {}", problem.constraints()[one.constraint].name,
                     one.is_upper ? "≤" : "≥", problem.constraint_text(one.constraint, value));
}

std::string changed_text(const Problem& problem, const ExceededLimit& one, double value) {
  return limit_text(problem, one, rounded_outward(value, one.is_upper));
}

/// "by 25.0 %", "by 340 times the limit"
std::string violation_text(double violation) {
  constexpr double hard_to_read = 10.0;
  return violation < hard_to_read ? "by " + percent(violation)
                                  : fmt::format("by {:.3g} times the limit", violation);
}

std::string joined(const std::vector<std::string>& texts, const std::string& last) {
  if (texts.size() == 1) return texts.front();
  const std::vector<std::string> first(texts.begin(), texts.end() - 1);
  return fmt::format("{}{}{}", fmt::join(first, ", "), last, texts.back());
}

}  // namespace

Eigen::VectorXd LimitRows::fold(const Eigen::VectorXd& rows,
                                const std::vector<Constraint>& limits) const {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(limits.size());
  std::vector<bool> is_set(limits.size(), false);
  for (std::size_t row = 0; row < constraint_of_row.size(); ++row) {
    const std::size_t i = constraint_of_row[row];
    const double value = rows[row];
    double& worst = values[i];
    if (!is_set[i] || limits[i].excess(value) > limits[i].excess(worst)) worst = value;
    is_set[i] = true;
  }
  return values;
}

LeastViolation find_least_violation(const LimitRows& rows, const std::vector<Constraint>& limits,
                                    const Eigen::VectorXd& start, int iterations) {
  return LeastViolationSearch(rows, limits, start, iterations).find();
}

std::string describe(const LeastViolation& least, const Problem& problem) {
  if (least.limits.empty()) return "";
  std::vector<std::string> conflict, alone, hopeless, together;
  for (const ExceededLimit& one : least.limits) {
    if (one.is_in_conflict) conflict.push_back(limit_text(problem, one, one.limit));
    if (one.alone) {
      alone.push_back(changed_text(problem, one, *one.alone));
    } else if (one.is_in_conflict) {
      hopeless.push_back(problem.constraints()[one.constraint].name);
    }
    together.push_back(changed_text(problem, one, one.together));
  }
  std::string text = joined(conflict, " and ") + " cannot be kept";
  if (conflict.size() > 1) text += " at once";
  text += fmt::format("; this design breaks its limits least, {}{}",
                      violation_text(least.violation), least.limits.size() > 1 ? " at most" : "");
  if (!alone.empty()) text += ". One change would do: " + joined(alone, ", or ");
  if (!alone.empty() && alone.size() < conflict.size()) {
    text +=
        fmt::format("; for {} alone no value was found that would do", joined(hopeless, " and "));
  }
  if (!alone.empty() && least.limits.size() == 1) return text;
  text += alone.empty() ? ". What would do together: " : "; or all of these: ";
  return text + joined(together, " and ");
}

}  // namespace pleuel
