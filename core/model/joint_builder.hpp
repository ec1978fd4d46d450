#pragma once

#include "core/model/attachment.hpp"

namespace pleuel {

/// Topology, numbers and derivatives of a joint of the scene.
/// @param coordinates       of the whole system
/// @param first_multiplier  index in λ of its first equation
JointModel make_joint(const Joint& joint, const std::vector<BodyModel>& bodies,
                      const BuildContext& context, int coordinates, int first_multiplier);

/// The joint as a term of the system.
std::unique_ptr<Term> make_joint_term(const JointModel& joint, int coordinates);

}  // namespace pleuel
