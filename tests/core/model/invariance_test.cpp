#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "core/model/state_in_space.hpp"
#include "core/response/analysis.hpp"
#include "core/response/full_mechanism.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::invariance_test {
namespace {

/// A sample with all numbers fixed, turned and shifted as a whole.
class MovedScene {
 public:
  MovedScene(const SampleScene& sample, const Eigen::Matrix3d& turn, const Eigen::Vector3d& shift)
      : design_(sample.design), turn_(turn), shift_(shift), scene_(sample.scene) {
    scene_.gravity = rotated(scene_.gravity);
    for (Body& body : scene_.bodies) move_body(body);
    for (Joint& joint : scene_.joints) {
      joint.at = moved(joint.at);
      joint.to = moved(joint.to);
      joint.axis = rotated(joint.axis);
      joint.second_axis = rotated(joint.second_axis);
    }
    for (Load& load : scene_.loads) {
      std::visit([this](auto& element) { move_load(element); }, load.element);
    }
  }
  const Scene& scene() const { return scene_; }

 private:
  template <class Array>
  Array rotated(const Array& vector) const {
    const Eigen::Vector3d v = turn_ * plain(vector);
    return {v(0), v(1), v(2)};
  }
  Eigen::Vector3d plain(const std::array<Number, 3>& numbers) const {
    return resolve_point(numbers, design_);
  }
  static Eigen::Vector3d plain(const std::array<double, 3>& numbers) { return to_vector(numbers); }
  Point moved(const Point& point) const {
    const Eigen::Vector3d p = turn_ * plain(point) + shift_;
    return {p(0), p(1), p(2)};
  }

  void move_body(Body& body) const {
    body.velocity = rotated(body.velocity);
    body.angular_velocity = rotated(body.angular_velocity);
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      // The default of local y knows the global axes.
      const Eigen::Vector3d y = turn_ * beam_pose(*beam, design_).rotation.col(1);
      beam->reference = {y(0), y(1), y(2)};
      beam->from = moved(beam->from);
      beam->to = moved(beam->to);
    } else if (auto* rigid = std::get_if<RigidBody>(&body.shape)) {
      rigid->at = moved(rigid->at);
      std::array<double, 6> i;
      for (std::size_t k = 0; k < 6; ++k) i[k] = resolve(rigid->inertia[k], design_);
      Eigen::Matrix3d inertia;
      inertia << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
      inertia = (turn_ * inertia * turn_.transpose()).eval();
      rigid->inertia = {inertia(0, 0), inertia(1, 1), inertia(2, 2),
                        inertia(0, 1), inertia(0, 2), inertia(1, 2)};
    } else {
      auto& point = std::get<PointMass>(body.shape);
      point.at = moved(point.at);
    }
  }
  void move_load(PointLoad& load) const {
    load.at = moved(load.at);
    load.direction = rotated(load.direction);
  }
  void move_load(SpringDamper& load) const {
    for (Point& point : load.at) point = moved(point);
  }
  void move_load(JointForce&) const {}

  const Design<double>& design_;
  Eigen::Matrix3d turn_;
  Eigen::Vector3d shift_;
  Scene scene_;
};

/// Both ends of every body, and the displacements of its nodes in its own axes, at the end.
struct End {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::VectorXd> displacements;
};

End end_of(const SampleScene& sample, const Scene& scene) {
  Model model = build_model(scene, sample.effects, sample.design, sample.design);
  SimulationOptions options{0.03, 1e-3, 0.8};
  options.newton_tolerance = 1e-13;
  const Trajectory trajectory = simulate(model.mechanism, options);
  State state = last_state(trajectory);
  End end;
  for (const BodyModel& body : model.bodies) {
    for (double at : {0.0, 1.0}) end.points.push_back(position_of(body, state, at));
    end.displacements.push_back(body.is_beam() ? stacked_displacements(body, state)
                                               : Eigen::VectorXd());
  }
  return end;
}

class Mechanisms : public testing::TestWithParam<int> {};

