#include "core/response/effect_influence.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/jobs/parallel.hpp"
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

/// Effects of one name that are turned round together.
struct Group {
  std::vector<const EffectRecord*> records;

  bool is_built() const { return records.front()->is_built; }
};

/// The settings as they concern one body.
EffectSettings settings_of(const std::string& body, const EffectSettings& plain,
                           const EffectDecisions& decisions) {
  EffectSettings settings = plain;
  for (auto one = decisions.measured.lower_bound({body, ""});
       one != decisions.measured.end() && one->first.first == body; ++one) {
    settings.decisions.measured.insert(*one);
  }
  return settings;
}

/// All effects that can be turned round: by name, of those that are built and of those that are not.
std::vector<Group> all_groups(const ProblemFile& fixed, const Model& model) {
  EffectSettings plain = fixed.effects;
  plain.decisions = {};
  std::vector<Group> groups;
  for (const EffectRecord& record : model.effects) {
    const Body* body = find_named(fixed.scene.bodies, record.body);
    if (!body || is_exact(record)) continue;
    EffectSettings settings = settings_of(record.body, plain, fixed.effects.decisions);
    const BodyEffects as_it_is = decide_effects(*body, settings);
    settings.decisions.measured[{record.body, record.name}].is_needed = !record.is_built;
    if (is_same(decide_effects(*body, settings), as_it_is)) continue;
    const auto is_its_group = [&](const Group& group) {
      const EffectRecord& first = *group.records.front();
      return first.name == record.name && first.is_built == record.is_built;
    };
    auto group = std::ranges::find_if(groups, is_its_group);
    if (group == groups.end()) group = groups.insert(groups.end(), Group{});
    group->records.push_back(&record);
  }
  return groups;
}

ProblemFile turned(const ProblemFile& fixed, const Group& group) {
  ProblemFile problem = fixed;
  for (const EffectRecord* record : group.records) {
    problem.effects.decisions.measured[{record->body, record->name}].is_needed = !record->is_built;
  }
  return problem;
}

std::vector<Group> halves(const Group& group) {
  const auto middle = group.records.begin() + std::ssize(group.records) / 2;
  return {{{group.records.begin(), middle}}, {{middle, group.records.end()}}};
}

std::vector<Group> single_effects(const std::vector<Group>& groups) {
  std::vector<Group> singles;
  for (const Group& group : groups) {
    for (const EffectRecord* record : group.records) singles.push_back({{record}});
  }
  return singles;
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

/// A group and what turning it round brings.
struct Measured {
  Group group;
  EffectInfluence influence;
};

EffectInfluence influence_of(const Group& group, const Run& run, const Run& as_it_is) {
  EffectInfluence one{{}, group.records.front()->name, run.failure, {}};
  for (const EffectRecord* record : group.records) one.bodies.push_back(record->body);
  if (!as_it_is.failure.empty()) one.failure = as_it_is.failure;
  if (!one.failure.empty()) return one;
  const int sign = group.is_built() ? 1 : -1;
  one.changes = sign * (run.values - as_it_is.values);
  one.unknowns = sign * (run.unknowns - as_it_is.unknowns);
  one.iterations = sign * (run.iterations - as_it_is.iterations);
  return one;
}

/// Simulates groups, those that divide others after them.
std::vector<Measured> measure(const ProblemFile& fixed, const Eigen::VectorXd& x,
                              std::vector<Group> open) {
  const Run as_it_is = simulate(fixed, x);
  const auto is_settled = [&](const EffectInfluence& one) {
    if (one.bodies.size() == 1 || !as_it_is.failure.empty()) return true;
    return one.failure.empty() && largest_influence(as_it_is.values, one.changes).relative <=
                                      change_that_counts(fixed.effects);
  };
  std::vector<Measured> all;
  while (!open.empty()) {
    std::vector<Run> runs(open.size());
    for_each_in_parallel(int_size(runs), available_threads(),
                         [&](int i) { runs[i] = simulate(turned(fixed, open[i]), x); });
    std::vector<Group> divided;
    for (std::size_t i = 0; i < open.size(); ++i) {
      EffectInfluence one = influence_of(open[i], runs[i], as_it_is);
      if (is_settled(one)) {
        all.push_back({std::move(open[i]), std::move(one)});
      } else {
        for (Group& half : halves(open[i])) divided.push_back(std::move(half));
      }
    }
    open = std::move(divided);
  }
  // In the order of the model, whose records stand one behind the other.
  std::ranges::sort(all, {}, [](const Measured& one) { return one.group.records.front(); });
  return all;
}

void measure_times(const ProblemFile& as_it_is, const Eigen::VectorXd& x,
                   std::vector<Measured>& all) {
  std::vector<std::function<void()>> works = {[&] { analyze(as_it_is, x); }};
  std::vector<Measured*> timed;
  for (Measured& one : all) {
    if (!one.influence.failure.empty()) continue;
    works.push_back([&x, problem = turned(as_it_is, one.group)] { analyze(problem, x); });
    timed.push_back(&one);
  }
  const std::vector<ComparedTime> times = compare_times(works, {.seconds = timing_budget});
  for (std::size_t k = 0; k < timed.size(); ++k) {
    timed[k]->influence.time = without(times[k + 1], timed[k]->group.is_built());
  }
}

}  // namespace

LargestInfluence largest_influence(const Eigen::VectorXd& values, const Eigen::VectorXd& changes) {
  constexpr double round_off = 1e-8;
  LargestInfluence largest;
  for (Eigen::Index i = 0; i < changes.size(); ++i) {
    const double relative = std::abs(changes(i)) / std::abs(values(i));
    if (values(i) == 0.0 || !(relative > std::max(largest.relative, round_off))) continue;
    largest = {i, relative};
  }
  return largest;
}

double change_that_counts(const EffectSettings& effects) {
  constexpr double usual = 1e-3;
  return effects.tolerance > 0.0 ? effects.tolerance : usual;
}

std::vector<EffectInfluence> effect_influences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               InfluenceTimes times) {
  const Eigen::VectorXd start = start_design(problem);
  const Model model =
      build_model(problem.scene, problem.effects, Design<double>(start.begin(), start.end()),
                  Design<double>(x.begin(), x.end()));
  const ProblemFile fixed = with_fixed_effects(problem, model);
  std::vector<Group> groups = all_groups(fixed, model);
  if (times == InfluenceTimes::measured) groups = single_effects(groups);
  std::vector<Measured> all = measure(fixed, x, std::move(groups));
  if (times == InfluenceTimes::measured) measure_times(fixed, x, all);
  std::vector<EffectInfluence> influences;
  for (Measured& one : all) influences.push_back(std::move(one.influence));
  return influences;
}

}  // namespace pleuel
