#pragma once

#include <functional>

#include "optimization/phase_one.hpp"
#include "optimization/solve.hpp"

namespace pleuel {

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
/// - A backend that leads to no design within the limits begins anew from one that restoration.hpp
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
