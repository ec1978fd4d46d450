#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/scene/problem_file.hpp"

namespace pleuel {

/// Stress at the points of a body that came with them, in a file [Pa]: von Mises,
/// σ_xx (normal), or von Mises over the strength (utilization). The model must outlive the signal.
std::unique_ptr<Signal> make_point_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity, StressPart part);

}  // namespace pleuel
