#pragma once

#include <functional>
#include <string>
#include <vector>

#include "optimization/phase_one.hpp"
#include "optimization/problem.hpp"
#include "optimization/result.hpp"
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
  /// How often an answer that is nearly one is refined by another backend .
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
  /// Whether what speaks against the numbers of the answer is looked for.
  bool checks_numbers = true;
  /// Whether a start that is verified is the answer: no other design is looked for.
  bool takes_verified_start = false;
  /// What an earlier part of the same run has used already, for messages.
  struct Used {
    int iterations = 0;
    int restarts = 0;
  } earlier{};
};

/// Optimizes from the start values of the problem with one backend, and proves or questions the
/// answer: check the start → backend → audit → polish if the design is nearly an optimum → restart
/// from there if it is unproven, from its better neighbour if it is no minimum → result.
/// @throws InputError if the backend is unknown or cannot take the constraints, or if the start lies
///         outside its bounds. A start that cannot be evaluated is not thrown but `failed`.
Result solve(Problem& problem, const SolveOptions& options, const Observer& observer = {});

/// One run of the backend, and the best design that it saw: not audited, and so never more than
/// `stalled`; without multipliers.
/// @throws InputError like solve()
Result search(Problem& problem, const SolveOptions& options, const Observer& observer = {});

/// What find_optimum() searches.
struct SearchedProblem {
  Problem& problem;  ///< its variables begin where the search begins
  /// Optimizes from a design with the backend of the options.
  std::function<Result(const Eigen::VectorXd& start, const SolveOptions& options,
                       const Observer& observer)>
      attempt;
  /// The limits as components that are smooth; valid until the next call of anything here.
  std::function<LimitRows()> limit_rows;
};

/// The search for an optimum from any start: a sequence of attempts, each from where the ones before
/// have led, until an optimum is verified, nothing is left to try, or the iterations are used up.
///
/// - A start that cannot be evaluated is left for the nearest design towards the middle of the
///   bounds that can, or for one anywhere between them.
/// - A backend that leads to no design within the limits begins anew from one that phase_one.hpp
///   finds, from the design that breaks the limits least, or from others between the bounds.
/// - Where restoration finds none, the least violation and the limits in conflict are found
///   (phase_one.hpp). Only with this evidence a problem is called infeasible.
/// - A backend that ends within the limits without a proof is followed by SolveOptions::
///   other_backends, and by itself with shorter first steps.
/// - An optimum whose objective, with its slope and its curvature, is less than a thousandth of
///   where the search began is proven beside nothing of its size: the search begins anew there. Where that finds nothing better, the proof stands.
///
/// The answer is the best design of all attempts; Result::backend found it, and Result::parts tells
/// what was tried.
/// @throws as solve()
Result find_optimum(const SearchedProblem& searched, const SolveOptions& options,
                    const Observer& observer = {}, const Notice& notice = {});

/// The same for a problem that is smooth as it is.
Result find_optimum(Problem& problem, const SolveOptions& options, const Observer& observer = {},
                    const Notice& notice = {});

}  // namespace pleuel
