#include "core/trust/refinement_set.hpp"

#include <algorithm>
#include <iterator>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

RefinementSet::RefinementSet(const ProblemFile& problem, const Eigen::VectorXd& x,
                             const Analysis& analysis, Divisions divisions,
                             const CoarseRuns* coarse)
    : problem_(problem), x_(x), similar_(&analysis.trajectory) {
  const std::optional<int> fewest = fewest_elements(analysis.model, problem);
  const bool has_few = fewest.value_or(1) <= 2 || !can_be_halved(analysis.model, problem);
  std::vector<Refinement> refinements = {{2.0, 1.0}, {4.0, 1.0}};
  std::vector<std::pair<Comparison JudgingRuns::*, std::size_t>> comparisons;
  const auto compare = [&](Comparison JudgingRuns::*comparison, std::size_t beside,
                           const Refinement& refinement) {
    comparisons.emplace_back(comparison, beside);
    refinements.push_back(refinement);
    return refinements.size() - 1;
  };
  const std::size_t basis = coarse != nullptr && coarse->is_four_enough ? 1 : 0;
  const double step = refinements[basis].step;
  std::size_t divided = basis;  // beside which modes are judged
  Refinement modes{step, 1.0, judging_modes};
  if (fewest && (has_few || divisions != Divisions::coarser)) {
    // One element may have no more modes, and more elements change nothing without them.
    divided = compare(&JudgingRuns::more_elements, basis, {.step = step, .pieces = 2});
    modes.pieces = 2;
  }
  if (fewest && !has_few && divisions != Divisions::finer) {
    compare(&JudgingRuns::fewer_elements, basis, {.step = step, .elements = 0.5});
  }
  if (has_reduced_beams(analysis.model, problem)) compare(&JudgingRuns::modes, divided, modes);
  if (problem.simulation.newton_tolerance > small_newton_tolerance) {
    compare(&JudgingRuns::newton, 1, {4.0, 1.0, 0, judging_newton});
  }
  std::vector<const RefinedRun*> kept;
  if (coarse != nullptr) {
    refinements.erase(refinements.begin(), refinements.begin() + 2);
    for (const NestedRun* run : {&coarse->twice, &coarse->four}) {
      kept.push_back(&made_.emplace_back(refined_run_of(*run)));
    }
  }
  for (RefinedRun& run : make_refined_runs(problem, x, refinements, similar_)) {
    kept.push_back(&made_.emplace_back(std::move(run)));
  }
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    runs_.*comparisons[i].first = {kept[i + 2], kept[comparisons[i].second]};
  }
  const auto is_coarser = [](const RefinedRun& one, Eigen::Index instants) {
    return one.has_failed() || one.time.size() < instants;  // one step has none above it
  };
  if (is_coarser(*kept[0], analysis.trajectory.time.size())) runs_.twice_step = kept[0];
  if (is_coarser(*kept[1], kept[0]->time.size())) runs_.four_steps = kept[1];
}

void RefinementSet::refine_steps() {
  const RefinedRun*& finer = runs_.half_step == nullptr ? runs_.half_step : runs_.quarter_step;
  const double step = runs_.half_step == nullptr ? 0.5 : 0.25;
  finer = &made_.emplace_back(make_refined_run(problem_, x_, {step, 1.0}, similar_));
}

JudgingRuns RefinementSet::runs_of_histories() const {
  JudgingRuns all = runs_;
  all.twice_step = &made_.front();
  all.four_steps = &*std::next(made_.begin());
  return all;
}

std::string RefinementSet::failure() const {
  const auto failed = std::find_if(made_.rbegin(), made_.rend(),
                                   [](const RefinedRun& run) { return run.has_failed(); });
  return failed == made_.rend() ? "" : failed->failure;
}

}  // namespace pleuel
