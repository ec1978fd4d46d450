#pragma once

#include <string>

#include "core/base/error.hpp"
#include "core/mobility/rigid_path.hpp"

namespace pleuel {

/// A drive that rigid bodies follow at the start and cannot follow to the end.
class LockedMechanism : public SimulationError {
 public:
  using SimulationError::SimulationError;
};

/// Follows the drives of a model; without drives there is nothing to follow.
/// @param end   [s] of the motion
/// @param step  [s] of the simulation
RigidPath follow_drives(const Model& model, double end, double step,
                        const PathObserver& observer = {});

/// When it locks, where, which bodies are at a dead centre there, and by how much they miss.
std::string lock_text(const Model& model, const RigidPath& path);

/// The joints that are driven: "bearing", "pin".
std::string names_of_drives(const Model& model);

/// What is said where rigid bodies cannot follow the drives from the start.
std::string bending_text(const Model& model);

/// @throws LockedMechanism if it locks
void require_no_lock(const Model& model, const RigidPath& path);

}  // namespace pleuel
