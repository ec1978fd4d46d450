#include "core/model/motion_plane.hpp"

#include <functional>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::motion_plane_test {
namespace {

ProblemFile shortened(const std::string& name, const std::string& spatial, double step) {
  ProblemFile problem =
      sample_problem(name, {"/simulation/end_time=0.06 s", "/scene/bodies/crank/elements=2",
                            "/scene/bodies/rod/elements=2", "/effects/spatial_motion=" + spatial});
  problem.simulation.step = step;
  problem.simulation.newton_tolerance = 1e-11;
  return problem;
}

/// Away from the tie of the start design.
Eigen::VectorXd uneven_design(const ProblemFile& problem) {
  Eigen::VectorXd x = start_design(problem);
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) *= 0.8 - 0.07 * double(i);
  return x;
}

class MotionPlane : public testing::TestWithParam<std::string> {};

/// Values and gradients (of relative changes) on top of each other, one row a response.
Eigen::MatrixXd linearised(const ProblemFile& problem, const Eigen::VectorXd& x) {
  const auto analysis = analyze(problem, x);
  const Eigen::MatrixXd gradients = direct_gradients(*analysis) * x.asDiagonal();
  Eigen::MatrixXd all(gradients.rows(), gradients.cols() + 1);
  all << values_of(*analysis), gradients;
  return all;
}

