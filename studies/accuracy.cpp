#include "studies/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/packed.hpp"
#include "core/base/relative_error.hpp"
#include "core/base/stop.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/response_parts.hpp"
#include "core/trust/trusted_run.hpp"
#include "studies/accuracy_run.hpp"

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

/// What is closer to the reference than that is to the truth is not known better.
void raise_to_errors_of(const AccuracyRun& reference, AccuracyRun& run) {
  if (run.has_failed()) return;
  run.errors = run.errors.cwiseMax(reference.errors);
  run.gradient_errors = run.gradient_errors.cwiseMax(reference.gradient_errors);
}

Recommendation recommend(const AccuracyStudy& study, double target) {
  Recommendation best;
  best.target = target;
  const auto improve = [&](std::optional<std::size_t>& chosen, std::size_t i, double seconds,
                           double of_chosen) {
    if (!chosen || seconds < of_chosen) chosen = i;
  };
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const AccuracyRun& run = study.runs[i];
    if (run.has_failed() || study.counted_error(run.errors) > target) continue;
    improve(best.values, i, run.simulation_seconds,
            best.values ? study.runs[*best.values].simulation_seconds : 0.0);
    if (study.counted_error(run.gradient_errors) > target) continue;
    improve(best.gradients, i, run.seconds(),
            best.gradients ? study.runs[*best.gradients].seconds() : 0.0);
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

std::optional<double> lagrangian_of_reference(const ProblemFile& problem,
                                              const PricedDesign& design,
                                              const AccuracyStudy& study, PartStore* parts) {
  return kept_part(parts, "lagrangian of the reference", [&] {
    return design.lagrangian(discretized(problem, study.reference.settings));
  });
}

class RefinementStudy {
 public:
  RefinementStudy(const ProblemFile& problem, const PricedDesign& design,
                  const AccuracyObserver& observer, PartStore* parts)
      : problem_(problem), design_(design), x_(design.x()), observer_(observer), parts_(parts) {}

  AccuracyStudy run() {
    study_.counted = asked_responses(problem_);
    const std::vector<Discretization> grid = accuracy_grid(problem_);
    find_reference(finer_than(problem_, grid));
    try {
      of_reference_ = lagrangian_of_reference(problem_, design_, study_, parts_);
      for (const Discretization& settings : grid) add_run(settings);
      double target = problem_.accuracy.target;
      for (int i = 0; i < recommended_targets; ++i, target *= 0.1) {
        study_.recommendations.push_back(recommend(study_, target));
      }
      study_.base = base_of(study_);
    } catch (const Stopped&) {
      study_.is_interrupted = true;
    }
    return std::move(study_);
  }

 private:
  void find_reference(const Discretization& settings) {
    AccuracyRun& reference = study_.reference;
    const ProblemFile finest = discretized(problem_, settings);
    reference =
        kept_part(parts_, "reference", [&] { return measure_run(finest, x_, Timing::once); });
    reference.settings = settings;
    AccuracyRun coarser = kept_part(parts_, "coarser than the reference", [&] {
      return measure_run(discretized(problem_, slightly_coarser(settings)), x_, Timing::once);
    });
    compare(reference, x_, coarser);
    reference.errors = richardson_share * coarser.errors;
    reference.gradient_errors = richardson_share * coarser.gradient_errors;
    study_.check = kept_part(parts_, "other formulation", [&] { return check_of(finest); });
    if (study_.check.failure.empty()) {
      reference.errors = reference.errors.cwiseMax(study_.check.differences);
    }
    if (observer_.run) observer_.run(reference);
  }

  ReferenceCheck check_of(const ProblemFile& finest) const {
    const Variation other = other_formulation(problem_);
    ReferenceCheck check;
    check.formulation = other.value;
    try {
      check.differences = differences_of(values_of(*analyze(other.of(finest), x_)));
    } catch (const SimulationError& error) {
      check.failure = error.what();
    } catch (const InputError& error) {
      check.failure = error.what();
    }
    return check;
  }

  Eigen::VectorXd differences_of(const Eigen::VectorXd& values) const {
    const AccuracyRun& reference = study_.reference;
    Eigen::VectorXd differences = Eigen::VectorXd::Zero(values.size());
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      // Errors of the integration are not the same in two formulations, however short the steps are.
      if (is_monitor(problem_, i)) continue;
      differences(i) = value_error(values(i), reference.values(i), reference.magnitudes(i));
    }
    return differences;
  }

  void add_run(const Discretization& settings) {
    study_.runs.push_back(kept_part(parts_,
                                    fmt::format("step {} s, elements {}, factor {}", settings.step,
                                                settings.elements, settings.factor),
                                    [&] { return compared_run(settings); }));
    if (observer_.run) observer_.run(study_.runs.back());
  }

  AccuracyRun compared_run(const Discretization& settings) const {
    const ProblemFile discrete = discretized(problem_, settings);
    AccuracyRun run = try_to_measure(discrete, x_, Timing::least);
    run.settings = settings;
    compare(study_.reference, x_, run);
    raise_to_errors_of(study_.reference, run);
    if (!run.has_failed()) run.optimum_change = design_.change(of_reference_, discrete);
    return run;
  }

  const ProblemFile& problem_;
  const PricedDesign& design_;
  const Eigen::VectorXd& x_;
  const AccuracyObserver& observer_;
  PartStore* parts_;
  AccuracyStudy study_;
  std::optional<double> of_reference_;  ///< Lagrangian
};

