#include "core/trust/promised_buckling.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/trust/load_factor.hpp"

namespace pleuel {

namespace {

/// When a history is largest, within the window of its response.
int instant_of_peak(const TrustedRun& run, std::size_t response) {
  const ResponseSettings& settings = run.problem.responses[response];
  const Eigen::VectorXd& time = run.analysis.trajectory.time;
  const Eigen::MatrixXd& history = run.analysis.histories[response];
  int peak = -1;
  for (int n = 0; n < int_size(time); ++n) {
    const bool is_within =
        time(n) >= settings.from.value_or(time(n)) && time(n) <= settings.to.value_or(time(n));
    if (is_within && (peak < 0 || history(0, n) > history(0, peak))) peak = n;
  }
  return peak;
}

/// The smallest upper limit on a response, or one half.
double largest_allowed(const ProblemFile& problem, const std::string& response) {
  std::optional<double> allowed;
  for (const ConstraintSettings& limit : problem.constraints) {
    if (limit.response != response || !limit.upper) continue;
    allowed = std::min(allowed.value_or(*limit.upper), *limit.upper);
  }
  return allowed.value_or(0.5);
}

}  // namespace

std::vector<Finding> check_promised_buckling(const TrustedRun& run) {
  constexpr double notable = 1.1;
  const auto& responses = run.problem.responses;
  const bool is_asked = std::any_of(responses.begin(), responses.end(), [](const auto& response) {
    return response.type == ResponseType::buckling;
  });
  if (!is_asked) return {};
  const LoadFactor load_factor(run.problem, run.x, run.analysis);
  if (!load_factor.is_known()) return {};
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const ResponseSettings& response = responses[i];
    if (response.type != ResponseType::buckling) continue;
    const int peak = instant_of_peak(run, i);
    if (peak < 0) continue;
    const double promised = run.analysis.histories[i](0, peak);
    const double factor = load_factor.at(peak);
    const double allowed = largest_allowed(run.problem, response.name);
    if (!(factor > 0.0) || 1.0 / factor < std::max(allowed, notable * promised)) continue;
    findings.push_back(
        {fmt::format(
             "\"{0}\" takes \"{1}\" by itself, pinned at both ends: it would buckle at "
             "{2:.3g} times what presses it at t = {3:.4g} s. Together with the bodies that "
             "it is connected to, something buckles at {4:.3g} times the loads of that "
             "instant. For {5:.3g} times limit \"{0}\" to some {6:.2g}.",
             response.name, response.bodies.front(), 1.0 / promised,
             run.analysis.trajectory.time(peak), factor, 1.0 / allowed,
             promised * factor * allowed),
         false,
         {response.name}});
  }
  return findings;
}

}  // namespace pleuel
