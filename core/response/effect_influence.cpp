#include "core/response/effect_influence.hpp"

#include <functional>
#include <memory>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/base/parallel.hpp"
#include "core/model/effect_decisions.hpp"

namespace pleuel {

namespace {

/// What the simulations whose times are compared may take [s].
constexpr double timing_budget = 2.0;

struct Run {
  Eigen::VectorXd values;
  std::string failure;
  int unknowns = 0, iterations = 0;
};

Run simulate(const ProblemFile& problem, const Eigen::VectorXd& x) {
  Run run;
  try {
    const std::unique_ptr<Analysis> analysis = analyze(problem, x);
    run.values = values_of(*analysis);
    const System& system = *analysis->model.mechanism.system;
    run.unknowns = system.coordinates() + system.multipliers();
    run.iterations = analysis->trajectory.newton_iterations;
  } catch (const SimulationError& error) {
    run.failure = error.what();
  } catch (const InputError& error) {  // a response needs the effect
    run.failure = error.what();
  }
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

bool is_same(const BodyEffects& one, const BodyEffects& other) {
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
    if (!body || is_exact(record)) continue;
    ProblemFile problem = fixed;
    problem.effects.decisions.measured[{record.body, record.name}].is_needed = !record.is_built;
    const bool changes_nothing =
        is_same(decide_effects(*body, problem.effects), decide_effects(*body, fixed.effects));
    if (!changes_nothing) turned.push_back({&record, std::move(problem)});
  }
  return turned;
}

/// What a simulation takes without an effect beside one with it.
/// @param turned  beside the run as it is, with the effect turned round
ComparedTime without(ComparedTime turned, bool is_built) {
  if (is_built) return turned;
  const double ratio = 1.0 + turned.change;
  turned.change = 1.0 / ratio - 1.0;
  turned.spread /= ratio * ratio;
  return turned;
}

/// @param turned  those that can be simulated
void measure_times(const ProblemFile& as_it_is, const std::vector<Turned>& turned,
                   const Eigen::VectorXd& x, std::vector<EffectInfluence>& influences) {
  std::vector<std::function<void()>> works = {[&] { analyze(as_it_is, x); }};
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (!influences[i].failure.empty()) continue;
    works.push_back([&, i] { analyze(turned[i].problem, x); });
    places.push_back(i);
  }
  const std::vector<ComparedTime> times = compare_times(works, {.seconds = timing_budget});
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::size_t i = places[k];
    influences[i].time = without(times[k + 1], turned[i].record->is_built);
  }
}

}  // namespace

std::vector<EffectInfluence> effect_influences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               InfluenceTimes times) {
  const Eigen::VectorXd start = start_design(problem);
  const Model model =
      build_model(problem.scene, problem.effects, Design<double>(start.begin(), start.end()),
                  Design<double>(x.begin(), x.end()));
  const ProblemFile fixed = with_fixed_effects(problem, model);
  const std::vector<Turned> turned = turned_problems(fixed, model);
  std::vector<Run> runs(turned.size() + 1);  // the last as it is
  for_each_in_parallel(int_size(runs), available_threads(), [&](int i) {
    runs[i] = simulate(i < std::ssize(turned) ? turned[i].problem : fixed, x);
  });
  const Run& as_it_is = runs.back();
  std::vector<EffectInfluence> influences;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const EffectRecord& record = *turned[i].record;
    EffectInfluence one{record.body, record.name, runs[i].failure, {}};
    if (!as_it_is.failure.empty()) one.failure = as_it_is.failure;
    if (one.failure.empty()) {
      const int sign = record.is_built ? 1 : -1;
      one.changes = sign * (runs[i].values - as_it_is.values);
      one.unknowns = sign * (runs[i].unknowns - as_it_is.unknowns);
      one.iterations = sign * (runs[i].iterations - as_it_is.iterations);
    }
    influences.push_back(std::move(one));
  }
  if (times == InfluenceTimes::measured) measure_times(fixed, turned, x, influences);
  return influences;
}

}  // namespace pleuel
