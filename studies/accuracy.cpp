#include "studies/accuracy.hpp"

#include <algorithm>
#include <ctime>

#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/base/stop.hpp"
#include "core/trust/doubts.hpp"
#include "core/trust/nested_runs.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

namespace {

/// Processor time: what else runs on the machine does not count.
double seconds_of(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// The least of up to three: caches that others filled only ever add time.
double least_seconds(const std::function<void()>& work) {
  constexpr double long_enough = 0.5;  // [s]; beyond this a second measurement says little more
  double least = seconds_of(work);
  for (int i = 1; i < 3 && least < long_enough; ++i) least = std::min(least, seconds_of(work));
  return least;
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

class Measuring {
 public:
  Measuring(const ProblemFile& problem, const Eigen::VectorXd& x) : problem_(problem), x_(x) {}

  AccuracyRun measure(const Discretization& settings) const {
    ProblemFile discrete = discretized(problem_, settings);
    // The study itself compares steps and elements.
    discrete.simulation.checks_resolution = false;
    AccuracyRun run;
    run.settings = settings;
    std::unique_ptr<Analysis> analysis;
    run.simulation_seconds = least_seconds([&] { analysis = analyze(discrete, x_); });
    keep_values(*analysis, run);
    run.doubts = find_doubts(discrete, x_, *analysis);
    if (x_.size() == 0) return run;
    run.gradient_seconds = least_seconds([&] { run.gradients = direct_gradients(*analysis); });
    return run;
  }

  AccuracyRun try_to_measure(const Discretization& settings) const {
    try {
      return measure(settings);
    } catch (const SimulationError& error) {
      AccuracyRun failed;
      failed.settings = settings;
      failed.failure = error.what();
      return failed;
    }
  }

  void compare(AccuracyRun& run, const AccuracyRun& reference) const {
    if (!run.failure.empty()) return;
    run.errors.resize(run.values.size());
    run.gradient_errors.resize(x_.size() > 0 ? run.values.size() : 0);
    for (Eigen::Index i = 0; i < run.values.size(); ++i) {
      const double magnitude = reference.magnitudes(i);
      run.errors(i) = value_error(run.values(i), reference.values(i), magnitude);
      if (x_.size() == 0) continue;
      run.gradient_errors(i) =
          gradient_error(run.gradients.row(i), reference.gradients.row(i), x_, magnitude);
    }
  }

  AccuracyRun reference(const std::vector<Discretization>& grid) const {
    Discretization finest = grid.front();
    for (const Discretization& one : grid) {
      finest.step = std::min(finest.step, one.step);
      finest.elements = std::max(finest.elements, one.elements);
      finest.factor = std::max(finest.factor, one.factor);
    }
    finest.step *= 0.5;
    finest.elements *= 2;
    finest.factor *= 2.0;
    AccuracyRun reference = measure(finest);
    estimate_errors(reference);
    return reference;
  }

 private:
  /// From a run that is coarser by a factor of 4/3 in space and time, of order 2 in both.
  void estimate_errors(AccuracyRun& reference) const {
    Discretization coarser = reference.settings;
    coarser.step *= 4.0 / 3.0;
    coarser.elements = std::min((3 * coarser.elements + 3) / 4, std::max(coarser.elements - 1, 0));
    coarser.factor *= 3.0 / 4.0;
    AccuracyRun other = measure(coarser);
    compare(other, reference);
    constexpr double share = 1.0 / (16.0 / 9.0 - 1.0);
    reference.errors = share * other.errors;
    reference.gradient_errors = share * other.gradient_errors;
  }

  const ProblemFile& problem_;
  const Eigen::VectorXd& x_;
};

/// What is closer to the reference than that is to the truth is not known better.
void raise_to_errors_of(const AccuracyRun& reference, AccuracyRun& run) {
  if (!run.failure.empty()) return;
  run.errors = run.errors.cwiseMax(reference.errors);
  run.gradient_errors = run.gradient_errors.cwiseMax(reference.gradient_errors);
}

std::vector<std::size_t> counted_responses(const ProblemFile& problem) {
  std::vector<std::size_t> counted;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    const std::string& name = problem.responses[i].name;
    const bool is_limited = std::any_of(
        problem.constraints.begin(), problem.constraints.end(),
        [&](const ConstraintSettings& constraint) { return constraint.response == name; });
    if (is_limited || (problem.objective && problem.objective->response == name)) {
      counted.push_back(i);
    }
  }
  if (!counted.empty()) return counted;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) counted.push_back(i);
  return counted;
}

double largest(const Eigen::VectorXd& errors, const std::vector<std::size_t>& counted) {
  double largest = 0.0;
  if (errors.size() == 0) return largest;
  for (const std::size_t i : counted) {
    largest = std::max(largest, errors(static_cast<Eigen::Index>(i)));
  }
  return largest;
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
    if (!run.failure.empty() || largest(run.errors, study.counted) > target) continue;
    improve(best.values, i, run.simulation_seconds,
            best.values ? study.runs[*best.values].simulation_seconds : 0.0);
    if (largest(run.gradient_errors, study.counted) > target) continue;
    improve(best.gradients, i, run.seconds(),
            best.gradients ? study.runs[*best.gradients].seconds() : 0.0);
  }
  return best;
}

