#include "studies/accuracy.hpp"

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/relative_error.hpp"
#include "core/base/stop.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

// Parts of a study (core/jobs/part_store.hpp).

/// But for the variation, which the file says.
template <class Archive>
void transfer(Archive& archive, VariedRun& varied) {
  auto& [variation, run, time, influence] = varied;
  (void)variation;
  archive(run, time.seconds, time.change, time.spread, influence);
}

namespace {

/// Of the file, then by tens.
constexpr int recommended_targets = 3;
/// Times that differ by more need not be compared in turns.
constexpr double clearly_more = 3.0;

/// More time that steps which follow the local error may take, relative to equal ones, before
/// smaller errors are tried.
constexpr double too_long = 20.0;

Recommendation recommend(const AccuracyStudy& study, double target) {
  Recommendation best;
  best.target = target;
  const auto is_faster = [&](std::size_t i, const std::optional<std::size_t>& than,
                             const auto& seconds) {
    return !than || seconds(study.runs[i]) < seconds(study.runs[*than]);
  };
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const AccuracyRun& run = study.runs[i];
    if (run.has_failed() || study.counted_error(run.errors) > target) continue;
    if (is_faster(i, best.values, std::mem_fn(&AccuracyRun::simulation_seconds))) best.values = i;
    if (study.counted_error(run.gradient_errors) > target) continue;
    if (is_faster(i, best.gradients, std::mem_fn(&AccuracyRun::seconds))) best.gradients = i;
  }
  return best;
}

/// The first that is recommended; else the most accurate one.
std::optional<std::size_t> base_of(const AccuracyStudy& study) {
  if (study.recommendations.front().values) return study.recommendations.front().values;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    if (study.runs[i].has_failed()) continue;
    const double error = study.counted_error(study.runs[i].errors);
    if (!best || error < study.counted_error(study.runs[*best].errors)) best = i;
  }
  return best;
}

struct Studying {
  const ProblemFile& problem;
  const PricedDesign& design;
  const AccuracyObserver& observer;
  PartStore* parts;
  AccuracyStudy& study;
  const Eigen::VectorXd& x = design.x();

  void find_reference(const Discretization& settings) {
    AccuracyRun& reference = study.reference;
    const ProblemFile finest = discretized(problem, settings);
    reference = kept_part(parts, "reference", [&] { return measure_run(finest, x, Timing::once); });
    reference.settings = settings;
    AccuracyRun coarser = kept_part(parts, "coarser than the reference", [&] {
      return measure_run(discretized(problem, slightly_coarser(settings)), x, Timing::once);
    });
    compare(reference, x, coarser);
    reference.errors = richardson_share * coarser.errors;
    reference.gradient_errors = richardson_share * coarser.gradient_errors;
    study.check = kept_part(parts, "other formulation", [&] { return check_of(finest); });
    if (study.check.failure.empty()) {
      reference.errors = reference.errors.cwiseMax(study.check.differences);
    }
    if (observer.run) observer.run(reference);
  }

  void add_runs(const std::vector<Discretization>& grid) {
    const std::optional<double> of_reference = lagrangian_of_reference();
    for (const Discretization& settings : grid) {
      study.runs.push_back(kept_part(parts, name_of(settings), [&] {
        const ProblemFile discrete = discretized(problem, settings);
        AccuracyRun run = try_to_measure(discrete, x, Timing::least);
        run.settings = settings;
        compare_with_reference(run);
        if (!run.has_failed()) run.optimum_change = design.change(of_reference, discrete);
        return run;
      }));
      if (observer.run) observer.run(study.runs.back());
    }
    double target = problem.accuracy.target;
    for (int i = 0; i < recommended_targets; ++i, target *= 0.1) {
      study.recommendations.push_back(recommend(study, target));
    }
    study.base = base_of(study);
  }

  void add_knobs() {
    const ProblemFile discrete = discretized(problem, base().settings);
    const std::optional<double> of_reference = lagrangian_of_reference();
    for (const Variation& one : numerical_variations(discrete)) {
      if (is_hopeless(one)) continue;
      add(one, study.knobs, [&] {
        VariedRun knob = varied(one, discrete);
        if (!knob.run.has_failed()) {
          knob.run.optimum_change = design.change(of_reference, one.of(discrete));
        }
        return knob;
      });
    }
  }

  void add_effects() {
    const ProblemFile discrete = discretized(problem, base().settings);
    const std::unique_ptr<Analysis> analysis = analyze(problem, x, values_only);
    const std::optional<double> of_file = design.lagrangian(problem);
    for (const Variation& one : effect_variations(problem, analysis->model)) {
      add(one, study.effects, [&] {
        VariedRun effect = varied(one, discrete);
        find_influence(one.of(problem), values_of(*analysis), effect);
        if (!effect.run.has_failed()) {
          effect.run.optimum_change = design.change(of_file, one.of(problem));
        }
        return effect;
      });
    }
  }

 private:
  const AccuracyRun& base() const { return study.runs[*study.base]; }

  std::optional<double> lagrangian_of_reference() const {
    return kept_part(parts, "lagrangian of the reference", [&] {
      return design.lagrangian(discretized(problem, study.reference.settings));
    });
  }

  ReferenceCheck check_of(const ProblemFile& finest) const {
    const Variation other = other_formulation(problem);
    ReferenceCheck check;
    check.formulation = other.value;
    check.failure = failure_of([&] {
      check.differences = differences_of(values_of(*analyze(other.of(finest), x, values_only)));
    });
    return check;
  }

