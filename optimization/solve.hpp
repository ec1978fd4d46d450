#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/base/error_bar.hpp"
#include "optimization/history.hpp"
#include "optimization/least_violation.hpp"
#include "optimization/problem.hpp"
#include "optimization/verdict.hpp"

namespace pleuel {

struct SolveOptions {
  /// One of optimizer_names().
  std::string backend = "nlopt-slsqp";
  /// Relative change of objective and scaled variables at which the backend stops, in (0, 1). Keep
  /// it above the noise of the simulation; the verdict does not depend on it.
  double tolerance = 1e-6;
  /// Designs at which gradients may be computed, restarts included; at least 1. Five times as many
  /// evaluations are allowed, since a line search that finds no way down has no other end.
  int max_iterations = 200;
  /// How often a backend that ended at an unproven design starts anew from there, with fresh
  /// scaling and approximations and a tenth of the tolerance; 0 takes its first answer.
  int max_restarts = 6;
  /// How often it starts anew from a better design beside a maximum or a saddle; not counted above.
  int max_escapes = 4;
  /// Failed evaluations in a row after which the run is given up, at least 1.
  int max_consecutive_failures = 20;
  /// How often an answer that is nearly one is refined by another backend (polish.hpp).
  int max_polishes = 2;
  /// Designs with gradients that a polish may use beyond max_iterations.
  int polish_iterations = 0;
  /// Iterations of the backend without a better design, neither in violation nor in objective,
  /// after which it is stopped; 0: any number.
  int patience = 0;
  /// Size of the first steps of the backend, relative to the usual one; in (0, 1].
  double first_step = 1.0;
  /// From how many designs the whole search begins, for messages.
  int starts = 1;
  /// Backends that find_optimum() may go on with where the first one leads nowhere.
  std::vector<std::string> other_backends{};
  /// What the verdict asks for.
  Tolerances verdict{};
  /// What an earlier part of the same run has used already, for messages.
  struct Used {
    int iterations = 0;
    int restarts = 0;
  } earlier{};
};

/// A part of the search for an optimum (find_optimum.hpp).
struct SearchPart {
  std::string method;  ///< a backend, or "restoration"
  Status status = Status::failed;
  int evaluations = 0;
};

struct Result {
  Status status = Status::failed;
  std::string message;  ///< a sentence: why this status
  /// Sentences: what speaks against the numbers of the last design.
  std::vector<std::string> warnings;
  /// Of responses and objective by steps, elements and effects; where a design problem knows them.
  std::vector<std::optional<ErrorBar>> response_errors;
  std::vector<Eigen::VectorXd> response_bands;  ///< of histories [SI]; empty where none is known
  std::optional<ErrorBar> error;                ///< of the optimal objective
  /// What was tried one after the other, where find_optimum() searched.
  std::vector<SearchPart> parts;
  /// Of an infeasible problem: what is in conflict.
  std::optional<LeastViolation> least_violation;
  bool gradients_are_disproved = false;  ///< by differences, where all else is well
  std::string backend;                   ///< that found the answer
  std::string polished_with;             ///< the backend that refined the answer; empty: nobody did
  Eigen::VectorXd x;                     ///< [SI]
  /// At x, with gradients. Without any entry if the start already failed.
  Evaluation evaluation;
  /// μ and β of KktAudit: d(optimal objective) / d(active limit) = −μ. That of a limit with slack
  /// is 0; see has_prices() of prices.hpp for the designs at which they are prices.
  Eigen::VectorXd constraint_multipliers, bound_multipliers;
  double kkt_residual = 0.0;   ///< relative
  double max_violation = 0.0;  ///< relative
  int evaluations = 0;
  int gradient_evaluations = 0;
  int iterations = 0;  ///< designs at which gradients were computed
  int restarts = 0;
  double seconds = 0.0;
  History history;
};

/// Optimizes from the start values of the problem with one backend, and proves or doubts the
/// answer: check the start → backend → audit → polish if the design is nearly an optimum → restart
/// from there if it is unproven, from its better neighbour if it is no minimum → result.
/// @throws InputError if the backend is unknown or cannot take the constraints, or if the start
/// lies
///         outside its bounds. A start that cannot be evaluated is not thrown but `failed`.
Result solve(Problem& problem, const SolveOptions& options, const Observer& observer = {});

/// One run of the backend, and the best design that it saw: not audited, and so never more than
/// `stalled`; without multipliers.
/// @throws InputError like solve()
Result search(Problem& problem, const SolveOptions& options, const Observer& observer = {});

/// Puts what an earlier run of the same optimization did before a result: counts, time, history.
void continue_from(const Result& before, Result& result);

/// A record as one that follows on a run.
EvaluationRecord following(EvaluationRecord record, const Result& before);

}  // namespace pleuel
