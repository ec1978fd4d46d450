#include "core/trust/doubts.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/blocked_drives.hpp"
#include "core/trust/case_doubts.hpp"
#include "core/trust/energy_balance.hpp"
#include "core/trust/extrapolation.hpp"
#include "core/trust/far_bending.hpp"
#include "core/trust/far_bounds.hpp"
#include "core/trust/far_limits.hpp"
#include "core/trust/fast_laws.hpp"
#include "core/trust/fast_turning.hpp"
#include "core/trust/frequency_meaning.hpp"
#include "core/trust/idle_freedoms.hpp"
#include "core/trust/initial_motion.hpp"
#include "core/trust/jerk_at_corners.hpp"
#include "core/trust/joint_turns.hpp"
#include "core/trust/laws_over_coordinates.hpp"
#include "core/trust/left_out_effects.hpp"
#include "core/trust/lost_places.hpp"
#include "core/trust/misaligned_joints.hpp"
#include "core/trust/modal_damping.hpp"
#include "core/trust/model_variants.hpp"
#include "core/trust/open_positions.hpp"
#include "core/trust/other_side.hpp"
#include "core/trust/promised_buckling.hpp"
#include "core/trust/proportions.hpp"
#include "core/trust/ranking.hpp"
#include "core/trust/resolution.hpp"
#include "core/trust/section_axes.hpp"
#include "core/trust/sideways_buckling.hpp"
#include "core/trust/sliding_contact.hpp"
#include "core/trust/stability.hpp"
#include "core/trust/sudden_start.hpp"
#include "core/trust/taut_members.hpp"
#include "core/trust/undetermined_reactions.hpp"
#include "core/trust/unseen_overshoot.hpp"

namespace pleuel {

std::vector<Doubt> find_doubts_before(const ProblemFile& problem) {
  std::vector<std::vector<Doubt>> doubts;
  for (const ProblemFile* one : simulated_problems(problem)) {
    doubts.push_back(doubt_fast_laws_before(*one));
  }
  std::vector<Doubt> joined = joined_doubts(problem, doubts);
  const std::vector<Doubt> of_variables = doubt_far_bounds(problem);
  joined.insert(joined.end(), of_variables.begin(), of_variables.end());
  return joined;
}

namespace {

/// What changes faster than the steps can follow.
std::vector<Doubt> doubt_all_too_fast(const TrustedRun& run) {
  std::vector<Doubt> doubts = doubt_fast_laws(run);
  if (doubts.empty()) doubts = doubt_fast_turning(run);
  for (const auto find :
       {doubt_laws_over_coordinates, doubt_jerks_at_corners, doubt_unseen_overshoot}) {
    const std::vector<Doubt> more = find(run);
    doubts.insert(doubts.end(), more.begin(), more.end());
  }
  return doubts;
}

/// Whether a doubt is about a response, or about what its formula is made from.
bool concerns(const Doubt& doubt, const ProblemFile& problem, std::size_t response) {
  const auto is_named = [&](std::size_t i) {
    const std::vector<std::string>& named = doubt.responses;
    return std::find(named.begin(), named.end(), problem.responses[i].name) != named.end();
  };
  const std::vector<std::size_t> parts = parts_of(problem, response);
  return doubt.responses.empty() || is_named(response) ||
         std::any_of(parts.begin(), parts.end(), is_named);
}

/// Whether a response is made from the motion.
bool moves(const TrustedRun& run, std::size_t response) {
  const std::vector<std::size_t> parts = parts_of(run.problem, response);
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::size_t part) { return run.analysis.histories[part].size() > 0; });
}

/// What happens between two instants is seen by no run with larger steps, which judge the error.
void leave_steps_unresolved(const TrustedRun& run, const std::vector<Doubt>& doubts,
                            std::vector<std::optional<ErrorBar>>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i] || !moves(run, i)) continue;
    if (std::any_of(doubts.begin(), doubts.end(),
                    [&](const Doubt& doubt) { return concerns(doubt, run.problem, i); })) {
      errors[i]->step.is_resolved = false;
    }
  }
}

/// A run with short steps behind jumps is nearer to the truth than those that bars are made from: none of peaks is narrower
/// than what it differs by.
void widen_to_short_steps(const TrustedRun& run, std::vector<std::optional<ErrorBar>>& errors) {
  if (!run.shared->with_short_steps) return;
  const Eigen::VectorXd missed = *run.shared->with_short_steps - values_of(run.analysis);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i] || !run.analysis.responses[i].is_peak_over_time()) continue;
    const double difference = missed(static_cast<Eigen::Index>(i));
    if (std::abs(difference) <= errors[i]->step.bound) continue;
    errors[i]->step.change = difference;
    errors[i]->step.bound = safety::of_seen * std::abs(difference);
  }
}

/// No bar knows how far numbers are off that leave what the equations are for.
void leave_unmodelled(const TrustedRun& run, const std::vector<Doubt>& doubts,
                      std::vector<std::optional<ErrorBar>>& errors) {
  for (const Doubt& doubt : doubts) {
    if (doubt.cause != Cause::not_modelled || !doubt.is_serious) continue;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (errors[i] && moves(run, i) && concerns(doubt, run.problem, i)) {
        errors[i]->is_modelled = false;
      }
    }
  }
}

