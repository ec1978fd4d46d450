#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/model/scene_geometry.hpp"
#include "core/scene/problem_file.hpp"

/// Joints, drives and loads of a scene in words.
namespace pleuel {

/// A function of time as points of a curve [SI].
struct LawPoints {
  std::vector<double> times, values;

  double lowest() const;
  double highest() const;
};

/// From the start to the end, with the kinks and jumps of a table.
LawPoints law_points(const TimeFunction& function, double end_time, const Design<double>& design,
                     LawOf purpose);

/// "0 … 200 N"; "20 N" of what stays the same; "−5 … 5 mm".
/// @param si  unit of the values
std::string range_text(const LawPoints& points, const std::string& si);

/// Table: joint, kind, bodies, its freedoms, its drive.
std::string joints_text(const ProblemFile& problem);

/// Table: drives and loads, on what they act, their smallest and largest values from the start to the end. Empty
/// where there are none.
std::string actions_text(const ProblemFile& problem, const Eigen::VectorXd& x);

/// "stiffness 1000 N/m, damping 5 N s/m", what is zero left out: of springs and of joints' springs.
std::string spring_text(const SpringDamper& spring, const Design<double>& design);
std::string spring_text(const JointForce& force, const Design<double>& design);

}  // namespace pleuel
