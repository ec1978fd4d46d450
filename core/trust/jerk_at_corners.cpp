#include "core/trust/jerk_at_corners.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/response/peak_place.hpp"
#include "core/scene/response_kind.hpp"
#include "core/scene/time_breaks.hpp"
#include "core/trust/asked_responses.hpp"

namespace pleuel {

namespace {

/// For so many steps behind a corner the ringing is more than a percent (0.8ⁿ).
constexpr double restless_steps = 20.0;

/// The corner that a peak belongs to [s].
std::optional<double> corner_at(const std::vector<double>& corners, double peak, double step) {
  for (const double corner : corners) {
    if (peak >= corner - 1.5 * step && peak <= corner + restless_steps * step) return corner;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Finding> check_jerks_at_corners(const TrustedRun& run) {
  const Trajectory& trajectory = run.analysis.trajectory;
  if (run.problem.simulation.formulation.constraints == ConstraintForm::index_1) return {};
  std::vector<double> corners;
  for (const Joint& joint : run.problem.scene.joints) {
    if (!joint.drive) continue;
    const std::vector<double> times =
        sharp_times(joint.drive->motion, trajectory.time(trajectory.steps()));
    corners.insert(corners.end(), times.begin(), times.end());
  }
  std::vector<Finding> findings;
  for (const std::size_t i : asked_parts(run.problem)) {
    const std::optional<ResponseType> rate_of = kind_of(run.problem.responses[i].type).rate_of;
    const bool is_jerk =
        rate_of == ResponseType::acceleration || rate_of == ResponseType::angular_acceleration;
    const auto peak = is_jerk ? find_peak(run.problem, run.analysis, i) : std::nullopt;
    if (!peak) continue;
    const auto corner = corner_at(corners, peak->time, trajectory.scheme.step);
    if (!corner) continue;
    const std::string& name = run.analysis.responses[i].name;
    findings.push_back(
        {fmt::format(
             "the peak of the jerk \"{}\" is at a corner in the acceleration of a drive (t = "
             "{:.4g} s): the accelerations ring there, and the jerk is wrong by up to a "
             "third of its jump there with any step. Take the /simulation/formulation \"index-1\", "
             "or a law "
             "without a corner there.",
             name, *corner),
         true,
         {name}});
  }
  return findings;
}

}  // namespace pleuel
