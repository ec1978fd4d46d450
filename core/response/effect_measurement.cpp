#include "core/response/effect_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
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
    return analyze(problem, start_design(problem));
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
       build_model(problem.scene, problem.effects, design, design).effects) {
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

}  // namespace pleuel
