#pragma once

#include <functional>
#include <memory>

#include "core/trust/trusted_run.hpp"

/// The same mechanism with something that it leaves out. What that changes needs no fine steps: it is
/// looked for at twice the step, where that can be simulated.
namespace pleuel {

/// What variants are compared with: the run with twice the step, which is made once, or the one that
/// is judged.
const Analysis& basis_of_variants(const TrustedRun& run);

/// The problem of that run.
const ProblemFile& problem_of_variants(const TrustedRun& run);

/// A variant, with the instants of the basis.
/// @throws SimulationError
std::unique_ptr<Analysis> analyze_variant(const TrustedRun& run, const ProblemFile& variant);

}  // namespace pleuel
