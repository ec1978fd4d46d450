#include "core/trust/energy_balance.hpp"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "core/base/number_text.hpp"

namespace pleuel {

namespace {

/// Share of the energy in motion. Errors of order h² are a few times larger in peaks than in
/// energy.
constexpr double small_energy_error = 1e-2;
/// Where so much is missing, vibrations are not seen that the motion has.
constexpr double large_energy_error = 0.1;

/// ", or a drive or a load jumps": of what there is.
std::string what_may_jump(const Scene& scene) {
  const bool has_drive = std::any_of(scene.joints.begin(), scene.joints.end(),
                                     [](const Joint& joint) { return joint.drive.has_value(); });
  const bool has_spring = std::any_of(scene.loads.begin(), scene.loads.end(), [](const Load& load) {
    return std::holds_alternative<SpringDamper>(load.element) ||
           std::holds_alternative<JointForce>(load.element);
  });
  const bool has_load = std::any_of(scene.loads.begin(), scene.loads.end(), [](const Load& load) {
    return std::holds_alternative<PointForce>(load.element) ||
           std::holds_alternative<PointTorque>(load.element);
  });
  std::vector<std::string> names;
  if (has_drive) names.emplace_back("a drive");
  if (has_load) names.emplace_back("a load");
  if (has_spring) names.emplace_back("a spring or motor");
  return names.empty() ? "" : fmt::format(", or {} jumps", fmt::join(names, " or "));
}

}  // namespace

std::vector<Finding> check_energy_balance(const TrustedRun& run) {
  const double error = run.monitors.energy_error;
  if (error <= small_energy_error) return {};
  return {{fmt::format("energy is balanced to {} of the largest in the motion only: steps are "
                       "too long for what moves here{}. Compare with a smaller "
                       "/simulation/step.",
                       rough_percent(error), what_may_jump(run.problem.scene)),
           error > large_energy_error}};
}

}  // namespace pleuel
