#include "core/trust/refinement_set.hpp"

#include <algorithm>
#include <utility>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

RefinementSet::RefinementSet(RefinedRuns& store, const Refinement& at, const ProblemFile& problem,
                             const Analysis& analysis, Divisions divisions, double basis)
    : store_(store), at_(at), similar_(analysis.trajectory) {
  const std::optional<int> fewest = fewest_elements(analysis.model, problem);
  const bool has_few = fewest.value_or(1) <= 2 || !can_be_halved(analysis.model, problem);
  std::vector<Refinement> refinements = {at * Refinement{2.0}, at * Refinement{4.0}};
  std::vector<std::pair<Comparison JudgingRuns::*, std::size_t>> comparisons;
  const auto compare = [&](Comparison JudgingRuns::*comparison, std::size_t beside,
                           const Refinement& change) {
    comparisons.emplace_back(comparison, beside);
    refinements.push_back(refinements[beside] * change);
    return refinements.size() - 1;
  };
  const std::size_t coarser = basis == 4.0 ? 1 : 0;
  std::size_t divided = coarser;  // beside which modes are judged
  if (fewest && (has_few || divisions != Divisions::coarser)) {
    // One element may have no more modes, and more elements change nothing without them.
    divided = compare(&JudgingRuns::more_elements, coarser, {.pieces = 2});
  }
  if (fewest && !has_few && divisions != Divisions::finer) {
    compare(&JudgingRuns::fewer_elements, coarser, {.elements = 0.5});
  }
  if (has_reduced_beams(analysis.model, problem)) {
    compare(&JudgingRuns::modes, divided, {.more_modes = judging_modes});
  }
  if (problem.simulation.newton_tolerance > small_newton_tolerance) {
    compare(&JudgingRuns::newton, 1, {.newton = judging_newton});
  }
  made_ = store_.runs(refinements, &similar_);
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    runs_.*comparisons[i].first = {made_[i + 2], made_[comparisons[i].second]};
  }
  const auto is_coarser = [](const RefinedRun& one, Eigen::Index instants) {
    return one.has_failed() || one.time.size() < instants;  // one step has none above it
  };
  if (is_coarser(*made_[0], analysis.trajectory.time.size())) runs_.twice_step = made_[0];
  if (is_coarser(*made_[1], made_[0]->time.size())) runs_.four_steps = made_[1];
}

void RefinementSet::refine_steps() {
  const RefinedRun*& finer = runs_.half_step == nullptr ? runs_.half_step : runs_.quarter_step;
  const double step = runs_.half_step == nullptr ? 0.5 : 0.25;
  finer = made_.emplace_back(store_.runs({at_ * Refinement{step}}, &similar_).front());
}

JudgingRuns RefinementSet::runs_of_histories() const {
  JudgingRuns all = runs_;
  all.twice_step = made_[0];
  all.four_steps = made_[1];
  return all;
}

std::string RefinementSet::failure() const {
  const auto failed = std::find_if(made_.rbegin(), made_.rend(),
                                   [](const RefinedRun* run) { return run->has_failed(); });
  return failed == made_.rend() ? "" : (*failed)->failure;
}

}  // namespace pleuel
