#include <set>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

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
      PointMotionResponse motion{{body.name, 0.3}, {direction}};
      const auto position = [&](double t) {
        State at = state_;
        advance(model_.mechanism.rotations, state_.q, t * state_.v + 0.5 * t * t * state_.a, at.q);
        return observed(model_, motion, at);
      };
      const double velocity = derivative_at_zero(position, 2e-3);
      const double acceleration = second_derivative_at_zero(position, 4e-3);
      // Fourth order, rates of some 10 1/s: (0.04)⁴/100 of 1 m/s and 100 m/s².
      motion.derivative = TimeDerivative::first;
      EXPECT_NEAR(observed(model_, motion, state_), velocity, 1e-7) << body.name;
      motion.derivative = TimeDerivative::second;
      EXPECT_NEAR(observed(model_, motion, state_), acceleration, 2e-5) << body.name;
    }
  }
}

/// The same of relative coordinates of joints, with and without elasticity.
TEST_P(EverySignal, OfAJointIsTheTimeDerivativeOfItsPosition) {
  for (const ResponseSettings& settings : all_histories(model_)) {
    const auto* position_of_joint = settings.as<JointMotionResponse>();
    if (!position_of_joint || position_of_joint->derivative != TimeDerivative::none) continue;
    JointMotionResponse motion = *position_of_joint;
    const auto position = [&](double t) {
      State at = state_;
      advance(model_.mechanism.rotations, state_.q, t * state_.v, at.q);
      return observed(model_, motion, at);
    };
    const double rate = derivative_at_zero(position, 2e-3);
    motion.derivative = TimeDerivative::first;
    EXPECT_NEAR(observed(model_, motion, state_), rate, 1e-6 * (1.0 + std::abs(rate)))
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
    const auto* motion = settings.as<PointMotionResponse>();
    if (motion && motion->derivative != TimeDerivative::second &&
        motion->component.direction != magnitude_direction && !motion->component.along) {
      problem.responses.push_back(settings);
    }
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

// What signals say of where their channels are.

class DescriptionOfASignal : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = sample_with_strength(GetParam());
  Model model_ = sample_.build();
};

TEST_P(DescriptionOfASignal, TellsItsChannelsApart) {
  for (const Response& response : make_responses(all_histories(model_), model_)) {
    const Signal& signal = *response.history()->signal;
    std::set<std::string> descriptions;
    for (int channel = 0; channel < signal.channels(); ++channel) {
      descriptions.insert(signal.describe(channel));
    }
    EXPECT_EQ(descriptions.size(), static_cast<std::size_t>(signal.channels())) << response.name;
    EXPECT_FALSE(descriptions.contains("")) << response.name;
  }
}

/// The rows of the constraints are in the order of the joints.
TEST_P(DescriptionOfASignal, OfDriftNamesTheJointOfEachEquation) {
  if (model_.mechanism.system->multipliers() == 0) GTEST_SKIP() << "no constraints";
  const std::vector<Response> responses = make_responses({{"drift", DriftResponse{}}}, model_);
  const Signal& drift = *responses.front().history()->signal;
  int channel = 0;
  for (const JointModel& joint : model_.joints) {
    for (int i = 1; i <= joint.equations(); ++i) {
      EXPECT_EQ(drift.describe(channel++), fmt::format("joint {}, equation {}", joint.name, i));
    }
  }
  EXPECT_EQ(channel, drift.channels());
}

/// Windows of one measure, and its repetitions by another name.
TEST_P(DescriptionOfASignal, SharesItWithAllThatObserveTheSame) {
  std::vector<ResponseSettings> settings = all_histories(model_);
  const std::size_t count = settings.size();
  for (std::size_t i = 0; i < count; ++i) {
    ResponseSettings twin = settings[i];
    twin.name += "_later";
    twin.from = 1e-3;
    settings.push_back(twin);
  }
  const std::vector<Response> responses = make_responses(settings, model_);
  std::set<const Signal*> signals;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& signal = responses[i].history()->signal;
    EXPECT_EQ(signal, responses[count + i].history()->signal) << settings[i].name;
    signals.insert(signal.get());
  }
  EXPECT_EQ(signals.size(), count);
}

