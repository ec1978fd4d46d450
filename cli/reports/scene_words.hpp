#pragma once

#include <string>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"

/// Joints, drives and loads of a scene in words.
namespace pleuel {

/// Table: joint, kind, bodies, its freedoms, its drive.
std::string joints_text(const ProblemFile& problem);

/// Table: drives and loads, on what they act, their smallest and largest values from the start to the end. Empty
/// where there are none.
std::string actions_text(const ProblemFile& problem, const Eigen::VectorXd& x);

/// "stiffness 1000 N/m, damping 5 N s/m", what is zero left out: of springs and of joints' springs.
std::string spring_text(const SpringDamper& spring, const Design<double>& design);
std::string spring_text(const JointForce& force, const Design<double>& design);

}  // namespace pleuel
