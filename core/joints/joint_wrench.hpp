#pragma once

#include "core/joints/joint.hpp"

namespace pleuel {

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
