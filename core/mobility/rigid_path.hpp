#pragma once

#include <functional>

#include <Eigen/Core>

#include "core/mobility/rigid_constraints.hpp"

namespace pleuel {

/// How far bodies that do not deform follow the drives.
struct RigidPath {
  enum class End {
    followed,  ///< to the end of the motion
    bends,     ///< joints leave drives no motion: what moves bends
    locks      ///< the drives could be followed up to a time, and not beyond it
  };
  End end = End::followed;
  double time = 0.0;    ///< [s] up to which they are followed
  double travel = 0.0;  ///< of the drives, relative to lengths or in radians
  Eigen::VectorXd q;    ///< positions then
  /// Where it locks: how bodies still move there while the drives nearly stand still, the last
  /// change of z (RigidConstraints).
  Eigen::VectorXd still_moves = {};
  /// Where it locks: by how much joints are apart at least when the drives go on, where that is
  /// worst [m] (RigidConstraints::gap())
  double gap = 0.0;
};

/// Hears of the positions on the way.
using PathObserver = std::function<void(double time, const Eigen::VectorXd& q)>;

/// Follows the drives of a mechanism over time by continuation (Allgower & Georg, Introduction to
/// Numerical Continuation Methods, 2003). Steps are quartered where positions are not where the
/// tangent points to, or where det Φ_z changes its sign: so the branch is kept that goes straight
/// on, and gaps in it are seen that a step would jump over; those that rounded dimensions leave are
/// passed. Where a step fails, however short, other branches
/// that begin there are tried; where there is none it locks, unless drives had no motion of their
/// own before: then it bends.
/// @param end   [s]
/// @param step  [s] a first step; the steps of a simulation
RigidPath follow_drives(RigidConstraints& constraints, const Eigen::VectorXd& start, double end,
                        double step, const PathObserver& observer = {});

}  // namespace pleuel
