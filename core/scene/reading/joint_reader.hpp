#pragma once

#include "core/scene/joint_kind.hpp"
#include "core/scene/reading/json_node.hpp"

/// Which coordinates of a joint a drive or load can act on.
namespace pleuel {

/// The coordinate that a drive or load of this joint acts on: the one that the key "coordinate" of
/// `node` says, which may be missing if there is only one. @throws InputError
DrivenCoordinate read_coordinate(const JsonNode& node, const Joint& joint);

/// @throws InputError unless the joint has an angle or a displacement of one body against the other,
/// which loads act along and responses look at. A distance has none.
void check_coordinate_between_bodies(const JsonNode& node, const Joint& joint);

}  // namespace pleuel
