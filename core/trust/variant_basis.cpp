#include "core/trust/variant_basis.hpp"

#include "core/base/error.hpp"
#include "core/trust/refined_runs.hpp"

namespace pleuel {

const ProblemFile& problem_of_variants(const TrustedRun& run) {
  SharedFindings& basis = *run.shared;
  if (basis.problem) return *basis.problem;
  basis.problem = refined(run.problem, {2.0, 1.0});
  basis.problem->simulation.moves_by_bending = true;  // whether it moves at all was asked before
  try {
    basis.analysis = analyze(*basis.problem, run.x, &run.analysis.trajectory);
  } catch (const SimulationError&) {
    basis.problem = run.problem;
  } catch (const InputError&) {  // a window without steps
    basis.problem = run.problem;
  }
  return *basis.problem;
}

const Analysis& basis_of_variants(const TrustedRun& run) {
  problem_of_variants(run);
  return run.shared->analysis ? *run.shared->analysis : run.analysis;
}

std::unique_ptr<Analysis> analyze_variant(const TrustedRun& run, const ProblemFile& variant) {
  return analyze(with_steps_of(basis_of_variants(run).trajectory, variant), run.x,
                 &run.analysis.trajectory);
}

}  // namespace pleuel
