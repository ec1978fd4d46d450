#include "core/integration/predictor.hpp"

#include <algorithm>

namespace pleuel {

void Predictor::predict(const StepState& old, double time, const Scheme& scheme,
                        const StepEquations& equations, StepState& state) {
  const Eigen::Matrix4d& h = scheme.history;
  state.increment = h(0, 1) * old.v + h(0, 2) * old.a + h(0, 3) * old.w;
  state.v = h(1, 0) * old.q + h(1, 1) * old.v + h(1, 2) * old.a + h(1, 3) * old.w;
  state.a = h(2, 0) * old.q + h(2, 1) * old.v + h(2, 2) * old.a + h(2, 3) * old.w;
  state.w = h(3, 0) * old.q + h(3, 1) * old.v + h(3, 2) * old.a + h(3, 3) * old.w;
  state.lambda = old.lambda;
  state.shift.setZero();
  state.eta.setZero();
  correction_.setZero();
  auto correction = correction_.head(old.q.size());
  correction = old.a - state.a;
  if (experience_.step > 0.0) {
    // No further ahead than it is known behind.
    const double ratio = std::min(1.0, scheme.step / experience_.step);
    correction += ratio * experience_.change_of_a;
    state.lambda += ratio * experience_.change_of_lambda;
  }
  correction /= scheme.correction(2);
  equations.apply(correction_, state);
  state.time = time;
}

void Predictor::record(const StepState& old, const StepState& state) {
  experience_.step = state.time - old.time;
  experience_.change_of_a = state.a - old.a;
  experience_.change_of_lambda = state.lambda - old.lambda;
}

}  // namespace pleuel
