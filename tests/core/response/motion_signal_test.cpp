#include <memory>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/int_size.hpp"
#include "core/base/machine_memory.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/linear/modes.hpp"
#include "core/response/analysis.hpp"
#include "core/response/history_jump.hpp"
#include "core/response/history_map.hpp"
#include "core/response/modal_vectors.hpp"
#include "core/response/monitors.hpp"
#include "core/response/reduction.hpp"
#include "core/response/validity.hpp"
#include "core/response/whole_turns.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::motion_signal_test {
namespace {

class MotionAlong : public testing::TestWithParam<int> {
 protected:
  Model model_ = all_samples()[GetParam()].build();
};

/// Of elastic coordinates: S_11 + S_22 + S_33 = S_ff.
TEST_P(MotionAlong, OfAllAxesIsTheMassMatrixOfABody) {
  for (const BodyModel& body : model_.bodies) {
    const Invariants<double>& constants = body.invariants;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(body.elastic_size(), body.elastic_size());
    for (int axis = 0; axis < 3; ++axis)
      sum += elastic_mass_along(constants, Eigen::Vector3d::Unit(axis));
    const Eigen::MatrixXd mass = dense_matrix(constants.pattern, constants.mass_matrix);
    EXPECT_LE((sum - mass).norm(), 1e-14 * mass.norm()) << body.name;
  }
}

/// In any state, of turned and deformed bodies: the mass matrix of the equations of motion, R_a.
TEST_P(MotionAlong, OfAllAxesIsTheMassMatrixOfAMechanism) {
  const State state = random_state(model_, 7);
  const Eigen::MatrixXd mass = linearize(model_.mechanism, state).M;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(mass.rows(), mass.cols());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd along = mass_along(model_, state, Eigen::Vector3d::Unit(axis));
    EXPECT_LE((along - along.transpose()).norm(), 1e-14 * mass.norm());
    EXPECT_GE(symmetric_eigenvalues(along).minCoeff(), -1e-12 * mass.norm());
    sum += along;
  }
  EXPECT_LE((sum - mass).norm(), 1e-12 * mass.norm());
}

INSTANTIATE_TEST_SUITE_P(Samples, MotionAlong, testing::Range(0, sample_count), sample_name);

/// Along an oblique axis of all axes that are normal to each other, too.
TEST_P(MotionAlong, OfObliqueAxesIsTheMassMatrix) {
  const State state = random_state(model_, 8);
  const Eigen::MatrixXd mass = linearize(model_.mechanism, state).M;
  const Eigen::Matrix3d axes = rotation_of(Eigen::Vector3d(0.3, -0.7, 1.1));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(mass.rows(), mass.cols());
  for (int i = 0; i < 3; ++i) sum += mass_along(model_, state, axes.col(i));
  EXPECT_LE((sum - mass).norm(), 1e-12 * mass.norm());
}

/// A point mass at 3 m/s along y and 4 m/s along z: m v² along each.
TEST(MotionAlong, OfAPointMassIsThatOfItsVelocity) {
  Scene scene;
  PointMass body;
  body.mass = 2.0;
  scene.bodies = {{"ball", body}};
  EffectSettings effects{.spatial_motion = EffectChoice::on};
  const Model model = build_model(scene, effects, {}, {});
  const State state(model.mechanism.system->coordinates(), 0);
  const Eigen::Vector3d velocity(0.0, 3.0, 4.0);
  const double squares[] = {0.0, 9.0, 16.0};
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_DOUBLE_EQ(velocity.dot(mass_along(model, state, Eigen::Vector3d::Unit(axis)) * velocity),
                     2.0 * squares[axis]);
  }
}

