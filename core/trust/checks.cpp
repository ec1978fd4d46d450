#include "core/trust/checks.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/bent_beams.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/coarse_runs.hpp"
#include "core/trust/fast_laws.hpp"
#include "core/trust/finding.hpp"
#include "core/trust/resolution.hpp"

namespace pleuel {

std::vector<Finding> check_before(const ProblemFile& problem) {
  std::vector<std::vector<Finding>> findings;
  for (const ProblemFile* one : simulated_problems(problem)) {
    findings.push_back(check_fast_laws_before(*one));
  }
  std::vector<Finding> joined = joined_findings(problem, findings);
  const std::vector<Finding> of_variables = check_far_bounds(problem);
  joined.insert(joined.end(), of_variables.begin(), of_variables.end());
  return joined;
}

namespace {

/// What changes faster than the steps can follow, beside loads and drives that do.
std::vector<Finding> check_fast_motion(const TrustedRun& run, bool has_fast_laws) {
  std::vector<Finding> findings;
  if (!has_fast_laws) findings = check_fast_turning(run);
  for (const auto find : {check_laws_over_coordinates, check_unresolved_transients}) {
    const std::vector<Finding> more = find(run);
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return findings;
}

/// Whether a finding is about a response, or about what its formula is made from.
bool concerns(const Finding& finding, const ProblemFile& problem, std::size_t response) {
  const auto is_named = [&](std::size_t i) {
    const std::vector<std::string>& named = finding.responses;
    return std::ranges::find(named, problem.responses[i].name) != named.end();
  };
  const std::vector<std::size_t> parts = parts_of(problem, response);
  return finding.responses.empty() || is_named(response) || std::ranges::any_of(parts, is_named);
}

/// Whether a response is made from the motion.
bool moves(const TrustedRun& run, std::size_t response) {
  const std::vector<std::size_t> parts = parts_of(run.problem, response);
  return std::ranges::any_of(
      parts, [&](std::size_t part) { return run.analysis.histories[part].size() > 0; });
}

/// What happens between two instants is seen by no run with larger steps, which judge the error.
void leave_steps_unresolved(const TrustedRun& run, const std::vector<Finding>& findings,
                            std::vector<std::optional<ErrorBar>>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i] || !moves(run, i)) continue;
    if (std::ranges::any_of(
            findings, [&](const Finding& finding) { return concerns(finding, run.problem, i); })) {
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
void leave_unmodelled(const TrustedRun& run, const std::vector<Finding>& findings,
                      std::vector<std::optional<ErrorBar>>& errors) {
  for (const Finding& finding : findings) {
    if (finding.cause != Cause::not_modelled || !finding.is_serious) continue;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (errors[i] && moves(run, i) && concerns(finding, run.problem, i)) {
        errors[i]->is_modelled = false;
      }
    }
  }
}

/// To the bars of all responses that have one, where it is known.
void add_left_out(const LeftOut& left_out, std::vector<std::optional<ErrorBar>>& errors) {
  for (const VariantChange& variant : left_out.changes) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const double change = variant.change(static_cast<int>(i));
      if (errors[i] && std::isfinite(change)) errors[i]->left_out[variant.name] = change;
    }
  }
}

/// Members that buckle leave no trace in a motion without their elasticity: what a tolerance leaves
/// out takes part here.
std::vector<Finding> check_buckling(const TrustedRun& run,
                                    const std::optional<CompleteRun>& complete) {
  const auto findings_of = [](const TrustedRun& pressed) {
    std::vector<Finding> findings = check_sideways_buckling(in_larger_steps(pressed));
    const std::vector<Finding> others = check_stability(pressed);
    findings.insert(findings.end(), others.begin(), others.end());
    return findings;
  };
  if (!complete || !complete->analysis) return findings_of(run);
  const Monitors monitors = monitor(complete->analysis->model, complete->analysis->trajectory);
  return findings_of({complete->problem, run.x, *complete->analysis, monitors});
}

struct Judge {
  Cause cause;
  std::vector<Finding> (*find)(const TrustedRun&);
};

