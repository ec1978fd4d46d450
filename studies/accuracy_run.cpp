#include "studies/accuracy_run.hpp"

#include <ctime>
#include <tuple>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/relative_error.hpp"
#include "core/trust/checks.hpp"
#include "core/trust/refined_runs.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

namespace {

/// How much larger the mesh of a reference is at least, and how often elements are doubled for it.
constexpr double least_growth = 1.5;
constexpr int most_doublings = 4;

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

std::vector<double> steps_of(const ProblemFile& problem) {
  if (!problem.accuracy.steps.empty()) return problem.accuracy.steps;
  std::vector<double> steps;
  for (const double factor : {4.0, 2.0, 1.0, 0.5}) {
    const double step = factor * problem.simulation.step;
    if (step <= 0.25 * problem.simulation.end_time) steps.push_back(step);
  }
  if (steps.empty()) steps.push_back(problem.simulation.step);
  return steps;
}

std::vector<Discretization> divisions_of(const ProblemFile& problem) {
  std::vector<Discretization> divisions;
  for (const int elements : problem.accuracy.elements) divisions.push_back({0.0, elements});
  if (!divisions.empty()) return divisions;
  const int most = most_elements(problem.scene);
  if (most > 1) divisions.push_back({0.0, 0, 0.5});
  divisions.push_back({0.0, 0, 1.0});
  if (most > 0) divisions.push_back({0.0, 0, 2.0});
  return divisions;
}

/// So many elements in every segment. Segments without a fraction share the length in proportion to
/// their elements: they keep their share.
void divide(BeamBody& beam, int elements) {
  double sum = 0.0;
  for (const Segment& segment : beam.segments) sum += segment.elements;
  for (Segment& segment : beam.segments) {
    if (!segment.fraction) segment.fraction = segment.elements / sum;
    segment.elements = elements;
  }
}

/// What repetitions may take [s]: what takes longer is so far above the noise that once is enough.
constexpr double enough = 0.25;
/// Measured that often, and what is very short until that time is spent [s].
constexpr int repetitions = 4;
constexpr double at_least = 0.03;

bool is_enough(int measurements, double spent) {
  return spent >= enough || (measurements >= repetitions && spent >= at_least);
}

void keep_values(const Analysis& analysis, AccuracyRun& run) {
  run.values = values_of(analysis);
  run.magnitudes = run.values.cwiseAbs();
  for (Eigen::Index i = 0; i < run.magnitudes.size(); ++i) {
    const Eigen::MatrixXd& history = analysis.histories[i];
    if (history.size() > 0) run.magnitudes(i) = history.cwiseAbs().maxCoeff();
  }
  const System& system = *analysis.model.mechanism.system;
  run.steps = analysis.trajectory.steps();
  run.unknowns = system.coordinates() + system.multipliers();
  run.newton_iterations = analysis.trajectory.newton_iterations;
  run.factorizations = analysis.trajectory.factorizations;
}

}  // namespace

std::string name_of(const Discretization& settings) {
  return fmt::format("step {} s, elements {}, factor {}", settings.step, settings.elements,
                     settings.factor);
}

ProblemFile discretized(ProblemFile problem, const Discretization& settings) {
  const double step = problem.simulation.step;
  problem = refined(std::move(problem), {1.0, settings.elements > 0 ? 1.0 : settings.factor});
  problem.simulation.step = settings.step;
  problem.simulation.smallest_step *= settings.step / step;
  if (settings.elements == 0) return problem;
  for (Body& body : problem.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) divide(*beam, settings.elements);
  }
  return problem;
}

std::vector<Discretization> accuracy_grid(const ProblemFile& problem) {
  const std::vector<double> steps = steps_of(problem);
  std::vector<Discretization> grid;
  for (Discretization division : divisions_of(problem)) {
    for (const double step : steps) {
      division.step = step;
      grid.push_back(division);
    }
  }
  return grid;
}

Discretization finer_than(const ProblemFile& problem, const std::vector<Discretization>& grid) {
  Discretization finest = grid.front();
  for (const Discretization& one : grid) {
    finest.step = std::min(finest.step, one.step);
    finest.elements = std::max(finest.elements, one.elements);
    finest.factor = std::max(finest.factor, one.factor);
  }
  finest.step *= 0.5;
  const int size = mesh_size(discretized(problem, finest));
  for (int doubling = 0; doubling < most_doublings; ++doubling) {
    finest.elements *= 2;
    finest.factor *= 2.0;
    if (mesh_size(discretized(problem, finest)) >= least_growth * size) break;
  }
  return finest;
}

Discretization slightly_coarser(Discretization settings) {
  settings.step *= 4.0 / 3.0;
  settings.elements = std::min((3 * settings.elements + 3) / 4, std::max(settings.elements - 1, 0));
  settings.factor *= 3.0 / 4.0;
  return settings;
}

double processor_seconds(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double least_seconds(const std::function<void()>& work) {
  double least = processor_seconds(work);
  double spent = least;
  for (int i = 1; !is_enough(i, spent); ++i) {
    const double seconds = processor_seconds(work);
    spent += seconds;
    least = std::min(least, seconds);
  }
  return least;
}

bool is_same_work(const AccuracyRun& one, const AccuracyRun& other) {
  const auto work = [](const AccuracyRun& run) {
    return std::tuple(run.steps, run.unknowns, run.newton_iterations, run.factorizations);
  };
  return work(one) == work(other);
}

AccuracyRun measure_run(ProblemFile problem, const Eigen::VectorXd& x, Timing timing) {
  // The study itself compares steps and elements.
  problem.simulation.checks_resolution = false;
  const auto seconds_of = timing == Timing::least ? least_seconds : processor_seconds;
  AccuracyRun run;
  std::unique_ptr<Analysis> analysis;
  run.simulation_seconds = seconds_of([&] { analysis = analyze(problem, x); });
  keep_values(*analysis, run);
  run.findings = check_run(problem, x, *analysis);
  if (x.size() == 0) return run;
  run.gradient_seconds = seconds_of([&] { run.gradients = direct_gradients(*analysis); });
  return run;
}

AccuracyRun try_to_measure(const ProblemFile& problem, const Eigen::VectorXd& x, Timing timing) {
  AccuracyRun run;
  run.failure = failure_of([&] { run = measure_run(problem, x, timing); });
  return run;
}

void compare(const AccuracyRun& reference, const Eigen::VectorXd& x, AccuracyRun& run) {
  if (run.has_failed()) return;
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

}  // namespace pleuel
