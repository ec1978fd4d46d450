#include "optimization/verdict.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "optimization/gradient_check.hpp"
#include "optimization/neighbourhood.hpp"

namespace pleuel {

namespace {

std::string worst_constraint(const EvaluationCache& cache, const KnownDesign& design) {
  const std::vector<Constraint>& constraints = cache.problem().constraints();
  std::string worst;
  double largest = 0.0;
  for (Eigen::Index j = 0; j < design.evaluation.constraints.size(); ++j) {
    const double value = design.evaluation.constraints[j];
    const double excess = std::max(value - constraints[j].upper, constraints[j].lower - value);
    if (excess / cache.scales().constraints[j] <= largest) continue;
    largest = excess / cache.scales().constraints[j];
    worst = fmt::format("{} = {:.6g} leaves its limits [{:.6g}, {:.6g}]", constraints[j].name,
                        value, constraints[j].lower, constraints[j].upper);
  }
  return worst;
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
  if (around.better) {
    verdict.status = Status::stalled;
    verdict.better_neighbour = around.better;
    verdict.message = fmt::format(
        "the conditions of first order hold, but not at a minimum: within the limits {} is lower "
        "by {:.2g} (relative) at {}",
        cache.problem().objective_name(), around.gain,
        describe_design(cache.problem(), *around.better));
  } else if (around.dimension == 0) {
    verdict.message += "; its limits leave no direction open";
  } else {
    verdict.message += fmt::format(
        "; no better design nearby, along {} of the {} directions that its limits "
        "leave open",
        around.directions, around.dimension);
  }
}

}  // namespace

std::string to_string(Status status) {
  constexpr std::array<const char*, 6> names = {"verified",   "unresolved", "stalled",
                                                "infeasible", "failed",     "interrupted"};
  return names[static_cast<std::size_t>(status)];
}

Verdict judge(EvaluationCache& cache, const KnownDesign& design, const Evaluation& start,
              const Tolerances& tolerances) {
  Verdict verdict;
  verdict.design = design;
  verdict.audit = audit_kkt(cache.problem(), design, start, cache.scales().constraints);
  if (design.max_violation > tolerances.violation) {
    verdict.status = Status::infeasible;
    verdict.message = fmt::format("no design that keeps all limits was found: {} ({:.2g} relative)",
                                  worst_constraint(cache, design), design.max_violation);
  } else if (!(verdict.audit.residual <= tolerances.kkt_residual)) {
    verdict.message = fmt::format(
        "limits are kept, but the design is not proven optimal: relative KKT residual {:.2g}, "
        "allowed {:.2g}",
        verdict.audit.residual, tolerances.kkt_residual);
  } else {
    judge_gradients(verdict, cache, tolerances);
  }
  if (verdict.status == Status::verified) judge_neighbourhood(verdict, cache, start, tolerances);
  return verdict;
}

}  // namespace pleuel
