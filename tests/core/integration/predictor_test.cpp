#include "core/integration/predictor.hpp"

#include <array>

#include <gtest/gtest.h>

#include "core/integration/simulate.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/scheme_case.hpp"

namespace pleuel::test {
namespace {

/// Predicts the step that follows three instants of given accelerations.
class PredictedStep : public testing::Test {
 protected:
  static constexpr double step = 1e-3;

  StepState state_with(double time, const Eigen::VectorXd& a) const {
    StepState state = old_;
    state.time = time;
    state.a = a;
    return state;
  }

  /// @param before   the two instants before, first the earlier one: their accelerations
  /// @param growth  of the step over those before
  StepState predict(const std::array<Eigen::VectorXd, 2>& before, double growth) {
    const double h = step / growth;
    const StepState first = state_with(old_.time - 2 * h, before[0]),
                    second = state_with(old_.time - h, before[1]);
    predictor_.remember(first, second);
    predictor_.remember(second, old_);
    return predict();
  }
  StepState predict() {
    StepState state = old_;
    equations_.begin(old_);
    predictor_.predict(old_, old_.time + step, scheme_, equations_, state);
    return state;
  }
  /// After steps in which the acceleration has changed at a constant rate.
  StepState predict_on_line(double growth) {
    const Eigen::VectorXd change = step / growth * jerk_;
    return predict({old_.a - 2 * change, old_.a - change}, growth);
  }

  /// Round-off: a is that of q⁺ over h².
  void expect_unchanged_acceleration(const StepState& state) const {
    EXPECT_LE((state.a - old_.a).lpNorm<Eigen::Infinity>(),
              1e-12 * old_.a.lpNorm<Eigen::Infinity>());
  }

  Model model_ = smooth_planar_sample().build();
  /// The trapezoidal rule.
  Scheme scheme_ = make_scheme(SchemeType::newmark, step, 1.0);
  StepEquations equations_{model_.mechanism, scheme_, index_3};
  Predictor predictor_{equations_, model_.mechanism.scale};
  StepState old_ = equations_.make_state(random_state(model_, 3));
  Eigen::VectorXd jerk_ = random_state(model_, 4).a / step;
};

/// Expected: a⁺ = a + h a', and by the trapezoidal rule v⁺ = v + h/2 (a + a⁺).
TEST_F(PredictedStep, FollowsAMotionOfConstantJerk) {
  for (const double growth : {0.25, 1.0, 2.0}) {
    const StepState state = predict_on_line(growth);
    const Eigen::VectorXd a = old_.a + step * jerk_;
    const Eigen::VectorXd v = old_.v + step * old_.a + 0.5 * step * step * jerk_;
    EXPECT_LE((state.a - a).lpNorm<Eigen::Infinity>(), 1e-12 * a.lpNorm<Eigen::Infinity>());
    EXPECT_LE((state.v - v).lpNorm<Eigen::Infinity>(), 1e-12 * v.lpNorm<Eigen::Infinity>());
    EXPECT_EQ(state.lambda, old_.lambda);
  }
}

/// A slope over a short step says little of a long one.
TEST_F(PredictedStep, KeepsTheAccelerationWhereTheStepGrowsByMuch) {
  expect_unchanged_acceleration(predict_on_line(4.0));
}

TEST_F(PredictedStep, KeepsTheAccelerationAfterAStart) {
  expect_unchanged_acceleration(predict());
}

/// Of a vibration that alternates from step to step a line is off by 4, the last value by 2.
TEST_F(PredictedStep, KeepsTheAccelerationOfWhatTheStepsDoNotResolve) {
  expect_unchanged_acceleration(predict({old_.a, -old_.a}, 1.0));
}

/// Of a smooth motion in 300 steps. Every sixteenth step makes a second iteration in any case:
/// 1.07 a step with those of the start. Measured: 1.08, and 1.56 with a⁺ = a.
TEST(Predictor, LetsOneIterationBeEnough) {
  Model model = smooth_planar_sample().build();
  const Trajectory trajectory = simulate(model.mechanism, {0.06, 2e-4, 0.8});
  EXPECT_LE(trajectory.newton_iterations, 1.2 * trajectory.steps());
}

}  // namespace
}  // namespace pleuel::test
