#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/monitors.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/energy.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/test.hpp"

/// Energies and errors of the time integration as responses; their gradients are tested with those
/// of all signals.
namespace pleuel::test::monitor_response_test {
namespace {

using namespace response_samples;

std::string response_of(const std::string& name, const std::string& value) {
  return "/responses/" + name + "=" + value;
}

double value_of(const Analysis& analysis, const std::string& name) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].name == name) return analysis.reductions[i].value;
  }
  throw std::runtime_error("no response " + name);
}

/// stiff_rod turns a crank of 0.001 kg m² at 60 rad/s and moves a slider of 0.2 kg.
TEST(KineticEnergyResponse, IsThatOfTurningAndOfTranslation) {
  const ProblemFile problem = sample_problem(
      "hard/stiff_rod",
      {response_of("crank", R"({"type": "kinetic-energy", "body": "crank", "over_time": "final"})"),
       response_of("slider",
                   R"({"type": "kinetic-energy", "body": "slider", "over_time": "final"})"),
       response_of("speed", R"({"type": "velocity", "body": "slider", "direction": "x",
                                "over_time": "final"})")});
  const auto analysis = analyze(problem, start_design(problem));
  EXPECT_NEAR(value_of(*analysis, "crank"), 0.5 * 0.001 * 60 * 60, 1e-8);  // a drive of index 3
  const double speed = value_of(*analysis, "speed");
  EXPECT_NEAR(value_of(*analysis, "slider"), 0.5 * 0.2 * speed * speed, 1e-14);
}

/// A cantilever in equilibrium under a force P at its tip holds P² L³/(6 E I).
TEST(ElasticEnergyResponse, OfACantileverIsThatOfStatics) {
  const double length = 0.3, side = 0.01, force = 2.0, young = 2.1e11;
  Scene scene = swinging_beam(length, RectangleSection{side, side}, 3);
  scene.gravity = {0.0, 0.0, 0.0};
  scene.joints.front().type = JointType::fixed;
  PointForce push{"beam", {length, 0.0, 0.0}, {0.0, 1.0, 0.0}, {}, false};
  push.value = ConstantFunction{force};
  scene.loads = {{"push", push}};
  ProblemFile problem;
  problem.scene = scene;
  problem.simulation.end_time = 0.01;
  problem.simulation.step = 1e-3;
  problem.simulation.quasi_static_start = true;
  ResponseSettings energy;
  energy.type = ResponseType::elastic_energy;
  energy.over_time = OverTime::mean;
  problem.responses = {energy};
  const double expected =
      force * force * std::pow(length, 3) / (6.0 * young * std::pow(side, 4) / 12.0);
  EXPECT_NEAR(analyze(problem, {})->reductions[0].value, expected, 1e-6 * expected);
}

/// tests/support/energy.hpp integrates the strain itself and takes the mass from the tangent.
TEST(EnergyResponses, AreThoseOfMassAndStrain) {
  for (SampleScene sample : {planar_sample(), planar_sample_in_space(), spatial_sample()}) {
    sample.scene.gravity = {0.0, 0.0, 0.0};
    Model model = sample.build();
    State state = random_state(model, 5);
    for (const double share : {0.1, 1.0, 10.0}) {  // 10: far beyond what a beam may bend
      for (const BodyModel& body : model.bodies) {
        state.q.segment(body.elastic_offset(), body.elastic_size()) *= share;
      }
      ResponseSettings kinetic, elastic;
      kinetic.type = ResponseType::kinetic_energy;
      elastic.type = ResponseType::elastic_energy;
      const double expected = energy_of(model, state);
      EXPECT_NEAR(observed(model, kinetic, state) + observed(model, elastic, state), expected,
                  1e-12 * expected)
          << sample.name;
    }
  }
}

class EverySimulatedSample : public testing::TestWithParam<int> {
 protected:
  EverySimulatedSample() {
    const SampleScene sample = sample_with_strength(GetParam());
    problem_ = sample.problem();
    problem_.simulation.end_time = 0.02;
    problem_.simulation.step = 1e-4;
    add_monitor_responses(sample.build(), problem_.responses);
  }

  std::unique_ptr<Analysis> run() const { return analyze(problem_, start_design(problem_)); }
  /// The response of this type in a window.
  ResponseSettings& response(ResponseType type) {
    for (ResponseSettings& response : problem_.responses) {
      if (response.type == type) return response;
    }
    throw std::runtime_error("no such response");
  }

  ProblemFile problem_;
};

/// The monitors have other formulas for the same balance; round-off of the largest energy.
TEST_P(EverySimulatedSample, MissesInItsBalanceWhatTheMonitorsMiss) {
  for (const bool is_window : {false, true}) {
    ResponseSettings& balance = response(ResponseType::energy_balance);
    balance.over_time = OverTime::final;
    if (is_window) balance.from = 0.005, balance.to = 0.015;
    const auto analysis = run();
    const Monitors monitors = monitor(analysis->model, analysis->trajectory);
    const int first = is_window ? 50 : 0, last = is_window ? 150 : 200;
    const Eigen::VectorXd missing = monitors.energy - monitors.work;
    const double size =
        monitors.energy.lpNorm<Eigen::Infinity>() + monitors.work.lpNorm<Eigen::Infinity>();
    EXPECT_NEAR(value_of(*analysis, balance.name), missing(last) - missing(first), 1e-12 * size);
    const auto index = static_cast<std::size_t>(response_index(problem_, balance.name));
    const Eigen::VectorXd expected = missing.array() - missing(first);
    EXPECT_LE((analysis->histories[index].row(0).transpose() - expected).lpNorm<Eigen::Infinity>(),
              1e-12 * size);
  }
}

TEST_P(EverySimulatedSample, DriftsAsTheMonitorsSay) {
  problem_.simulation.formulation.constraints = ConstraintForm::index_1;
  for (ResponseSettings& response : problem_.responses) {
    if (response.type == ResponseType::constraint_drift) response.over_time = OverTime::max_abs;
  }
  const auto analysis = run();
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  // The peak of a response may lie between two steps: the vertex of a parabola through three
  // samples is above the middle one by an eighth of it at most, where one neighbour is as high and
  // the other zero.
  const double position = value_of(*analysis, "drift 0"), velocity = value_of(*analysis, "drift 1");
  EXPECT_GT(monitors.position_drift, 0.0);
  EXPECT_GE(position, monitors.position_drift);
  EXPECT_LE(position, 1.125 * monitors.position_drift);
  EXPECT_GE(velocity, monitors.velocity_drift);
  EXPECT_LE(velocity, 1.125 * monitors.velocity_drift);
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySimulatedSample, testing::Range(0, sample_count),
                         sample_name);

/// Index 1 drifts by something that depends on the design, and its gradient says how; index 3 keeps
/// its constraints at every design. The drift is a sum of small errors: with the step of the file
/// what Newton's method leaves at round-off is 1e-5 of its gradient by differences. Eight times
/// that step drifts so much more that it counts no more.
class DriftGradient : public testing::TestWithParam<std::string> {};

TEST_P(DriftGradient, IsThatOfCentralDifferences) {
  std::vector<std::string> overrides = {
      "/responses={}", "/simulation/end_time=0.2", "/simulation/formulation=index-1",
      "/simulation/newton_tolerance=1e-16", "/simulation/step=4 ms"};
  for (const char* level : {"position", "velocity"}) {
    overrides.push_back(
        response_of(level, fmt::format(R"({{"type": "constraint-drift", "level": "{}",
                                            "over_time": "{}"}})",
                                       level, GetParam())));
  }
  const ProblemFile problem = sample_problem("hard/dead_centres", overrides);
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::VectorXd direct = direct_gradients(*analysis).col(0);
  Eigen::Vector2d best = Eigen::Vector2d::Ones();
  for (const double step : {4e-2, 2e-2, 1e-2}) {
    const Eigen::VectorXd wide = central_differences(problem, x, step).col(0);
    const Eigen::VectorXd narrow = central_differences(problem, x, step / 2).col(0);
    const Eigen::VectorXd expected = (4.0 * narrow - wide) / 3.0;
    best = best.cwiseMin((direct.cwiseQuotient(expected).array() - 1.0).abs().matrix());
  }
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_GT(std::abs(direct(i)) * x(0), 1e-4 * analysis->reductions[std::size_t(i)].value);
    EXPECT_LE(best(i), 2e-7) << i;  // measured 4e-11 to 2e-8
  }
}

INSTANTIATE_TEST_SUITE_P(OverTime, DriftGradient,
                         testing::Values("max-abs", "rms", "final", "mean"), [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(DriftGradientOfIndex3, VanishesWithTheDrift) {
  const ProblemFile problem = sample_problem(
      "hard/dead_centres",
      {response_of("drift", R"({"type": "constraint-drift", "over_time": "max-abs"})")});
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::Index drift = response_index(problem, "drift");
  EXPECT_LE(value_of(*analysis, "drift"), 1e-11);  // measured 1.7e-12 [m]
  EXPECT_LE(std::abs(direct_gradients(*analysis)(drift, 0)) * x(0), 1e-11);
}

/// A beam that nothing holds.
TEST(DriftResponse, NeedsConstraints) {
  Scene scene = swinging_beam(0.3, RectangleSection{0.01, 0.01}, 1);
  scene.joints.clear();
  const Model model = build_model(scene, {}, {}, {});
  ASSERT_EQ(model.mechanism.system->multipliers(), 0);
  ResponseSettings drift;
  drift.type = ResponseType::constraint_drift;
  EXPECT_THROW(make_responses({drift}, model), InputError);
}

}  // namespace
}  // namespace pleuel::test::monitor_response_test
