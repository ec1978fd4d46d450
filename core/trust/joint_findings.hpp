#pragma once

#include <string>
#include <vector>

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Joints that would constrain a motion twice if they were aligned exactly, and are so nearly: a
/// motion is blocked by what is hardly a number of the file, with forces that are the larger the
/// smaller it is.
std::vector<Finding> check_misaligned_joints(const TrustedRun& run);

/// Springs in joints in space that turn farther than half a turn from where they began: there the
/// angle is counted from −π to π, where motion in a plane counts whole turns, and the moment jumps.
std::vector<Finding> check_joint_turns(const TrustedRun& run);

/// Drives that no rigid motion follows, since joints or other drives hold already what they move:
/// all that moves then does so because bodies bend. That may be meant, of a press fit say; mostly a
/// joint has a freedom too few, or a drive is too many.
std::vector<Finding> check_blocked_drives(const TrustedRun& run);

/// Drives that stand still where nothing else acts: numbers that are round-off.
std::vector<Finding> check_rest(const TrustedRun& run);

/// The finding at a state; empty if there is none.
std::string blocked_drives_text(const Model& model, const State& state);

/// Reactions of joints that hold more than they have to, as two hinges of a door do: the equations
/// of motion do not say which one takes how much (redundancy.hpp).
std::vector<Finding> check_undetermined_reactions(const TrustedRun& run);

}  // namespace pleuel
