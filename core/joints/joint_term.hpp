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

/// What a joint does to its second body: the force [N], then the moment about its point [N m],
/// global axes (joint_residual.hpp).
/// @param q       local coordinates: first marker's, then second marker's
/// @param lambda  multipliers of its equations
/// For double, Dual and WideDual; compiled once.
template <class Scalar>
Eigen::Matrix<Scalar, 6, 1> joint_wrench(const JointTopology& topology,
                                         const JointData<Scalar>& data, double time,
                                         const Scalar* q, const Scalar* lambda);

}  // namespace pleuel