/// The same mechanism on more coordinates: rotations about one axis add their angles in space, too,
/// so that the two make the same steps. What is left is round-off.
TEST_P(MotionPlane, GivesWhatSpaceGives) {
  const ProblemFile planar = shortened(GetParam(), "auto", 1e-4);
  const Eigen::VectorXd x = uneven_design(planar);
  const Eigen::MatrixXd expected = linearised(planar, x);
  const Eigen::MatrixXd found = linearised(shortened(GetParam(), "on", 1e-4), x);
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    EXPECT_LE(relative_difference(found.row(i), expected.row(i)), 1e-9) << planar.responses[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, MotionPlane,
                         testing::Values("slider_crank", "slider_crank_round"), named_by_value());

/// A clamped beam without weight: nothing but its load says in which plane it moves.
TEST(PlaneOfACantilever, IsThatOfItsLoad) {
  Scene scene = swinging_beam(0.7, RectangleSection{0.03, 0.02}, 2);
  scene.gravity = {0.0, 0.0, 0.0};
  scene.joints.front().type = JointType::fixed;
  const auto plane_with = [&](const decltype(Load::element)& load) {
    scene.loads = {{"load", load}};
    return find_motion_plane(scene, {}).plane;
  };
  const Point tip{0.7, 0.0, 0.0};
  const double slope = std::sqrt(0.5);
  const auto of_force =
      plane_with(PointLoad{LoadKind::force, "beam", tip, {0.0, 1.0, 0.0}, {}, false});
  const auto of_torque =
      plane_with(PointLoad{LoadKind::torque, "beam", tip, {0.0, -1.0, 0.0}, {}, false});
  ASSERT_TRUE(of_force && of_torque);
  EXPECT_EQ(of_force->normal.cwiseAbs(), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(of_torque->normal.cwiseAbs(), Eigen::Vector3d::UnitY());
  EXPECT_FALSE(plane_with(PointLoad{LoadKind::force, "beam", tip, {0.0, slope, slope}, {}, false}));
}

/// What leads out of the plane is said, each of it; without it the pendulum moves in the plane.
struct OutOfPlane {
  const char* reason;
  std::function<void(Scene&)> change;
};
class RefusedPlane : public testing::TestWithParam<OutOfPlane> {};

Scene pendulum_in_a_plane() {
  Scene scene = swinging_beam(0.7, RectangleSection{0.03, 0.02}, 2);
  RigidBody mass{.at = {0.7, 0.0, 0.0}, .mass = 1.0, .inertia = {1.0, 2.0, 3.0, 0.1, 0.0, 0.0}};
  scene.bodies.push_back({"mass", mass});
  Joint joint;
  joint.name = "end";
  joint.type = JointType::fixed;
  joint.bodies = {"beam", "mass"};
  joint.at = {0.7, 0.0, 0.0};
  scene.joints.push_back(joint);
  return scene;
}

RigidBody& mass_of(Scene& scene) {
  return std::get<RigidBody>(scene.bodies.back().shape);
}

/// A second mass on a joint with this axis.
constexpr std::array<double, 3> along = {1.0, 0.0, 0.0}, across = {0.0, 0.0, 1.0},
                                tilted = {0.6, 0.0, 0.8};
Joint& add_joint(Scene& scene, JointType type, const std::array<double, 3>& axis) {
  scene.bodies.push_back(
      {"other", RigidBody{{0.7, 0.3, 0.0}, 1.0, {1.0, 2.0, 3.0, 0.1, 0.0, 0.0}}});
  Joint joint;
  joint.name = "more";
  joint.type = type;
  joint.bodies = {"mass", "other"};
  joint.at = {0.7, 0.0, 0.0};
  joint.to = {0.7, 0.3, 0.0};
  joint.axis = axis;
  joint.second_axis = {0.0, 1.0, 0.0};
  scene.joints.push_back(joint);
  return scene.joints.back();
}

TEST_P(RefusedPlane, IsRefusedForThatReason) {
  Scene scene = pendulum_in_a_plane();
  const Design<double> start = {0.0};
  ASSERT_TRUE(find_motion_plane(scene, start).plane);
  GetParam().change(scene);
  const PlaneAnalysis analysis = find_motion_plane(scene, start);
  EXPECT_FALSE(analysis.plane);
  EXPECT_EQ(analysis.reason, std::string(GetParam().reason) + " leaves the plane");
}

/// What stays in the plane is not refused: the same joints, drives and loads with other axes.
TEST(MotionPlaneOf, JointsWhoseAxesLieInItOrAcrossItIsKept) {
  const Design<double> start = {0.0};
  const auto is_planar = [&](JointType type, const std::array<double, 3>& axis,
                             const std::function<void(Scene&)>& change = {}) {
    Scene scene = pendulum_in_a_plane();
    add_joint(scene, type, axis);
    if (change) change(scene);
    return find_motion_plane(scene, start).plane.has_value();
  };
  EXPECT_TRUE(is_planar(JointType::revolute, across));
  EXPECT_TRUE(is_planar(JointType::prismatic, along));
  EXPECT_TRUE(is_planar(JointType::point_on_line, along));
  EXPECT_TRUE(is_planar(JointType::distance, tilted)) << "it has no axis";
  EXPECT_TRUE(is_planar(JointType::spherical, tilted));
  for (const JointType type : {JointType::cylindrical, JointType::planar, JointType::universal}) {
    EXPECT_TRUE(is_planar(type, along));
    EXPECT_TRUE(is_planar(type, across));
  }
  const auto driven = [](DrivenCoordinate coordinate) {
    return [coordinate](Scene& scene) {
      scene.joints.back().drive = Drive(ConstantFunction{0.1}, coordinate);
    };
  };
  EXPECT_TRUE(is_planar(JointType::cylindrical, along, driven(DrivenCoordinate::displacement)));
  EXPECT_TRUE(is_planar(JointType::cylindrical, across, driven(DrivenCoordinate::angle)));
}

INSTANTIATE_TEST_SUITE_P(
    Reasons, RefusedPlane,
    testing::Values(
        OutOfPlane{"gravity", [](Scene& scene) { scene.gravity[2] = 1e-3; }},
        // Zero now, but a design variable may make it something.
        OutOfPlane{"gravity", [](Scene& scene) { scene.gravity[2] = Number::bound(0); }},
        OutOfPlane{"body mass", [](Scene& scene) { mass_of(scene).at[2] = 1e-3; }},
        OutOfPlane{"body mass", [](Scene& scene) { mass_of(scene).at[2] = Number::bound(0); }},
        OutOfPlane{"a principal axis of inertia of body mass",
                   [](Scene& scene) { mass_of(scene).inertia[4] = 0.01; }},
        OutOfPlane{"a principal axis of inertia of body mass",
                   [](Scene& scene) { mass_of(scene).inertia[5] = 0.01; }},
        OutOfPlane{"a principal axis of the sections of body beam",
                   [](Scene& scene) {
                     std::get<BeamBody>(scene.bodies.front().shape).reference = {0.0, 1.0, 1.0};
                   }},
        OutOfPlane{"the velocity of body mass",
                   [](Scene& scene) { scene.bodies.back().velocity[2] = 1.0; }},
        OutOfPlane{"the velocity of body mass",
                   [](Scene& scene) { scene.bodies.back().velocity[2] = Number::bound(0); }},
        OutOfPlane{"the angular velocity of body mass",
                   [](Scene& scene) { scene.bodies.back().angular_velocity[0] = 1.0; }},
        OutOfPlane{
            "the angular velocity of body mass",
            [](Scene& scene) { scene.bodies.back().angular_velocity[1] = Number::bound(0); }},
        OutOfPlane{"joint end", [](Scene& scene) { scene.joints.back().at[2] = 1e-3; }},
        OutOfPlane{"joint end", [](Scene& scene) { scene.joints.back().at[2] = Number::bound(0); }},
        OutOfPlane{
            "body beam",
            [](Scene& scene) { std::get<BeamBody>(scene.bodies.front().shape).to[2] = 1e-3; }},
        OutOfPlane{"body beam",
                   [](Scene& scene) {
                     std::get<BeamBody>(scene.bodies.front().shape).to[2] = Number::bound(0);
                   }},
        // A principal axis, but of another direction.
        OutOfPlane{"a principal axis of inertia of body mass",
                   [](Scene& scene) { mass_of(scene).inertia = {1.0, 2.0, 3.0, 0.0, 0.1, 0.1}; }},
        OutOfPlane{"joint more",
                   [](Scene& scene) { add_joint(scene, JointType::revolute, tilted); }},
        OutOfPlane{"joint more",
                   [](Scene& scene) { add_joint(scene, JointType::revolute, along); }},
        OutOfPlane{"joint more",
                   [](Scene& scene) { add_joint(scene, JointType::prismatic, tilted); }},
        OutOfPlane{"joint more",
                   [](Scene& scene) { add_joint(scene, JointType::prismatic, across); }},
        OutOfPlane{"joint more",
                   [](Scene& scene) { add_joint(scene, JointType::point_on_line, tilted); }},
        OutOfPlane{"joint more",
                   [](Scene& scene) { add_joint(scene, JointType::cylindrical, tilted); }},
        OutOfPlane{"joint more", [](Scene& scene) { add_joint(scene, JointType::planar, tilted); }},
        OutOfPlane{"joint more",
                   [](Scene& scene) { add_joint(scene, JointType::universal, tilted); }},
        OutOfPlane{"joint more",
                   [](Scene& scene) {
                     add_joint(scene, JointType::universal, along).second_axis = {0.0, 0.6, 0.8};
                   }},
        OutOfPlane{"joint more",
                   [](Scene& scene) {
                     add_joint(scene, JointType::distance, along).to = {0.7, 0.3, 1e-3};
                   }},
        OutOfPlane{"the drive of joint more",
                   [](Scene& scene) {
                     add_joint(scene, JointType::cylindrical, along).drive =
                         Drive(ConstantFunction{0.1}, DrivenCoordinate::angle);
                   }},
        OutOfPlane{"the drive of joint more",
                   [](Scene& scene) {
                     add_joint(scene, JointType::cylindrical, across).drive =
                         Drive(ConstantFunction{0.1}, DrivenCoordinate::displacement);
                   }},
        OutOfPlane{"load spring",
                   [](Scene& scene) {
                     scene.loads = {
                         {"spring", SpringDamper{{"ground", "mass"},
                                                 {Point{0.0, 1.0, 0.1}, Point{0.7, 0.0, 0.0}},
                                                 10.0,
                                                 0.0,
                                                 {}}}};
                   }},
        OutOfPlane{"load spring",
                   [](Scene& scene) {
                     add_joint(scene, JointType::cylindrical, along);
                     scene.loads = {
                         {"spring",
                          JointForce{"more", DrivenCoordinate::angle, 2.0, 0.0, 0.0, {}}}};
                   }},
        OutOfPlane{"load spring",
                   [](Scene& scene) {
                     add_joint(scene, JointType::cylindrical, across);
                     scene.loads = {
                         {"spring",
                          JointForce{"more", DrivenCoordinate::displacement, 2.0, 0.0, 0.0, {}}}};
                   }},
        OutOfPlane{"load push",
                   [](Scene& scene) {
                     scene.loads = {
                         {"push",
                          PointLoad{
                              LoadKind::force, "mass", {0.7, 0.0, 0.0}, {0, 0, 1}, {}, false}}};
                   }},
        OutOfPlane{"load push",
                   [](Scene& scene) {
                     scene.loads = {
                         {"push",
                          PointLoad{
                              LoadKind::force, "mass", {0.7, 0.0, 0.1}, {0, 1, 0}, {}, false}}};
                   }},
        OutOfPlane{"load twist",
                   [](Scene& scene) {
                     scene.loads = {
                         {"twist",
                          PointLoad{
                              LoadKind::torque, "mass", {0.7, 0.0, 0.0}, {1, 0, 0}, {}, false}}};
                   }}),
    named_by(&OutOfPlane::reason));

/// A scene whose points are fixed, turned about z and shifted.
Scene moved_scene(Scene scene, double angle, const Eigen::Vector3d& shift) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto move = [&](Point& point) {
    const Eigen::Vector3d p(point[0].constant, point[1].constant, point[2].constant);
    const Eigen::Vector3d q = turn * p + shift;
    point = {q(0), q(1), q(2)};
  };
  for (Body& body : scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      move(beam->from);
      move(beam->to);
    } else {
      move(std::get<PointMass>(body.shape).at);
    }
  }
  for (Joint& joint : scene.joints) {
    move(joint.at);
    const Eigen::Vector3d axis =
        turn * Eigen::Vector3d(joint.axis[0], joint.axis[1], joint.axis[2]);
    joint.axis = {axis(0), axis(1), axis(2)};
  }
  return scene;
}

TEST(Frame, StressDeflectionAndTorqueDoNotDependOnWhereTheSceneStands) {
  ProblemFile problem = shortened("slider_crank", "auto", 2e-4);
  const Eigen::VectorXd x = uneven_design(problem);
  const Eigen::VectorXd expected = values_of(*analyze(problem, x));
  for (double angle : {0.7, 3.0, -2.2}) {
    ProblemFile moved = problem;
    moved.scene = moved_scene(problem.scene, angle, {0.3, -0.2, 0.15});
    const Eigen::VectorXd found = values_of(*analyze(moved, x));
    for (Eigen::Index i = 0; i < found.size(); ++i) {
      const auto& response = problem.responses[i];
      if (time_derivative_of(response) == TimeDerivative::none) continue;  // does depend on it
      EXPECT_NEAR(found(i), expected(i), 1e-8 * std::abs(expected(i)))
          << response.name << " at " << angle;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::motion_plane_test
