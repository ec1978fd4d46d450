#include "optimization/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "optimization/broken_limits.hpp"
#include "optimization/gradient_check.hpp"
#include "optimization/neighbourhood.hpp"
#include "optimization/scaling.hpp"

namespace pleuel {

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

std::string to_string(Status status) {
  constexpr std::array<const char*, 6> names = {"verified",   "unresolved", "stalled",
                                                "infeasible", "failed",     "interrupted"};
  return names[static_cast<std::size_t>(status)];
}

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
