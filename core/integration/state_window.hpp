#pragma once

#include "core/integration/simulate.hpp"
#include "core/integration/step_equations.hpp"

namespace pleuel {

/// The states of consecutive instants, a column each. Their times are kept elsewhere.
class StateWindow {
 public:
  /// Room for so many states of this size; holds none.
  void resize(const StepState& like, Eigen::Index columns);
  void make_room(Eigen::Index columns);
  /// Empty, with this instant to come.
  void clear(Eigen::Index next);
  void push(const StepState& state);

  Eigen::Index capacity() const { return q_.cols(); }
  bool is_full() const { return count_ == capacity(); }
  bool holds(Eigen::Index instant) const { return instant >= first_ && instant < first_ + count_; }
  void load(Eigen::Index instant, State& state) const;
  void load_eta(Eigen::Index instant, Eigen::VectorXd& eta) const;
  /// q and v before the projection only.
  void load_drifted(Eigen::Index instant, State& state) const;

  /// Gives all states to a trajectory.
  void move_to(Trajectory& trajectory);

 private:
  Eigen::Index first_ = 0, count_ = 0;
  Eigen::MatrixXd q_, v_, a_, lambda_, eta_, drifted_q_, drifted_v_;
};

}  // namespace pleuel
