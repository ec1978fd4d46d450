#include "cli/reports/monitors_report.hpp"

#include <fmt/format.h>

#include "core/base/number_text.hpp"

namespace pleuel {

Json monitors_document(const Monitors& monitors) {
  return {{"position_drift", monitors.position_drift},
          {"velocity_drift", monitors.velocity_drift},
          {"energy_error", monitors.energy_error},
          {"elastic_energy_error", monitors.elastic_energy_error},
          {"elastic_rotation", monitors.elastic_rotation}};
}

std::string monitors_text(const Monitors& monitors, int multipliers) {
  std::string text;
  if (multipliers > 0) {
    text =
        fmt::format("Joints and drives are kept to {} m or rad, their rates to {} m/s or rad/s.\n",
                    magnitude(monitors.position_drift), magnitude(monitors.velocity_drift));
  }
  return text + fmt::format("Energy is balanced to {} of the largest energy in the motion.\n",
                            magnitude(monitors.energy_error));
}

}  // namespace pleuel
