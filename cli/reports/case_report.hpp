#pragma once

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/result.hpp"
#include "studies/uncertainty.hpp"

/// What is said of load cases at an optimum: which of them decide.
namespace pleuel {

/// The case that a constraint is of; empty where it holds in all cases alike.
std::string case_of(const ProblemFile& problem, std::size_t constraint);

/// The same for a table: "fast", "all", or "several" where it is made from some.
std::string cases_of_limit(const ProblemFile& problem, std::size_t constraint);

/// One a constraint: whether its value is the nearest to the limit, or the furthest beyond, of the
/// values in all cases.
std::vector<bool> deciding_constraints(const ProblemFile& problem, const Eigen::VectorXd& values);

/// The case whose mechanism is shown first: that with the largest share in an objective over cases;
/// of equal ones that whose limit costs most, then that whose limit is used most, then the one that
/// the verdict names.
std::size_t deciding_case(const ProblemFile& problem, const Result& result);

/// {"names", "shown", "objective": {CASE: value}, "shares": {CASE: share}}: the last two of an
/// objective over cases.
Json cases_document(const ProblemFile& problem, const Result& result);

/// A line with the objective in each case, and which decides; empty where it is the same in all.
std::string objective_in_cases(const ProblemFile& problem, const Result& result);

/// "trajectory-optimum-slow.csv": of a case in the file names of a run; unchanged without cases.
std::string name_of_case_file(const std::string& stem, const ProblemFile& load_case);

// Responses and limits that are made from several load cases, of one design.

/// {"deviation", "bounds", "shares", "gradients"} of one that scatters, to first order [SI].
Json uncertain_document(const ProblemFile& problem, const UncertainResponse& response);

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
