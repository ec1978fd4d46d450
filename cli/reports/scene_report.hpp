#pragma once

#include "cli/text/json.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_file.hpp"
#include "core/start/degrees_of_freedom.hpp"

/// What `check` says of bodies and variables.
namespace pleuel {

/// [{"name", "mass", "elements", "coordinates"}]
Json bodies_document(const Model& model);
std::string bodies_text(const Model& model);

/// {"coordinates", "constraints", "drives", "free", "blocked_drives"}: how joints and drives hold the mechanism if
/// its bodies do not deform, at the start of the simulation.
Json freedoms_document(const DegreesOfFreedom& freedoms, const Model& model);
/// @param state  at which they were counted: with it the line names the bodies that move freely
std::string freedoms_text(const DegreesOfFreedom& freedoms, const Model& model,
                          const State* state = nullptr);
bool has_drives(const Model& model);

/// The bound at which a variable is, to a millionth of its range, or, where a bound is far away, of
/// that bound and the start: "lower", "upper", "both" where they are equal, or "" where it is at none.
std::string reached_bound(const DesignVariable& variable, double value);

/// Says how far assembly moved the mechanism from where the file places it; empty if it did not.
std::string assembly_text(const Analysis& analysis);

/// {NAME: {"start", "lower", "upper", "unit"}} [SI]
Json variables_document(const ProblemFile& problem);
/// {NAME: {"value", "unit", "lower", "upper", "start"}} [SI]: what read_design() reads.
Json variables_document(const ProblemFile& problem, const Eigen::VectorXd& x);
std::string variables_text(const ProblemFile& problem);

// Joints, drives and loads of a scene in words.

/// A function of time as points of a curve [SI].
struct LawPoints {
  std::vector<double> times, values;
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