constexpr Judge judges[] = {
    {Cause::unit, check_proportions},
    {Cause::limit, check_far_limits},
    {Cause::mobility, check_blocked_drives},
    {Cause::mobility, check_unactuated_freedoms},
    {Cause::mobility, check_initial_motion},
    {Cause::mobility, check_joint_turns},
    {Cause::mobility, check_misaligned_joints},
    {Cause::mobility, check_open_positions},
    {Cause::mobility, check_rest},
    {Cause::mobility, check_unconnected_bodies},
    {Cause::mobility, check_undetermined_reactions},
    {Cause::not_modelled, check_extrapolation},
    {Cause::not_modelled, check_linear_elasticity},
    {Cause::not_modelled, check_lost_places},
    {Cause::not_modelled, check_sliding_contacts},
    {Cause::unstable, check_frequencies},
    {Cause::unstable, check_promised_buckling},
    {Cause::not_converged, check_energy_balance},
    {Cause::left_out, check_modal_damping},
    {Cause::left_out, check_other_side},
    {Cause::left_out, check_section_axes},
    {Cause::left_out, check_startup_transient},
};

}  // namespace

Trust judge_run(const TrustedRun& run) {
  Trust trust;
  if (run.scrutiny == Scrutiny::none) {
    trust.findings = {{"what speaks against these numbers was not looked for (--no-checks)"}};
    return trust;
  }
  std::vector<Finding>& findings = trust.findings;
  const auto add = [&](Cause cause, const std::vector<Finding>& found) {
    for (const Finding& finding : found) {
      findings.push_back(finding);
      findings.back().cause = cause;
    }
  };
  for (const auto& [cause, find] : judges) add(cause, find(run));
  std::vector<Finding> too_fast = check_fast_laws(run);
  add(Cause::mobility, too_fast);  // the motion is not the one that the file describes
  const std::vector<Finding> fast_motion = check_fast_motion(run, !too_fast.empty());
  add(Cause::not_converged, fast_motion);
  too_fast.insert(too_fast.end(), fast_motion.begin(), fast_motion.end());
  const std::optional<CompleteRun> complete = simulate_completely(run);
  if (complete) add(Cause::left_out, check_neglected_effects(run, *complete));
  Resolution resolution = judge_resolution(run);
  add(Cause::not_converged, check_resolution(run, resolution));
  add(Cause::unstable, check_buckling(run, complete));  // in the larger steps of the resolution
  trust.errors = std::move(resolution.bars);
  trust.evidence = std::move(resolution.evidence);
  trust.bands = std::move(resolution.bands);
  trust.failed_run = std::move(resolution.failure);
  leave_steps_unresolved(run, too_fast, trust.errors);
  widen_to_short_steps(run, trust.errors);
  leave_unmodelled(run, findings, trust.errors);
  const LeftOut left_out = compare_variants(run);
  findings.insert(findings.end(), left_out.findings.begin(), left_out.findings.end());
  add_left_out(left_out, trust.errors);
  if (complete) add_neglected_effects(run, *complete, trust.errors);
  rank_findings(findings);
  return trust;
}

std::vector<Finding> findings_before_failure(ProblemFile problem, const Eigen::VectorXd& x,
                                             double time) {
  // Beside the failure states may be none of the mechanism.
  constexpr double share = 0.75;
  SimulationSettings& settings = problem.simulation;
  if (settings.period > 0.0 || share * time < settings.step) return {};
  settings.end_time = share * time;
  problem.responses.clear();
  problem.constraints.clear();
  try {
    const auto analysis = analyze(problem, x, values_only);
    if (analysis->rigid_path.end == RigidPath::End::bends) return {};  // the error tells that
    std::vector<Finding> findings = check_run(problem, x, *analysis);
    std::erase_if(findings, [](const Finding& finding) { return !finding.is_serious; });
    if (findings.size() > 1) findings.resize(1);  // the others follow from the first
    return findings;
  } catch (const SimulationError&) {  // in shorter steps than what failed
  } catch (const InputError&) {       // of what cannot be asked of a shorter motion
  }
  return {};
}

std::vector<Finding> check_run(const TrustedRun& run) {
  return judge_run(run).findings;
}

std::vector<Finding> check_run(const ProblemFile& problem, const Eigen::VectorXd& x,
                               const Analysis& analysis) {
  const Monitors monitors = monitor(analysis.model, analysis.trajectory);
  return check_run(TrustedRun{problem, x, analysis, monitors});
}

std::vector<std::string> texts_of(const std::vector<Finding>& findings) {
  std::vector<std::string> texts;
  for (const Finding& finding : findings) texts.push_back(finding.text);
  return texts;
}

bool has_serious(const std::vector<Finding>& findings) {
  return std::ranges::any_of(findings, [](const Finding& finding) { return finding.is_serious; });
}

}  // namespace pleuel