/// Two modes that are halves of motion along x and of motion along y are turned until one is all of
/// it.
TEST(CombinationsAlong, TellModesThatCoincideApart) {
  const Eigen::Matrix2d mass = Eigen::Vector2d(2.0, 2.0).asDiagonal(),
                        along = Eigen::Vector2d(2.0, 0.0).asDiagonal();
  Eigen::Matrix2cd modes;
  modes << 0.5, 0.5, 0.5, -0.5;
  const Eigen::MatrixXcd found = modes * combinations_along(modes, mass, along);
  ASSERT_EQ(found.cols(), 1);
  EXPECT_NEAR(std::abs(found(0, 0)), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(std::abs(found(1, 0)), 0.0, 1e-15);
}

/// What moves along two axes alike is along none.
TEST(CombinationsAlong, LeaveOutWhatIsAlongNoAxis) {
  const Eigen::Matrix2d mass = Eigen::Matrix2d::Identity(),
                        along = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  const Eigen::MatrixXcd mode = Eigen::Vector2cd::Constant(std::sqrt(0.5));
  EXPECT_EQ(combinations_along(mode, mass, along).cols(), 0);
}

TEST(WholeTurns, AreAddedWhereAnAngleJumps) {
  Eigen::MatrixXd history(1, 400);
  for (int i = 0; i < 400; ++i) {
    const double angle = 20.0 * std::sin(0.02 * i);  // to and fro, three turns each way
    history(0, i) = std::remainder(angle, 2.0 * std::numbers::pi);
  }
  count_turns(history);
  for (int i = 0; i < 400; ++i) EXPECT_NEAR(history(0, i), 20.0 * std::sin(0.02 * i), 1e-12);
}

/// Two wheels on axes that differ, so that the motion is in space: 100 rad/s for 0.2 s.
TEST(WholeTurns, OfAJointCountInSpace) {
  const char* wheels = R"({
    "scene": {
      "bodies": {
        "one": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.02, 0.02, 0.02, 0, 0, 0],
                "angular_velocity": [0, 0, 100]},
        "two": {"type": "rigid", "at": [0, 1, 0], "mass": 2, "inertia": [0.02, 0.02, 0.02, 0, 0, 0],
                "angular_velocity": [10, 0, 0]}},
      "joints": {
        "first": {"type": "revolute", "bodies": ["ground", "one"], "at": [0, 0, 0], "axis": [0, 0, 1]},
        "second": {"type": "revolute", "bodies": ["ground", "two"], "at": [0, 1, 0], "axis": [1, 0, 0]}
      }
    },
    "simulation": {"end_time": 0.2, "step": "1 ms"},
    "responses": {
      "most": {"type": "joint-position", "joint": "first", "over_time": "max"},
      "mean": {"type": "joint-position", "joint": "first", "over_time": "mean"},
      "of_body": {"type": "angle", "body": "one", "direction": "z", "over_time": "final"}
    }
  })";
  const ProblemFile problem = problem_from(wheels);
  const Eigen::VectorXd values = values_of(*analyze(problem, start_design(problem)));
  EXPECT_NEAR(values(0), 20.0, 1e-6);
  EXPECT_NEAR(values(1), 10.0, 1e-6);
  EXPECT_NEAR(values(2), 20.0, 1e-6);
}

template <class Work>
std::string failure_of(const Work& work) {
  return thrown<SimulationError>([&] { work(); });
}

/// Short, since only what comes out matters.
ProblemFile short_crank(const std::string& density) {
  return sample_problem(
      "slider_crank",
      {"/simulation/end_time=1 ms",
       R"(/scene/materials={"steel":{"young":2.1e11,"poisson":0.3,"density":)" + density + "}}"});
}

std::string failure_with(const std::string& density) {
  const ProblemFile problem = short_crank(density);
  return failure_of([&] { analyze(problem, start_design(problem)); });
}

TEST(NotFinite, IsAFailedSimulationThatNamesTheFirstResponseAndItsTime) {
  EXPECT_EQ(failure_with("7850"), "");
  // Stress squares what is 1e196 times as large.
  const std::string failure = failure_with("1e200");
  EXPECT_THAT(failure, HasSubstr("stress\" is not finite at t = 2.5e-05 s"));
}

TEST(NotFinite, IsAFailureOfTheMonitorsToo) {
  const auto [problem, x, analysis] = AtStart(short_crank("7850"));
  analysis->trajectory.columns().v()(0, 7) = 1e200;
  EXPECT_THAT(
      failure_of([&analysis = analysis] { monitor(analysis->model, analysis->trajectory); }),
      HasSubstr("energy of the mechanism is not finite at t = 0.000175 s"));
}

