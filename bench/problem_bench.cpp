/// Time of one simulation (with its responses) and of one gradient of every problem file, at the
/// start design. Ratios within one run are what can be compared between machines.

#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "core/scene/problem_reader.hpp"
#include "sensitivity/gradients.hpp"

namespace pleuel {
namespace {

void simulate_problem(benchmark::State& state, const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  double steps = 0.0, newton = 0.0, unknowns = 0.0;
  for (auto _ : state) {
    const auto analysis = analyze(problem, x);
    steps = analysis->trajectory.steps();
    newton = analysis->trajectory.newton_iterations;
    unknowns = analysis->model.mechanism.system->size();
  }
  state.counters["steps"] = steps;
  state.counters["newton_per_step"] = newton / steps;
  state.counters["unknowns"] = unknowns;
  state.counters["step_time"] = benchmark::Counter(
      steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void differentiate_problem(benchmark::State& state, const ProblemFile& problem,
                           ExactMethod method) {
  const auto analysis = analyze(problem, start_design(problem));
  const auto values = response_values(*analysis);
  for (auto _ : state) benchmark::DoNotOptimize(sampled_gradients(*analysis, values, method));
  state.counters["variables"] = static_cast<double>(problem.variables.size());
}

void register_problem(const std::string& file, const std::vector<std::string>& overrides) {
  const ProblemFile problem =
      read_problem(std::filesystem::path(PLEUEL_SOURCE_DIR) / "problems" / (file + ".json"),
                   overrides)
          .complete();
  std::string name = file;
  for (const std::string& assignment : overrides) name += " " + assignment;
  benchmark::RegisterBenchmark(("simulate/" + name).c_str(), simulate_problem, problem)
      ->Unit(benchmark::kMillisecond);
  if (problem.variables.empty()) return;
  benchmark::RegisterBenchmark(("direct/" + name).c_str(), differentiate_problem, problem,
                               ExactMethod::direct)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("adjoint/" + name).c_str(), differentiate_problem, problem,
                               ExactMethod::adjoint)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace pleuel

int main(int argc, char** argv) {
  for (const char* name :
       {"slider_crank", "slider_crank_round", "slider_crank_tapered", "slider_crank_exudyn",
        "four_bar", "spatial_slider_crank", "robot_arm"}) {
    pleuel::register_problem(name, {});
  }
  // The same mechanism with everything forced on: what the analysis of the scene saves.
  pleuel::register_problem("slider_crank", {"/effects/spatial_motion=on"});
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
