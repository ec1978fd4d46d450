#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/scene/scene.hpp"

namespace pleuel {

/// Names of the bodies that joints, springs and each other tie to the ground.
std::set<std::string> grounded_bodies(const Scene& scene);

/// Whether the file gives a body a velocity at the start.
bool has_given_velocity(const Body& body, const std::vector<double>& design);

/// Whether a force or a torque acts on a body.
bool has_load(const Scene& scene, const std::string& body);

}  // namespace pleuel
