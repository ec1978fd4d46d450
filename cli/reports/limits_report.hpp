#pragma once

#include <string>

#include "cli/text/json.hpp"
#include "core/response/analysis.hpp"

/// How one simulated design stands to the limits of its problem, without the margins that
/// `deviations` ask for.
namespace pleuel {

/// {"value", "limit", "side", "unit", "utilisation", "kept"} of one limit [SI]
Json limit_document(const ProblemFile& problem, const ConstraintSettings& constraint, double value);

/// {NAME: {"value", "limit", "side", "unit", "utilisation", "kept"}} [SI]
Json limits_document(const ProblemFile& problem, const Eigen::VectorXd& x,
                     const Analysis& analysis);

/// A table of the same, and which limits are broken; empty without limits.
std::string limits_text(const ProblemFile& problem, const Eigen::VectorXd& x,
                        const Analysis& analysis);

/// As exactly as a verified optimum does.
bool keeps_limits(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis);

}  // namespace pleuel
