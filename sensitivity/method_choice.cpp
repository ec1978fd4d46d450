#include "sensitivity/method_choice.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "sensitivity/adjoint.hpp"
#include "sensitivity/direct.hpp"

namespace pleuel {

namespace {

/// Steps that are timed.
constexpr int measured_steps = 32;
/// The adjoint has to be faster by this factor: measurements scatter.
constexpr double clear_gain = 1.3;

template <class Function>
double seconds_of(Function&& function) {
  const auto begin = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The last steps of a trajectory, as one of their own.
Trajectory last_steps(const Trajectory& all, int steps) {
  Trajectory part = all;
  part.time = all.time.tail(steps + 1).eval();
  const auto cut = [&](const Eigen::MatrixXd& from) { return from.rightCols(steps + 1).eval(); };
  part.q = cut(all.q);
  part.v = cut(all.v);
  part.a = cut(all.a);
  part.lambda = cut(all.lambda);
  part.eta = cut(all.eta);
  part.drifted_q = cut(all.drifted_q);
  part.drifted_v = cut(all.drifted_v);
  return part;
}

/// How much of the time the adjoints of the values are alive, in columns: a value counts from its
/// last sample back to the start.
double mean_columns(const std::vector<SampledValue>& values, int steps) {
  double sum = 0.0;
  for (const SampledValue& value : values) {
    int last = 0;
    for (const Sample& sample : value.samples) last = std::max(last, sample.step);
    sum += static_cast<double>(last) / steps;
  }
  return sum;
}

}  // namespace

ExactMethod cheaper_method(double direct, double adjoint) {
  return direct > clear_gain * adjoint ? ExactMethod::adjoint : ExactMethod::direct;
}

MethodChoice choose_method(Analysis& analysis, const std::vector<SampledValue>& values) {
  Mechanism& mechanism = analysis.model.mechanism;
  const int variables = mechanism.system->variables();
  const auto functions = static_cast<int>(std::count_if(
      values.begin(), values.end(), [](const auto& value) { return !value.samples.empty(); }));
  const std::string counts =
      fmt::format("{} variable{}, {} value{} of the motion", variables, variables == 1 ? "" : "s",
                  functions, functions == 1 ? "" : "s");
  const int steps = analysis.trajectory.steps();
  if (variables <= functions || steps < 2 * measured_steps) return {ExactMethod::direct, counts};

  const Trajectory part = last_steps(analysis.trajectory, measured_steps);
  const double direct = seconds_of(
      [&] { differentiate(mechanism, part, [](int, const State&, const StateSensitivity&) {}); });
  const int columns = std::max(1, static_cast<int>(std::lround(mean_columns(values, steps))));
  const double adjoint = seconds_of([&] {
    adjoint_gradients(mechanism, part, columns, [&](int step, const State&, StateAdjoint& of) {
      if (step == part.steps()) of.q.setOnes();
      return columns;
    });
  });
  return {cheaper_method(direct, adjoint),
          fmt::format("{}: direct takes {:.2g} times as long as the adjoint in a short stretch",
                      counts, direct / adjoint)};
}

}  // namespace pleuel
