#pragma once

#include <string>

#include <Eigen/Core>

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"

/// Responses and limits that are made from several load cases, of one design.
namespace pleuel {

/// From the documents of the cases, as `simulate`, `gradient` or `uncertainty` gives them:
/// {"responses": {NAME: {"value", "unit", "gradients"}}, "constraints": {NAME: {"value", …}}}, the
/// gradients if the cases have them; of `uncertainty` {"value", "unit", "deviation", "bounds",
/// "shares", "gradients"} to first order. Null where the file has no such numbers. What has no finite
/// value, or no derivative, has an "error" that says why.
/// @param cases  {CASE: document}
Json over_cases_document(const ProblemFile& joined, const Eigen::VectorXd& x, const Json& cases);

/// A table of the same; empty where there are none.
std::string over_cases_text(const ProblemFile& joined, const Json& document);

/// Whether one of them has an error.
bool lacks_numbers(const Json& document);

}  // namespace pleuel