/// The shortest beam of the slider-crank is 120 mm long: 0.12 mm are allowed.
TEST(PulledApartJoint, FailsBeyondAThousandthOfTheShortestBeam) {
  const auto [problem, x, analysis] = AtStart(short_crank("7850"));
  SimulationOptions options{1e-3, 2.5e-5};
  ConstraintGuard guard(analysis->model, options);
  State state = state_of(analysis->trajectory, 0);
  const int crank = analysis->model.body("crank").frame.offset;
  EXPECT_EQ(failure_of([&] { guard.see(0, state); }), "");
  state.q(crank) += 0.11e-3;
  EXPECT_EQ(failure_of([&] { guard.see(0, state); }), "");
  state.q(crank) += 0.02e-3;
  EXPECT_THAT(failure_of([&] { guard.see(0, state); }),
              AllOf(HasSubstr("the joint \"crank_pin\""), HasSubstr("is apart by 0.00013")));
}

/// Index 1 promises accelerations only; Newton's method with a loose tolerance promises little.
TEST(PulledApartJoint, IsJudgedByWhatTheFormulationPromises) {
  const AtStart start(short_crank("7850"));
  const Model& model = start.analysis->model;
  State state = state_of(start.analysis->trajectory, 0);
  state.q(model.body("crank").frame.offset) += 0.2e-3;
  SimulationOptions options{1e-3, 2.5e-5};
  options.newton_tolerance = 1e-4;
  EXPECT_EQ(failure_of([&] { ConstraintGuard(model, options).see(0, state); }), "");
  // A hundred tolerances, of the crank's 120 mm: 1.2 mm.
  const double placed = state.q(model.body("crank").frame.offset) - 0.2e-3;
  const auto fails_at = [&](double apart) {
    state.q(model.body("crank").frame.offset) = placed + apart;
    return !failure_of([&] { ConstraintGuard(model, options).see(0, state); }).empty();
  };
  EXPECT_FALSE(fails_at(1.18e-3));
  EXPECT_TRUE(fails_at(1.22e-3));
  EXPECT_FALSE(fails_at(0.2e-3));
  options.newton_tolerance = 1e-10;
  options.formulation.constraints = ConstraintForm::index_1;
  EXPECT_EQ(failure_of([&] { ConstraintGuard(model, options).see(0, state); }), "");
  options.formulation.is_projected = true;
  EXPECT_NE(failure_of([&] { ConstraintGuard(model, options).see(0, state); }), "");
}

// Linear maps from what is observed to histories.

const Eigen::VectorXd uneven{{0.0, 0.1, 0.3, 0.35, 0.6, 1.0}};
constexpr StepRange inner{2, 4};

