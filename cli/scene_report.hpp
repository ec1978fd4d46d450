#pragma once

#include <string>

#include "cli/json.hpp"
#include "core/model/model.hpp"

/// What `check` says of bodies and variables.
namespace pleuel {

/// [{"name", "mass", "elements", "coordinates"}]
Json bodies_document(const Model& model);
std::string bodies_text(const Model& model);

/// {NAME: {"start", "lower", "upper", "unit"}} [SI]
Json variables_document(const ProblemFile& problem);
/// {NAME: {"value", "unit", "lower", "upper", "start"}} [SI]: what read_design() reads.
Json variables_document(const ProblemFile& problem, const Eigen::VectorXd& x);
std::string variables_text(const ProblemFile& problem);

}  // namespace pleuel
