#include "cli/monitors_report.hpp"

#include <fmt/format.h>

#include "cli/number_text.hpp"

namespace pleuel {

namespace {

/// Elastic rotations [rad] beyond which deformation is not small.
constexpr double small_rotation = 0.2;
/// Share of the energy in motion. Errors of order h² are a few times larger in peaks than in
/// energy.
constexpr double small_energy_error = 1e-2;

}  // namespace

Json monitors_document(const Monitors& monitors) {
  return {{"position_drift", monitors.position_drift},
          {"velocity_drift", monitors.velocity_drift},
          {"energy_error", monitors.energy_error},
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

std::vector<std::string> doubts(const Monitors& monitors) {
  std::vector<std::string> sentences;
  if (monitors.elastic_rotation > small_rotation) {
    sentences.push_back(fmt::format(
        "\"{}\" bends until it has turned by {} rad against its frame: too far for linear "
        "elasticity, which is good for some {:g} rad. Do not trust these numbers.",
        monitors.most_bent, significant(monitors.elastic_rotation), small_rotation));
  }
  if (monitors.energy_error > small_energy_error) {
    sentences.push_back(fmt::format(
        "energy is balanced to {} of the largest in the motion only: steps are too long for what "
        "moves here, or a drive jumps. Compare with a smaller /simulation/step.",
        percent(monitors.energy_error)));
  }
  return sentences;
}

std::string warnings_text(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += fmt::format("Warning: {}\n", warning);
  return text;
}

}  // namespace pleuel
