#pragma once

#include <string>

#include "cli/text/json.hpp"
#include "core/response/analysis.hpp"
#include "core/start/degrees_of_freedom.hpp"

/// What `check` says of bodies and variables.
namespace pleuel {

/// [{"name", "mass", "elements", "coordinates"}]
Json bodies_document(const Model& model);
std::string bodies_text(const Model& model);

/// {"coordinates", "constraints", "drives", "free", "blocked_drives"}: how joints and drives hold the mechanism if
/// its bodies do not deform, at the start of the simulation.
Json freedoms_document(const DegreesOfFreedom& freedoms, const Model& model);
std::string freedoms_text(const DegreesOfFreedom& freedoms, const Model& model);

enum class ReachedBound { none, lower, upper, both };

/// The bound at which a variable is, to a millionth of its range, or, where a bound is far away, of
/// that bound and the start; both where they are equal.
ReachedBound reached_bound(const DesignVariable& variable, double value);

/// "lower", "upper", "both", or "" where it is at none.
const char* to_string(ReachedBound reached);

/// Says how far assembly moved the mechanism from where the file places it; empty if it did not.
std::string assembly_text(const Analysis& analysis);

/// {NAME: {"start", "lower", "upper", "unit"}} [SI]
Json variables_document(const ProblemFile& problem);
/// {NAME: {"value", "unit", "lower", "upper", "start"}} [SI]: what read_design() reads.
Json variables_document(const ProblemFile& problem, const Eigen::VectorXd& x);
std::string variables_text(const ProblemFile& problem);

}  // namespace pleuel
