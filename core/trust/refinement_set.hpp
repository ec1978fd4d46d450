#pragma once

#include <vector>

#include "core/trust/error_bars.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Which other divisions of beams a question needs.
enum class Divisions {
  coarser,  ///< half the elements: the cheapest. Twice, where a beam has too few of them to be halved
  finer,    ///< twice the elements
  both
};

/// The runs that judge a simulation. Always there are two and four times the step. At a larger step
/// elements are fewer or more, and reduced beams have more modes; at four times the step the tolerance
/// of Newton's method is smaller, if it is not small already. Half and a quarter of the step are made
/// when they are asked for.
class RefinementSet {
 public:
  /// @param store     where the runs are kept, of a file
  /// @param at        how the simulation that is judged differs from the file
  /// @param problem   the file with that
  /// @param analysis  that is judged
  /// @param basis     times its step: where other elements are compared; 2 or 4
  RefinementSet(RefinedRuns& store, const Refinement& at, const ProblemFile& problem,
                const Analysis& analysis, Divisions divisions, double basis);

  /// Makes the run with half the step; of one that is there already, with a quarter.
  void refine_steps();
  /// What of it a value can be judged by.
  const JudgingRuns& runs() const { return runs_; }
  /// The same for histories, which one step has, too.
  JudgingRuns runs_of_histories() const;
  /// Why a run failed; empty: none did.
  std::string failure() const;

 private:
  RefinedRuns& store_;
  Refinement at_;
  const Trajectory& similar_;
  std::vector<const RefinedRun*> made_;  ///< the first two: with twice and four times the step
  JudgingRuns runs_;
};

}  // namespace pleuel
