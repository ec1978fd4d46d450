#include "optimization/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/neighbourhood.hpp"
#include "optimization/problem.hpp"
#include "optimization/result.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

namespace {

constexpr double step = 1e-3;             ///< h
constexpr double short_step = 1e-4;       ///< the second attempt
constexpr double least_magnitude = 1e-2;  ///< part of s that replaces |x| near zero

/// To which sides a variable can go: +1 or −1 at a bound, 0 where both are free or none is.
struct StepRanges {
  Eigen::VectorXd sizes;  ///< of a step of relative length 1; 0 for a variable without room
  Eigen::VectorXd sides;
};

StepRanges ranges_around(const Problem& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd s = local_scales(problem, x);
  StepRanges ranges{Eigen::VectorXd::Zero(x.size()), Eigen::VectorXd::Zero(x.size())};
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double size = std::clamp(std::abs(x[i]), least_magnitude * s[i], s[i]);
    const Variable& variable = problem.variables()[i];
    const bool can_rise = x[i] + 2.0 * step * size <= variable.upper;
    const bool can_fall = x[i] - 2.0 * step * size >= variable.lower;
    if (!can_rise && !can_fall) continue;
    ranges.sizes[i] = size;
    if (can_rise != can_fall) ranges.sides[i] = can_rise ? 1.0 : -1.0;
  }
  return ranges;
}

/// Relative changes of the variables with room to both sides, no two of the same pattern.
Eigen::VectorXd generic_changes(const StepRanges& ranges, GenericNumbers& numbers) {
  Eigen::VectorXd changes = Eigen::VectorXd::Zero(ranges.sizes.size());
  for (Eigen::Index i = 0; i < changes.size(); ++i) {
    const bool has_both_sides = ranges.sizes[i] > 0.0 && ranges.sides[i] == 0.0;
    if (has_both_sides) changes[i] = numbers.signed_size();
  }
  return changes;
}

/// Likewise of those at a bound.
Eigen::VectorXd generic_changes_inwards(const StepRanges& ranges, GenericNumbers& numbers) {
  return ranges.sides.unaryExpr([&](double side) {
    const double size = numbers.size();
    return side * size * numbers.size();
  });
}

/// d₁, d₂ and d₃ at 120° to each other in relative changes of the variables with room to both
/// sides: whatever has a slope along their plane is seen from both sides. With one such variable
/// d₂ = d₃ = −d₁. Variables at a bound go inwards in all of them, each time otherwise.
std::vector<Eigen::VectorXd> generic_directions(const Problem& problem, const Eigen::VectorXd& x) {
  const StepRanges ranges = ranges_around(problem, x);
  GenericNumbers numbers;
  const Eigen::VectorXd first = generic_changes(ranges, numbers);
  Eigen::VectorXd across = generic_changes(ranges, numbers);
  if ((first.array() != 0.0).count() > 1) {
    across -= across.dot(first) / first.squaredNorm() * first;
    across *= first.norm() / across.norm();
  } else {
    across.setZero();
  }
  const double sine = 0.5 * std::sqrt(3.0);
  std::vector<Eigen::VectorXd> directions;
  for (const auto& [a, b] : {std::pair(1.0, 0.0), std::pair(-0.5, sine), std::pair(-0.5, -sine)}) {
    Eigen::VectorXd changes = a * first + b * across + generic_changes_inwards(ranges, numbers);
    const double largest = changes.lpNorm<Eigen::Infinity>();
    if (largest > 0.0) changes /= largest;
    const Eigen::VectorXd direction = changes.cwiseProduct(ranges.sizes);
    if (directions.empty() || direction != directions.back()) directions.push_back(direction);
  }
  return directions;
}

/// Differences of the objective (first) and of the constraints along the direction.
std::optional<Eigen::VectorXd> differences(EvaluationCache& cache, const EvaluatedDesign& design,
                                           const Eigen::VectorXd& direction, double h) {
  const auto values = [](const Evaluation& evaluation) {
    Eigen::VectorXd all(1 + evaluation.constraints.size());
    all << evaluation.objective, evaluation.constraints;
    return all;
  };
  const Evaluation* near = cache.evaluate(design.x + h * direction, Request::values);
  if (near == nullptr) return std::nullopt;
  const Eigen::VectorXd near_values = values(*near);
  const Evaluation* far = cache.evaluate(design.x + 2.0 * h * direction, Request::values);
  if (far == nullptr) return std::nullopt;
  return (-3.0 * values(design.evaluation) + 4.0 * near_values - values(*far)) / (2.0 * h);
}

