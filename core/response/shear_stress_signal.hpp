#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/response/station.hpp"

namespace pleuel {

/// Shear stress [Pa] of shear forces and torsion at the places of the sections of an elastic beam
/// where it can be the largest (ShearPoint), its magnitude. Of motion in a plane the place that the
/// shear force of this plane makes the largest.
/// @pre all sections have such places
std::unique_ptr<Signal> make_shear_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity,
                                                 const StationChoice& stations);

}  // namespace pleuel
