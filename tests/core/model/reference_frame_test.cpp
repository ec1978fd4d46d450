#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "core/model/state_in_space.hpp"
#include "core/response/analysis.hpp"
#include "core/response/full_mechanism.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/places.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::reference_frame_test {
namespace {

constexpr std::array frames = {ReferenceCondition::chord, ReferenceCondition::tangent,
                               ReferenceCondition::tangent_end, ReferenceCondition::mean_axis};

/// A slider-crank with a rigid crank; the rod is bent by its weight and a force in the middle.
Scene slider_crank(ReferenceCondition frame, double young) {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  scene.materials.push_back({"soft", young, 0.3, 2000.0});
  const Point origin = {0.0, 0.0, 0.0}, pin = {0.06, 0.08, 0.0}, end = {0.36, 0.0, 0.0};
  BeamBody rod;
  rod.from = pin;
  rod.to = end;
  rod.material = "soft";
  rod.segments = {{RectangleSection{0.012, 0.012}, 4, {}}};
  rod.frame = frame;
  rod.damping = {0.0, 2e-3};
  BeamBody crank = rod;
  crank.from = origin;
  crank.to = pin;
  crank.is_rigid = true;
  crank.frame = ReferenceCondition::tangent;
  scene.bodies = {{"crank", crank}, {"rod", rod}, {"slider", PointMass{end, 0.05}}};
  const auto joint = [](const char* name, JointType type, const char* first, const char* second,
                        const Point& at) {
    Joint result;
    result.name = name;
    result.type = type;
    result.bodies = {first, second};
    result.at = at;
    return result;
  };
  scene.joints = {joint("bearing", JointType::revolute, ground_name, "crank", origin),
                  joint("pin", JointType::revolute, "crank", "rod", pin),
                  joint("slider pin", JointType::revolute, "rod", "slider", end),
                  joint("guide", JointType::point_on_line, ground_name, "slider", end)};
  scene.joints[0].drive = RampToSpeedDrive{6.0, 0.2};
  scene.joints[3].axis = {1, 0, 0};
  PointForce push{"rod", {0.21, 0.04, 0.0}, {0.0, -1.0, 0.0}, {}, false};
  push.value = RampToSpeedDrive{4.0, 0.1};
  scene.loads = {{"push", push}};
  return scene;
}

struct Motions {
  Eigen::MatrixXd places;   ///< of the slider and of places along the rod, a column a step
  double deflection = 0.0;  ///< largest of the rod's middle from its chord [m]
};

Motions motions_of(ReferenceCondition frame, double young) {
  Model model = build_model(slider_crank(frame, young), {}, {}, {});
  const Trajectory trajectory = simulate(model.mechanism, {0.3, 1e-3, 0.8});
  const BodyModel &rod = model.body("rod"), &slider = model.body("slider");
  Motions result;
  result.places.resize(8, trajectory.steps() + 1);
  State state;
  for (int step = 0; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    const Eigen::Vector3d start = position_of(rod, state, 0.0),
                          middle = position_of(rod, state, 0.5), end = position_of(rod, state, 1.0),
                          side = position_of(rod, state, 0.7);
    result.places.col(step) << position_of(slider, state).head<2>(), middle.head<2>(),
        side.head<2>(), end.head<2>();
    const Eigen::Vector3d chord = (end - start).normalized();
    result.deflection = std::max(result.deflection, chord.cross(middle - start).norm());
  }
  return result;
}

/// Frames differ in what they neglect, which is of second order in the deflection. Measured: 2.0
/// for all; 7 % of δ²/L for tangents, 0.04 % for the mean axis.
TEST(ReferenceFrames, AgreeTheBetterTheLessABodyBends) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    std::vector<double> deflections, differences;
    for (double young : {1e9, 2e9, 4e9}) {
      const Motions chord = motions_of(frames[0], young), other = motions_of(frames[i], young);
      deflections.push_back(chord.deflection);
      differences.push_back((other.places - chord.places).lpNorm<Eigen::Infinity>());
    }
    EXPECT_NEAR(observed_order(deflections, differences), 2.0, 0.1) << i;
    EXPECT_LE(differences.back(), 0.5 * deflections.back() * deflections.back() / 0.31) << i;
  }
}

/// ∫ρ S and ∫ρ p₀ × S of a mean axis, against those of the same beam in a chord frame.
TEST(MeanAxis, CarriesNoMomentumRelativeToItsFrame) {
  for (SampleScene sample : {reduced_sample(), reduced_sample_in_space()}) {
    const Model model = sample.build();
    for (Body& body : sample.scene.bodies) {
      auto& beam = std::get<BeamBody>(body.shape);
      if (beam.frame == ReferenceCondition::mean_axis) beam.frame = ReferenceCondition::chord;
    }
    const Model chord = sample.build();
    const auto momentum = [](const Invariants<double>& i) {
      Eigen::MatrixXd rows(6, i.size());
      rows.topRows(3) = i.shape;
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        rows.row(3 + k) = i.mixed.row(3 * a + b) - i.mixed.row(3 * b + a);
      }
      return rows;
    };
    for (const char* name : {"rod", "arm"}) {
      const auto found = momentum(model.body(name).invariants);
      const auto scale = momentum(chord.body(name).invariants);
      for (int k = 0; k < 6; ++k) {
        EXPECT_LE(found.row(k).lpNorm<Eigen::Infinity>(),
                  1e-13 * scale.topRows(3).lpNorm<Eigen::Infinity>())
            << name << ", " << k;
      }
    }
  }
}

