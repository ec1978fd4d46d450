#pragma once

#include <memory>

#include "core/base/strengths.hpp"
#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/response/station.hpp"

namespace pleuel {

/// What an amplitude and a mean stress are compared with.
struct CycleStrengths {
  double Strengths<double>::*of_amplitude = &Strengths<double>::endurance_limit;
  double Strengths<double>::*of_mean = &Strengths<double>::ultimate;
};

/// Normal stress (axial and bending, signed) [Pa] at fixed points of the sections of an elastic beam.
/// On round outlines in space, where any point may be the worst, there are 24 points 15° apart:
/// between two of them stress is larger by 0.9 % at most.
std::unique_ptr<Signal> make_fixed_point_signal(const BodyModel& body,
                                                const Eigen::Vector3d& gravity,
                                                const StationChoice& stations);

/// Two channels for each of a stress: over what amplitudes, and over what mean stress is compared with
/// (fatigue.hpp).
/// @param stress  of fixed points [Pa]
/// @pre the material has both strengths
std::unique_ptr<Signal> make_fatigue_signal(std::unique_ptr<Signal> stress, const BodyModel& body,
                                            int variables, const CycleStrengths& strengths);

}  // namespace pleuel
