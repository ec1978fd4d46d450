#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/number_text.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/coarse_runs.hpp"
#include "core/trust/round_off.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

namespace {

/// Share of a peak that the start may add without a word.
constexpr double small_addition = 0.05;
/// Of the largest elastic acceleration: starts with less are no shock.
constexpr double small_shock = 1e-3;

bool can_be_sudden(const TrustedRun& run) {
  const std::vector<Body>& bodies = run.problem.scene.bodies;
  return run.problem.simulation.checks_resolution && !run.analysis.trajectory.periodic &&
         !run.problem.simulation.quasi_static_start &&
         !run.analysis.model.mechanism.elastic.empty() &&
         std::ranges::none_of(bodies,
                              [](const Body& body) { return !body.initial_deflections.empty(); });
}

/// Whether elastic coordinates are accelerated at t = 0.
bool begins_with_a_shock(const Analysis& analysis) {
  constexpr int instants = 4;
  const Mechanism& mechanism = analysis.model.mechanism;
  const Trajectory& trajectory = analysis.trajectory;
  const auto largest_at = [&](int step) {
    const State state = trajectory.state_at(step);
    double largest = 0.0;
    for (const int i : mechanism.elastic) {
      largest = std::max(largest, std::abs(state.a(i)) / mechanism.scale(i));
    }
    return largest;
  };
  const double first = largest_at(0);
  double largest = first;
  for (int i = 1; i <= instants; ++i) {
    largest = std::max(largest, largest_at(i * trajectory.steps() / instants));
  }
  return first > small_shock * largest;
}

/// Whether deformation and forces are all that it is made from, so that it changes at once where a vibration
/// begins; a velocity does not.
bool changes_at_once(const ResponseSettings& response) {
  if (response.is<PointMotionResponse, JointMotionResponse>()) {
    return time_derivative_of(response) == TimeDerivative::none;
  }
  if (response.is<DriveResponse>()) return !response.is(DriveNumber::power);
  return response.is<MassResponse, StressResponse, ShearStressResponse, SectionForceResponse,
                     DeflectionResponse, ReactionResponse>();
}

/// The first step of a motion that begins in equilibrium.
std::unique_ptr<Analysis> first_step_from_equilibrium(const TrustedRun& run) {
  ProblemFile problem = run.problem;
  SimulationSettings& settings = problem.simulation;
  settings.quasi_static_start = settings.moves_by_bending = true;
  settings.end_time = settings.step;
  settings.local_error = 0.0;
  for (ResponseSettings& response : problem.responses) response.from = response.to = std::nullopt;
  return analyze(problem, run.x, values_only);
}

/// Whether the difference of both starts, which vibrations about the equilibrium are as large as, adds
/// enough to a response that is asked for.
bool may_decide(const TrustedRun& run) {
  const Analysis& sudden = run.analysis;
  try {
    const std::unique_ptr<Analysis> settled = first_step_from_equilibrium(run);
    const auto is_small = [&](std::size_t response) {
      double sum = 0.0;
      for (const WeightedResponse& part : linearized(sudden, response).parts) {
        if (!changes_at_once(run.problem.responses[part.response])) return false;
        if (sudden.histories[part.response].size() == 0) continue;
        const Eigen::VectorXd change =
            settled->histories[part.response].col(0) - sudden.histories[part.response].col(0);
        sum += std::abs(part.weight) * change.lpNorm<Eigen::Infinity>();
      }
      return sum <= small_addition * std::abs(sudden.reductions[response].value);
    };
    return !std::ranges::all_of(asked_responses(run.problem), is_small);
  } catch (const SimulationError&) {
  } catch (const InputError&) {  // of what cannot be asked of one step
  }
  return true;
}

/// The peaks of a start in equilibrium; none where there is no stable one.
std::unique_ptr<Analysis> from_equilibrium(const TrustedRun& run) {
  try {
    return analyze_variant(
        run, [](ProblemFile& problem) { problem.simulation.quasi_static_start = true; });
  } catch (const SimulationError&) {
    return nullptr;
  } catch (const InputError&) {  // of what does not go with such a start
    return nullptr;
  }
}

bool is_compared(const Response& response) {
  return response.is_peak_over_time() || response.expression();
}

}  // namespace

std::vector<Finding> check_startup_transient(const TrustedRun& run) {
  if (!can_be_sudden(run) || !begins_with_a_shock(run.analysis) || !may_decide(run)) return {};
  const std::unique_ptr<Analysis> settled = from_equilibrium(run);
  if (!settled) return {};
  const Analysis& sudden = basis_of_variants(run);
  Finding finding;
  double worst = 0.0, worst_value = 0.0;
  const std::vector<bool> is_round_off = find_round_off(run);
  for (const std::size_t i : asked_responses(run.problem)) {
    const Response& response = run.analysis.responses[i];
    const double value = sudden.reductions[i].value, other = settled->reductions[i].value;
    const double change = std::abs(value - other);
    if (!is_compared(response) || is_round_off[i]) continue;
    if (!(change > small_addition * std::max(std::abs(value), std::abs(other)))) continue;
    finding.responses.push_back(response.name);
    const double share = change / std::max(std::abs(other), small_addition * std::abs(value));
    if (share <= worst) continue;
    worst = share;
    worst_value = other / value;
    finding.text = response.name;
  }
  if (finding.responses.empty()) return {};
  const std::size_t others = finding.responses.size() - 1;
  finding.text = fmt::format(
      "the start decides \"{}\"{}: elastic bodies begin undeformed under loads and speeds that are "
      "there at once, and vibrate. From their equilibrium it would be {}: "
      "\"initial_state\": \"quasi-static\", or \"periodic\" for a machine that has been running. "
      "Where the sudden start is meant, nothing is to be done.",
      finding.text,
      others == 0 ? "" : fmt::format(" and {} other response{}", others, others == 1 ? "" : "s"),
      times_as_large(worst_value));
  return {finding};
}

}  // namespace pleuel