/// A parabola goes through three instants.
TEST(RateMap, IsExactForParabolasWithUnevenSteps) {
  const Eigen::MatrixXd parabola =
      (3.0 + 2.0 * uneven.array() - 5.0 * uneven.array().square()).matrix().transpose();
  const Eigen::MatrixXd rate = RateMap().apply(uneven, {0, 5}, parabola);
  const Eigen::MatrixXd expected = (2.0 - 10.0 * uneven.array()).matrix().transpose();
  EXPECT_LE((rate - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(RateMap, IsASlopeBetweenTwoInstants) {
  const Eigen::MatrixXd line{{1.0, 4.0}};
  const Eigen::MatrixXd rate = RateMap().apply(Eigen::Vector2d(0.0, 0.5), {0, 1}, line);
  EXPECT_EQ(rate, Eigen::MatrixXd::Constant(1, 2, 6.0));
}

/// The trapezoidal rule is exact for a rate that is linear in time: amount 1 + t² of the rate 2t; with
/// another 3 (t − t₀) of it, that is missing.
TEST(BalanceMap, IsWhatTheRateDoesNotMake) {
  const Eigen::ArrayXd t = uneven.array();
  Eigen::MatrixXd observed(2, uneven.size());
  observed << (1.0 + t.square() + 3.0 * t).matrix().transpose(), (2.0 * t).matrix().transpose();
  const Eigen::MatrixXd missing = BalanceMap().apply(uneven, inner, observed);
  const Eigen::MatrixXd expected = (3.0 * (t - t(inner.first))).matrix().transpose();
  EXPECT_LE((missing - expected).cwiseAbs().maxCoeff(), 1e-15);
}

class HistoryMaps : public testing::TestWithParam<bool> {
 protected:
  HistoryMaps() {
    if (GetParam()) {
      map_ = std::make_unique<RateMap>();
    } else {
      map_ = std::make_unique<BalanceMap>();
    }
  }

  std::unique_ptr<HistoryMap> map_;
};

/// What a sample of a history is made from says the same as the history.
TEST_P(HistoryMaps, TellWhatTheirSamplesAreMadeFrom) {
  const Eigen::MatrixXd observed = Eigen::MatrixXd::Random(4, uneven.size());
  const Eigen::MatrixXd history = map_->apply(uneven, inner, observed);
  for (int channel = 0; channel < int_size(history.col(0)); ++channel) {
    for (int step = 0; step < int_size(uneven); ++step) {
      std::vector<Sample> samples;
      map_->add_observed(uneven, inner, {step, channel, 2.0}, samples);
      double sum = 0.0;
      for (const Sample& sample : samples) {
        sum += sample.weight * observed(sample.channel, sample.step);
        EXPECT_THAT(map_->observed_channels(channel), testing::Contains(sample.channel));
      }
      EXPECT_NEAR(sum, 2.0 * history(channel, step), 1e-13) << channel << " " << step;
    }
  }
}

/// The channels of one channel of the history alone make it.
TEST_P(HistoryMaps, NeedNoOtherChannels) {
  const Eigen::MatrixXd observed = Eigen::MatrixXd::Random(4, uneven.size());
  const Eigen::MatrixXd history = map_->apply(uneven, inner, observed);
  const std::vector<int> channels = map_->observed_channels(1);
  const Eigen::MatrixXd alone = map_->apply(uneven, inner, observed(channels, Eigen::all));
  EXPECT_EQ(alone, history.row(1));
}

INSTANTIATE_TEST_SUITE_P(All, HistoryMaps, testing::Bool(),
                         [](const auto& is_rate) { return is_rate.param ? "Rate" : "Balance"; });

// Peaks beside jumps, and ranges that end with one.

Eigen::VectorXd instants(int count) {
  return Eigen::VectorXd::LinSpaced(count, 0.0, 0.01 * (count - 1));
}

/// A force 20 that friction of 20 is added to until it turns round: it does not come near 45, which
/// is what a parabola through 40, 40 and 0 makes of it.
TEST(HistoryJump, OfFrictionThatTurnsRoundHasNoPeakAboveItsSamples) {
  Eigen::MatrixXd values(1, 20);
  for (int i = 0; i < 20; ++i) values(0, i) = 20.0 + (i < 10 ? 20.0 : -20.0);
  EXPECT_TRUE(jumps_beside(instants(20), values, 0, 9));
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 40.0);
  for (const Eigen::Index end : {0, 19}) EXPECT_FALSE(jumps_beside(instants(20), values, 0, end));
  values(0, 10) = 20.0;  // an instant within the jump
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 40.0);
  values.reverseInPlace();
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 40.0);
}

/// At the first instant nothing moves, so that there is no friction yet.
TEST(HistoryJump, BehindTheFirstInstantIsSeen) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(1, 20, 40.0);
  values(0, 0) = 20.0;
  for (int i = 1; i < 20; ++i) values(0, i) -= 0.1 * i;
  EXPECT_EQ(reduce(OverTime::max, instants(20), values).value, 39.9);
}

/// Sines with 5.5 steps a period or more, wherever the peak lies between them, and bells with a
/// deviation of 1.2 steps.
TEST(HistoryJump, IsNoneInWhatIsSmooth) {
  for (const double steps : {5.5, 6.0, 7.0, 8.0, 22.0, 100.0}) {
    for (double phase = 0.0; phase < 1.0; phase += 0.1) {
      Eigen::MatrixXd values(1, 200);
      for (int i = 0; i < 200; ++i) {
        values(0, i) = std::cos(2.0 * std::numbers::pi * (i + phase) / steps);
      }
      const double found = reduce(OverTime::max, instants(200), values).value;
      // Of the parabola, at most (remainder of interpolation); of the samples it is (π/n)²/2.
      const double most = std::pow(2.0 * std::numbers::pi / steps, 4) / 32.0;
      EXPECT_NEAR(found, 1.0, most + 1e-12) << steps << " " << phase;
      const Eigen::Index middle = std::lround(std::round(100.0 / steps) * steps - phase);
      EXPECT_FALSE(jumps_beside(instants(200), values, 0, middle)) << steps << " " << phase;
    }
  }
  for (double phase = -0.5; phase <= 0.5; phase += 0.1) {
    Eigen::MatrixXd values(1, 41);
    for (int i = 0; i < 41; ++i)
      values(0, i) = std::exp(-0.5 * std::pow((i - 20 + phase) / 1.2, 2));
    EXPECT_FALSE(jumps_beside(instants(41), values, 0, 20)) << phase;
  }
}

