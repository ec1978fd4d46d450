#pragma once

#include "optimization/evaluation_store.hpp"
#include "optimization/solve.hpp"
#include "studies/accuracy.hpp"

/// What accuracy costs where it is needed: whole optimizations with several settings.
namespace pleuel {

/// An optimization from the start of the file with one setting.
struct OptimumRun {
  Discretization settings;
  std::string failure;  ///< why there is no design within the limits; empty: there is one
  Status status = Status::failed;
  Eigen::VectorXd x;       ///< [SI]
  double objective = 0.0;  ///< [SI]
  double change = 0.0;     ///< of the objective against the reference [SI]
  double seconds = 0.0;  ///< processor time of the optimization, the least of a few if it is short
  int evaluations = 0;

  bool has_failed() const { return !failure.empty(); }
};

struct OptimumStudy {
  /// With the setting of the study's reference, from the optimum that is known.
  OptimumRun reference;
  /// What the reference itself may be off by [SI]: by Richardson and by another formulation, both
  /// through the envelope theorem, and by the tolerance of the optimizer. None without prices.
  std::optional<double> reference_error;
  std::vector<OptimumRun> runs;
  bool is_interrupted = false;

  /// |change| of a run, or the error of the reference if that is more; relative.
  double relative_error(const OptimumRun& run) const;
  double relative_floor() const;
};

using OptimumObserver = std::function<void(const OptimumRun&)>;

/// The settings of a study that are worth an optimization, at most six: those that are recommended,
/// and those than which no other is both faster and more accurate in what counts.
std::vector<Discretization> efficient_settings(const AccuracyStudy& study);

/// Optimizes with each efficient setting, and with the reference.
/// @param study   of the problem at its optimum
/// @param x       that optimum, with the setting of the file
/// @param parts   runs that are known; may be null
/// @throws InputError if the problem has no variables or no objective
/// @throws Stopped if a stop was asked for before the reference was done
OptimumStudy optimum_study(const ProblemFile& problem, const Eigen::VectorXd& x,
                           const AccuracyStudy& study, const SolveOptions& options,
                           const OptimumObserver& observer = {}, PartStore* parts = nullptr);

/// The optimum of a problem from its start, without the checks of its resolution.
/// @param store  evaluations that are known; may be null
Result plain_optimum(ProblemFile problem, const SolveOptions& options,
                     EvaluationStore* store = nullptr);

}  // namespace pleuel
