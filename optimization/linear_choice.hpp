#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

/// Which of several sizes to take for each of several variables, by a linear model:
///
///     minimize f + Σᵢ fᵢ(kᵢ)   subject to   lower ≤ c + Σᵢ cᵢ(kᵢ) ≤ upper,   kᵢ among the sizes of i
namespace pleuel {

/// A size of a variable, and what taking it changes.
struct LinearOption {
  int size = 0;                 ///< its place in the list
  double objective = 0.0;       ///< f_i
  Eigen::VectorXd constraints;  ///< c_i
};

struct LinearChoiceModel {
  double objective = 0.0;
  Eigen::VectorXd constraints;
  Eigen::VectorXd lower, upper;  ///< of the constraints
  Eigen::VectorXd scales;        ///< of the constraints: what violations are relative to
  std::vector<std::vector<LinearOption>> options;  ///< by variable, at least one each
};

struct PredictedChoice {
  std::vector<int> sizes;  ///< of each variable
  double objective = 0.0;
};

/// The choices with the lowest objective among those that exceed no limit by more than is allowed,
/// the best first: branching over the variables, a branch is left where the least that the rest can
/// add to the objective, or to the violation of a limit, is too much.
/// @param count    at most so many
/// @param allowed  relative violation
/// @param nodes    after so many branchings it ends with what it has
std::vector<PredictedChoice> best_choices(const LinearChoiceModel& model, std::size_t count,
                                          double allowed, long nodes = 200000);

/// lower ≤ A x ≤ upper; infinite where there is no limit.
struct LinearLimits {
  Eigen::MatrixXd rows;          ///< A, limits × variables
  Eigen::VectorXd lower, upper;  ///< one a limit
};

/// Which limits contradict each other: no x within its bounds keeps all of them. Empty: some x does. That none
/// does is proven by multipliers y ≥ 0 of the rows B x ≤ b of limits and bounds with
///     Bᵀ y = 0,  bᵀ y < 0
/// (Farkas' lemma), which are sought by non-negative least squares; of few rows, as its solutions are.
/// @param lower, upper  finite bounds of x
std::vector<std::size_t> linear_conflict(const LinearLimits& limits, const Eigen::VectorXd& lower,
                                         const Eigen::VectorXd& upper);

}  // namespace pleuel