  Eigen::VectorXd differences_of(const Eigen::VectorXd& values) const {
    const AccuracyRun& reference = study.reference;
    Eigen::VectorXd differences = Eigen::VectorXd::Zero(values.size());
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      // Errors of the integration are not the same in two formulations, however short the steps are.
      if (is_monitor(problem, i)) continue;
      differences(i) = value_error(values(i), reference.values(i), reference.magnitudes(i));
    }
    return differences;
  }

  /// What is closer to the reference than that is to the truth is not known better.
  void compare_with_reference(AccuracyRun& run) const {
    if (run.has_failed()) return;
    compare(study.reference, x, run);
    run.errors = run.errors.cwiseMax(study.reference.errors);
    run.gradient_errors = run.gradient_errors.cwiseMax(study.reference.gradient_errors);
  }

  template <class Make>
  void add(const Variation& variation, std::vector<VariedRun>& all, const Make& make) const {
    const std::string name =
        fmt::format("{} {} at {}", variation.knob, variation.value, name_of(base().settings));
    all.push_back(kept_part(parts, name, make));
    all.back().variation = variation;
    if (observer.variation) observer.variation(all.back());
  }

  /// Smaller local errors only take longer than one that took too long already.
  bool is_hopeless(const Variation& variation) const {
    if (variation.knob != "local_error" || study.knobs.empty()) return false;
    const VariedRun& last = study.knobs.back();
    const bool is_too_long = last.run.has_failed() || last.time.change > too_long;
    return last.variation.knob == variation.knob && is_too_long;
  }

  VariedRun varied(const Variation& variation, const ProblemFile& discrete) const {
    const ProblemFile changed = variation.of(discrete);
    VariedRun varied{variation, try_to_measure(changed, x, Timing::once)};
    AccuracyRun& run = varied.run;
    run.settings = base().settings;
    run.settings.step = changed.simulation.step;
    if (run.has_failed()) return varied;
    compare_with_reference(run);
    varied.time = time_of(run, changed, discrete);
    run.simulation_seconds = base().simulation_seconds * (1.0 + varied.time.change);
    return varied;
  }

  /// Beside the base: one baseline for all.
  ComparedTime time_of(const AccuracyRun& run, const ProblemFile& changed,
                       const ProblemFile& discrete) const {
    const double once = run.simulation_seconds, of_base = base().simulation_seconds;
    if (is_same_work(run, base())) return {once, 0.0, 0.0};
    if (once > clearly_more * of_base) return {once, once / of_base - 1.0, 0.0};
    return compare_times({[&] { analyze(discrete, x); }, [&] { analyze(changed, x); }}).back();
  }

  /// With the steps and elements of the file: those of an optimum at the design.
  void find_influence(const ProblemFile& changed, const Eigen::VectorXd& values,
                      VariedRun& effect) const {
    if (effect.run.has_failed()) return;
    try {
      effect.influence = values_of(*analyze(changed, x, values_only)) - values;
    } catch (const SimulationError& error) {
      effect.run.failure = error.what();
    }
  }
};

}  // namespace

double AccuracyStudy::counted_error(const Eigen::VectorXd& errors) const {
  double largest = 0.0;
  if (errors.size() == 0) return largest;
  for (const std::size_t i : counted) {
    largest = std::max(largest, errors(i));
  }
  return largest;
}

AccuracyStudy accuracy_study(const ProblemFile& problem, const PricedDesign& design,
                             const AccuracyObserver& observer, PartStore* parts) {
  if (problem.responses.empty()) throw InputError("/responses is missing: nothing can be compared");
  AccuracyStudy study;
  study.counted = asked_responses(problem);
  Studying studying{problem, design, observer, parts, study};
  const std::vector<Discretization> grid = accuracy_grid(problem);
  studying.find_reference(finer_than(problem, grid));
  try {
    studying.add_runs(grid);
  } catch (const Stopped&) {
    study.is_interrupted = true;
  }
  return study;
}

void vary_settings(const ProblemFile& problem, const PricedDesign& design, AccuracyStudy& study,
                   const AccuracyObserver& observer, PartStore* parts) {
  if (!study.base) return;
  try {
    Studying studying{problem, design, observer, parts, study};
    studying.add_knobs();
    studying.add_effects();
  } catch (const SimulationError& error) {  // the setting of the file cannot be simulated
    study.failure = error.what();
  } catch (const Stopped&) {
    study.is_interrupted = true;
  }
}

std::optional<double> fitted_order(const AccuracyStudy& study,
                                   Eigen::VectorXd AccuracyRun::*errors) {
  const double floor = 3.0 * study.counted_error(study.reference.*errors);
  int elements = 0;
  double factor = 0.0;
  for (const AccuracyRun& run : study.runs) {
    elements = std::max(elements, run.settings.elements);
    factor = std::max(factor, run.settings.factor);
  }
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const AccuracyRun& run : study.runs) {
    const bool is_finest = run.settings.elements == elements && run.settings.factor == factor;
    if (!is_finest || run.has_failed()) continue;
    const double error = study.counted_error(run.*errors);
    if (!(error > floor)) continue;
    const double s = std::log(run.settings.step), e = std::log(error);
    n += 1.0, x += s, y += e, xx += s * s, xy += s * e;
  }
  const double spread = n * xx - x * x;
  if (n < 2.0 || !(spread > 0.0)) return std::nullopt;
  return (n * xy - x * y) / spread;
}

}  // namespace pleuel
