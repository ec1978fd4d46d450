#pragma once

/// The same design in larger steps. What something changes needs no fine steps: it is looked for in
/// the coarsest run that says what the fine one says, the basis.

#include <functional>
#include <memory>
#include <vector>

#include "core/response/analysis.hpp"
#include "core/scene/problem_file.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// How much another simulation changes a response, relative.
struct ResponseChange {
  /// To what it is in the reference, or a hundredth of the largest in its history where that is near
  /// zero.
  double of_value = 0.0;
  /// The same, or a tenth of its limits where these are far away.
  double beside_limits = 0.0;
};

/// One a response.
/// - Coordinates, whose zero is arbitrary (positions, angles, lengths of springs), are compared with
///   how far they move from where the file draws them.
/// - Damage by fatigue is compared with itself alone, and so are formulas, which may be a difference
///   of large parts.
///
/// Round-off, and monitors (balance of energy, drift of constraints), change by 0.
std::vector<ResponseChange> response_changes(const ProblemFile& problem, const Analysis& reference,
                                             const Analysis& other);

/// With twice and four times the step, made once.
const CoarseRuns& coarse_runs(const TrustedRun& run);

/// What variants are compared with: the run with four times the step where it says the same of all
/// that is asked, by half a percent; else that with twice; the one that is judged where neither is there.
const Analysis& basis_of_variants(const TrustedRun& run);

/// From now on four times the step is not enough, as where disturbances are followed along a variant.
void compare_at_twice(const TrustedRun& run);

/// The basis as a run that is judged itself, if coarser runs are there already: what is looked for at each
/// instant is looked for at fewer. Else the run.
TrustedRun in_larger_steps(const TrustedRun& run);

/// The run with twice the step, if coarser runs are there already and it says what the fine one says: disturbances
/// are followed along it. Else the run that is judged.
const Analysis& in_twice_the_step(const TrustedRun& run);

/// The mechanism of the basis with something else in it, at the instants of the basis. What fails in
/// the largest steps is tried in smaller ones, which then are the basis.
/// @throws SimulationError, InputError
std::unique_ptr<Analysis> analyze_variant(const TrustedRun& run,
                                          const std::function<void(ProblemFile&)>& change);

}  // namespace pleuel