/// What is changed at the setting that is recommended.
class Variations {
 public:
  Variations(const ProblemFile& problem, const PricedDesign& design, AccuracyStudy& study,
             const AccuracyObserver& observer, PartStore* parts)
      : problem_(problem),
        design_(design),
        x_(design.x()),
        study_(study),
        observer_(observer),
        parts_(parts),
        base_(study.runs[*study.base]),
        discrete_(discretized(problem, base_.settings)) {}

  void add_knobs() {
    const std::optional<double> of_reference =
        lagrangian_of_reference(problem_, design_, study_, parts_);
    for (const Variation& one : numerical_variations(discrete_)) {
      if (is_hopeless(one)) continue;
      add(one, study_.knobs, [&] {
        VariedRun knob = varied(one);
        if (!knob.run.has_failed()) {
          knob.run.optimum_change = design_.change(of_reference, one.of(discrete_));
        }
        return knob;
      });
    }
  }

  void add_effects() {
    const std::unique_ptr<Analysis> analysis = analyze(problem_, x_);
    const std::optional<double> of_file = design_.lagrangian(problem_);
    for (const Variation& one : effect_variations(problem_, analysis->model)) {
      add(one, study_.effects, [&] {
        VariedRun effect = varied(one);
        find_influence(one.of(problem_), values_of(*analysis), effect);
        if (!effect.run.has_failed()) {
          effect.run.optimum_change = design_.change(of_file, one.of(problem_));
        }
        return effect;
      });
    }
  }

 private:
  template <class Make>
  void add(const Variation& variation, std::vector<VariedRun>& all, const Make& make) const {
    const std::string name =
        fmt::format("{} {} at step {} s, elements {}, factor {}", variation.knob, variation.value,
                    base_.settings.step, base_.settings.elements, base_.settings.factor);
    all.push_back(kept_part(parts_, name, make));
    all.back().variation = variation;
    if (observer_.variation) observer_.variation(all.back());
  }

  /// Smaller local errors only take longer than one that took too long already.
  bool is_hopeless(const Variation& variation) const {
    if (variation.knob != "local_error" || study_.knobs.empty()) return false;
    const VariedRun& last = study_.knobs.back();
    const bool is_too_long = last.run.has_failed() || last.time.change > too_long;
    return last.variation.knob == variation.knob && is_too_long;
  }

  VariedRun varied(const Variation& variation) const {
    const ProblemFile changed = variation.of(discrete_);
    VariedRun varied{variation, try_to_measure(changed, x_, Timing::once)};
    AccuracyRun& run = varied.run;
    run.settings = base_.settings;
    run.settings.step = changed.simulation.step;
    if (run.has_failed()) return varied;
    compare(study_.reference, x_, run);
    raise_to_errors_of(study_.reference, run);
    varied.time = time_of(run, changed);
    run.simulation_seconds = base_.simulation_seconds * (1.0 + varied.time.change);
    return varied;
  }

  /// Beside the base: one baseline for all.
  ComparedTime time_of(const AccuracyRun& run, const ProblemFile& changed) const {
    const double once = run.simulation_seconds;
    if (is_same_work(run, base_)) return {once, 0.0, 0.0};
    if (once > clearly_more * base_.simulation_seconds) {
      return {once, once / base_.simulation_seconds - 1.0, 0.0};
    }
    return compare_times({[&] { analyze(discrete_, x_); }, [&] { analyze(changed, x_); }}).back();
  }

  /// With the steps and elements of the file: those of an optimum at the design.
  void find_influence(const ProblemFile& changed, const Eigen::VectorXd& values,
                      VariedRun& effect) const {
    if (effect.run.has_failed()) return;
    try {
      effect.influence = values_of(*analyze(changed, x_)) - values;
    } catch (const SimulationError& error) {
      effect.run.failure = error.what();
    }
  }

  const ProblemFile& problem_;
  const PricedDesign& design_;
  const Eigen::VectorXd& x_;
  AccuracyStudy& study_;
  const AccuracyObserver& observer_;
  PartStore* parts_;
  const AccuracyRun& base_;
  ProblemFile discrete_;
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
  return RefinementStudy(problem, design, observer, parts).run();
}

void vary_settings(const ProblemFile& problem, const PricedDesign& design, AccuracyStudy& study,
                   const AccuracyObserver& observer, PartStore* parts) {
  if (!study.base) return;
  try {
    Variations variations(problem, design, study, observer, parts);
    variations.add_knobs();
    variations.add_effects();
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