/// |error| of the directional derivatives, each weighted with its multiplier (1 for the objective).
Eigen::VectorXd weighted_errors(const Eigen::VectorXd& difference, const EvaluatedDesign& design,
                                const KktAudit& audit, const Eigen::VectorXd& direction) {
  Eigen::VectorXd derivative(difference.size());
  derivative << design.evaluation.objective_gradient.dot(direction),
      design.evaluation.constraint_jacobian * direction;
  Eigen::VectorXd weights(difference.size());
  weights << 1.0, audit.constraint_multipliers;
  return (difference - derivative).cwiseProduct(weights).cwiseAbs();
}

struct DirectionError {
  double error;
  Eigen::Index row;  ///< of the worst: 0 for the objective
};

/// The largest error along a direction; nullopt if it cannot be had.
std::optional<DirectionError> error_along(EvaluationCache& cache, const EvaluatedDesign& design,
                                          const KktAudit& audit, const Eigen::VectorXd& direction,
                                          double h) {
  const auto difference = differences(cache, design, direction, h);
  if (!difference) return std::nullopt;
  const Eigen::VectorXd s = local_scales(cache.problem(), design.x);
  const double length = direction.cwiseQuotient(s).norm();
  const double dimension = std::sqrt(static_cast<double>(design.x.size()));
  Eigen::Index row = 0;
  const double largest = weighted_errors(*difference, design, audit, direction).maxCoeff(&row);
  return DirectionError{dimension * largest / (length * audit.gradient_scale), row};
}

}  // namespace

GradientCheck check_gradients(EvaluationCache& cache, const EvaluatedDesign& design,
                              const KktAudit& audit, double good_enough) {
  const Problem& problem = cache.problem();
  GradientCheck check;
  for (const Eigen::VectorXd& direction : generic_directions(problem, design.x)) {
    if (direction.isZero(0.0)) return {true, 0.0, ""};  // every variable is fixed
    auto found = error_along(cache, design, audit, direction, step);
    if (!found || found->error > good_enough) {
      const auto closer = error_along(cache, design, audit, direction, short_step);
      if (closer && (!found || closer->error < found->error)) found = closer;
    }
    if (!found) continue;
    check.is_possible = true;
    if (found->error < check.error) continue;
    check.error = found->error;
    check.worst =
        found->row == 0 ? problem.objective_name() : problem.constraints()[found->row - 1].name;
  }
  return check;
}

namespace {

/// Relative to s: how far variables without proof are moved to see how their slopes change.
constexpr double probe = 0.01;

/// κ of KktAudit::variable_residuals() for the variables whose residuals are too large, by one
/// gradient at a design where they are moved downhill; zeros for the others, or where it fails.
Eigen::VectorXd probe_curvatures(EvaluationCache& cache, const EvaluatedDesign& design,
                                 const KktAudit& audit, double allowed) {
  const Eigen::VectorXd s = local_scales(cache.problem(), design.x);
  const Eigen::VectorXd residuals = audit.variable_residuals();
  Eigen::VectorXd moved = design.x;
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    if (residuals[i] > allowed) moved[i] += std::copysign(probe * s[i], -audit.stationarity[i]);
  }
  moved = within_bounds(cache.problem(), std::move(moved));
  const Eigen::VectorXd step = (moved - design.x).cwiseQuotient(s);
  Eigen::VectorXd curvatures = Eigen::VectorXd::Zero(s.size());
  const Evaluation* there = cache.evaluate(moved, Request::values_and_gradients);
  if (there == nullptr) return curvatures;
  const Eigen::VectorXd change = s.cwiseProduct(
      there->objective_gradient - design.evaluation.objective_gradient +
      (there->constraint_jacobian - design.evaluation.constraint_jacobian).transpose() *
          audit.constraint_multipliers);
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    if (step[i] != 0.0) curvatures[i] = std::abs(change[i] / step[i]);
  }
  return curvatures;
}

struct UnprovenVariable {
  std::size_t variable;
  double residual;
};

/// The variable with the largest residual, if that is more than allowed.
std::optional<UnprovenVariable> unproven_variable(EvaluationCache& cache, Verdict& verdict,
                                                  const Tolerances& tolerances) {
  const double allowed = tolerances.variable_residual;
  Eigen::VectorXd residuals = verdict.audit.variable_residuals();
  if (residuals.maxCoeff() <= allowed) return std::nullopt;
  residuals = verdict.audit.variable_residuals(
      probe_curvatures(cache, verdict.design, verdict.audit, allowed));
  Eigen::Index worst = 0;
  const double largest = residuals.maxCoeff(&worst);
  if (largest <= allowed) return std::nullopt;
  return UnprovenVariable{static_cast<std::size_t>(worst), largest};
}