INSTANTIATE_TEST_SUITE_P(Samples, DescriptionOfASignal, testing::Range(0, sample_count),
                         sample_name);

class GradientsOfResponses : public testing::TestWithParam<int> {
 protected:
  GradientsOfResponses() {
    const SampleScene sample = sample_with_strength(GetParam());
    problem_ = sample.problem();
    problem_.simulation.end_time = 8e-3;
    problem_.simulation.step = 1e-3;
    problem_.simulation.newton_tolerance = 1e-13;
    problem_.responses = all_histories(sample.build());
    for (ResponseSettings& response : problem_.responses) {
      response.over_time = OverTime::final;
      // Along a whole beam the place of the largest stress jumps.
      const auto place = [](auto& one) {
        if constexpr (requires { one.where; }) one.where.station = 0.37;
      };
      std::visit(place, response.what);
    }
    // A member of that one would buckle out of the plane: modes that grow, and meet.
    if (sample.name == "PlanarJoints") return;
    for (int mode = 0; mode < 3; ++mode) {
      problem_.responses.push_back(
          {"frequency " + std::to_string(mode), ModeResponse{.mode = {.number = mode}}});
    }
  }
  ProblemFile problem_;
};

/// Round-off of differences, per relative change of a variable: positions carry 1e-16 m, and
/// accelerations and reactions 1/h² of that.
double noise_of(const ResponseSettings& response) {
  if (response.is<StressResponse, ShearStressResponse>()) return 1e-2;  // [Pa]
  // [rad/s]: soft modes, of 0.3 rad/s, beside stiff members
  if (response.is<ModeResponse>()) return 1e-4;
  const auto* reaction = response.as<ReactionResponse>();
  const bool is_force = reaction && reaction->kind == ReactionKind::force;
  const bool is_acceleration = time_derivative_of(response) == TimeDerivative::second;
  return is_force || is_acceleration ? 1e-5 : 1e-7;
}

/// The component of a vector that a response is; none: it is of another kind.
std::optional<int> direction_of(const ResponseSettings& response) {
  return std::visit(
      [](const auto& one) -> std::optional<int> {
        if constexpr (requires { one.component; }) return one.component.direction;
        if constexpr (requires { one.direction; }) return one.direction;
        return std::nullopt;
      },
      response.what);
}

/// Direct differentiation against differences of fourth order of re-simulated designs, both as
/// changes per relative change of a variable, at the better of two steps, the second of which is taken
/// where the first is not good enough. 5e-6: measured 2.4e-6 of an acceleration, 1e-6 of all else.
TEST_P(GradientsOfResponses, AreThoseOfDifferencesOfSimulations) {
  const auto [x, analysis] = started(problem_);
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
  constexpr double any = 1e300;
  Eigen::VectorXd allowed = Eigen::VectorXd::Constant(direct.rows(), any);
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const ResponseSettings& response = problem_.responses[i];
    const double value = std::abs(analysis->reductions[i].value);
    // The magnitude of what vanishes has a kink.
    if (direction_of(response) == magnitude_direction && value < 1e-6) continue;
    const double slope = direct.row(i).lpNorm<Eigen::Infinity>();
    if (response.is<ShearStressResponse>() && value < 1e-2 * slope) continue;
    allowed(i) = 5e-6 * (slope + value) + noise_of(response);
  }
  Eigen::VectorXd best = Eigen::VectorXd::Constant(direct.rows(), any);
  for (double step : {8e-3, 1e-3}) {
    const Eigen::MatrixXd wide = central_differences(problem_, x, step) * x.asDiagonal();
    const Eigen::MatrixXd narrow = central_differences(problem_, x, step / 2) * x.asDiagonal();
    const Eigen::MatrixXd error = (4.0 * narrow - wide) / 3.0 - direct;
    best = best.cwiseMin(error.cwiseAbs().rowwise().maxCoeff());
    if ((best.array() <= allowed.array()).all()) break;
  }
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LE(best(i), allowed(i)) << problem_.responses[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, GradientsOfResponses, testing::Range(0, sample_count),
                         sample_name);

}  // namespace
}  // namespace pleuel::test::signal_derivative_test
