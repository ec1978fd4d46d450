#include "core/response/vibration_state.hpp"

#include "core/base/error.hpp"

namespace pleuel {

VibrationState vibration_state(Mechanism& mechanism) {
  if (mechanism.elastic.empty()) return {initial_state(mechanism), ""};
  try {
    return {equilibrium_state(mechanism), ""};
  } catch (const SimulationError& error) {
    return {initial_state(mechanism), error.what()};
  }
}

}  // namespace pleuel
