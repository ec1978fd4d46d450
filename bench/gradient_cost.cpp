/// What gradients and formulations of the constraints cost, as ratios within one interleaved run
/// (processor time, medians): of the problem files simulation and gradient together over the
/// simulation with its responses (of all responses, and by direct differentiation of objective and
/// limits only), and the simulation in each formulation over that in index 3.
///
///     gradient_cost [repetitions, default 15] [problem …]

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/stopwatch.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "sensitivity/sampled_gradients.hpp"

namespace pleuel {
namespace {

using Times = std::vector<double>;

template <class Call>
double seconds(const Call& call) {
  const ThreadStopwatch stopwatch;
  call();
  return stopwatch.seconds();
}

double median(Times times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

ProblemFile problem(const std::string& name, const std::string& formulation) {
  return read_problem(std::string(PLEUEL_SOURCE_DIR) + "/problems/" + name + ".json",
                      {"/simulation/formulation=" + formulation})
      .complete();
}

/// What an optimization asks for: objective and limits.
std::vector<SampledValue> limited_values(const ProblemFile& file, const Analysis& analysis) {
  std::vector<SampledValue> values;
  for (const SampledValue& value : response_values(analysis)) {
    const std::string& name = file.responses[value.response].name;
    const auto limits = [&](const auto& limit) { return limit.response == name; };
    const bool is_limited = std::any_of(file.constraints.begin(), file.constraints.end(), limits) ||
                            (file.objective && file.objective->response == name);
    if (is_limited) values.push_back(value);
  }
  return values;
}

void compare_gradients(const std::string& name, int repetitions) {
  const ProblemFile file = problem(name, "index-3");
  const Eigen::VectorXd x = start_design(file);
  std::unique_ptr<Analysis> analysis;
  Times simulation, direct, adjoint, limited;
  for (int i = 0; i < repetitions; ++i) {
    simulation.push_back(seconds([&] { analysis = analyze(file, x); }));
    const auto cost = [&](const std::vector<SampledValue>& values, ExactMethod method) {
      return 1.0 +
             seconds([&] { sampled_gradients(*analysis, values, method); }) / simulation.back();
    };
    const auto all = response_values(*analysis);
    direct.push_back(cost(all, ExactMethod::direct));
    adjoint.push_back(cost(all, ExactMethod::adjoint));
    limited.push_back(cost(limited_values(file, *analysis), ExactMethod::direct));
  }
  fmt::print("{:22} {:9} {:10.2f} us {:8.2f} {:8.2f} {:8.2f}\n", name, x.size(),
             1e6 * median(simulation) / analysis->trajectory.steps(), median(direct),
             median(adjoint), median(limited));
}

void compare_formulations(const std::string& name, int repetitions) {
  std::vector<ProblemFile> files;
  for (const char* form : {"index-3", "stabilized-index-2", "index-1"}) {
    files.push_back(problem(name, form));
  }
  const Eigen::VectorXd x = start_design(files.front());
  std::vector<Times> ratios(files.size());
  for (int i = 0; i < repetitions; ++i) {
    Times times;
    for (const ProblemFile& file : files) times.push_back(seconds([&] { analyze(file, x); }));
    for (std::size_t k = 0; k < files.size(); ++k) ratios[k].push_back(times[k] / times[0]);
  }
  fmt::print("{:22} {:14.2f} {:14.2f}\n", name, median(ratios[1]), median(ratios[2]));
}

}  // namespace
}  // namespace pleuel

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 15;
  std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
  if (names.empty()) {
    names = {"slider_crank", "slider_crank_round",   "slider_crank_tapered",
             "four_bar",     "spatial_slider_crank", "robot_arm"};
  }
  fmt::print("{:22} {} {:>13} {:>8} {:>8} {:>8}\n", "with a gradient", "variables", "a step",
             "direct", "adjoint", "limits");
  for (const std::string& name : names) pleuel::compare_gradients(name, repetitions);
  fmt::print("\n{:22} {:>14} {:>14}\n", "over index 3", "stab. index 2", "index 1");
  for (const std::string& name : names) pleuel::compare_formulations(name, repetitions);
}
