#pragma once

#include "optimization/design/staged_solve.hpp"

/// Optimization with sizes that are chosen from lists (DesignVariable::choices).
namespace pleuel {

/// What choosing sizes came to.
struct SizeChoiceReport {
  Status relaxed_status = Status::failed;  ///< of the continuous optimum
  double relaxed_objective = 0.0;          ///< [SI]
  Eigen::VectorXd relaxed_x;               ///< [SI]
  double combinations = 1.0;               ///< of all lists
  int tried = 0;                           ///< of them
  int feasible = 0;                        ///< of those
  bool is_exhaustive = false;              ///< all were tried
  bool is_choice = false;                  ///< whether the design is one of them
  bool are_lists_tried = false;            ///< with any other size in place of each one of it

  /// Of the objective, relative to the continuous optimum; positive: choosing costs that much.
  double penalty(double objective) const;
};

/// Choices that are all tried where each costs a simulation.
inline constexpr double most_simulated_choices = 300.0;

/// Whether some variables are chosen from lists.
bool has_choices(const ProblemFile& file);

/// Whether sizes of the design are all chosen from the lists.
bool keeps_choices(const ProblemFile& file, const Eigen::VectorXd& x);

/// Takes the optimum between the sizes (of numbers: between the smallest and the largest; of
/// sections: along a path through all of the list, see section_choices.hpp) to a choice of sizes.
/// Every choice is a design of that continuous problem too, so none can be better than its global
/// optimum.
///
/// - Where there are few choices (300, or 16 if other variables are optimized for each), all are tried.
/// - Else from the best design so far a linear model (in reciprocals where limits fall as a size grows)
///   says which choices of sizes around it may be better (linear_choice.hpp); these are simulated, and
///   it begins anew from the best, until no neighbour is better: each size one up or down, and what the
///   model favours.
///
/// The other variables are optimized for each choice. Each choice is a task of its own
/// (core/jobs/tasks.hpp): the answer does not depend on the number of jobs.
/// @param solution  the continuous optimum; becomes the choice: `verified` if it is the best of all, or
///                  if no neighbour is better
/// @throws Stopped, and as solve()
SizeChoiceReport choose_sizes(StagedSolution& solution, const SearchSetup& setup);

}  // namespace pleuel
