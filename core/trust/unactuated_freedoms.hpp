#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/scene/scene.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Bodies that can move freely although nothing is there to move them: a joint or a drive may have
/// been forgotten.
///
/// A body is acted on if its free motion does work against its weight, a load, a spring, a damper
/// or a motor, or if the file gives it a velocity. Free motions of the mechanism (all drives held)
/// that move only bodies on which nothing acts are idle: at most inertia moves them. They are
/// looked for in a position near the start that is no special one. Of a mechanism with drives those
/// are told, too, on which only weight acts: a linkage that hangs where a joint is missing.
///
/// Not idle: a mechanism that touches the ground nowhere but moves; the spin of a body about an
/// axis through its centre of mass, where its joints are points or the body moves otherwise (a rod
/// between ball joints, a roller).
std::vector<Finding> check_unactuated_freedoms(const TrustedRun& run);

/// Bodies without a way of joints and springs to the ground, where others have one, that nobody has
/// given a velocity or a load.
std::vector<Finding> check_unconnected_bodies(const TrustedRun& run);

/// Names of the bodies that joints, springs and each other tie to the ground.
std::set<std::string> grounded_bodies(const Scene& scene);

/// Whether the file gives a body a velocity at the start.
bool has_given_velocity(const Body& body, const std::vector<double>& design);

/// Whether a force or a torque acts on a body.
bool has_load(const Scene& scene, const std::string& body);

}  // namespace pleuel
