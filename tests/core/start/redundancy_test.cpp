#include "core/start/redundancy.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "core/integration/step_equations.hpp"
#include "core/mechanism/linear_solver.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/response/analysis.hpp"
#include "core/start/degrees_of_freedom.hpp"
#include "core/start/initial_state.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::redundancy_test {
namespace {

Joint revolute(const std::string& name, const std::string& a, const std::string& b, Point at) {
  Joint joint;
  joint.name = name;
  joint.bodies = {a, b};
  joint.at = std::move(at);
  return joint;
}

Body rigid_bar(const std::string& name, Point from, Point to) {
  BeamBody bar;
  bar.from = std::move(from);
  bar.to = std::move(to);
  bar.material = "steel";
  bar.segments = {{CircleSection{0.01}, 1, {}}};
  bar.is_rigid = true;
  return {name, bar};
}

/// A planar four-bar with rigid links; its ground pins are a unit apart.
Scene four_bar(const Point& crank_pin, const Point& rocker_pin) {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.materials.push_back({"steel", 2.1e11, 0.3, 7850.0});
  const Point left = {0.0, 0.0, 0.0}, right = {1.0, 0.0, 0.0};
  scene.bodies = {rigid_bar("crank", left, crank_pin), rigid_bar("coupler", crank_pin, rocker_pin),
                  rigid_bar("rocker", right, rocker_pin)};
  scene.joints = {revolute("left", ground_name, "crank", left),
                  revolute("first pin", "crank", "coupler", crank_pin),
                  revolute("second pin", "coupler", "rocker", rocker_pin),
                  revolute("right", ground_name, "rocker", right)};
  return scene;
}

Model in_space(const Scene& scene) {
  EffectSettings effects{.spatial_motion = EffectChoice::on};
  return build_model(scene, effects, {}, {});
}

TEST(RedundantConstraints, AreNotInTheSamples) {
  for (const SampleScene& sample : all_samples()) {
    EXPECT_THAT(sample.build().mechanism.system->left_out(), IsEmpty()) << sample.name;
  }
}

/// Grübler's count in space: 6 · 3 − 5 · 4 = −2 for a loop that has one freedom: 3 too many.
TEST(RedundantConstraints, OfAPlanarLoopInSpaceAreThree) {
  const Model model = in_space(four_bar({0.2, 0.3, 0.0}, {1.1, 0.6, 0.0}));
  EXPECT_EQ(model.mechanism.system->left_out().size(), 3u);
  const EffectRecord& record = model.effects.back();
  EXPECT_EQ(record.name, "redundant_constraints");
  EXPECT_THAT(record.reason, HasSubstr("follow from the others"));
}

TEST(RedundantConstraints, LeaveTheMotionThatThePlaneHas) {
  const Scene scene = four_bar({0.2, 0.3, 0.0}, {1.1, 0.6, 0.0});
  Model space = in_space(scene), plane = build_model(scene, {}, {}, {});
  const SimulationOptions options{0.5, 1e-3, 0.8};
  const Trajectory in_the_plane = simulate(plane.mechanism, options);
  const int last = in_the_plane.steps();
  for (ConstraintForm form : {ConstraintForm::index_3, ConstraintForm::stabilized_index_2}) {
    SimulationOptions with_form = options;
    with_form.formulation.constraints = form;
    const Trajectory found = simulate(space.mechanism, with_form),
                     expected = simulate(plane.mechanism, with_form);
    for (std::size_t i = 0; i < space.bodies.size(); ++i) {
      const auto place = [&](const Model& model, const Trajectory& trajectory) {
        return Eigen::Vector2d(
            trajectory.columns().q().col(last).segment<2>(model.bodies[i].frame.offset));
      };
      // Positions to what Newton's method leaves.
      EXPECT_LE((place(space, found) - place(plane, expected)).norm(), 1e-9) << i;
    }
  }
}

/// Four-bars in a row, each with its ground pins; a bar connects each crank with the next if asked.
enum class Neighbours { apart, connected };
Scene four_bars(int count, Neighbours neighbours) {
  Scene all;
  all.gravity = {0.0, -9.81, 0.0};
  all.materials.push_back({"steel", 2.1e11, 0.3, 7850.0});
  for (int i = 0; i < count; ++i) {
    const double x = 1.5 * i;
    const std::string of = std::to_string(i);
    const Point left = {x, 0.0, 0.0}, right = {x + 1.0, 0.0, 0.0}, crank_pin = {x + 0.2, 0.3, 0.0},
                rocker_pin = {x + 1.1, 0.6, 0.0};
    all.bodies.push_back(rigid_bar("crank" + of, left, crank_pin));
    all.bodies.push_back(rigid_bar("coupler" + of, crank_pin, rocker_pin));
    all.bodies.push_back(rigid_bar("rocker" + of, right, rocker_pin));
    all.joints.push_back(revolute("left" + of, ground_name, "crank" + of, left));
    all.joints.push_back(revolute("first" + of, "crank" + of, "coupler" + of, crank_pin));
    all.joints.push_back(revolute("second" + of, "coupler" + of, "rocker" + of, rocker_pin));
    all.joints.push_back(revolute("right" + of, ground_name, "rocker" + of, right));
    if (neighbours == Neighbours::apart || i == 0) continue;
    const std::string before = std::to_string(i - 1), bar = "bar" + of;
    const Point from = {x - 0.4, 0.6, 0.0};
    all.bodies.push_back(rigid_bar(bar, from, crank_pin));
    all.joints.push_back(revolute("begin" + of, "rocker" + before, bar, from));
    all.joints.push_back(revolute("end" + of, bar, "crank" + of, crank_pin));
  }
  return all;
}

/// Many links: rows of separate four-bars are ranked by themselves, those of connected ones by a
/// sparse decomposition. A bar with two joints between moving links closes one more planar loop.
TEST(RedundantConstraints, OfManyPlanarLoopsInSpaceAreThreeEach) {
  constexpr int count = 12;
  const Model apart = in_space(four_bars(count, Neighbours::apart));
  EXPECT_EQ(apart.mechanism.system->left_out().size(), 3u * count);
  const Model connected = in_space(four_bars(count, Neighbours::connected));
  EXPECT_EQ(connected.mechanism.system->left_out().size(), 3u * (2 * count - 1));
}

/// All links in a line: the rank falls there, but only there.
TEST(RedundantConstraints, AreToldFromASingularPosition) {
  const Model model = build_model(four_bar({0.5, 0.0, 0.0}, {1.5, 0.0, 0.0}), {}, {}, {});
  EXPECT_THAT(model.mechanism.system->left_out(), IsEmpty());
}

TEST(RedundantConstraints, OfADoubledJointAreThoseOfOne) {
  Scene scene = swinging_beam(0.3, CircleSection{0.01}, 2);
  scene.joints.push_back(revolute("again", ground_name, "beam", {0.0, 0.0, 0.0}));
  Model twice = build_model(scene, {}, {}, {});
  scene.joints.pop_back();
  Model once = build_model(scene, {}, {}, {});
  EXPECT_EQ(twice.mechanism.system->left_out().size(), 2u);
  const Trajectory found = simulate(twice.mechanism, {0.1, 1e-3}),
                   expected = simulate(once.mechanism, {0.1, 1e-3});
  EXPECT_LE((found.columns().q() - expected.columns().q()).lpNorm<Eigen::Infinity>(), 1e-12);
}

/// A second drive of the same angle follows from the first if it says the same at all times; one
/// that agrees at the start only contradicts it.
TEST(RedundantConstraints, OfADoubledDriveAreThoseOfOneOnlyIfBothSayTheSame) {
  Scene scene = swinging_beam(0.3, CircleSection{0.01}, 2);
  scene.joints.front().drive = Drive(ConstantSpeedDrive{3.0});
  scene.joints.push_back(revolute("again", ground_name, "beam", {0.0, 0.0, 0.0}));
  scene.joints.back().drive = Drive(ConstantSpeedDrive{3.0});
  EXPECT_EQ(build_model(scene, {}, {}, {}).mechanism.system->left_out().size(), 3u);
  scene.joints.back().drive = Drive(ConstantSpeedDrive{4.0});
  EXPECT_EQ(build_model(scene, {}, {}, {}).mechanism.system->left_out().size(), 2u);
}

/// A bar on two hinges of one axis, both driven alike: its motion is that of the law, and the
/// torque that both exert together is that of one, I φ̈ + m g L/2 cos φ, at every instant.
TEST(RedundantConstraints, OfTwoDrivesShareTheTorqueOfOne) {
  const double length = 0.3, width = 0.02;
  Scene scene = swinging_beam(length, RectangleSection{width, width}, 2);
  std::get<BeamBody>(scene.bodies.front().shape).is_rigid = true;
  const Drive law(PolynomialFunction{{0.0, 0.0, 0.0, 40.0}});  // 40 t³
  scene.joints.front().drive = law;
  scene.joints.push_back(revolute("again", ground_name, "beam", {0.0, 0.0, 0.0}));
  scene.joints.back().drive = law;
  const double mass = 7850.0 * width * width * length;
  const double inertia = mass * (length * length / 3 + width * width / 12);
  for (const EffectChoice spatial : {EffectChoice::automatic, EffectChoice::on}) {
    EffectSettings effects{.spatial_motion = spatial};
    Model model = build_model(scene, effects, {}, {});
    const Trajectory trajectory = simulate(model.mechanism, {0.2, 1e-3});
    State state;
    for (const int step : {100, 150, 200}) {
      trajectory.states->load(step, state);
      const double t = state.time, angle = 40.0 * t * t * t;
      const FrameMotion<double> motion = frame_of(model.body("beam"), state);
      EXPECT_NEAR(motion.A(1, 0), std::sin(angle), 1e-9);
      double torque = 0.0;
      for (const char* name : {"bearing", "again"}) {
        torque -= state.lambda(model.joint(name).drive_row);
      }
      const double expected = inertia * 240.0 * t + mass * 9.81 * length / 2 * std::cos(angle);
      // Of second order in the step: (h/t)² at most.
      EXPECT_NEAR(torque / expected, 1.0, 2e-4) << t;
    }
  }
}

/// Newton's method sets their multipliers to zero, whatever they were: with a wrong factor
/// round-off would grow from step to step.
TEST(RedundantConstraints, HaveNoMultipliersAfterAStepOfNewtonsMethod) {
  Model model = in_space(four_bar({0.2, 0.3, 0.0}, {1.1, 0.6, 0.0}));
  Mechanism& mechanism = model.mechanism;
  const State start = initial_state(mechanism).state;
  for (const Formulation formulation :
       {Formulation{ConstraintForm::index_3}, Formulation{ConstraintForm::stabilized_index_2},
        Formulation{ConstraintForm::index_1, 50.0}}) {
    StepEquations equations(mechanism, generalized_alpha(1e-3, 0.8), formulation);
    equations.begin(start);
    StepState state = equations.make_state(start);
    for (int i : mechanism.system->left_out()) {
      state.lambda(i) = 1.0;
      if (state.eta.size() > 0) state.eta(i) = 1.0;
    }
    System::Matrix matrix = equations.make_matrix();
    Eigen::VectorXd residual;
    equations.linearize(state, residual, matrix);
    LinearSolver solver(matrix);
    ASSERT_TRUE(solver.factorize(matrix));
    Eigen::MatrixXd correction = -residual;
    solver.solve(correction);
    equations.apply(correction, state);
    for (int i : mechanism.system->left_out()) {
      EXPECT_NEAR(state.lambda(i), 0.0, 1e-12);
      if (state.eta.size() == 0) continue;
      EXPECT_NEAR(state.eta(i), 0.0, 1e-12);
    }
  }
}

struct Expected {
  std::string problem;
  std::vector<std::string> overrides;
  int coordinates, free;
};

class RigidFreedoms : public testing::TestWithParam<Expected> {};

/// Counted by hand: three coordinates a body in the plane and two a point, six and three in space.
TEST_P(RigidFreedoms, AreThoseOfTheMechanism) {
  const Expected& expected = GetParam();
  const auto [problem, x, analysis] = AtStart(sample_problem(expected.problem, expected.overrides));
  State initial = state_of(analysis->trajectory, 0);
  const DegreesOfFreedom freedoms = rigid_degrees_of_freedom(analysis->model.mechanism, initial);
  EXPECT_EQ(freedoms.coordinates, expected.coordinates);
  EXPECT_EQ(freedoms.free(), expected.free);
}

/// Free motions keep all constraints to first order, and are as many as the freedoms.
TEST_P(RigidFreedoms, AreSpannedByMotionsThatKeepTheConstraints) {
  const auto [problem, x, analysis] =
      AtStart(sample_problem(GetParam().problem, GetParam().overrides));
  Mechanism& mechanism = analysis->model.mechanism;
  State state = state_of(analysis->trajectory, 0);
  const Eigen::MatrixXd motions = free_motions(mechanism, state);
  ASSERT_EQ(motions.cols(), GetParam().free);
  State generic = generic_position(mechanism, state);
  for (State* at : {&state, &generic}) {
    const Eigen::MatrixXd free = free_motions(mechanism, *at);
    ASSERT_EQ(free.cols(), GetParam().free);
    EXPECT_LE(
        (free.transpose() * free - Eigen::MatrixXd::Identity(free.cols(), free.cols())).norm(),
        1e-12);
    for (Eigen::Index i = 0; i < free.cols(); ++i) {
      Eigen::VectorXd before, after;
      State moved = *at;
      mechanism.system->residual(moved, ConstraintLevel::position, before);
      advance(mechanism.rotations, at->q, 1e-6 * mechanism.scale.cwiseProduct(free.col(i)),
              moved.q);
      mechanism.system->residual(moved, ConstraintLevel::position, after);
      // Of second order, and the round-off of positions.
      EXPECT_LE((after - before).tail(mechanism.system->multipliers()).lpNorm<Eigen::Infinity>(),
                1e-10);
    }
  }
}

const std::string brief = "/simulation/end_time=2 ms";

INSTANTIATE_TEST_SUITE_P(
    Problems, RigidFreedoms,
    testing::Values(
        // Driven: crank, rod, and a point.
        Expected{"slider_crank", {"/simulation/end_time=0.25 ms"}, 8, 0},
        // The same without a drive, in the dead centre.
        Expected{"hard/dead_centres", {brief}, 8, 1},
        // A single loop in space, which can move only because one of its constraints is redundant.
        Expected{"hard/bricard", {"/simulation/end_time=20 ms"}, 30, 1}),
    [](const auto& test) {
      std::string name = test.param.problem;
      std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
      return name;
    });

}  // namespace
}  // namespace pleuel::test::redundancy_test
