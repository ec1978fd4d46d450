#include "studies/accuracy.hpp"

#include <algorithm>
#include <chrono>

#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/base/stop.hpp"
#include "core/trust/doubts.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

namespace {

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The fastest of up to three: other work on the machine only ever adds time.
double least_seconds(const std::function<void()>& work) {
  constexpr double long_enough = 0.5;  // [s]; beyond this a second measurement says little more
  double least = seconds_of(work);
  for (int i = 1; i < 3 && least < long_enough; ++i) least = std::min(least, seconds_of(work));
  return least;
}

ProblemFile discretized(ProblemFile problem, const Discretization& settings) {
  problem.simulation.step = settings.step;
  for (Body& body : problem.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      for (Segment& segment : beam->segments) segment.elements = settings.elements;
    }
  }
  return problem;
}

void keep_values(const Analysis& analysis, AccuracyRun& run) {
  run.values = values_of(analysis);
  run.magnitudes = run.values.cwiseAbs();
  for (Eigen::Index i = 0; i < run.magnitudes.size(); ++i) {
    const Eigen::MatrixXd& history = analysis.histories[static_cast<std::size_t>(i)];
    if (history.size() > 0) run.magnitudes(i) = history.cwiseAbs().maxCoeff();
  }
  run.steps = analysis.trajectory.steps();
  run.newton_iterations = analysis.trajectory.newton_iterations;
  run.factorizations = analysis.trajectory.factorizations;
}

AccuracyRun measure(const ProblemFile& problem, const Discretization& settings) {
  ProblemFile discrete = discretized(problem, settings);
  // The study itself compares steps and elements.
  discrete.simulation.checks_resolution = false;
  const Eigen::VectorXd x = start_design(problem);
  AccuracyRun run;
  run.settings = settings;
  std::unique_ptr<Analysis> analysis;
  run.simulation_seconds = least_seconds([&] { analysis = analyze(discrete, x); });
  keep_values(*analysis, run);
  run.doubts = find_doubts(discrete, x, *analysis);
  if (x.size() == 0) return run;
  run.gradient_seconds = least_seconds([&] { run.gradients = direct_gradients(*analysis); });
  return run;
}

AccuracyRun try_to_measure(const ProblemFile& problem, const Discretization& settings) {
  try {
    return measure(problem, settings);
  } catch (const SimulationError& error) {
    AccuracyRun failed;
    failed.settings = settings;
    failed.failure = error.what();
    return failed;
  }
}

void compare(AccuracyRun& run, const AccuracyRun& reference, const Eigen::VectorXd& x) {
  if (!run.failure.empty()) return;
  run.errors.resize(run.values.size());
  run.gradient_errors.resize(x.size() > 0 ? run.values.size() : 0);
  for (Eigen::Index i = 0; i < run.values.size(); ++i) {
    const double magnitude = reference.magnitudes(i);
    run.errors(i) = value_error(run.values(i), reference.values(i), magnitude);
    if (x.size() == 0) continue;
    run.gradient_errors(i) =
        gradient_error(run.gradients.row(i), reference.gradients.row(i), x, magnitude);
  }
}

/// What is closer to the reference than that is to the truth is not known better.
void raise_to_errors_of(const AccuracyRun& reference, AccuracyRun& run) {
  if (!run.failure.empty()) return;
  run.errors = run.errors.cwiseMax(reference.errors);
  run.gradient_errors = run.gradient_errors.cwiseMax(reference.gradient_errors);
}

/// From a run that is coarser by a factor of 4/3 in space and time, of order 2 in both.
void estimate_errors(AccuracyRun& reference, const ProblemFile& problem) {
  const auto& [step, elements] = reference.settings;
  const int fewer = std::min((3 * elements + 3) / 4, elements - 1);
  AccuracyRun other = measure(problem, {4.0 / 3.0 * step, fewer});
  compare(other, reference, start_design(problem));
  constexpr double share = 1.0 / (16.0 / 9.0 - 1.0);
  reference.errors = share * other.errors;
  reference.gradient_errors = share * other.gradient_errors;
}

AccuracyRun measure_reference(const ProblemFile& problem, const AccuracySettings& settings) {
  const double finest = *std::min_element(settings.steps.begin(), settings.steps.end());
  const int most = *std::max_element(settings.elements.begin(), settings.elements.end());
  AccuracyRun reference = measure(problem, {0.5 * finest, 2 * most});
  estimate_errors(reference, problem);
  return reference;
}

std::optional<std::size_t> fastest(const std::vector<AccuracyRun>& runs, double error) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!runs[i].failure.empty() || runs[i].largest_error() > error) continue;
    if (!best || runs[i].seconds() < runs[*best].seconds()) best = i;
  }
  return best;
}

}  // namespace

double AccuracyRun::largest_error() const {
  const double value = errors.size() > 0 ? errors.maxCoeff() : 0.0;
  return gradient_errors.size() > 0 ? std::max(value, gradient_errors.maxCoeff()) : value;
}

AccuracyStudy accuracy_study(const ProblemFile& problem, const AccuracyObserver& observer) {
  if (!problem.accuracy) throw InputError("/accuracy is missing: it says which steps to try");
  if (problem.responses.empty()) throw InputError("/responses is missing: nothing can be compared");
  const AccuracySettings& settings = *problem.accuracy;
  AccuracyStudy study;
  study.reference = measure_reference(problem, settings);
  if (observer) observer(study.reference);
  for (const int elements : settings.elements) {
    for (const double step : settings.steps) {
      try {
        study.runs.push_back(try_to_measure(problem, {step, elements}));
      } catch (const Stopped&) {
        study.is_interrupted = true;
        return study;
      }
      compare(study.runs.back(), study.reference, start_design(problem));
      raise_to_errors_of(study.reference, study.runs.back());
      if (observer) observer(study.runs.back());
    }
  }
  study.recommended = fastest(study.runs, settings.error);
  return study;
}

}  // namespace pleuel
