#pragma once

#include <memory>
#include <string>

#include "core/model/model.hpp"
#include "core/response/signal.hpp"
#include "core/scene/problem_file.hpp"

/// Stress at points of a body that came with them, in a file. The model must outlive the signals.
namespace pleuel {

/// Von Mises [Pa], σ_xx (normal) [Pa], or von Mises over the strength (utilization).
/// @param at  a point or a group of points; empty: all
std::unique_ptr<Signal> make_point_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity, StressPart part,
                                                 const std::string& at);

/// Normal stress nᵀ σ n [Pa] on fixed planes through each point, one of which is the critical plane of
/// fatigue. Their normals n are 15° apart, the local x axis among them: what lies between is
/// larger by 1 − cos² 7.5° = 1.7 % at most, in space by some 3 %. In planar motion they are in the plane.
std::unique_ptr<Signal> make_plane_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity,
                                                 const std::string& at);

}  // namespace pleuel
