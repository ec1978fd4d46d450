#include "sensitivity/method_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/stopwatch.hpp"
#include "sensitivity/adjoint.hpp"
#include "sensitivity/direct.hpp"

namespace pleuel {

namespace {

/// Steps that are timed, and how often: the least processor time of a few is hardly disturbed by what
/// else the machine does.
constexpr int measured_steps = 32;
constexpr int measurements = 3;
/// The adjoint has to be faster by this factor: measurements scatter.
constexpr double clear_gain = 1.3;

template <class Function>
double seconds_of(Function&& function) {
  const ThreadStopwatch stopwatch;
  function();
  return stopwatch.seconds();
}

/// The last steps of a trajectory, as one of their own.
Trajectory last_steps(const Trajectory& all, int steps) {
  Trajectory part;
  part.scheme = all.scheme;
  part.scheme_type = all.scheme_type;
  part.spectral_radius = all.spectral_radius;
  part.formulation = all.formulation;
  part.has_constraints = all.has_constraints;
  part.time = all.time.tail(steps + 1);
  RecordedState state;
  all.states->load_record(all.steps(), state);
  StateColumns columns(state, steps + 1);
  for (int i = 0; i <= steps; ++i) {
    all.states->load_record(all.steps() - steps + i, state);
    columns.set(i, state);
  }
  part.states = std::make_shared<StoredStates>(std::move(columns));
  return part;
}

/// What it takes to simulate so many steps again, where the trajectory does not hold its states:
/// each of the two methods has to go through all of them once.
double seconds_of_repetition(const Trajectory& trajectory, int steps) {
  const RecomputedStates* states = trajectory.recomputed();
  if (!states) return 0.0;
  const int before = states->recomputed_steps();
  State state;
  const double seconds = seconds_of([&] { trajectory.states->load(1, state); });
  const int recomputed = states->recomputed_steps() - before;
  return recomputed > 0 ? seconds * steps / recomputed : 0.0;
}

/// How much of the time the adjoints of the values are alive, in columns: a value counts from its
/// last sample back to the start.
double mean_columns(const Analysis& analysis, const std::vector<SampledValue>& values) {
  double sum = 0.0;
  for (const SampledValue& value : values) sum += std::max(last_step(analysis, value), 0);
  return sum / analysis.trajectory.steps();
}

}  // namespace

ExactMethod cheaper_method(double direct, double adjoint) {
  return direct > clear_gain * adjoint ? ExactMethod::adjoint : ExactMethod::direct;
}

int values_of_motion(const Analysis& analysis, const std::vector<SampledValue>& values) {
  return static_cast<int>(
      std::count_if(values.begin(), values.end(),
                    [&](const SampledValue& value) { return last_step(analysis, value) >= 0; }));
}

MethodChoice choose_method(Analysis& analysis, const std::vector<SampledValue>& values) {
  Mechanism& mechanism = analysis.model.mechanism;
  const int variables = mechanism.system->variables();
  const int functions = values_of_motion(analysis, values);
  const std::string counts =
      fmt::format("{} variable{}, {} value{} of the motion", variables, variables == 1 ? "" : "s",
                  functions, functions == 1 ? "" : "s");
  const int steps = analysis.trajectory.steps();
  if (variables <= functions || steps < 2 * measured_steps) return {ExactMethod::direct, counts};

  const Trajectory part = last_steps(analysis.trajectory, measured_steps);
  const double repetition = seconds_of_repetition(analysis.trajectory, measured_steps);
  const int columns = std::max(1, static_cast<int>(std::lround(mean_columns(analysis, values))));
  const auto begin_all = [&](int step, const State&, StateAdjoint& of) {
    if (step == part.steps()) of.q.setOnes();
    return columns;
  };
  const auto differentiate_part = [&] {
    differentiate(mechanism, part, [](int, const State&, const StateSensitivity&) {});
  };
  const auto go_back = [&] { adjoint_gradients(mechanism, part, columns, begin_all); };
  double direct = std::numeric_limits<double>::infinity(), adjoint = direct;
  for (int i = 0; i < measurements; ++i) {
    direct = std::min(direct, repetition + seconds_of(differentiate_part));
    adjoint = std::min(adjoint, repetition + seconds_of(go_back));
  }
  return {cheaper_method(direct, adjoint),
          fmt::format("{}: direct takes {:.2g} times as long as the adjoint in a short stretch{}",
                      counts, direct / adjoint,
                      analysis.trajectory.recomputed() ? ", which both have simulated again" : "")};
}

}  // namespace pleuel
