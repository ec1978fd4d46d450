#include "optimization/design/linear_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/body_frequency.hpp"
#include "optimization/design/peak_windows.hpp"
#include "optimization/linear_choice.hpp"

namespace pleuel {

void require_linear_limits(const ProblemFile& file) {
  std::vector<const ConstraintSettings*> linear;
  for (const ConstraintSettings& limit : file.constraints) {
    if (!limit.linear.empty()) linear.push_back(&limit);
  }
  if (linear.empty()) return;
  constexpr double none = std::numeric_limits<double>::infinity();
  const Eigen::Index count = std::ssize(linear), variables = std::ssize(file.variables);
  LinearLimits limits{Eigen::MatrixXd::Zero(count, variables), Eigen::VectorXd(count),
                      Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    for (const auto& [variable, factor] : linear[i]->linear) limits.rows(i, variable) += factor;
    limits.lower(i) = linear[i]->lower.value_or(-none);
    limits.upper(i) = linear[i]->upper.value_or(none);
  }
  Eigen::VectorXd lower(variables), upper(variables);
  for (Eigen::Index k = 0; k < variables; ++k) {
    lower(k) = file.variables[k].lower;
    upper(k) = file.variables[k].upper;
  }
  std::vector<std::string> names;
  for (const std::size_t i : linear_conflict(limits, lower, upper)) {
    names.push_back(linear[i]->name);
  }
  if (names.empty()) return;
  throw InputError(
      fmt::format("/constraints: no design within the bounds of the variables keeps the linear "
                  "limit{} \"{}\"{}",
                  names.size() == 1 ? "" : "s", fmt::join(names, "\", \""),
                  names.size() == 1 ? "" : " together"));
}

namespace {

/// Relative difference of frequencies that meet, as far as a search that stalls comes to the kink.
constexpr double meeting = 1e-3;

/// The natural frequency of a mode of what a response looks at [rad/s]; none if there is no such
/// mode.
std::optional<double> frequency_of_mode(const Analysis& analysis, const ResponseSettings& response,
                                        int number) {
  if (number < 0) return std::nullopt;
  if (response.bodies.empty()) {
    const Eigen::VectorXd& all = analysis.mechanism_frequencies;
    return number < all.size() ? std::optional(all(number)) : std::nullopt;
  }
  const Model& model = model_of_modes(analysis);
  const BodyModel& body = model.body(response.bodies.front());
  if (number >= body.elastic_size()) return std::nullopt;
  return std::sqrt(body_mode(body, {number}).square);
}

bool meets_another(const Analysis& analysis, const ResponseSettings& response) {
  if (response.type != ResponseType::frequency || response.mode.axis) return false;
  const double shown = *frequency_of_mode(analysis, response, response.mode.number);
  return std::ranges::any_of(std::array{-1, 1}, [&](int step) {
    const auto other = frequency_of_mode(analysis, response, response.mode.number + step);
    return other && std::abs(*other - shown) <= meeting * std::abs(shown);
  });
}

}  // namespace

std::string advise_on_meeting_frequencies(DesignProblem& design, const Eigen::VectorXd& x) {
  std::vector<std::string> names;
  try {
    for (std::size_t c = 0; c < design.case_count(); ++c) {
      DesignCase& one = design.load_case(c);
      for (const std::size_t response : optimized_responses(design, c)) {
        const ResponseSettings& settings = one.file().responses[response];
        if (!meets_another(one.analysis_at(x), settings)) continue;
        if (std::ranges::find(names, settings.name) == names.end()) names.push_back(settings.name);
      }
    }
  } catch (const SimulationError&) {
    return {};
  }
  if (names.empty()) return {};
  return fmt::format(
      "{} coincide{} with the frequency of another mode, which makes a kink: ask for the lowest "
      "mode "
      "along each axis instead (\"direction\" \"y\", and \"z\") and limit each, or their min()",
      fmt::join(names, " and "), names.size() == 1 ? "s" : "");
}

}  // namespace pleuel
