#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "core/scene/joint_kind.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::freedom_test {
namespace {

/// A rigid body held by one joint on the ground.
struct Freedom {
  JointType type;
  bool is_driven, is_point;
  int in_space, in_plane;  ///< degrees of freedom left
};

Scene scene_of(const Freedom& c) {
  Scene scene;
  Body body{"body", RigidBody{{0.3, 0.1, 0.0}, 1.0, {0.1, 0.2, 0.25, 0.0, 0.0, 0.0}}};
  if (c.is_point) body.shape = PointMass{{0.2, 0.1, 0.0}, 1.0};
  scene.bodies = {body};
  Joint joint;
  joint.name = "joint";
  joint.type = c.type;
  joint.bodies = {ground_name, "body"};
  joint.at = {0.2, 0.1, 0.0};
  const bool slides = c.type == JointType::prismatic || c.type == JointType::point_on_line;
  if (slides) joint.axis = {0.6, 0.8, 0.0};
  if (c.is_driven) joint.drive = ConstantSpeedDrive{2.0};
  scene.joints = {joint};
  // A second one about z, which tells the plane and takes no freedom: it holds another body.
  scene.bodies.push_back({"other", PointMass{{0.0, 0.0, 0.0}, 1.0}});
  Joint other;
  other.name = "other";
  other.bodies = {ground_name, "other"};
  other.at = {0.0, 0.0, 0.0};
  scene.joints.push_back(other);
  return scene;
}

/// Coordinates less the rank of Φ_q.
int freedom_of(const Scene& scene, EffectChoice spatial) {
  EffectSettings effects{.spatial_motion = spatial};
  Model model = build_model(scene, effects, {}, {});
  System& system = *model.mechanism.system;
  State state = model.mechanism.guess;
  System::Matrix matrix = system.make_matrix();
  system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
  const Eigen::MatrixXd jacobian =
      Eigen::MatrixXd(matrix).bottomLeftCorner(system.multipliers(), system.coordinates());
  const auto rank = rank_of(jacobian);
  EXPECT_EQ(rank, system.multipliers()) << "no equation says what another one says";
  return system.coordinates() - static_cast<int>(rank);
}

TEST(Joints, LeaveTheDegreesOfFreedomOfTheirKind) {
  for (const Freedom& c : {Freedom{JointType::revolute, false, false, 1, 1},
                           Freedom{JointType::revolute, true, false, 0, 0},
                           Freedom{JointType::prismatic, false, false, 1, 1},
                           Freedom{JointType::fixed, false, false, 0, 0},
                           Freedom{JointType::point_on_line, false, false, 4, 2},
                           Freedom{JointType::revolute, false, true, 0, 0},
                           Freedom{JointType::fixed, false, true, 0, 0},
                           Freedom{JointType::prismatic, false, true, 1, 1},
                           Freedom{JointType::point_on_line, false, true, 1, 1}}) {
    const Scene scene = scene_of(c);
    EXPECT_EQ(freedom_of(scene, EffectChoice::on), c.in_space) << static_cast<int>(c.type);
    EXPECT_EQ(freedom_of(scene, EffectChoice::off), c.in_plane) << static_cast<int>(c.type);
  }
}

// Two free bodies that start with some spin and one joint between them.

constexpr int all_in_space = 12, all_in_plane = 6;  // coordinates of two bodies

struct Pair {
  const char* name;
  JointType type;
  std::array<double, 3> axis;
  std::array<double, 3> second_axis;
  int equations;  ///< that the joint takes, without its drive
  std::optional<DrivenCoordinate> driven;
};

constexpr std::array<double, 3> point = {0.1, 0.06, 0.0}, far_point = {0.25, -0.04, 0.0};
constexpr auto angle = DrivenCoordinate::angle, displacement = DrivenCoordinate::displacement;

Point point_of(const std::array<double, 3>& p) {
  return {p[0], p[1], p[2]};
}

/// In a plane the bodies are symmetric about it and their velocities lie in it.
Scene scene_of(const Pair& pair, EffectChoice spatial) {
  const bool is_planar = spatial == EffectChoice::off;
  const double out = is_planar ? 0.0 : 1.0;
  Scene scene;
  scene.bodies = {
      {"first", RigidBody{{0.0, 0.0, 0.1 * out}, 1.0, {0.01, 0.02, 0.015, 0.003, 0.0, 0.0}}},
      {"second", RigidBody{{0.3, 0.1, -0.1 * out}, 0.7, {0.02, 0.01, 0.014, 0.001, 0.0, 0.0}}}};
  scene.bodies[0].velocity = {0.3, -0.2, 0.4 * out};
  scene.bodies[0].angular_velocity = {1.5 * out, -2.0 * out, 2.5};
  scene.bodies[1].velocity = {-0.4, 0.3, 0.2 * out};
  scene.bodies[1].angular_velocity = {-1.0 * out, 3.0 * out, -2.0};
  Joint joint;
  joint.name = "joint";
  joint.type = pair.type;
  joint.bodies = {"first", "second"};
  joint.at = point_of(point);
  joint.to = point_of(far_point);
  joint.axis = pair.axis;
  joint.second_axis = pair.second_axis;
  if (pair.driven) joint.drive = Drive(PolynomialFunction{{0.0, 0.3, 2.0}}, *pair.driven);
  scene.joints = {joint};
  return scene;
}

/// Where a moving body has brought what it carries, from its pose alone.
struct Carried {
  Eigen::Vector3d point, axis, second_axis;
  Eigen::Matrix3d turn;

