#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/reports/document_table.hpp"
#include "cli/text/json.hpp"
#include "core/base/error_bar.hpp"
#include "core/response/analysis.hpp"

/// How one simulated design stands to the limits of its problem, without the margins that
/// `deviations` ask for.
namespace pleuel {

/// {"value", "limit", "side", "unit", "utilisation"} of the limit of a constraint that is nearer to its
/// value [SI]: how much of it is used, 1 = at the limit, where the ratio says something.
Json limit_entry(const ProblemFile& problem, const ConstraintSettings& constraint, double value);

/// The same with "kept".
Json limit_document(const ProblemFile& problem, const ConstraintSettings& constraint,
                    const Eigen::VectorXd& x, double value);

/// {NAME: {"value", "limit", "side", "unit", "utilisation", "kept", "within_error"}} [SI]; the last of
/// those that are broken: whether by less than the error of the response
/// @param errors  of the responses; may be empty
Json limits_document(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                     const std::vector<std::optional<ErrorBar>>& errors);

/// "kept", "BROKEN" of an entry of such a document.
DocumentColumn kept_column();

/// A table of limits_document(), and which limits are broken; empty without limits.
std::string limits_text(const ProblemFile& problem, const Json& limits);

/// As exactly as a verified optimum does.
/// @param limits  of limits_document()
bool keeps_limits(const Json& limits);

}  // namespace pleuel