/// m = ρAL, ∫ρ p = (mL/2, 0, 0), ∫ρ p pᵀ = diag(mL²/3, ρ I_z L, ρ I_y L) of a uniform bar; two
/// segments add what each has about the common origin.
TEST(RigidBeam, HasTheInertiaOfABar) {
  constexpr double length = 0.4, density = 2000.0, width = 0.03, height = 0.05, diameter = 0.02;
  constexpr double pi = std::numbers::pi;
  BeamBody beam;
  beam.from = {0.0, 0.0, 0.0};
  beam.to = {length, 0.0, 0.0};
  beam.material = "steel";
  beam.segments = {{RectangleSection{width, height}, 2, 0.25}, {CircleSection{diameter}, 1, 0.75}};
  beam.is_rigid = true;
  Scene scene;
  scene.materials.push_back({"steel", 1e9, 0.3, density});
  scene.bodies = {{"bar", beam}};
  for (ReferenceCondition frame : frames) {
    std::get<BeamBody>(scene.bodies[0].shape).frame = frame;
    const Model model = build_model(scene, {}, {}, {});
    const Invariants<double>& bar = model.bodies[0].invariants;
    EXPECT_EQ(bar.size(), 0);
    const double m1 = density * width * height * 0.1,
                 m2 = density * pi / 4 * diameter * diameter * 0.3;
    EXPECT_NEAR(bar.mass, m1 + m2, 1e-14 * bar.mass);
    const Eigen::Vector3d first(m1 * 0.05 + m2 * 0.25, 0.0, 0.0);
    EXPECT_LE((bar.first_moment - first).norm(), 1e-14 * first.norm());
    const double round = m2 * diameter * diameter / 16;
    const Eigen::Vector3d second(m1 * 0.1 * 0.1 / 3 + m2 * (0.25 * 0.25 + 0.3 * 0.3 / 12),
                                 m1 * height * height / 12 + round,
                                 m1 * width * width / 12 + round);
    EXPECT_LE((bar.second_moment - Eigen::Matrix3d(second.asDiagonal())).norm(),
              1e-14 * second.norm());
  }
}

FrameMotion<double> motion_of(const BodyModel& body, const State& state) {
  const int first = body.frame.offset, size = body.frame.size();
  return frame_motion<double>(body.frame, state.q.segment(first, size),
                              state.v.segment(first, size), state.a.segment(first, size));
}

Eigen::Matrix<double, 6, Eigen::Dynamic> deformation(const BodyModel& body,
                                                     const Eigen::VectorXd& of) {
  return body.places.displacements(of.segment(body.elastic_offset(), body.elastic_size()));
}

/// Positions are those of the plane. Constraints of index 3 hold for positions: velocities (1.2e-5 of the largest) and
/// accelerations of a step differ from consistent ones by the order of the step.
TEST(StateInSpace, HasTheAccelerationsOfTheMotionInThePlane) {
  const ProblemFile problem =
      sample_problem("slider_crank", {"/simulation/end_time=20 ms", "/simulation/step=0.05 ms",
                                      "/scene/joints/bearing/drive/ramp=20 ms"});
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> design(x.begin(), x.end());
  const auto analysis = analyze(problem, x);
  const auto space = make_full_mechanism(problem, design, design);
  State state;
  analysis->trajectory.states->load(330, state);
  const std::optional<State> here = state_in_space(analysis->model, state, space->model);
  ASSERT_TRUE(here);
  EXPECT_GT(here->q.size(), state.q.size());
  for (std::size_t i = 0; i < space->model.bodies.size(); ++i) {
    const BodyModel &flat = analysis->model.bodies[i], &body = space->model.bodies[i];
    const FrameMotion<double> expected = motion_of(flat, state), found = motion_of(body, *here);
    EXPECT_LE((found.A - expected.A).norm(), 1e-12) << body.name;
    EXPECT_LE((found.r_dot - expected.r_dot).norm(), 1e-4 * expected.r_dot.norm()) << body.name;
    EXPECT_LE((found.r_ddot - expected.r_ddot).norm(), 1e-3 * expected.r_ddot.norm()) << body.name;
    if (body.elastic_size() == 0) continue;
    EXPECT_LE((deformation(body, here->q) - deformation(flat, state.q)).norm(),
              1e-9 * deformation(flat, state.q).norm())
        << body.name;
  }
}

/// Who leaves the stretch out in the plane has a member in space that no force presses.
TEST(StateInSpace, IsNoneWhereThePlaneLeavesTheStretchOut) {
  const ProblemFile problem =
      sample_problem("slider_crank", {"/simulation/end_time=2 ms", "/simulation/step=1 ms",
                                      "/effects={\"axial_elasticity\": \"off\"}"});
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> design(x.begin(), x.end());
  const auto analysis = analyze(problem, x);
  const auto space = make_full_mechanism(problem, design, design);
  State state;
  analysis->trajectory.states->load(1, state);
  EXPECT_FALSE(state_in_space(analysis->model, state, space->model));
}

}  // namespace
}  // namespace pleuel::test::reference_frame_test
