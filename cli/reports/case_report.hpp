#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/text/json.hpp"
#include "core/scene/problem_file.hpp"
#include "optimization/result.hpp"

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

}  // namespace pleuel
