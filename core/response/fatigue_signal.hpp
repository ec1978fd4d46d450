#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/response/station.hpp"

namespace pleuel {

/// What an amplitude of stress is compared with.
enum class AmplitudeStrength {
  endurance,  ///< endurance limit
  basquin     ///< fatigue strength of Basquin's line
};

/// What a mean stress is compared with.
enum class MeanStrength { ultimate, yield };

struct FatigueStrengths {
  AmplitudeStrength of_amplitude = AmplitudeStrength::endurance;
  MeanStrength of_mean = MeanStrength::ultimate;
};

/// Normal stress (axial and bending, signed) at fixed points of the sections of an elastic beam, two
/// channels a point: over what amplitudes, and over what mean stress is compared with (fatigue.hpp). On round outlines in space, where any point may
/// be the worst, there are 24 points 15° apart: between two of them stress is larger by 0.9 % at
/// most.
/// @pre the material has both
std::unique_ptr<Signal> make_fatigue_signal(const BodyModel& body, const Model& model,
                                            const FatigueStrengths& strengths,
                                            const StationChoice& stations);

}  // namespace pleuel
