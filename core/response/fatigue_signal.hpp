#pragma once

#include <memory>

#include "core/base/strengths.hpp"
#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// What an amplitude and a mean stress are compared with.
struct CycleStrengths {
  double Strengths<double>::*of_amplitude = &Strengths<double>::endurance_limit;
  double Strengths<double>::*of_mean = &Strengths<double>::ultimate;
};

/// Two channels for each of a stress: over what amplitudes, and over what mean stress is compared with
/// (fatigue.hpp).
/// @param stress  normal, signed, at points that stay where they are [Pa]
/// @pre the material has both strengths
std::unique_ptr<Signal> make_fatigue_signal(std::unique_ptr<Signal> stress, const BodyModel& body,
                                            int variables, const CycleStrengths& strengths);

}  // namespace pleuel
