#include "core/response/effect_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/jobs/parallel.hpp"
#include "core/model/effect_decisions.hpp"
#include "core/model/effect_estimates.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/scene/response_parts.hpp"

namespace pleuel {

namespace {

/// Of the largest magnitude in the history of a response: values below it are "near zero".
constexpr double near_zero = 1e-2;
constexpr double round_off = 1e-9;

/// One effect of one body: (body, name of the effect), as in EffectDecisions::measured.
using Unit = std::pair<std::string, std::string>;

double size_of(const Analysis& analysis, std::size_t response) {
  const double value = std::abs(analysis.reductions[response].value);
  if (analysis.responses[response].is_reduced_by(OverTime::integral)) return value;
  return std::max(value, magnitude_of(analysis, response));
}

std::unique_ptr<Analysis> try_to_analyze(const ProblemFile& problem) {
  try {
    return analyze(problem, start_design(problem), values_only);
  } catch (const SimulationError&) {
    return nullptr;
  }
}

/// What is left out of the model by estimate or by measurement: nothing where no tolerance allows it.
std::vector<Unit> left_out(const ProblemFile& problem) {
  if (problem.effects.tolerance <= 0.0) return {};
  const Eigen::VectorXd start = start_design(problem);
  const Design<double> design(start.begin(), start.end());
  std::vector<Unit> units;
  for (const EffectRecord& record :
       build_model(problem.scene, problem.effects, design, design, std::nullopt).effects) {
    const bool is_decided =
        record.kind == EffectRecord::Kind::estimated || record.kind == EffectRecord::Kind::measured;
    if (is_decided && !record.is_built) units.emplace_back(record.body, record.name);
  }
  return units;
}

class EffectMeasurement {
 public:
  explicit EffectMeasurement(ProblemFile& problem) : problem_(problem) {}

  void run_together() {
    const std::vector<Unit> units = left_out(problem_);
    if (units.empty()) return;
    reference_ = try_to_analyze(with_all_effects(problem_));
    const LargestChange change =
        reference_ ? change_of(problem_)
                   : LargestChange{std::numeric_limits<double>::infinity(), "the simulation"};
    const bool is_needed = !(change.relative <= problem_.effects.tolerance);
    for (const Unit& unit : units) set(unit, is_needed, change);
  }

  void run() {
    std::vector<Unit> units = left_out(problem_);
    if (units.empty()) return;
    reference_ = try_to_analyze(with_all_effects(problem_));
    if (!reference_) {
      problem_.effects.decisions.estimates.clear();
      return;
    }
    for (; !units.empty(); units = left_out(problem_)) {
      const LargestChange change = change_of(problem_);
      if (change.relative <= problem_.effects.tolerance) {
        for (const Unit& unit : units) set(unit, false, change);
        return;
      }
      take_back(units, change);
    }
  }

 private:
  LargestChange change_of(const ProblemFile& problem) const {
    const auto analysis = try_to_analyze(problem);
    if (!analysis) return {std::numeric_limits<double>::infinity(), "the simulation"};
    return largest_change(problem, *reference_, *analysis);
  }

  /// Without this alone.
  const LargestChange& cost_of(const Unit& unit) {
    const auto found = costs_.find(unit);
    if (found != costs_.end()) return found->second;
    ProblemFile without = with_all_effects(problem_);
    without.effects.decisions.measured[unit].is_needed = false;
    return costs_.emplace(unit, change_of(without)).first->second;
  }

  void take_back(const std::vector<Unit>& units, const LargestChange& together) {
    if (units.size() == 1) {
      set(units.front(), true, together);
      return;
    }
    const Unit* dearest = &units.front();
    bool is_done = false;
    for (const Unit& unit : units) {
      const LargestChange& cost = cost_of(unit);
      if (cost.relative > cost_of(*dearest).relative) dearest = &unit;
      if (!(cost.relative > problem_.effects.tolerance)) continue;
      set(unit, true, cost);
      is_done = true;
    }
    if (!is_done) set(*dearest, true, together);
  }

  void set(const Unit& unit, bool is_needed, const LargestChange& change) {
    problem_.effects.decisions.measured[unit] = {is_needed, change.relative, change.response};
  }

  ProblemFile& problem_;
  std::unique_ptr<Analysis> reference_;
  std::map<Unit, LargestChange> costs_;
};

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
    const std::unique_ptr<Analysis> analysis = analyze(problem, x, values_only);
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
  std::vector<std::function<void()>> works = {[&] { analyze(as_it_is, x, values_only); }};
  std::vector<Measured*> timed;
  for (Measured& one : all) {
    if (!one.influence.failure.empty()) continue;
    works.push_back(
        [&x, problem = turned(as_it_is, one.group)] { analyze(problem, x, values_only); });
    timed.push_back(&one);
  }
  const std::vector<ComparedTime> times = compare_times(works, {.seconds = timing_budget});
  for (std::size_t k = 0; k < timed.size(); ++k) {
    timed[k]->influence.time = without(times[k + 1], timed[k]->group.is_built());
  }
}

}  // namespace

LargestChange largest_change(const ProblemFile& problem, const Analysis& reference,
                             const Analysis& other) {
  std::map<std::string, double> floors;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    double& floor = floors[reference.responses[i].unit];
    floor = std::max(floor, round_off * size_of(reference, i));
  }
  LargestChange largest;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    if (is_monitor(problem, i)) continue;
    const double value = reference.reductions[i].value;
    const double difference = std::abs(other.reductions[i].value - value);
    if (difference <= floors[reference.responses[i].unit]) continue;
    const double scale = std::max(std::abs(value), near_zero * size_of(reference, i));
    const double change =
        scale > 0.0 ? difference / scale : std::numeric_limits<double>::infinity();
    if (!(change <= largest.relative)) largest = {change, problem.responses[i].name};
  }
  return largest;
}

ProblemFile with_all_effects(ProblemFile problem) {
  problem.effects.decisions = {};
  return problem;
}

void decide_effects(ProblemFile& problem) {
  for (ProblemFile& one : problem.cases) decide_effects(one);
  if (problem.has_cases()) return;
  problem.effects.decisions = EffectDecisions{estimate_effects(problem), {}};
  EffectMeasurement(problem).run();
}

ProblemFile decided(UndecidedProblem problem) {
  ProblemFile lean = std::move(problem).complete();
  decide_effects(lean);
  return lean;
}

ProblemFile starting_at(ProblemFile problem, const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    problem.variables[i].start = x(i);
  }
  for (ProblemFile& one : problem.cases) one = starting_at(std::move(one), x);
  return problem;
}

void decide_effects(ProblemFile& problem, const Eigen::VectorXd& x) {
  for (ProblemFile& one : problem.cases) decide_effects(one, x);
  if (problem.has_cases()) return;
  ProblemFile there = starting_at(problem, x);
  EffectDecisions decisions{estimate_effects(there), {}};
  for (const auto& [unit, measured] : problem.effects.decisions.measured) {
    if (measured.is_needed) decisions.measured.emplace(unit, measured);
  }
  there.effects.decisions = std::move(decisions);
  EffectMeasurement(there).run();
  problem.effects = there.effects;
}

void try_to_leave_out(ProblemFile& problem, const Eigen::VectorXd& x) {
  ProblemFile there = starting_at(problem, x);
  there.effects.decisions = EffectDecisions{estimate_effects(there), {}};
  EffectMeasurement(there).run_together();
  problem.effects = there.effects;
}

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
                  Design<double>(x.begin(), x.end()), std::nullopt);
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
