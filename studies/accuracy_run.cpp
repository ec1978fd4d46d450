#include "studies/accuracy_run.hpp"

#include <algorithm>
#include <ctime>
#include <memory>
#include <tuple>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/trust/checks.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {

namespace {

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
  AccuracyRun failed;
  try {
    return measure_run(problem, x, timing);
  } catch (const SimulationError& error) {
    failed.failure = error.what();
  } catch (const InputError& error) {  // a window of time without steps, too many modes …
    failed.failure = error.what();
  }
  return failed;
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
