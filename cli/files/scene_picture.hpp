#pragma once

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"

/// What is drawn of a scene, as a document for the report (docs/report.md) [SI].
namespace pleuel {

/// What does not depend on the design: names, kinds, who is joined to whom, gravity, plane of
/// motion.
Json scene_picture(const ProblemFile& problem);

/// What does: bodies with their axes and the outlines of their sections, places of joints and loads
/// on the bodies, drives and loads over time.
Json geometry_picture(const ProblemFile& problem, const Eigen::VectorXd& x);

}  // namespace pleuel
