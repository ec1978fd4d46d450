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

/// Where nobody asks for an accuracy, an optimum is verified to what it is known; beyond this no number is to
/// be trusted (core/trust/resolution.hpp).
constexpr double most_unasked_error = 0.1;

double relative_error(const ErrorBar& bar, double size) {
  return size > 0.0 ? bar.bound() / size : 0.0;
}

/// @param size  what the error is compared with
/// @returns empty if the target is met
std::string complaint(const ProblemFile& file, const std::string& what, const ErrorBar& bar,
                      double size, const std::string& failed_run) {
  const bool is_asked = file.accuracy.chooses_setting;
  const double target = is_asked ? file.accuracy.target : most_unasked_error;
  const double share = relative_error(bar, size);
  if (!bar.is_modelled) return "";  // it is a finding that forbids more
  if (bar.is_resolved() && share <= target) return "";
  const std::string amount =
      bar.is_resolved() ? fmt::format("is known to ± {} % only", significant(100.0 * share, 2))
                        : std::string("is not resolved by steps and elements");
  const std::string asked =
      is_asked ? fmt::format(", /accuracy/target is {:g} %", 100.0 * target) : "";
  return fmt::format("{} {}{}. {}", what, amount, asked,
                     std::isfinite(share) ? advice(file, bar, share / target)
                                          : "A run that would tell failed: " + failed_run);
}

/// Whether a limit could be broken by the error of its value.
bool may_break(const ConstraintSettings& limit, double value, double error) {
  return (limit.upper && value + error > *limit.upper) ||
         (limit.lower && value - error < *limit.lower);
}

/// What f + Σ μ c is made of: the objective and what is limited, each a response of one case. Where f is
/// maximized it is f − Σ μ c, as the multipliers are those of −f.
std::vector<WeightedResponse> parts_of_optimum(DesignProblem& design, const Result& result) {
  const ProblemFile& file = design.file();
  std::vector<WeightedResponse> parts;
  const std::size_t objective = design.objective_response();
  if (file.objective->over_cases == OverCases::same) {
    parts = design.linearized_at(result.x, objective).parts;
  } else {
    const std::size_t of_case = file.case_responses[objective].index;
    const bool has_shares = result.case_shares.size() > 0;
    for (std::size_t c = 0; c < design.case_count(); ++c) {
      const double factor = has_shares ? result.case_shares(c) : design.objective_weight(c);
      if (factor != 0.0) parts.push_back({joined_response(file, {c, of_case}), factor});
    }
  }
  for (std::size_t i = 0; i < design.constraints().size(); ++i) {
    const auto response = design.response_of(i);
    const double multiplier = result.constraint_multipliers(i);
    if (!response || multiplier == 0.0) continue;
    for (const WeightedResponse& part : design.linearized_at(result.x, *response).parts) {
      parts.push_back({part.response, part.weight * design.objective_sign() * multiplier});
    }
  }
  return parts;
}

double nearest_limit(const ConstraintSettings& limit, double value) {
  if (!limit.lower) return *limit.upper;
  if (!limit.upper) return *limit.lower;
  return *limit.upper - value < value - *limit.lower ? *limit.upper : *limit.lower;
}

/// A limit that the error of its value could break, and what the error is compared with.
struct OpenLimit {
  const std::string& response;
  const ErrorBar& error;
  double size;
};

std::vector<OpenLimit> open_limits(DesignProblem& design, const Result& result,
                                   const Trust& trust) {
  std::vector<OpenLimit> open;
  const std::vector<ConstraintSettings>& limits = design.file().constraints;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto response = design.response_of(i);
    if (!response || !trust.errors[*response]) continue;
    const ErrorBar& error = *trust.errors[*response];
    const double value = result.evaluation.constraints(i);
    if (!may_break(limits[i], value, error.bound())) continue;
    open.push_back({limits[i].response, error, std::abs(nearest_limit(limits[i], value))});
  }
  return open;
}

}  // namespace

std::optional<ErrorBar> optimum_error(DesignProblem& design, const Result& result,
                                      const Trust& trust) {
  if (trust.errors.empty() || !has_prices(result)) return std::nullopt;
  return error_of_sum(design.file(), trust, parts_of_optimum(design, result),
                      std::abs(result.evaluation.objective))
      .value_or(ErrorBar());
}

double optimum_change(DesignProblem& design, const Result& result, const Eigen::VectorXd& changes) {
  double change = 0.0;
  for (const WeightedResponse& part : parts_of_optimum(design, result)) {
    change += part.weight * changes(part.response);
  }
  return change;
}

std::string inaccuracy(DesignProblem& design, const Result& result, const Trust& trust) {
  const std::optional<ErrorBar> bar = optimum_error(design, result, trust);
  if (!bar) return "";
  const ProblemFile& file = design.file();
  const std::string of_objective =
      complaint(file, fmt::format("the optimum of {}", file.objective->response), *bar,
                std::abs(result.evaluation.objective), trust.failed_run);
  if (!of_objective.empty()) return of_objective;
  for (const OpenLimit& limit : open_limits(design, result, trust)) {
    const std::string of_limit =
        complaint(file, fmt::format("\"{}\", which is limited,", limit.response), limit.error,
                  limit.size, trust.failed_run);
    if (!of_limit.empty()) return of_limit;
  }
  return "";
}

std::string accuracy_text(DesignProblem& design, const Result& result, const Trust& trust) {
  const auto percent = [](double share) {
    return fmt::format("± {} %", significant(100.0 * share, 2));
  };
  std::string text =
      "to " + percent(relative_error(*result.error, std::abs(result.evaluation.objective)));
  for (const OpenLimit& limit : open_limits(design, result, trust)) {
    const double ratio = relative_error(limit.error, limit.size);
    if (ratio <= design.file().accuracy.target) continue;
    text += fmt::format(", the limit on \"{}\" to {}", limit.response, percent(ratio));
  }
  return text;
}

}  // namespace pleuel