void judge_gradients(Verdict& verdict, EvaluationCache& cache, const Tolerances& tolerances) {
  const GradientCheck check =
      check_gradients(cache, verdict.design, verdict.audit, tolerances.gradient);
  if (!check.is_possible) {
    verdict.message = "the designs beside this one cannot be evaluated: its gradients are unproven";
  } else if (check.error > tolerances.gradient) {
    verdict.gradients_are_disproved = true;
    verdict.message = fmt::format(
        "the gradient of {} differs from differences of its values by {:.2g} (relative; allowed "
        "{:.2g}): it is wrong, noisy, or this is a kink",
        check.worst, check.error, tolerances.gradient);
  } else {
    verdict.status = Status::verified;
    verdict.message = fmt::format(
        "a local optimum: KKT residual {:.2g}, limits kept to {:.2g}, gradients checked to {:.2g} "
        "(all relative)",
        verdict.audit.residual, verdict.design.max_violation, check.error);
  }
}

void judge_neighbourhood(Verdict& verdict, EvaluationCache& cache, const Evaluation& start,
                         const Tolerances& tolerances) {
  const Neighbourhood around =
      explore_neighbourhood(cache, verdict.design, verdict.audit, start, tolerances.gain);
  const double value_scale = objective_value_scale(verdict.design.evaluation, start);
  verdict.gain_left = around.gain_left + verdict.audit.complementarity / value_scale;
  if (around.better) {
    verdict.status = Status::stalled;
    verdict.better_neighbour = around.better;
    verdict.message = fmt::format(
        "the conditions of first order hold, but not at a minimum: within the limits {} is lower "
        "by {:.2g} (relative) at {}",
        cache.problem().objective_name(), around.gain,
        describe_design(cache.problem(), *around.better));
  } else if (verdict.gain_left > tolerances.gain) {
    verdict.status = Status::stalled;
    verdict.message = fmt::format(
        "near a local optimum, but {:.2g} of the objective (relative; allowed {:.2g}) is estimated "
        "to be left to it",
        verdict.gain_left, tolerances.gain);
  } else if (around.dimension == 0) {
    verdict.message += "; its active limits alone determine it";
  } else {
    verdict.message += fmt::format(
        "; no better design nearby, along {} of the {} directions that its limits "
        "leave open",
        around.directions, around.dimension);
    if (around.is_plateau) {
      verdict.message += fmt::format(
          "; but nor does any change {} at all: all designs nearby that keep the limits are as "
          "good",
          cache.problem().objective_name());
    }
  }
}

}  // namespace

Verdict judge(EvaluationCache& cache, const EvaluatedDesign& design, const Evaluation& start,
              const Tolerances& tolerances) {
  Verdict verdict;
  verdict.design = design;
  verdict.audit = audit_kkt(cache.problem(), design, start, cache.scales().constraints);
  if (design.max_violation > tolerances.violation) {
    verdict.status = Status::infeasible;
    verdict.message = fmt::format(
        "no design that keeps all limits was found; of those seen, this one breaks them least "
        "({:.2g} relative): {}",
        design.max_violation,
        broken_limits(cache.problem(), design.evaluation.constraints, cache.scales().constraints,
                      tolerances.violation));
  } else if (!(verdict.audit.residual <= tolerances.kkt_residual)) {
    verdict.message = fmt::format(
        "limits are kept, but the design is not proven optimal: relative KKT residual {:.2g}, "
        "allowed {:.2g}",
        verdict.audit.residual, tolerances.kkt_residual);
  } else if (const auto unproven = unproven_variable(cache, verdict, tolerances)) {
    verdict.message = fmt::format(
        "limits are kept, but {} is not proven optimal: what is left of its slope is {:.2g} of the "
        "terms that make it up, allowed {:.2g}",
        cache.problem().variables()[unproven->variable].name, unproven->residual,
        tolerances.variable_residual);
  } else {
    judge_gradients(verdict, cache, tolerances);
  }
  if (verdict.status == Status::verified) judge_neighbourhood(verdict, cache, start, tolerances);
  return verdict;
}

}  // namespace pleuel