  Carried(const BodyModel& body, const State& start, const State& now, const Pair& pair,
          const std::array<double, 3>& at) {
    const FrameMotion<double> before = motion(body, start), after = motion(body, now);
    turn = after.A * before.A.transpose();
    point = after.r + turn * (to_vector(at) - before.r);
    axis = turn * to_vector(pair.axis).normalized();
    second_axis = turn * to_vector(pair.second_axis).normalized();
  }
  static FrameMotion<double> motion(const BodyModel& body, const State& state) {
    const int first = body.frame.offset, size = body.frame.size();
    return frame_motion<double>(body.frame, state.q.segment(first, size),
                                state.v.segment(first, size), state.a.segment(first, size));
  }
};

/// How far two bodies are from what the name of their joint promises.
double violation(const Pair& pair, const Carried& first, const Carried& second, double change) {
  const Eigen::Vector3d distance = second.point - first.point;
  const double apart = distance.norm(), off_line = first.axis.cross(distance).norm();
  const double tilt = first.axis.cross(second.axis).norm();
  const double turned = (second.turn - first.turn).norm();
  const double length = (to_vector(far_point) - to_vector(point)).norm();
  switch (pair.type) {
    case JointType::revolute:
      return apart + tilt;
    case JointType::prismatic:
      return off_line + turned;
    case JointType::fixed:
      return apart + turned;
    case JointType::point_on_line:
      return off_line;
    case JointType::cylindrical:
      return off_line + tilt;
    case JointType::universal:
      return apart + std::abs(first.axis.dot(second.second_axis));
    case JointType::spherical:
      return apart;
    case JointType::planar:
      return std::abs(first.axis.dot(distance)) + tilt;
    case JointType::point_on_plane:
      return std::abs(first.axis.dot(distance));
    default:
      return std::abs(apart - length - change);
  }
}

/// The driven coordinate of the second body against the first. The angle is that of a direction of
/// the second body that is normal to the axis: the second axis of a universal joint.
double driven_coordinate(const Pair& pair, const Carried& first, const Carried& second) {
  if (*pair.driven == displacement) return first.axis.dot(second.point - first.point);
  const Eigen::Vector3d start = first.turn.transpose() * first.axis;
  const Eigen::Vector3d normal = pair.type == JointType::universal
                                     ? to_vector(pair.second_axis).normalized()
                                     : start.unitOrthogonal();
  const Eigen::Vector3d a = first.turn * normal, d = second.turn * normal;
  return std::atan2(first.axis.cross(a).dot(d), a.dot(d));
}

/// After 0.1 s in which the bodies turn by some 0.2 rad.
void check(const Pair& pair, EffectChoice spatial) {
  SCOPED_TRACE(std::string(pair.name) + (pair.driven ? ", driven" : "") +
               (spatial == EffectChoice::off ? ", in a plane" : ", in space"));
  EffectSettings effects{.spatial_motion = spatial};
  Model model = build_model(scene_of(pair, spatial), effects, {}, {});
  const Trajectory trajectory = simulate(model.mechanism, {0.1, 1e-3, 0.8});
  const State start = trajectory.state_at(0), end = trajectory.state_at(trajectory.steps());

  System& system = *model.mechanism.system;
  System::Matrix matrix = system.make_matrix();
  system.tangent(end, {.q = 1.0}, ConstraintLevel::position, matrix);
  const Eigen::MatrixXd jacobian =
      Eigen::MatrixXd(matrix).bottomLeftCorner(system.multipliers(), system.coordinates());
  const auto rank = system.multipliers() > 0 ? rank_of(jacobian) : 0;
  EXPECT_EQ(system.coordinates(), spatial == EffectChoice::off ? all_in_plane : all_in_space);
  EXPECT_EQ(rank, pair.equations + (pair.driven ? 1 : 0));
  EXPECT_EQ(rank, system.multipliers()) << "no equation says what another one says";

  const Carried first(model.bodies[0], start, end, pair, point);
  const Carried second(model.bodies[1], start, end, pair,
                       pair.type == JointType::distance ? far_point : point);
  const double time = trajectory.time(trajectory.steps());
  const double driven = pair.driven ? 0.3 * time + 2.0 * time * time : 0.0;
  EXPECT_LE(violation(pair, first, second, driven), 1e-8);
  if (pair.driven && pair.type != JointType::distance) {
    EXPECT_NEAR(driven_coordinate(pair, first, second), driven, 1e-8);
  }
  const Eigen::Matrix3d relative = first.turn.transpose() * second.turn;
  const double moved =
      (relative - Eigen::Matrix3d::Identity()).norm() + (second.point - first.point).norm();
  if (pair.type != JointType::fixed) {
    EXPECT_GE(moved, 1e-2) << "what is free moves";
  }
}

TEST(Joints, BetweenFreeBodiesInSpaceTakeTheirFreedomAndLeaveTheRest) {
  const std::array<double, 3> axis = {0.6, 0.48, 0.64}, second = {-0.8, 0.36, 0.48};
  for (const Pair& pair :
       {Pair{"revolute", JointType::revolute, axis, second, 5, {}},
        Pair{"revolute", JointType::revolute, axis, second, 5, angle},
        Pair{"prismatic", JointType::prismatic, axis, second, 5, {}},
        Pair{"prismatic", JointType::prismatic, axis, second, 5, displacement},
        Pair{"fixed", JointType::fixed, axis, second, 6, {}},
        Pair{"point on line", JointType::point_on_line, axis, second, 2, {}},
        Pair{"point on line", JointType::point_on_line, axis, second, 2, displacement},
        Pair{"cylindrical", JointType::cylindrical, axis, second, 4, {}},
        Pair{"cylindrical", JointType::cylindrical, axis, second, 4, angle},
        Pair{"cylindrical", JointType::cylindrical, axis, second, 4, displacement},
        Pair{"universal", JointType::universal, axis, second, 4, {}},
        Pair{"universal", JointType::universal, axis, second, 4, angle},
        Pair{"spherical", JointType::spherical, axis, second, 3, {}},
        Pair{"planar", JointType::planar, axis, second, 3, {}},
        Pair{"planar", JointType::planar, axis, second, 3, angle},
        Pair{"point on plane", JointType::point_on_plane, axis, second, 1, {}},
        Pair{"distance", JointType::distance, axis, second, 1, {}},
        Pair{"distance", JointType::distance, axis, second, 0, displacement}}) {
    check(pair, EffectChoice::on);
    if (pair.driven) continue;
    EXPECT_EQ(kind_of(pair.type).freedoms(), 6 - pair.equations) << pair.name;
  }
}

/// Axes in the plane leave or take what the plane has not taken already.
TEST(Joints, BetweenFreeBodiesInAPlaneTakeTheirFreedomAndLeaveTheRest) {
  const std::array<double, 3> normal = {0, 0, 1}, against = {0, 0, -1}, along = {0.6, 0.8, 0},
                              across = {-0.8, 0.6, 0};
  for (const Pair& pair :
       {Pair{"revolute", JointType::revolute, normal, along, 2, {}},
        Pair{"revolute against", JointType::revolute, against, along, 2, angle},
        Pair{"prismatic", JointType::prismatic, along, across, 2, {}},
        Pair{"prismatic", JointType::prismatic, along, across, 2, displacement},
        Pair{"fixed", JointType::fixed, along, across, 3, {}},
        Pair{"point on line", JointType::point_on_line, along, across, 1, {}},
        Pair{"point on line", JointType::point_on_line, along, across, 1, displacement},
        Pair{"cylindrical normal", JointType::cylindrical, normal, along, 2, {}},
        Pair{"cylindrical against", JointType::cylindrical, against, along, 2, angle},
        Pair{"cylindrical in plane", JointType::cylindrical, along, across, 2, {}},
        Pair{"cylindrical in plane", JointType::cylindrical, along, across, 2, displacement},
        Pair{"universal normal", JointType::universal, normal, along, 2, {}},
        Pair{"universal against", JointType::universal, against, along, 2, angle},
        Pair{"universal second normal", JointType::universal, along, normal, 2, {}},
        Pair{"universal in plane", JointType::universal, along, across, 3, {}},
        Pair{"spherical", JointType::spherical, normal, along, 2, {}},
        Pair{"planar normal", JointType::planar, normal, along, 0, {}},
        Pair{"planar against", JointType::planar, against, along, 0, angle},
        Pair{"planar in plane", JointType::planar, along, across, 2, {}},
        Pair{"point on plane normal", JointType::point_on_plane, normal, along, 0, {}},
        Pair{"point on plane in plane", JointType::point_on_plane, along, across, 1, {}},
        Pair{"distance", JointType::distance, normal, along, 1, {}},
        Pair{"distance", JointType::distance, normal, along, 0, displacement}}) {
    if (std::string(pair.name) == "universal in plane") {
      // Holds all that a plane has: nothing moves.
      Model model = build_model(scene_of(pair, EffectChoice::off), {}, {}, {});
      EXPECT_EQ(model.mechanism.system->multipliers(), 3);
      continue;
    }
    check(pair, EffectChoice::off);
  }
}

TEST(Joints, AreClosedAtTheStartOfASceneThatIsDrawnClosed) {
  for (const SampleScene& sample : all_samples()) {
    Model model = sample.build();
    Eigen::VectorXd residual;
    model.mechanism.system->residual(model.mechanism.guess, ConstraintLevel::position, residual);
    EXPECT_LE(residual.tail(model.mechanism.system->multipliers()).lpNorm<Eigen::Infinity>(), 1e-15)
        << sample.name;
  }
}

}  // namespace
}  // namespace pleuel::test::freedom_test
