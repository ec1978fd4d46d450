#pragma once

#include <memory>

#include "core/joints/joint.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// A joint as a term of the system. The tangent at position level comes from
/// joint_linearization.hpp, at the other levels from dual numbers through joint_residual.hpp.
/// @param derivatives  of the joint's numbers with respect to the variables they depend on
std::unique_ptr<Term> make_joint_term(JointTopology topology, JointData<double> data,
                                      std::vector<DesignDerivative<JointData<double>>> derivatives);

}  // namespace pleuel
