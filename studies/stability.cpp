#include "studies/stability.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/stop.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/response/monitors.hpp"
#include "core/scene/load_cases.hpp"
#include "core/trust/checks.hpp"
#include "optimization/problem.hpp"

namespace pleuel {

namespace {

/// What all runs of a study are read with.
struct FileReading {
  const std::vector<std::string>& overrides;
  const std::optional<std::string>& load_case;
};

UndecidedProblem read_with(const std::filesystem::path& file, const FileReading& reading,
                           const ComparedFormulation& formulation) {
  std::vector<std::string> overrides = reading.overrides;
  overrides.insert(overrides.end(), formulation.overrides.begin(), formulation.overrides.end());
  UndecidedProblem read = read_problem(file, overrides);
  if (!reading.load_case) return read;
  return UndecidedProblem(problem_of_case(read.complete(), *reading.load_case));
}

void measure(UndecidedProblem read, StabilityRun& run) {
  const ProblemFile problem = decided(std::move(read));
  const Stopwatch stopwatch;
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x, values_only);
  run.seconds = stopwatch.seconds();
  const Trajectory& trajectory = analysis->trajectory;
  run.steps = trajectory.steps();
  run.newton_iterations = trajectory.newton_iterations;
  run.factorizations = trajectory.factorizations;
  run.condition = trajectory.worst_condition;
  const Monitors monitors = monitor(analysis->model, trajectory);
  run.position_drift = monitors.position_drift;
  run.velocity_drift = monitors.velocity_drift;
  run.energy_error = monitors.energy_error;
  run.warnings = texts_of(check_run(TrustedRun{problem, x, *analysis, monitors}));
}

/// Overrides that set a formulation, without a projection unless that follows.
std::vector<std::string> formulation(const std::string& name,
                                     const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"/simulation/formulation=" + name,
                                        "/simulation/projection=false"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

/// A failure may also be that the problem does not go with the formulation, as a motion that repeats
/// itself with one that drifts.
StabilityRun try_to_measure(const std::filesystem::path& file, const FileReading& reading,
                            const ComparedFormulation& formulation) {
  StabilityRun run;
  run.file = file;
  run.formulation = formulation.name;
  run.problem = read_with(file, reading, compared_formulations().front()).complete().name;
  run.failure = failure_of([&] { measure(read_with(file, reading, formulation), run); });
  return run;
}

}  // namespace

const std::vector<ComparedFormulation>& compared_formulations() {
  static const std::vector<ComparedFormulation> all = {
      {"index-3", formulation("index-3")},
      {"stabilized-index-2", formulation("stabilized-index-2")},
      {"index-1", formulation("index-1")},
      {"index-1 with Baumgarte", formulation("index-1", {"/simulation/baumgarte=100"})},
      {"index-1 with projection", formulation("index-1", {"/simulation/projection=true"})},
      {"index-3, Newmark", formulation("index-3", {"/simulation/scheme=newmark"})},
      {"index-3, implicit Euler", formulation("index-3", {"/simulation/scheme=implicit-euler"})},
  };
  return all;
}

std::vector<StabilityRun> stability_study(const std::vector<std::filesystem::path>& files,
                                          const std::vector<std::string>& overrides,
                                          const StabilityObserver& observer,
                                          const std::optional<std::string>& load_case) {
  const FileReading reading{overrides, load_case};
  // Bad input shall not cost the runs before it.
  for (const auto& file : files) read_with(file, reading, compared_formulations().front());
  std::vector<StabilityRun> runs;
  for (const auto& file : files) {
    for (const ComparedFormulation& formulation : compared_formulations()) {
      try {
        runs.push_back(try_to_measure(file, reading, formulation));
      } catch (const Stopped&) {
        if (runs.empty()) throw;
        return runs;
      }
      if (observer) observer(runs.back());
    }
  }
  return runs;
}

}  // namespace pleuel
