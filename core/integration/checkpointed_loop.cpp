#include "core/integration/checkpointed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

int whole(double number) {
  return static_cast<int>(std::min(number, double{std::numeric_limits<int>::max()}));
}

}  // namespace

int CheckpointPlan::most_checkpoints() const {
  return whole(std::floor(0.5 * memory / checkpoint_bytes));
}

int CheckpointPlan::longest_stretch() const {
  return std::max(0, whole(std::floor(0.5 * memory / state_bytes)) - 1);
}

int CheckpointPlan::most_states() const {
  return whole(1.0 * most_checkpoints() * longest_stretch());
}

int CheckpointPlan::stretch_for(int states) const {
  return std::max(1, (states + most_checkpoints() - 1) / std::max(most_checkpoints(), 1));
}

double CheckpointPlan::least_memory(int states) const {
  const double balanced = std::sqrt(states * state_bytes * checkpoint_bytes);
  // Neither half holds a part of a state; the end of a stretch is the next checkpoint.
  return 2.0 * (balanced + checkpoint_bytes + state_bytes);
}

namespace {

class CheckpointedLoop : public RecomputedStates {
 public:
  CheckpointedLoop(TimeLoop loop, const CheckpointPlan& plan)
      : loop_(std::move(loop)), plan_(plan) {
    const int states = loop_.units() + 1;
    if (plan_.most_states() < states)
      throw InputError(too_little(states, plan_.least_memory(states)));
    stretch_ = plan_.stretch_for(states);
  }

  Trajectory run() {
    loop_.start(plan_.longest_stretch() + 1);
    checkpoints_.push_back(loop_.checkpoint(0));
    for (int unit = 1; unit <= loop_.units(); ++unit) {
      loop_.advance(unit);
      record_length(loop_.instant() - checkpoints_.back().instant);
      if (unit < loop_.units()) keep(unit);
    }
    end_ = loop_.instant();
    return loop_.end();
  }

  void load(int step, State& state) override {
    hold(step);
    loop_.window().load(step, state);
  }
  void load_record(int step, RecordedState& state) override {
    hold(step);
    loop_.window().load_record(step, state);
  }

  int checkpoints() const override { return int_size(checkpoints_); }
  int most_held() const override { return static_cast<int>(most_held_); }
  int recomputed_steps() const override { return static_cast<int>(recomputed_steps_); }

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
      if (i > 0) record_length(checkpoints_[i].instant - kept.back().instant);
      kept.push_back(std::move(checkpoints_[i]));
    }
    checkpoints_ = std::move(kept);
    stretch_ *= 2;
    record_length(loop_.instant() - checkpoints_.back().instant);
  }

  void record_length(Eigen::Index states) {
    if (states > plan_.longest_stretch()) {
      // Giving up every second checkpoint may leave half of the memory unused.
      const int so_far = static_cast<int>(loop_.instant()) + 1;
      const double guess = std::max(plan_.least_memory(2 * so_far), 2.0 * plan_.memory);
      throw SimulationError(too_little(so_far, guess));
    }
    most_held_ = std::max(most_held_, states + 1);
  }

  std::string too_little(int states, double needed) const {
    constexpr double rounded_up = 1.01;  // of three digits
    return fmt::format(
        "/sensitivity/memory is too little: {:.3g} MB do not hold the checkpoints of {} steps; at "
        "least {:.3g} MB do",
        plan_.memory * 1e-6, states - 1, rounded_up * needed * 1e-6);
  }

  /// Simulates the stretch of a step again if it is not at hand.
  void hold(Eigen::Index step) {
    if (loop_.window().holds(step)) return;
    const auto next =
        std::ranges::upper_bound(checkpoints_, step, {}, &TimeLoop::Checkpoint::instant);
    const Eigen::Index end = next == checkpoints_.end() ? end_ : next->instant;
    const TimeLoop::Checkpoint& from = *std::prev(next);
    loop_.restore(from);
    for (int unit = from.unit + 1; loop_.instant() < end; ++unit) loop_.advance(unit);
    recomputed_steps_ += end - from.instant;
  }

  TimeLoop loop_;
  CheckpointPlan plan_;
  std::vector<TimeLoop::Checkpoint> checkpoints_;
  Eigen::Index stretch_ = 1, end_ = 0, most_held_ = 1, recomputed_steps_ = 0;
};

}  // namespace

Trajectory simulate_with_checkpoints(TimeLoop loop, const CheckpointPlan& plan) {
  auto states = std::make_shared<CheckpointedLoop>(std::move(loop), plan);
  Trajectory trajectory = states->run();
  trajectory.states = std::move(states);
  return trajectory;
}

}  // namespace pleuel
