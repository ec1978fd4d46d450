#pragma once

#include <string>
#include <vector>

#include "core/scene/reading/json_node.hpp"
#include "core/scene/scene.hpp"

/// What the types of joints are called, and which of their coordinates a drive or load can act on.
namespace pleuel {

/// @throws InputError
JointType read_joint_type(const JsonNode& node);

/// As in a file: "point-on-line".
std::string name_of(JointType type);

/// None for fixed and spherical joints, two for a cylindrical joint, one for all others.
std::vector<DrivenCoordinate> drivable_coordinates(JointType type);

/// The coordinate that a drive or load of this joint acts on: the one that the key "coordinate" of
/// `node` says, which may be missing if there is only one. @throws InputError
DrivenCoordinate read_coordinate(const JsonNode& node, const Joint& joint);

/// Ends the reading: a joint with such coordinates is needed.
[[noreturn]] void fail_joint_type(const JsonNode& node, const Joint& joint,
                                  const std::vector<JointType>& needed);

/// Those with a coordinate that can be driven.
std::vector<JointType> drivable_types();

}  // namespace pleuel