/// Turned by a general rotation: a planar mechanism then moves in a tilted plane. Only round-off
/// differs; of positions [m] against the half metre of the samples, of displacements against the
/// largest of the mechanism.
TEST_P(Mechanisms, MoveAlikeWhereverTheyStandInSpace) {
  const SampleScene sample = all_samples()[GetParam()];
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.48, -0.6, 0.64)).toRotationMatrix();
  const Eigen::Vector3d shift(0.3, -0.2, 0.45);
  const End here = end_of(sample, sample.scene);
  const End there = end_of(sample, MovedScene(sample, turn, shift).scene());
  double largest = 0.0;
  for (const auto& d : here.displacements) {
    if (d.size() > 0) largest = std::max(largest, d.lpNorm<Eigen::Infinity>());
  }
  for (std::size_t i = 0; i < here.points.size(); ++i) {
    EXPECT_LE((there.points[i] - turn * here.points[i] - shift).norm(), 1e-9 * 0.5)
        << sample.scene.bodies[i / 2].name;
  }
  for (std::size_t i = 0; i < here.displacements.size(); ++i) {
    if (here.displacements[i].size() == 0) continue;
    EXPECT_LE((there.displacements[i] - here.displacements[i]).lpNorm<Eigen::Infinity>(),
              1e-9 * largest)
        << sample.scene.bodies[i].name;
  }
}

/// … and are told to.
TEST(Mechanisms, InATiltedPlaneAreKnownToStayThere) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.48, -0.6, 0.64)).toRotationMatrix();
  for (const SampleScene& sample : {planar_sample(), planar_joints_sample(), reduced_sample()}) {
    for (const Eigen::Matrix3d& turned : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turn}) {
      const MovedScene moved(sample, turned, {0.1, 0.2, 0.3});
      const PlaneAnalysis analysis = find_motion_plane(moved.scene(), sample.design);
      ASSERT_TRUE(analysis.plane) << sample.name << ": " << analysis.reason;
      EXPECT_NEAR(std::abs(analysis.plane->normal.dot(turned.col(2))), 1.0, 1e-12);
    }
  }
  for (const SampleScene& sample : {spatial_sample(), spatial_joints_sample()}) {
    EXPECT_FALSE(find_motion_plane(sample.scene, sample.design).plane) << sample.name;
  }
}

/// A planar mechanism on the coordinates of space makes the same motion: rotations about one axis
/// add their angles there, too, and a number of modes has the same modes in the plane.
TEST(Mechanisms, OfAPlaneMoveInSpaceAsInThePlane) {
  for (SampleScene sample : {planar_sample(), planar_joints_sample(), reduced_sample()}) {
    const End plane = end_of(sample, sample.scene);
    sample.effects.spatial_motion = EffectChoice::on;
    const End space = end_of(sample, sample.scene);
    for (std::size_t i = 0; i < plane.points.size(); ++i) {
      EXPECT_LE((space.points[i] - plane.points[i]).norm(), 1e-9 * 0.5)
          << sample.name << ", " << sample.scene.bodies[i / 2].name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, Mechanisms, testing::Range(0, sample_count), sample_name);

/// Torques about an axis in the plane, and forces along its normal, are no matter of a plane.
TEST(MotionPlane, IsLeftByAJointForceAcrossIt) {
  SampleScene sample = planar_joints_sample();
  const auto plane_with = [&](const std::string& joint, DrivenCoordinate coordinate) {
    Scene scene = sample.scene;
    JointForce force{joint, coordinate, 0.0, 0.0, 0.0, {}};
    force.motor = ConstantFunction{1.0};
    scene.loads.push_back({"across", force});
    return find_motion_plane(scene, sample.design);
  };
  EXPECT_TRUE(plane_with("hub", DrivenCoordinate::angle).plane);
  EXPECT_TRUE(plane_with("ram guide", DrivenCoordinate::displacement).plane);
  EXPECT_FALSE(plane_with("hub", DrivenCoordinate::displacement).plane);
  const PlaneAnalysis analysis = plane_with("ram guide", DrivenCoordinate::angle);
  EXPECT_FALSE(analysis.plane);
  EXPECT_EQ(analysis.reason, "load across leaves the plane");
}

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
  PointLoad push{LoadKind::force, "rod", {0.21, 0.04, 0.0}, {0.0, -1.0, 0.0}, {}, false};
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
  for (int step = 0; step <= trajectory.steps(); ++step) {
    const State state = trajectory.state_at(step);
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
  const auto space = make_full_mechanism(problem, design, design, InvariantDifferentiation());
  State state = state_of(analysis->trajectory, 330);
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
  const auto space = make_full_mechanism(problem, design, design, InvariantDifferentiation());
  State state = state_of(analysis->trajectory, 1);
  EXPECT_FALSE(state_in_space(analysis->model, state, space->model));
}

}  // namespace
}  // namespace pleuel::test::invariance_test