/// At a load that falls from 10 to 1 at the instant 10 the sample is 5.5: windows see their own
/// side, with derivatives of the samples that it is made from.
TEST(HistoryJump, AtTheEndOfARangeCountsFromWithin) {
  const auto value = [](int i) { return (i < 10 ? 10.0 : 1.0) + 0.01 * i; };
  Eigen::MatrixXd values(1, 21);
  for (int i = 0; i < 21; ++i) values(0, i) = value(i);
  values(0, 10) = 5.6;
  BrokenInstants breaks(21, false);
  breaks[10] = true;
  const Eigen::VectorXd time = instants(21);
  const Reduction before = reduce(OverTime::final, time, values, {0, 10}, breaks);
  EXPECT_NEAR(before.value, 10.1, 1e-12);
  double sum = 0.0;
  for (const Sample& sample : before.samples) sum += sample.weight * values(0, sample.step);
  EXPECT_NEAR(sum, before.value, 1e-12);
  EXPECT_NEAR(reduce(OverTime::max, time, values, {0, 10}, breaks).value, 10.1, 1e-12);
  EXPECT_NEAR(reduce(OverTime::min, time, values, {10, 20}, breaks).value, 1.1, 1e-12);
  EXPECT_NEAR(reduce(OverTime::mean, time, values, {10, 20}, breaks).value, 1.15, 1e-12);
  double lowest = 100.0;
  for (const Reduction& one : reduce_windows(OverTime::min, time, values, 3, {10, 20}, breaks)) {
    lowest = std::min(lowest, one.value);
  }
  EXPECT_NEAR(lowest, 1.1, 1e-12);
  // Elsewhere, and without a break, it is a sample like others.
  EXPECT_NEAR(reduce(OverTime::final, time, values, {0, 10}).value, 5.6, 1e-12);
  EXPECT_NEAR(reduce(OverTime::max, time, values, {0, 20}, breaks).value, 10.09, 1e-12);
}

constexpr const char* pendulum = R"({"scene": {"gravity": [0, -9.81, 0],
    "materials": {"m": {"young": 210e9, "poisson": 0.3, "density": 7850}},
    "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
      "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "elements": 1000}},
    "joints": {"j": {"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": 1, "step": 1e-9},
  "responses": {"s": {"type": "stress", "body": "b", "over_time": "max"}}})";

TEST(Memory, ByDefaultFollowsTheMachineUpToFourGigabytes) {
  EXPECT_GT(machine_memory(), 1e7);
  const double states = problem_from(pendulum).sensitivity.memory;
  EXPECT_LE(states, 4e9);
  EXPECT_LE(states, 0.25 * machine_memory());
  const std::vector<std::string> given = {R"(/sensitivity={"memory": "1 MB"})"};
  EXPECT_EQ(problem_from(pendulum, given).sensitivity.memory, 1e6);
}

/// 1e9 steps with the stress of thousands of places are some 1e13 bytes.
TEST(Memory, OfHistoriesThatNoMachineHoldsIsTooMuchBeforeTheRun) {
  const ProblemFile problem = problem_from(pendulum);
  const std::string said = thrown<InputError>([&] { require_memory(problem); });
  EXPECT_THAT(said, HasSubstr("1e+09 steps with"));
  EXPECT_THAT(said, HasSubstr("but the machine has"));
  EXPECT_THROW(analyze(problem, start_design(problem)), InputError);
}

}  // namespace
}  // namespace pleuel::test::motion_signal_test
