#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "tests/support/places.hpp"
#include "tests/support/sample_name.hpp"
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
  void move_load(PointForce& load) const {
    load.at = moved(load.at);
    load.direction = rotated(load.direction);
  }
  void move_load(PointTorque& load) const {
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
  State state;
  trajectory.states->load(trajectory.steps(), state);
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

}  // namespace
}  // namespace pleuel::test::invariance_test
