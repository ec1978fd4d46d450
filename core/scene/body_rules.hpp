#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/scene/problem_file.hpp"
#include "core/scene/scene.hpp"

/// What the numbers of one body must keep among themselves at every design.
namespace pleuel {

/// size ≤ share · limit. Both are linear in the design variables, so it is what a linear constraint
/// of the optimization can keep.
struct SectionRule {
  const char* key;    ///< of the size in the file
  Number size;        ///< [m]
  const char* limit;  ///< "the radius"
  Number of;          ///< the dimension that the limit is a share of [m]
  double share = 1.0;
  const char* owner = "";  ///< " of the tube"
};

/// That walls fit into the outline, and what the formulas of a section hold for.
std::vector<SectionRule> section_rules(const Section& section);

/// `must not exceed …, got …` if a rule is broken by more than `tolerance`, relative.
std::optional<std::string> complaint(const SectionRule& rule, const Design<double>& design,
                                     double tolerance);

/// `must …` if no distribution of masses has these moments of inertia: no principal moment exceeds
/// the sum of the other two (as x² + y² ≤ (x² + z²) + (y² + z²)), and none is negative. A body that
/// gives its moment about one axis only, the other two zero, is let pass: it is meant for a motion
/// about this axis. Numbers may be rounded to three digits, and those of a plate are equal.
std::optional<std::string> inertia_complaint(const RigidBody& body, const Design<double>& design);

/// What makes a body impossible at a design: `its section's thickness must not exceed …`. More
/// tolerant than for what is read: an optimizer keeps linear constraints to its own tolerance, and
/// differences step across them. The formulas are smooth there.
std::optional<std::string> find_impossible(const Body& body, const Design<double>& design);

/// Corners of the bounds at which bodies are impossible, a sentence each, with the linear
/// constraint that would keep an optimizer away; one for each rule. Those that linear constraints
/// of the problem exclude are not named.
std::vector<std::string> impossible_corners(const ProblemFile& problem);

/// Where the points of bodies, joints and loads are that depend on design variables [m].
std::vector<Eigen::Vector3d> bound_points(const Scene& scene, const Design<double>& design);

}  // namespace pleuel
