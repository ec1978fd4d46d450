#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/text/json.hpp"
#include "core/base/error_bar.hpp"
#include "core/response/analysis.hpp"

/// How one simulated design stands to the limits of its problem, without the margins that
/// `deviations` ask for.
namespace pleuel {

/// {"value", "limit", "side", "unit", "utilisation", "kept"} of one limit [SI]
Json limit_document(const ProblemFile& problem, const ConstraintSettings& constraint,
                    const Eigen::VectorXd& x, double value);

/// {NAME: {"value", "limit", "side", "unit", "utilisation", "kept", "within_error"}} [SI]; the last of
/// those that are broken: whether by less than the error of the response
/// @param errors  of the responses; may be empty
Json limits_document(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                     const std::vector<std::optional<ErrorBar>>& errors);

/// A table of the same, and which limits are broken; empty without limits.
std::string limits_text(const ProblemFile& problem, const Eigen::VectorXd& x,
                        const Analysis& analysis,
                        const std::vector<std::optional<ErrorBar>>& errors);

/// As exactly as a verified optimum does.
bool keeps_limits(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis);

}  // namespace pleuel
