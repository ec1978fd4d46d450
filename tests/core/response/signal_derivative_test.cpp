#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/configuration.hpp"
#include "core/response/analysis.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_name.hpp"

namespace pleuel::test::signal_derivative_test {
namespace {

using namespace response_samples;

class EverySignal : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = sample_with_strength(GetParam());
  Model model_ = sample_.build();
  State state_ = random_state(model_, 11);
  std::vector<Response> responses_ = make_responses(all_histories(model_), model_);

  SignalGradient gradient_of(Signal& signal, int channel) const {
    const System& system = *model_.mechanism.system;
    SignalGradient gradient(system.coordinates(), system.multipliers(), system.variables());
    signal.add_gradient(state_, channel, 1.0, gradient);
    return gradient;
  }

  /// Compares slopes along one direction: `move(state, s)` goes there, `slope(gradient)` is what
  /// the gradient says. Differences of fourth order with relative steps of 1e-3: 1e-9 of the value,
  /// and round-off.
  template <class Move, class Slope>
  void expect_slopes(const Move& move, const Slope& slope, const char* what) {
    for (const Response& response : responses_) {
      Signal& signal = *response.history()->signal;
      const auto at = [&](double s) {
        State moved = state_;
        move(moved, s);
        return observed(signal, moved);
      };
      const Eigen::VectorXd found = derivative_at_zero(at, 4e-4), values = observed(signal, state_);
      for (int channel = 0; channel < signal.channels(); ++channel) {
        const double expected = slope(gradient_of(signal, channel));
        EXPECT_NEAR(found(channel), expected,
                    1e-8 * (std::abs(expected) + std::abs(values(channel))) + 1e-12)
            << response.name << ", " << signal.describe(channel) << ", " << what;
      }
    }
  }
};

TEST_P(EverySignal, HasTheGradientOfItsValueInThePositions) {
  const Mechanism& mechanism = model_.mechanism;
  const Eigen::VectorXd along =
      random_vector(state_.q.size(), 3).cwiseProduct(mechanism.scale.cwiseMin(1.0));
  expect_slopes(
      [&](State& at, double s) {
        const Eigen::VectorXd start = at.q;
        advance(mechanism.rotations, start, s * along, at.q);
      },
      [&](const SignalGradient& gradient) { return gradient.q.dot(along); }, "q");
}

TEST_P(EverySignal, HasTheGradientOfItsValueInTheRates) {
  const Eigen::VectorXd v = random_vector(state_.v.size(), 4), a = random_vector(v.size(), 5);
  expect_slopes(
      [&](State& at, double s) {
        at.v += s * v;
        at.a += 10.0 * s * a;
      },
      [&](const SignalGradient& gradient) { return gradient.v.dot(v) + 10.0 * gradient.a.dot(a); },
      "v, a");
}

TEST_P(EverySignal, HasTheGradientOfItsValueInTheMultipliers) {
  const Eigen::VectorXd lambda = random_vector(state_.lambda.size(), 6);
  expect_slopes([&](State& at, double s) { at.lambda += s * lambda; },
                [&](const SignalGradient& gradient) { return gradient.lambda.dot(lambda); },
                "lambda");
}

/// q(t) = q ⊕ (v t + ½ a t²) has the rates v, a at t = 0, rotation vectors included.
TEST_P(EverySignal, OfAMotionIsTheTimeDerivativeOfThePosition) {
  for (const BodyModel& body : model_.bodies) {
    for (int direction : {0, 1, 2}) {
      ResponseSettings settings;
      settings.bodies = {body.name};
      settings.at = 0.3;
      settings.direction = direction;
      settings.type = ResponseType::position;
      const auto position = [&](double t) {
        State at = state_;
        advance(model_.mechanism.rotations, state_.q, t * state_.v + 0.5 * t * t * state_.a, at.q);
        return observed(model_, settings, at);
      };
      const double velocity = derivative_at_zero(position, 2e-3);
      const double acceleration = second_derivative_at_zero(position, 4e-3);
      // Fourth order, rates of some 10 1/s: (0.04)⁴/100 of 1 m/s and 100 m/s².
      settings.type = ResponseType::velocity;
      EXPECT_NEAR(observed(model_, settings, state_), velocity, 1e-7) << body.name;
      settings.type = ResponseType::acceleration;
      EXPECT_NEAR(observed(model_, settings, state_), acceleration, 2e-5) << body.name;
    }
  }
}

/// The same of relative coordinates of joints, with and without elasticity.
TEST_P(EverySignal, OfAJointIsTheTimeDerivativeOfItsPosition) {
  for (ResponseSettings settings : all_histories(model_)) {
    if (settings.type != ResponseType::joint_position) continue;
    const auto position = [&](double t) {
      State at = state_;
      advance(model_.mechanism.rotations, state_.q, t * state_.v, at.q);
      return observed(model_, settings, at);
    };
    const double rate = derivative_at_zero(position, 2e-3);
    settings.type = ResponseType::joint_velocity;
    EXPECT_NEAR(observed(model_, settings, state_), rate, 1e-6 * (1.0 + std::abs(rate)))
        << settings.name;
  }
}

/// Central differences of simulated positions over the second half of 200 steps. 2e-3 of the
/// largest speed: terms of second order in the step, of beams that vibrate (measured 9.5e-4).
TEST_P(EverySignal, OfAMotionFollowsTheSimulatedPosition) {
  ProblemFile problem = sample_.problem();
  problem.simulation.end_time = 0.01;
  problem.simulation.step = 5e-5;
  for (const ResponseSettings& settings : all_histories(model_)) {
    const bool is_motion =
        settings.type == ResponseType::position || settings.type == ResponseType::velocity;
    if (is_motion && settings.direction != magnitude_direction)
      problem.responses.push_back(settings);
  }
  const auto analysis = analyze(problem, start_design(problem));
  const double h = analysis->trajectory.time(1);
  const auto steps = analysis->trajectory.time.size();
  // Of each body: three positions, three speeds.
  for (std::size_t first = 0; first < problem.responses.size(); first += 6) {
    double error = 0.0, largest = 0.0;
    for (std::size_t i = first; i < first + 3; ++i) {
      const Eigen::RowVectorXd y = analysis->histories[i].row(0);
      const Eigen::RowVectorXd rate = analysis->histories[i + 3].row(0);
      largest = std::max(largest, rate.cwiseAbs().maxCoeff());
      for (Eigen::Index k = steps / 2; k + 1 < steps; ++k) {
        error = std::max(error, std::abs((y(k + 1) - y(k - 1)) / (2 * h) - rate(k)));
      }
    }
    EXPECT_LE(error, 2e-3 * largest) << problem.responses[first].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySignal, testing::Range(0, sample_count), sample_name);

}  // namespace
}  // namespace pleuel::test::signal_derivative_test
