#include "core/response/effect_influence.hpp"

#include <algorithm>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/base/parallel.hpp"
#include "core/base/stopwatch.hpp"
#include "core/model/effect_decisions.hpp"

namespace pleuel {

namespace {

/// Runs up to this time [s] are timed twice.
constexpr double short_run = 0.3;

struct Timed {
  Eigen::VectorXd values;
  std::string failure;
  double seconds = 0.0;
};

Timed simulate(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const ThreadStopwatch stopwatch;
  Timed run;
  try {
    run.values = values_of(*analyze(problem, x));
  } catch (const SimulationError& error) {
    run.failure = error.what();
  } catch (const InputError& error) {  // a response needs the effect
    run.failure = error.what();
  }
  run.seconds = stopwatch.seconds();
  return run;
}

/// The problem with the same effects, each of them decided by its entry in `measured`.
ProblemFile with_fixed_effects(ProblemFile problem, const Model& model) {
  EffectSettings& settings = problem.effects;
  settings.decisions = {};
  for (const EffectRecord& record : model.effects) {
    if (!record.body.empty()) {
      settings.decisions.measured[{record.body, record.name}].is_needed = record.is_built;
    }
  }
  for (const BeamEffect& effect : beam_effects) settings.*effect.choice = EffectChoice::automatic;
  return problem;
}

bool is_same(const BeamEffects& one, const BeamEffects& other) {
  for (const BeamEffect& effect : beam_effects) {
    if (one.*effect.is_built != other.*effect.is_built) return false;
  }
  return true;
}

bool is_exact(const EffectRecord& record) {
  return record.kind == EffectRecord::Kind::exact && !record.is_built;
}

/// The problems to be compared, and which effect each of them turns round.
struct Turned {
  const EffectRecord* record;
  ProblemFile problem;
};

std::vector<Turned> turned_problems(const ProblemFile& fixed, const Model& model) {
  std::vector<Turned> turned;
  for (const EffectRecord& record : model.effects) {
    const Body* body = find_named(fixed.scene.bodies, record.body);
    // Of bodies that a file describes effects are told, but not decided.
    if (!body || !std::holds_alternative<BeamBody>(body->shape) || is_exact(record)) continue;
    ProblemFile problem = fixed;
    problem.effects.decisions.measured[{record.body, record.name}].is_needed = !record.is_built;
    const bool changes_nothing = is_same(decide_beam_effects(*body, problem.effects),
                                         decide_beam_effects(*body, fixed.effects));
    if (!changes_nothing) turned.push_back({&record, std::move(problem)});
  }
  return turned;
}

}  // namespace

std::vector<EffectInfluence> effect_influences(const ProblemFile& problem,
                                               const Eigen::VectorXd& x) {
  const Eigen::VectorXd start = start_design(problem);
  const Model model =
      build_model(problem.scene, problem.effects, Design<double>(start.begin(), start.end()),
                  Design<double>(x.begin(), x.end()));
  const ProblemFile fixed = with_fixed_effects(problem, model);
  const std::vector<Turned> turned = turned_problems(fixed, model);
  std::vector<Timed> runs(turned.size() + 1);  // the last as it is
  const auto run_all = [&] {
    for_each_in_parallel(int_size(runs), available_threads(), [&](int i) {
      Timed run = simulate(i < std::ssize(turned) ? turned[i].problem : fixed, x);
      if (runs[i].seconds > 0.0) run.seconds = std::min(run.seconds, runs[i].seconds);
      runs[i] = std::move(run);
    });
  };
  run_all();
  if (runs.back().seconds < short_run) run_all();  // the first time was a warm-up
  const Timed& as_it_is = runs.back();
  const double seconds = as_it_is.seconds;
  std::vector<EffectInfluence> influences;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const EffectRecord& record = *turned[i].record;
    EffectInfluence one{record.body, record.name, runs[i].failure, {}, 0.0, 0.0};
    if (!as_it_is.failure.empty()) one.failure = as_it_is.failure;
    if (one.failure.empty()) {
      const double sign = record.is_built ? 1.0 : -1.0;
      one.changes = sign * (runs[i].values - as_it_is.values);
      one.seconds = sign * (seconds - runs[i].seconds);
      one.share = seconds > 0.0 ? one.seconds / seconds : 0.0;
    }
    influences.push_back(std::move(one));
  }
  return influences;
}

}  // namespace pleuel
