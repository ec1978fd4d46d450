#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/model/body_energy.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

/// Energies and errors of the time integration as responses; their gradients are tested with those
/// of all signals.

namespace pleuel::test::monitor_test {
namespace {

/// vᵀR of the terms that the energy of bodies stands for: all less the others.
double power_into_bodies(Model& model, const State& state) {
  Eigen::VectorXd residual, others = Eigen::VectorXd::Zero(model.mechanism.system->size());
  model.mechanism.system->residual(state, ConstraintLevel::position, residual);
  const TermsBesidesBodies besides = terms_besides_bodies(model);
  for (const auto* terms : {&besides.stiffening, &besides.acting}) {
    for (Term* term : *terms) term->add_residual(state, ConstraintLevel::position, others);
  }
  return state.v.dot((residual - others).head(state.v.size()));
}

class EveryMechanism : public ::testing::TestWithParam<SampleScene> {};

TEST_P(EveryMechanism, HasTheKineticEnergyOfItsMassMatrix) {
  Model model = GetParam().build();
  System& system = *model.mechanism.system;
  const Eigen::Index n = system.coordinates();
  for (unsigned seed : {1u, 2u}) {
    const State state = random_state(model, seed);
    System::Matrix mass = system.make_matrix();
    system.tangent(state, {.a = 1.0}, ConstraintLevel::position, mass);
    const double expected = 0.5 * state.v.dot(Eigen::MatrixXd(mass).topLeftCorner(n, n) * state.v);
    EXPECT_NEAR(energy_of_bodies(model, state).kinetic, expected, 1e-12 * expected);
  }
}

/// dE/dt = vᵀ (M a − Q) − dissipation along any motion with these q, v, a: ties energy of every
/// kind and the loss by damping to the forces of the bodies. The error is that of the differences.
TEST_P(EveryMechanism, GainsInEnergyWhatItsBodiesAreDriven) {
  Model model = GetParam().build();
  for (unsigned seed : {1u, 2u}) {
    const State state = random_state(model, seed);
    const double expected =
        power_into_bodies(model, state) - energy_of_bodies(model, state).dissipation;
    const double found = derivative_at_zero(
        [&](double t) {
          State moved = state;
          advance(model.mechanism.rotations, state.q, t * state.v, moved.q);
          moved.v += t * state.a;
          return energy_of_bodies(model, moved).total();
        },
        1e-4);
    EXPECT_NEAR(found, expected, 1e-8 * std::abs(expected));
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EveryMechanism, ::testing::ValuesIn(all_samples()),
                         [](const auto& test) { return test.param.name; });

/// A rigid bar that a drive turns steadily against its weight does the work m g L/2 sin Ωt,
/// whatever the steps are. 3e-4: the trapezoidal rule is off by (Ωh)²/12 = 2e-4 of the amplitude.
TEST(Work, IsSummedOverUnequalSteps) {
  const double speed = 3.0, length = 0.4, end = 1.0;
  Scene scene = swinging_beam(length, RectangleSection{0.02, 0.02}, 2);
  std::get<BeamBody>(scene.bodies.front().shape).is_rigid = true;
  scene.joints.front().drive = Drive(ConstantSpeedDrive{speed});
  Model model = build_model(scene, {}, {}, {});
  SimulationOptions options{end, 0.016, 0.8};
  for (double t = 0.0, step = 0.002; t < end; t += step, step = 0.018 - step) {
    options.instants.push_back(t);  // steps of 2 and 16 ms by turns
  }
  options.instants.push_back(end);
  const Trajectory trajectory = simulate(model.mechanism, options);
  ASSERT_EQ(static_cast<std::size_t>(trajectory.time.size()), options.instants.size());
  const Monitors monitors = monitor(model, trajectory);
  const double amplitude = 7850 * 0.02 * 0.02 * length * 9.81 * length / 2;
  for (Eigen::Index i = 0; i < trajectory.time.size(); ++i) {
    EXPECT_NEAR(monitors.work(i), amplitude * std::sin(speed * trajectory.time(i)),
                3e-4 * amplitude)
        << trajectory.time(i);
  }
  EXPECT_LE(monitors.energy_error, 6e-4);
}

Monitors monitors_of(const SampleScene& sample, double end, double step) {
  Model model = sample.build();
  SimulationOptions options{end, step, 0.8};
  options.newton_tolerance = 1e-12;
  return monitor(model, simulate(model.mechanism, options));
}

/// A mechanism with steps that are short enough for what vibrates noticeably in it.
struct Run {
  SampleScene sample;
  double end;
  std::vector<double> steps;
};

class EveryMotion : public ::testing::TestWithParam<Run> {};

/// Order two, of the scheme and of the rule that sums the work: see monitors.hpp.
TEST_P(EveryMotion, ClosesItsBalanceOfEnergyWithTheOrderOfTheScheme) {
  std::vector<double> velocity_drifts, errors;
  for (double step : GetParam().steps) {
    const Monitors monitors = monitors_of(GetParam().sample, GetParam().end, step);
    errors.push_back(monitors.energy_error);
    velocity_drifts.push_back(monitors.velocity_drift);
    EXPECT_LE(monitors.position_drift, 1e-14);  // index 3: to round-off; measured 1.4e-15
  }
  EXPECT_NEAR(observed_order(GetParam().steps, errors), 2.0, 0.2);
  EXPECT_NEAR(observed_order(GetParam().steps, velocity_drifts), 2.0, 0.1);
  EXPECT_LE(errors.back(), 5e-5);
}

std::vector<Run> motions() {
  const std::vector<double> steps = {1e-3, 5e-4, 2.5e-4};
  // For loads that act at once on beams without damping, which vibrate at up to 3e4 rad/s.
  const std::vector<double> fine = {3.2e-5, 1.6e-5, 8e-6};
  // For a boom of short elements: where its vibration is met by the steps shifts the largest drift.
  // From one halving to the next it falls by 3.5, 4.6, 5.2, 4.5 and 3.5.
  const std::vector<double> wide = {1e-3, 2.5e-4, 3.125e-5};
  SampleScene smooth = smooth_planar_sample();
  smooth.name = "DrivenSliderCrank";
  return {{smooth, 0.1, steps},
          {planar_sample(), 0.1, steps},
          {planar_sample_in_space(), 0.1, steps},
          {spatial_sample(), 0.1, steps},
          {spatial_joints_sample(), 0.1, wide},
          {reduced_sample(), 0.1, steps},
          {reduced_sample_in_space(), 0.1, steps},
          {planar_joints_sample(), 0.02, fine}};
}

INSTANTIATE_TEST_SUITE_P(Samples, EveryMotion, ::testing::ValuesIn(motions()),
                         [](const auto& test) { return test.param.sample.name; });

/// A rubber beam that falls from the horizontal and swings, without damping: it bends far, so that
/// geometric stiffening takes part.
SampleScene rubber_pendulum(double height = 0.0) {
  SampleScene sample;
  sample.scene = swinging_beam(0.5, RectangleSection{0.02, 0.02}, 3);
  sample.scene.materials[0] = {"steel", 5e6, 0.3, 1100.0};
  auto& beam = std::get<BeamBody>(sample.scene.bodies[0].shape);
  for (Point* point : {&beam.from, &beam.to, &sample.scene.joints[0].at}) (*point)[1] = height;
  return sample;
}

struct Simulation {
  Model model;
  Trajectory trajectory;
};

Simulation simulated_pendulum(double step) {
  Simulation simulation{rubber_pendulum().build(), {}};
  SimulationOptions options{0.3, step, 0.95};
  options.newton_tolerance = 1e-12;
  simulation.trajectory = simulate(simulation.model.mechanism, options);
  return simulation;
}

TEST(Monitors, FindNoWorkInAFreeSwingAndAnEnergyThatStays) {
  const std::vector<double> steps = {4e-4, 2e-4, 1e-4};
  std::vector<double> errors;
  for (double step : steps) {
    auto [model, trajectory] = simulated_pendulum(step);
    const Monitors monitors = monitor(model, trajectory);
    // Nothing acts but the bearing, whose multipliers are some 10 N.
    EXPECT_LE(monitors.work.lpNorm<Eigen::Infinity>(), 1e-12);
    errors.push_back(monitors.energy_error);
  }
  EXPECT_NEAR(observed_order(steps, errors), 2.0, 0.2);
}

/// What stretching stores is a potential (tests/support/energy.hpp integrates the strain itself);
/// here it is summed as work. The difference is that of the sum, O(h²).
TEST(Monitors, FindTheEnergyOfTheStrain) {
  const std::vector<double> steps = {4e-4, 2e-4, 1e-4};
  std::vector<double> errors;
  for (double step : steps) {
    auto [model, trajectory] = simulated_pendulum(step);
    ASSERT_TRUE(model.bodies[0].has_stiffening);
    const Monitors monitors = monitor(model, trajectory);
    State state;
    double error = 0.0;
    for (int i = 0; i <= trajectory.steps(); ++i) {
      trajectory.states->load(i, state);
      error = std::max(error, std::abs(monitors.energy(i) - energy_of(model, state)));
    }
    errors.push_back(error);
  }
  EXPECT_NEAR(observed_order(steps, errors), 2.0, 0.2);
}

/// The pendulum as it swings, with all rates 1 % too large: its kinetic energy, which makes all of
/// the energy in its deepest position, is 1.01² of the true one, so that 1 − 1.01⁻² of it are
/// missing.
/// What a large kinetic energy hides, the elastic energy shows: the energy that is missing, over
/// the largest of the strain, which a response gives. 1e-3: the monitors sum that of stiffening up
/// over time.
TEST(Monitors, CompareTheBalanceWithTheEnergyOfTheStrainToo) {
  const SampleScene sample = planar_sample();
  ProblemFile problem = sample.problem();
  problem.simulation.end_time = 0.05;
  problem.simulation.step = 1e-3;
  problem.responses = {{"strain", EnergyResponse{.kind = EnergyKind::elastic}}};
  const auto analysis = analyze(problem, start_design(problem));
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  const double missing =
      ((monitors.energy - monitors.work).array() - monitors.energy(0)).abs().maxCoeff();
  const double strain = analysis->histories[0].maxCoeff();
  ASSERT_GT(missing, 0.0);
  EXPECT_NEAR(monitors.elastic_energy_error, missing / strain, 1e-3 * missing / strain);
  EXPECT_GT(monitors.elastic_energy_error, monitors.energy_error);
}

TEST(Monitors, SeeRatesThatDoNotBelongToTheMotion) {
  auto [model, trajectory] = simulated_pendulum(1e-4);
  trajectory.columns().v() *= 1.01;
  EXPECT_NEAR(monitor(model, trajectory).energy_error, 1.0 - 1.0 / (1.01 * 1.01), 1e-3);
}

/// A slider that is put 1 mm off its guide for an instant, and moves off it at 10 mm/s in another:
/// by so much the equations of the guide are wrong, and those of its pin.
TEST(Monitors, SeeConstraintsThatAreNotKept) {
  Model model = smooth_planar_sample().build();
  Trajectory trajectory = simulate(model.mechanism, {0.05, 1e-4, 0.8});
  const BodyFrame& slider = model.body("slider").frame;
  const Eigen::Vector3d off_the_guide = {0.0, 1.0, 0.0};
  const Eigen::VectorXd direction = slider.basis.transpose() * off_the_guide;
  trajectory.columns().q().col(200).segment(slider.offset, slider.size()) += 1e-3 * direction;
  trajectory.columns().v().col(100).segment(slider.offset, slider.size()) += 1e-2 * direction;
  const Monitors monitors = monitor(model, trajectory);
  EXPECT_NEAR(monitors.position_drift, 1e-3, 1e-12);
  EXPECT_NEAR(monitors.velocity_drift, 1e-2, 1e-3);  // with the drift that is there: 7e-5
}

/// The potential of weight counts from the start only: no height makes an error look smaller.
TEST(Monitors, AreTheSameAtAnyHeight) {
  const double ground = monitors_of(rubber_pendulum(), 0.1, 4e-4).energy_error;
  const double tower = monitors_of(rubber_pendulum(64.0), 0.1, 4e-4).energy_error;
  EXPECT_NEAR(tower, ground, 1e-6 * ground);  // round-off of 64 m against Newton's tolerance
}

TEST(Monitors, FindNothingAtRest) {
  SampleScene sample = rubber_pendulum();
  sample.scene.gravity = {0.0, 0.0, 0.0};
  Model model = sample.build();
  const Monitors monitors = monitor(model, simulate(model.mechanism, {0.01, 1e-3, 0.8}));
  EXPECT_EQ(monitors.position_drift, 0.0);
  EXPECT_EQ(monitors.velocity_drift, 0.0);
  EXPECT_EQ(monitors.energy_error, 0.0);
}

/// A cantilever that starts in equilibrium under a force P at its tip stays there: its tip turns by
/// P L²/(2EI), in nodal and in modal coordinates.
TEST(ElasticRotation, OfACantileverIsThatOfStatics) {
  const double length = 0.3, side = 0.01, force = 2.0, young = 2.1e11;
  const double expected = force * length * length / (2.0 * young * std::pow(side, 4) / 12.0);
  for (bool is_reduced : {false, true}) {
    Scene scene = swinging_beam(length, RectangleSection{side, side}, 3);
    scene.gravity = {0.0, 0.0, 0.0};
    scene.joints.front().type = JointType::fixed;
    if (is_reduced) {
      std::get<BeamBody>(scene.bodies.front().shape).reduction = CraigBampton{2, {}};
    }
    PointLoad push{LoadKind::force, "beam", {length, 0.0, 0.0}, {0.0, 1.0, 0.0}, {}, false};
    push.value = ConstantFunction{force};
    scene.loads = {{"push", push}};
    Model model = build_model(scene, {}, {}, {});
    model.mechanism.starts_in_equilibrium = true;
    const Monitors monitors = monitor(model, simulate(model.mechanism, {0.01, 1e-3, 0.8}));
    EXPECT_NEAR(monitors.elastic_rotation, expected, 1e-6 * expected) << is_reduced;
    EXPECT_EQ(monitors.most_bent, "beam");
  }
}

/// A mast that stands still and obliquely, so that round-off moves it: energy of the last digits is no
/// energy that steps could miss.
TEST(EnergyMonitor, OfAMechanismAtRestIsKept) {
  Scene scene;
  Material steel;
  steel.name = "steel";
  steel.young = 2.1e11;
  steel.poisson = 0.3;
  steel.density = 7850.0;
  scene.materials = {steel};
  BeamBody beam;
  beam.to = {0.72, 0.96, 0.1};
  beam.material = "steel";
  Segment segment;
  segment.section = RectangleSection{0.05, 0.04};
  segment.elements = 6;
  beam.segments = {segment};
  scene.bodies = {{"mast", beam}};
  Joint root;
  root.name = "root";
  root.type = JointType::fixed;
  root.bodies = {ground_name, "mast"};
  scene.joints = {root};
  ProblemFile problem;
  problem.scene = scene;
  problem.simulation.end_time = 0.02;
  problem.simulation.step = 0.001;
  const auto analysis = analyze(problem, {});
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  EXPECT_LE(monitors.energy_error, 1e-3);
  EXPECT_LE(monitors.elastic_energy_error, 1e-3);
}

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
  const auto [problem, x, analysis] = AtStart(sample_problem(
      "hard/stiff_rod",
      {response_of("crank", R"({"type": "kinetic-energy", "body": "crank", "over_time": "final"})"),
       response_of("slider",
                   R"({"type": "kinetic-energy", "body": "slider", "over_time": "final"})"),
       response_of(
           "speed",
           R"({"type": "velocity", "body": "slider", "direction": "x", "over_time": "final"})")}));
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
  PointLoad push{LoadKind::force, "beam", {length, 0.0, 0.0}, {0.0, 1.0, 0.0}, {}, false};
  push.value = ConstantFunction{force};
  scene.loads = {{"push", push}};
  ProblemFile problem;
  problem.scene = scene;
  problem.simulation.end_time = 0.01;
  problem.simulation.step = 1e-3;
  problem.simulation.quasi_static_start = true;
  problem.responses = {{"energy", EnergyResponse{.kind = EnergyKind::elastic}, OverTime::mean}};
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
      const EnergyResponse kinetic{.kind = EnergyKind::kinetic},
          elastic{.kind = EnergyKind::elastic};
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
  ResponseSettings& balance() {
    for (ResponseSettings& response : problem_.responses) {
      if (response.is<EnergyBalanceResponse>()) return response;
    }
    throw std::runtime_error("no such response");
  }

  ProblemFile problem_;
};

/// The monitors have other formulas for the same balance; round-off of the largest energy.
TEST_P(EverySimulatedSample, MissesInItsBalanceWhatTheMonitorsMiss) {
  for (const bool is_window : {false, true}) {
    ResponseSettings& balance = this->balance();
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
    if (response.is<DriftResponse>()) response.over_time = OverTime::max_abs;
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
    overrides.push_back(response_of(
        level, fmt::format(R"({{"type": "constraint-drift", "level": "{}", "over_time": "{}"}})",
                           level, GetParam())));
  }
  const auto [problem, x, analysis] = AtStart(sample_problem("hard/dead_centres", overrides));
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
  const auto [problem, x, analysis] = AtStart(sample_problem(
      "hard/dead_centres",
      {response_of("drift", R"({"type": "constraint-drift", "over_time": "max-abs"})")}));
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
  EXPECT_THROW(make_responses({{"drift", DriftResponse{}}}, model), InputError);
}

}  // namespace
}  // namespace pleuel::test::monitor_test