/// Of a segment of an elastic beam; 0 without any.
int most_elements(const Scene& scene) {
  int most = 0;
  for (const Body& body : scene.bodies) {
    const auto* beam = std::get_if<BeamBody>(&body.shape);
    if (beam == nullptr || beam->is_rigid) continue;
    for (const Segment& segment : beam->segments) most = std::max(most, segment.elements);
  }
  return most;
}

/// Of the file, then by tens.
constexpr int recommended_targets = 3;

}  // namespace

ProblemFile discretized(ProblemFile problem, const Discretization& settings) {
  const double step = problem.simulation.step;
  problem = refined(std::move(problem), {1.0, settings.elements > 0 ? 1.0 : settings.factor});
  problem.simulation.step = settings.step;
  problem.simulation.smallest_step *= settings.step / step;
  if (settings.elements == 0) return problem;
  for (Body& body : problem.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      for (Segment& segment : beam->segments) segment.elements = settings.elements;
    }
  }
  return problem;
}

std::vector<Discretization> accuracy_grid(const ProblemFile& problem) {
  std::vector<double> steps = problem.accuracy.steps;
  if (steps.empty()) {
    for (const double factor : {4.0, 2.0, 1.0, 0.5}) {
      const double step = factor * problem.simulation.step;
      if (step <= 0.25 * problem.simulation.end_time) steps.push_back(step);
    }
    if (steps.empty()) steps.push_back(problem.simulation.step);
  }
  std::vector<Discretization> divisions;
  for (const int elements : problem.accuracy.elements) divisions.push_back({0.0, elements});
  if (divisions.empty()) {
    const int most = most_elements(problem.scene);
    if (most > 1) divisions.push_back({0.0, 0, 0.5});
    divisions.push_back({0.0, 0, 1.0});
    if (most > 0) divisions.push_back({0.0, 0, 2.0});
  }
  std::vector<Discretization> grid;
  for (Discretization division : divisions) {
    for (const double step : steps) {
      division.step = step;
      grid.push_back(division);
    }
  }
  return grid;
}

AccuracyStudy accuracy_study(const ProblemFile& problem, const Eigen::VectorXd& x,
                             const AccuracyObserver& observer) {
  if (problem.responses.empty()) throw InputError("/responses is missing: nothing can be compared");
  const std::vector<Discretization> grid = accuracy_grid(problem);
  const Measuring measuring(problem, x);
  AccuracyStudy study;
  study.counted = counted_responses(problem);
  study.reference = measuring.reference(grid);
  if (observer) observer(study.reference);
  for (const Discretization& settings : grid) {
    try {
      study.runs.push_back(measuring.try_to_measure(settings));
    } catch (const Stopped&) {
      study.is_interrupted = true;
      return study;
    }
    measuring.compare(study.runs.back(), study.reference);
    raise_to_errors_of(study.reference, study.runs.back());
    if (observer) observer(study.runs.back());
  }
  double target = problem.accuracy.target;
  for (int i = 0; i < recommended_targets; ++i, target *= 0.1) {
    study.recommendations.push_back(recommend(study, target));
  }
  return study;
}

}  // namespace pleuel
