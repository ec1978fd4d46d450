#include "core/trust/coarse_runs.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/jobs/parallel.hpp"
#include "core/trust/response_changes.hpp"

namespace pleuel {

namespace {

/// Changes of what is asked by which a coarser run says the same: half of those that are told.
constexpr double same_values = 0.005;
/// Runs of fewer steps may agree on having seen nothing.
constexpr int fewest_steps = 64;

bool says_the_same(const TrustedRun& run, const NestedRun& coarse) {
  if (!coarse.analysis || coarse.analysis->trajectory.steps() < fewest_steps) return false;
  const std::vector<ResponseChange> changes =
      response_changes(run.problem, run.analysis, *coarse.analysis);
  return std::ranges::all_of(asked_parts(run.problem),
                             [&](std::size_t i) { return changes[i].of_value <= same_values; });
}

}  // namespace

const CoarseRuns& coarse_runs(const TrustedRun& run) {
  std::optional<CoarseRuns>& coarse = run.shared->coarse;
  if (coarse) return *coarse;
  coarse.emplace();
  for_each_in_parallel(2, available_threads(), [&](int i) {
    NestedRun& nested = i == 0 ? coarse->twice : coarse->four;
    nested = simulate_refined(run.problem, run.x, {i == 0 ? 2.0 : 4.0}, &run.analysis.trajectory);
  });
  coarse->is_four_enough = says_the_same(run, coarse->four);
  return *coarse;
}

namespace {

/// Null: the run that is judged.
const NestedRun* basis_of(const TrustedRun& run) {
  const CoarseRuns& coarse = coarse_runs(run);
  if (coarse.is_four_enough) return &coarse.four;
  return coarse.twice.analysis ? &coarse.twice : nullptr;
}

}  // namespace

const Analysis& basis_of_variants(const TrustedRun& run) {
  const NestedRun* basis = basis_of(run);
  return basis != nullptr ? *basis->analysis : run.analysis;
}

void compare_at_twice(const TrustedRun& run) {
  coarse_runs(run);
  run.shared->coarse->is_four_enough = false;
}

TrustedRun in_larger_steps(const TrustedRun& run) {
  const Analysis& analysis = run.shared->coarse ? basis_of_variants(run) : run.analysis;
  return {run.problem, run.x, analysis, run.monitors};
}

std::unique_ptr<Analysis> analyze_variant(const TrustedRun& run,
                                          const std::function<void(ProblemFile&)>& change) {
  const NestedRun* basis = basis_of(run);
  ProblemFile variant = basis != nullptr ? basis->problem : run.problem;
  change(variant);
  try {
    return analyze(with_steps_of(basis_of_variants(run).trajectory, variant), run.x,
                   &run.analysis.trajectory);
  } catch (const SimulationError&) {
    if (!run.shared->coarse->is_four_enough) throw;
  }
  compare_at_twice(run);
  return analyze_variant(run, change);
}

}  // namespace pleuel
