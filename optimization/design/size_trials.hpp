#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "optimization/design/staged_solve.hpp"

/// Choices of sizes that are tried, each a task of its own (core/jobs/tasks.hpp).
namespace pleuel {

/// A choice that was tried.
struct SizeTrial {
  Eigen::VectorXd x;  ///< [SI]
  double objective = 0.0, max_violation = std::numeric_limits<double>::infinity();
  Eigen::VectorXd constraints = {};
  History history = {};
  double seconds = 0.0;

  bool has_failed() const { return constraints.size() == 0 && !std::isfinite(max_violation); }
  bool keeps_limits() const { return max_violation <= Tolerances().violation; }
};

/// Keeps the limits and is lighter, or breaks them less.
bool is_better(const SizeTrial& one, const SizeTrial& other);

/// Whether each choice has to be optimized: there are other variables, or margins that follow from
/// gradients.
bool needs_optimization(const ProblemFile& file);

/// The problem with the sizes of a design fixed. Its start stays: what the model decides there stays
/// too.
ProblemFile with_sizes(ProblemFile file, const Eigen::VectorXd& x);

/// Simulates each design, or optimizes the other variables from it (needs_optimization()).
/// @param scales  of the constraints: what violations are relative to
/// @return        in the order of the designs; one whose task failed has a failure in its history
std::vector<SizeTrial> try_sizes(const ProblemFile& file,
                                 const std::vector<Eigen::VectorXd>& designs,
                                 const Eigen::VectorXd& scales, const SolveOptions& options,
                                 const Execution& execution);

/// The designs that are tried, made again on another rank (PackedWork).
inline constexpr const char* trial_work_name = "trials";
std::unique_ptr<TaskWork> make_trial_work(const std::string& content);

}  // namespace pleuel
