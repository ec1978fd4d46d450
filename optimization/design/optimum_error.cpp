#include "optimization/design/optimum_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/load_cases.hpp"
#include "optimization/design/case_trust.hpp"
#include "optimization/prices.hpp"

namespace pleuel {

namespace {

/// Steps that are proposed aim at so much of the target.
constexpr double proposed_share = 0.7;

/// What would bring an error below the target.
std::string advice(const ProblemFile& file, const ErrorBar& bar, double excess) {
  if (bar.effects.bound > std::max(bar.elements.bound, bar.step.bound)) {
    return "Try a smaller /effects/tolerance";
  }
  if (bar.elements.bound > bar.step.bound && bar.elements.is_resolved) {
    return "Try twice the elements";
  }
  const double factor =
      bar.step.is_resolved ? std::clamp(std::sqrt(proposed_share / excess), 1.0 / 16.0, 0.9) : 0.25;
  if (file.has_cases()) return fmt::format("Try {:.2g} times the /simulation/step", factor);
  return fmt::format("Try a /simulation/step of {:.2g} s", factor * file.simulation.step);
}

/// @param size  what the error is compared with
/// @returns empty if the target is met
std::string complaint(const ProblemFile& file, const std::string& what, const ErrorBar& bar,
                      double size) {
  const double target = file.accuracy.target;
  const double share = size > 0.0 ? bar.bound() / size : 0.0;
  if (bar.is_resolved() && share <= target) return "";
  const std::string amount =
      bar.is_resolved() ? fmt::format("is known to ± {} % only", significant(100.0 * share, 2))
                        : std::string("is not resolved by steps and elements");
  return fmt::format("{} {}, /accuracy/target is {:g} %. {}", what, amount, 100.0 * target,
                     advice(file, bar, share / target));
}

/// Whether a limit could be broken by the error of its value.
bool may_break(const ConstraintSettings& limit, double value, double error) {
  return (limit.upper && value + error > *limit.upper) ||
         (limit.lower && value - error < *limit.lower);
}

/// What the objective is made from: calls add(response, factor).
template <class Add>
void for_each_objective(DesignProblem& design, const Result& result, const Add& add) {
  const ProblemFile& file = design.file();
  const std::size_t objective = design.objective_response();
  if (file.objective->over_cases == OverCases::same) {
    for (const WeightedResponse& part : design.linearized_at(result.x, objective).parts) {
      add(part.response, part.weight);
    }
    return;
  }
  const std::size_t of_case = file.case_responses[objective].index;
  for (std::size_t c = 0; c < design.case_count(); ++c) {
    const bool has_shares = result.case_shares.size() > 0;
    const double factor = has_shares ? result.case_shares(c) : design.objective_weight(c);
    if (factor != 0.0) add(joined_response(file, {c, of_case}), factor);
  }
}

/// Calls add(response, factor) for what f + Σ μ c is made of: the objective and what is limited, each a
/// response of one case. Where f is maximized it is f − Σ μ c, as the multipliers are those of −f.
template <class Add>
void for_each_share(DesignProblem& design, const Result& result, const Add& add) {
  for_each_objective(design, result, add);
  for (std::size_t i = 0; i < design.constraints().size(); ++i) {
    const auto response = design.response_of(i);
    const double multiplier = result.constraint_multipliers(i);
    if (!response || multiplier == 0.0) continue;
    for (const WeightedResponse& part : design.linearized_at(result.x, *response).parts) {
      add(part.response, part.weight * design.objective_sign() * multiplier);
    }
  }
}

double nearest_limit(const ConstraintSettings& limit, double value) {
  if (!limit.lower) return *limit.upper;
  if (!limit.upper) return *limit.lower;
  return *limit.upper - value < value - *limit.lower ? *limit.upper : *limit.lower;
}

}  // namespace

std::optional<ErrorBar> optimum_error(DesignProblem& design, const Result& result,
                                      const Trust& trust) {
  if (trust.errors.empty() || !has_prices(result)) return std::nullopt;
  std::vector<WeightedResponse> shares;
  for_each_share(design, result, [&](std::size_t response, double factor) {
    shares.push_back({response, factor});
  });
  return error_of_sum(design.file(), trust, shares, std::abs(result.evaluation.objective))
      .value_or(ErrorBar());
}

double optimum_change(DesignProblem& design, const Result& result, const Eigen::VectorXd& changes) {
  double change = 0.0;
  for_each_share(design, result, [&](std::size_t response, double factor) {
    change += factor * changes(response);
  });
  return change;
}

std::string inaccuracy(DesignProblem& design, const Result& result, const Trust& trust) {
  const std::optional<ErrorBar> bar = optimum_error(design, result, trust);
  if (!bar) return "";
  const std::vector<std::optional<ErrorBar>>& errors = trust.errors;
  const ProblemFile& file = design.file();
  const std::string of_objective =
      complaint(file, fmt::format("the optimum of {}", file.objective->response), *bar,
                std::abs(result.evaluation.objective));
  if (!of_objective.empty()) return of_objective;
  for (std::size_t i = 0; i < file.constraints.size(); ++i) {
    const ConstraintSettings& limit = file.constraints[i];
    const auto response = design.response_of(i);
    if (!response || !errors[*response]) continue;
    const double value = result.evaluation.constraints(i);
    if (!may_break(limit, value, errors[*response]->bound())) continue;
    const std::string text =
        complaint(file, fmt::format("\"{}\", which is limited,", limit.response),
                  *errors[*response], std::abs(nearest_limit(limit, value)));
    if (!text.empty()) return text;
  }
  return "";
}

}  // namespace pleuel
