#include "core/integration/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/integration/checkpoint_plan.hpp"
#include "core/integration/time_loop.hpp"

namespace pleuel {

int step_count(const TimeIntegration& options) {
  // A step that divides the time up to round-off is not shortened.
  return std::max(1, static_cast<int>(std::ceil(options.end_time / options.step * (1 - 1e-12))));
}

std::vector<double> regular_instants(const SimulationOptions& options) {
  constexpr double round_off = 1e-9, least_distance = 0.25;  // of a step
  const int steps = step_count(options);
  const double end = options.end_time, h = end / steps;
  std::vector<double> breaks = options.breaks, instants = {0.0};
  std::sort(breaks.begin(), breaks.end());
  std::erase_if(breaks, [&](double time) { return !(end - time >= least_distance * h); });
  breaks.push_back(end);
  instants.reserve(static_cast<std::size_t>(steps) + 2 * breaks.size());
  double last = 0.0;
  for (const double time : breaks) {
    if (time - last < least_distance * h && time < end) continue;
    const double length = time - last, exact = length / h;
    const int count = std::max(1, static_cast<int>(std::ceil(exact - round_off * exact)));
    const bool is_regular = last == 0.0 && time == end;
    for (int i = 1; i < count; ++i) {
      instants.push_back(is_regular ? end * i / steps : last + length * i / count);
    }
    instants.push_back(time);
    last = time;
  }
  return instants;
}

namespace {

CheckpointPlan make_plan(const Mechanism& mechanism, const SimulationOptions& options) {
  const double n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  const bool is_stabilized = options.formulation.constraints == ConstraintForm::stabilized_index_2;
  const double extra = is_stabilized ? m : options.formulation.is_projected ? 2 * n : 0;
  const double state = 3 * n + m + extra;
  return {sizeof(double) * state, sizeof(double) * (state + (is_stabilized ? 3 : 2) * n),
          options.memory};
}

/// All states, or nothing if they turn out not to fit into the memory.
std::optional<Trajectory> simulate_whole(TimeLoop loop, const CheckpointPlan& plan) {
  if (!plan.holds(loop.units() + 1.0)) return std::nullopt;
  loop.start(loop.units() + 1);
  for (int unit = 1; unit <= loop.units(); ++unit) {
    loop.advance(unit);
    if (!plan.holds(static_cast<double>(loop.instant() + 1))) return std::nullopt;
  }
  Trajectory trajectory = loop.trajectory();
  loop.window().move_to(trajectory);
  return trajectory;
}

/// A simulation that keeps checkpoints only (checkpoint_plan.hpp). Where the number of steps is not
/// known beforehand, every second one is given up whenever there are too many.
class CheckpointedLoop : public RepeatedStates {
 public:
  CheckpointedLoop(TimeLoop loop, const CheckpointPlan& plan)
      : loop_(std::move(loop)), plan_(plan) {
    const int states = loop_.units() + 1;
    if (plan_.most_states() < states) throw InputError(too_little(states, states));
    stretch_ = plan_.stretch_for(states);
  }

  Trajectory run() {
    loop_.start(plan_.longest_stretch() + 1);
    checkpoints_.push_back(loop_.checkpoint(0));
    for (int unit = 1; unit <= loop_.units(); ++unit) {
      loop_.advance(unit);
      note_length(loop_.instant() - checkpoints_.back().instant);
      if (unit < loop_.units()) keep(unit);
    }
    end_ = loop_.instant();
    return loop_.trajectory();
  }

  void load(int step, State& state) override {
    hold(step);
    state.time = loop_.time(step);
    loop_.window().load(step, state);
  }
  void load_eta(int step, Eigen::VectorXd& eta) override {
    hold(step);
    loop_.window().load_eta(step, eta);
  }
  void load_drifted(int step, State& state) override {
    hold(step);
    loop_.window().load_drifted(step, state);
  }

  int checkpoints() const override { return static_cast<int>(checkpoints_.size()); }
  int most_held() const override { return static_cast<int>(most_held_); }
  int repeated_steps() const override { return static_cast<int>(repeated_steps_); }

 private:
  void keep(int unit) {
    if (loop_.instant() - checkpoints_.back().instant < stretch_) return;
    if (checkpoints() == plan_.most_checkpoints()) thin_out();
    if (loop_.instant() - checkpoints_.back().instant < stretch_) return;
    checkpoints_.push_back(loop_.checkpoint(unit));
    loop_.empty_window();
  }

  void thin_out() {
    std::vector<TimeLoop::Checkpoint> kept;
    for (std::size_t i = 0; i < checkpoints_.size(); i += 2) {
      if (i > 0) note_length(checkpoints_[i].instant - kept.back().instant);
      kept.push_back(std::move(checkpoints_[i]));
    }
    checkpoints_ = std::move(kept);
    stretch_ *= 2;
    note_length(loop_.instant() - checkpoints_.back().instant);
  }

  void note_length(Eigen::Index states) {
    if (states > plan_.longest_stretch()) {
      // Giving up every second checkpoint may leave half of the room unused.
      const int so_far = static_cast<int>(loop_.instant()) + 1;
      throw SimulationError(too_little(so_far, 2 * so_far));
    }
    most_held_ = std::max(most_held_, states + 1);
  }

  std::string too_little(int states, int room) const {
    constexpr double rounded_up = 1.01;  // of three digits
    return fmt::format(
        "/sensitivity/memory is too little: {:.3g} MB do not hold the checkpoints of {} steps; at "
        "least {:.3g} MB do",
        plan_.memory * 1e-6, states - 1, rounded_up * plan_.least_memory(room) * 1e-6);
  }

  /// Simulates the stretch of a step again if it is not at hand.
  void hold(Eigen::Index step) {
    if (loop_.window().holds(step)) return;
    const auto next = std::upper_bound(
        checkpoints_.begin(), checkpoints_.end(), step,
        [](Eigen::Index instant, const auto& checkpoint) { return instant < checkpoint.instant; });
    const Eigen::Index end = next == checkpoints_.end() ? end_ : next->instant;
    const TimeLoop::Checkpoint& from = *std::prev(next);
    loop_.restore(from);
    for (int unit = from.unit + 1; loop_.instant() < end; ++unit) loop_.advance(unit);
    repeated_steps_ += end - from.instant;
  }

  TimeLoop loop_;
  CheckpointPlan plan_;
  std::vector<TimeLoop::Checkpoint> checkpoints_;
  Eigen::Index stretch_ = 1, end_ = 0, most_held_ = 1, repeated_steps_ = 0;
};

}  // namespace

Trajectory simulate(Mechanism& mechanism, const SimulationOptions& options,
                    const InstantObserver& observer) {
  const CheckpointPlan plan = make_plan(mechanism, options);
  if (auto whole = simulate_whole({mechanism, options, observer}, plan)) return std::move(*whole);
  auto loop = std::make_shared<CheckpointedLoop>(TimeLoop(mechanism, options, observer), plan);
  Trajectory trajectory = loop->run();
  trajectory.repeated = std::move(loop);
  return trajectory;
}

}  // namespace pleuel
