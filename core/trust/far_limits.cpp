#include "core/trust/far_limits.hpp"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

constexpr double far = 1e4;

/// The limit that a value exceeds or misses by far.
std::optional<double> far_limit(const ConstraintSettings& constraint, double value) {
  const double size = std::abs(value);
  if (constraint.upper && value > *constraint.upper && size > far * std::abs(*constraint.upper)) {
    return constraint.upper;
  }
  if (constraint.lower && value < *constraint.lower && far * size < std::abs(*constraint.lower)) {
    return constraint.lower;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> far_limit_text(const ProblemFile& problem,
                                          const ConstraintSettings& constraint, double value) {
  if (constraint.response.empty() || !std::isfinite(value)) return std::nullopt;
  const std::optional<double> limit = far_limit(constraint, value);
  // A limit of zero is meant: any value is beyond it by far.
  if (!limit || *limit == 0.0 || value == 0.0) return std::nullopt;
  const std::string si = unit_of(problem, constraint).si, unit = si == "1" ? "" : " " + si;
  return fmt::format(
      "the limit of \"{}\" is {:.4g}{}, and the value {:.4g}{}: {:.1g} times as much. Is a unit "
      "missing, or another one meant?",
      constraint.name, *limit, unit, value, unit, std::abs(value / *limit));
}

std::vector<Finding> check_far_limits(const TrustedRun& run) {
  std::vector<Finding> findings;
  const Eigen::VectorXd values = values_of(run.analysis);
  for (const ConstraintSettings& constraint : run.problem.constraints) {
    const auto index = index_of_named(run.problem.responses, constraint.response);
    if (!index) continue;
    const auto text = far_limit_text(run.problem, constraint, values(*index));
    if (text) findings.push_back({*text, false, {constraint.response}});
  }
  return findings;
}

}  // namespace pleuel
