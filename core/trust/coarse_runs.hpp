#pragma once

#include <functional>
#include <memory>

#include "core/trust/trusted_run.hpp"

/// The same design in larger steps. What something changes needs no fine steps: it is looked for in
/// the coarsest run that says what the fine one says, the basis.
namespace pleuel {

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

/// The mechanism of the basis with something else in it, at the instants of the basis. What fails in
/// the largest steps is tried in smaller ones, which then are the basis.
/// @throws SimulationError, InputError
std::unique_ptr<Analysis> analyze_variant(const TrustedRun& run,
                                          const std::function<void(ProblemFile&)>& change);

}  // namespace pleuel
