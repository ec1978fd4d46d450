#pragma once

#include <list>

#include "core/trust/error_bars.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Which other divisions of beams a question needs.
enum class Divisions {
  coarser,  ///< half the elements: the cheapest. Twice, where a beam has too few of them to be halved
  finer,    ///< twice the elements
  both
};

/// The runs that judge a simulation, each kept for all that is asked of it. Always there are two and
/// four times the step. At twice the step, or four times where that is enough, elements are fewer or
/// more, and reduced beams have more modes; at four times the step the tolerance of Newton's method is
/// smaller, if it is not small already. Half and a quarter of the step are made when they are asked for.
class RefinementSet {
 public:
  /// @param analysis  that is judged
  /// @param coarse    with larger steps, if they are there already
  RefinementSet(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                Divisions divisions, const CoarseRuns* coarse = nullptr);

  /// Makes the run with half the step; of one that is there already, with a quarter.
  void refine_steps();
  /// What of it a value can be judged by.
  const JudgingRuns& runs() const { return runs_; }
  /// The same for histories, which one step has, too.
  JudgingRuns runs_of_histories() const;
  /// Why a run failed; empty: none did.
  std::string failure() const;

 private:
  const ProblemFile& problem_;
  const Eigen::VectorXd& x_;
  const Trajectory* similar_;
  std::list<RefinedRun> made_;  ///< the first two: with twice and four times the step
  JudgingRuns runs_;
};

}  // namespace pleuel
