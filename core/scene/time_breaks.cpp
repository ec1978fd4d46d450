#include "core/scene/time_breaks.hpp"

#include <algorithm>
#include <limits>

namespace pleuel {

namespace {

/// Steps between points of a table that are resolved one by one.
constexpr double sparse = 4.0;

double closest(const std::vector<double>& times, std::size_t i) {
  double distance = std::numeric_limits<double>::infinity();
  if (i > 0) distance = times[i] - times[i - 1];
  if (i + 1 < times.size()) distance = std::min(distance, times[i + 1] - times[i]);
  return distance;
}

/// @param is_smooth  whether an interpolation is smooth enough at inner points
void add_breaks(const TimeFunction& function, double step, bool (*is_smooth)(Interpolation),
                std::vector<double>& breaks) {
  const auto* table = std::get_if<TableFunction>(&function);
  if (!table) return;
  const std::vector<double>& times = table->times;
  const double least =
      table->interpolation == Interpolation::step ? 0.0 : sparse * step * (1.0 - 1e-9);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool is_inner = i > 0 && i + 1 < times.size();
    if (is_inner && is_smooth(table->interpolation)) continue;
    if (closest(times, i) >= least) breaks.push_back(times[i]);
  }
}

void add_load_breaks(const TimeFunction& function, double step, std::vector<double>& breaks) {
  add_breaks(
      function, step,
      [](Interpolation interpolation) {
        return interpolation == Interpolation::monotone || interpolation == Interpolation::spline;
      },
      breaks);
}

}  // namespace

std::vector<double> time_breaks(const Scene& scene, double step) {
  std::vector<double> breaks;
  for (const Joint& joint : scene.joints) {
    if (!joint.drive) continue;
    add_breaks(
        joint.drive->motion, step, [](Interpolation) { return false; }, breaks);
  }
  for (const Load& load : scene.loads) {
    if (const auto* force = std::get_if<PointForce>(&load.element)) {
      add_load_breaks(force->value, step, breaks);
    } else if (const auto* torque = std::get_if<PointTorque>(&load.element)) {
      add_load_breaks(torque->value, step, breaks);
    } else if (const auto* joint = std::get_if<JointForce>(&load.element)) {
      if (joint->motor) add_load_breaks(*joint->motor, step, breaks);
    }
  }
  return breaks;
}

}  // namespace pleuel
