#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/response/station.hpp"

namespace pleuel {

/// A section force of a beam [N] or [N m], as stress is made from them.
std::unique_ptr<Signal> make_section_force_signal(const BodyModel& body,
                                                  const Eigen::Vector3d& gravity,
                                                  SectionForcePart part,
                                                  const StationChoice& stations);

}  // namespace pleuel
