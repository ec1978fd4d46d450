#pragma once

#include "core/integration/step_equations.hpp"

namespace pleuel {

/// The state that Newton's method begins a step with: y⁺ = history · y (for q as q ⊕ increment),
/// then the correction that leads to an acceleration: the one on the straight line through those at
/// both ends of the step before,
///     a⁺ = a + (h / h₋) (a − a₋)
/// which is closer to that of a smooth motion than a⁺ = a by one order of h, so that one iteration
/// is enough more often. Where the line would have missed the last acceleration by more (vibrations
/// that the steps do not resolve, jumps), where the step grows by much and after a start: a⁺ = a.
/// λ stays: the equations are linear in it.
class Predictor {
 public:
  /// @param scale  of the coordinates (n)
  Predictor(const StepEquations& equations, const Eigen::VectorXd& scale)
      : scale_(scale), correction_(equations.size()) {}

  /// What it knows of the instant before the one that a step sets out from.
  struct Past {
    bool is_known = false;
    bool is_straight = false;  ///< the line would have been closer to the last acceleration
    double time = 0.0;         ///< [s]
    Eigen::VectorXd a;         ///< (n)
  };
  const Past& past() const { return past_; }
  void set_past(const Past& past) { past_ = past; }

  /// To be called after each step that is kept.
  void remember(const State& old, const State& now) {
    past_.is_straight =
        past_.is_known && miss(old, now, growth(old, now.time)) < miss(old, now, 0.0);
    past_.is_known = true;
    past_.time = old.time;
    past_.a = old.a;
  }

  /// @param time       the end of the step [s]
  /// @param equations  those of the step
  void predict(const StepState& old, double time, const Scheme& scheme,
               const StepEquations& equations, StepState& state) {
    const Eigen::Matrix4d& h = scheme.history;
    state.increment = h(0, 1) * old.v + h(0, 2) * old.a + h(0, 3) * old.w;
    state.v = h(1, 0) * old.q + h(1, 1) * old.v + h(1, 2) * old.a + h(1, 3) * old.w;
    state.a = h(2, 0) * old.q + h(2, 1) * old.v + h(2, 2) * old.a + h(2, 3) * old.w;
    state.w = h(3, 0) * old.q + h(3, 1) * old.v + h(3, 2) * old.a + h(3, 3) * old.w;
    state.shift.setZero();
    state.eta.setZero();
    correction_.setZero();
    auto correction = correction_.head(old.q.size());
    correction = old.a - state.a;
    if (past_.is_straight && growth(old, time) < most_growth) {
      correction += growth(old, time) * (old.a - past_.a);
    }
    correction /= scheme.correction(2);
    equations.apply(correction_, state);
    state.time = time;
  }

 private:
  /// Of a step over the one before, up to which the line is used.
  static constexpr double most_growth = 2.5;

  /// h / h₋
  double growth(const State& old, double time) const {
    return (time - old.time) / (old.time - past_.time);
  }

  /// Of a + growth (a − a₋) from what came out; the largest of all coordinates over their scales.
  double miss(const State& old, const State& now, double growth) const {
    return (now.a - old.a - growth * (old.a - past_.a))
        .cwiseQuotient(scale_)
        .lpNorm<Eigen::Infinity>();
  }

  const Eigen::VectorXd& scale_;
  Past past_;
  Eigen::VectorXd correction_;
};

}  // namespace pleuel
