#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/trust/error_bars.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// What the file alone says against the numbers to come, at its start design: known before a long
/// run, and found again after it.
std::vector<Finding> check_before(const ProblemFile& problem);

/// What speaks most against the motion of a simulation that failed, up to some steps before it did;
/// nothing of a search for a motion that repeats itself, or of less than a step.
/// @param time  of the failure [s]
std::vector<Finding> findings_before_failure(ProblemFile problem, const Eigen::VectorXd& x,
                                             double time);

/// How far the numbers of a simulated design can be trusted.
struct Trust {
  std::vector<Finding> findings;  ///< the serious ones first
  /// One a response, none of those that are errors themselves or round-off; empty where the file
  /// leaves the check of resolution out.
  std::vector<std::optional<ErrorBar>> errors;
  std::vector<std::optional<Evidence>> evidence;  ///< of the errors by steps and elements
  std::vector<Eigen::VectorXd> bands;             ///< of histories (error_bars.hpp)
  std::string failed_run;                         ///< why a run that judges failed; empty: none did
};

Trust judge_run(const TrustedRun& run);

/// All findings about a simulated design, the serious ones first; every
/// command that shows numbers shows them. Each kind of finding has a file of its own beside this one.
std::vector<Finding> check_run(const TrustedRun& run);

/// The same with monitors of its own.
std::vector<Finding> check_run(const ProblemFile& problem, const Eigen::VectorXd& x,
                               const Analysis& analysis);

/// Their sentences.
std::vector<std::string> texts_of(const std::vector<Finding>& findings);

/// Whether one of them is serious.
bool has_serious(const std::vector<Finding>& findings);

}  // namespace pleuel