/// To the bars of all responses that have one.
void add_left_out(const LeftOut& left_out, std::vector<std::optional<ErrorBar>>& errors) {
  for (const VariantChange& variant : left_out.changes) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (errors[i]) errors[i]->left_out[variant.name] = variant.change(static_cast<int>(i));
    }
  }
}

/// Members that buckle leave no trace in a motion without their elasticity: what a tolerance leaves
/// out takes part here.
std::vector<Doubt> doubt_buckling(const TrustedRun& run,
                                  const std::optional<CompleteRun>& complete) {
  const auto doubts_of = [](const TrustedRun& pressed) {
    std::vector<Doubt> doubts = doubt_sideways_buckling(pressed);
    const std::vector<Doubt> others = doubt_stability(pressed);
    doubts.insert(doubts.end(), others.begin(), others.end());
    return doubts;
  };
  if (!complete || !complete->analysis) return doubts_of(run);
  const Monitors monitors = monitor(complete->analysis->model, complete->analysis->trajectory);
  return doubts_of({complete->problem, run.x, *complete->analysis, monitors});
}

struct Judge {
  Cause cause;
  std::vector<Doubt> (*find)(const TrustedRun&);
};

constexpr Judge judges[] = {
    {Cause::unit, doubt_proportions},
    {Cause::limit, doubt_far_limits},
    {Cause::mobility, doubt_blocked_drives},
    {Cause::mobility, doubt_idle_freedoms},
    {Cause::mobility, doubt_initial_motion},
    {Cause::mobility, doubt_joint_turns},
    {Cause::mobility, doubt_misaligned_joints},
    {Cause::mobility, doubt_open_positions},
    {Cause::mobility, doubt_rest},
    {Cause::mobility, doubt_unconnected_bodies},
    {Cause::mobility, doubt_undetermined_reactions},
    {Cause::not_modelled, doubt_extrapolation},
    {Cause::not_modelled, doubt_linear_elasticity},
    {Cause::not_modelled, doubt_lost_places},
    {Cause::not_modelled, doubt_sliding_contacts},
    {Cause::unstable, doubt_frequencies},
    {Cause::unstable, doubt_promised_buckling},
    {Cause::not_converged, doubt_energy_balance},
    {Cause::left_out, doubt_lost_stiffening},
    {Cause::left_out, doubt_modal_damping},
    {Cause::left_out, doubt_other_side},
    {Cause::left_out, doubt_section_axes},
    {Cause::left_out, doubt_sudden_start},
    {Cause::left_out, doubt_taut_members},
};

}  // namespace

Trust judge_run(const TrustedRun& run) {
  Trust trust;
  if (run.scrutiny == Scrutiny::none) {
    trust.doubts = {{"what speaks against these numbers was not looked for (--no-checks)"}};
    return trust;
  }
  std::vector<Doubt>& doubts = trust.doubts;
  const auto add = [&](Cause cause, const std::vector<Doubt>& found) {
    for (const Doubt& doubt : found) {
      doubts.push_back(doubt);
      doubts.back().cause = cause;
    }
  };
  for (const auto& [cause, find] : judges) add(cause, find(run));
  const std::vector<Doubt> too_fast = doubt_all_too_fast(run);
  add(Cause::not_converged, too_fast);
  const std::optional<CompleteRun> complete = simulate_completely(run);
  if (complete) add(Cause::left_out, doubt_left_out_effects(run, *complete));
  add(Cause::unstable, doubt_buckling(run, complete));
  Resolution resolution = judge_resolution(run);
  add(Cause::not_converged, doubt_resolution(run, resolution));
  trust.errors = std::move(resolution.bars);
  trust.evidence = std::move(resolution.evidence);
  trust.bands = std::move(resolution.bands);
  trust.failed_run = std::move(resolution.failure);
  leave_steps_unresolved(run, too_fast, trust.errors);
  widen_to_short_steps(run, trust.errors);
  leave_unmodelled(run, doubts, trust.errors);
  const LeftOut left_out = compare_variants(run);
  doubts.insert(doubts.end(), left_out.doubts.begin(), left_out.doubts.end());
  add_left_out(left_out, trust.errors);
  if (complete) add_left_out_effects(run, *complete, trust.errors);
  rank_doubts(doubts);
  return trust;
}

std::vector<Doubt> find_doubts(const TrustedRun& run) {
  return judge_run(run).doubts;
}

std::vector<Doubt> find_doubts(const ProblemFile& problem, const Eigen::VectorXd& x,
                               const Analysis& analysis) {
  const Monitors monitors = monitor(analysis.model, analysis.trajectory);
  return find_doubts(TrustedRun{problem, x, analysis, monitors});
}

std::vector<std::string> texts_of(const std::vector<Doubt>& doubts) {
  std::vector<std::string> texts;
  for (const Doubt& doubt : doubts) texts.push_back(doubt.text);
  return texts;
}

bool has_serious(const std::vector<Doubt>& doubts) {
  return std::any_of(doubts.begin(), doubts.end(),
                     [](const Doubt& doubt) { return doubt.is_serious; });
}

}  // namespace pleuel
