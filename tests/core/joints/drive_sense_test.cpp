#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/frame/marker_kinematics.hpp"
#include "core/frame/number_data.hpp"
#include "core/integration/simulate.hpp"
#include "core/joints/joint_linearization.hpp"
#include "core/joints/joint_residual.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::drive_sense_test {
namespace {

/// A bar that is driven about `axis`, and a point mass on a revolute joint about +z that comes
/// first and decides which normal the plane gets.
Scene driven_bar(const std::array<double, 3>& axis) {
  Scene scene;
  scene.bodies = {{"mass", PointMass{{0.0, 0.0, 0.0}, 1.0}},
                  {"bar", RigidBody{{0.2, 0.0, 0.0}, 1.0, {0.1, 0.1, 0.1, 0.0, 0.0, 0.0}}}};
  Joint pin;
  pin.name = "pin";
  pin.bodies = {ground_name, "mass"};
  pin.at = {0.0, 0.0, 0.0};
  Joint hinge;
  hinge.name = "hinge";
  hinge.bodies = {ground_name, "bar"};
  hinge.at = {0.2, 0.0, 0.0};
  hinge.axis = axis;
  hinge.drive = RampToSpeedDrive{2.0, 0.1};
  scene.joints = {pin, hinge};
  return scene;
}

struct Outcome {
  double sine;    ///< of the angle of the bar, about +z
  double torque;  ///< of the drive
};

/// While the drive accelerates.
Outcome run(const std::array<double, 3>& axis, EffectChoice spatial) {
  EffectSettings effects{.spatial_motion = spatial};
  Model model = build_model(driven_bar(axis), effects, {}, {});
  const Trajectory trajectory =
      simulate(model.mechanism, {{.end_time = 0.05, .step = 1e-3, .spectral_radius = 0.8}});
  const BodyModel& bar = model.body("bar");
  const Eigen::VectorXd q =
      trajectory.columns().q().col(trajectory.steps()).segment(bar.frame.offset, bar.frame.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
  const FrameMotion<double> motion = frame_motion<double>(bar.frame, q, zero, zero);
  return {motion.A(1, 0),
          -trajectory.columns().lambda()(model.joint("hinge").drive_row, trajectory.steps())};
}

TEST(Drive, TurnsAboutTheAxisOfItsJointInThePlaneAsInSpace) {
  for (const auto& axis : {std::array{0.0, 0.0, 1.0}, std::array{0.0, 0.0, -1.0}}) {
    const Outcome plane = run(axis, EffectChoice::automatic), space = run(axis, EffectChoice::on);
    EXPECT_NEAR(plane.sine, space.sine, 1e-9);
    EXPECT_NEAR(plane.torque, space.torque, 1e-3 * std::abs(space.torque));
    EXPECT_GT(plane.sine * axis[2], 0.0);
    EXPECT_GT(plane.torque, 0.0) << "it accelerates in its own sense";
  }
}

/// Two rigid beams that start at 0.5 and 1.9 rad against x, free but for one joint between them,
/// and a point mass on a revolute joint about +z that comes first and decides the normal of the
/// plane.
Scene inclined_beams(JointType type, const std::array<double, 3>& axis) {
  const auto beam = [](double x, double angle) {
    BeamBody body;
    body.from = {x, 0.0, 0.0};
    body.to = {x + 0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.0};
    body.material = "steel";
    body.segments = {{RectangleSection{0.02, 0.02}, 1, {}}};
    body.is_rigid = true;
    return body;
  };
  Scene scene;
  scene.materials.push_back({"steel", 210e9, 0.3, 7850.0});
  scene.bodies = {{"mass", PointMass{{0.0, 0.0, 0.0}, 1.0}},
                  {"first", beam(0.0, 0.5)},
                  {"second", beam(0.1, 1.9)}};
  Joint pin;
  pin.name = "pin";
  pin.bodies = {ground_name, "mass"};
  pin.at = {0.0, 0.0, 0.0};
  Joint held = pin;
  held.name = "held";
  held.type = JointType::fixed;
  held.bodies = {ground_name, "first"};
  Joint joint;
  joint.name = "joint";
  joint.type = type;
  joint.bodies = {"first", "second"};
  joint.at = {0.1, 0.0, 0.0};
  joint.axis = axis;
  scene.joints = {pin, held, joint};
  return scene;
}

/// How far the second beam has turned about +z at the end.
double turn_of(const Scene& scene, EffectChoice spatial, double end_time) {
  EffectSettings effects{.spatial_motion = spatial};
  Model model = build_model(scene, effects, {}, {});
  EXPECT_EQ(model.body("second").frame.rotation == RotationCoordinates::angle,
            spatial == EffectChoice::automatic);
  const Trajectory trajectory =
      simulate(model.mechanism, {{.end_time = end_time, .step = 1e-3, .spectral_radius = 0.8}});
  State state = last_state(trajectory);
  const FrameMotion<double> motion = frame_of(model.body("second"), state);
  return std::remainder(std::atan2(motion.A(1, 0), motion.A(0, 0)) - 1.9, 2 * std::acos(-1.0));
}

/// The angle of a drive counts from the start, whatever angles the bodies start at.
TEST(Drive, AboutMinusZCountsFromTheStartOfInclinedBodies) {
  for (JointType type : {JointType::planar, JointType::revolute, JointType::cylindrical}) {
    for (double sense : {1.0, -1.0}) {
      Scene scene = inclined_beams(type, {0.0, 0.0, sense});
      scene.joints.back().drive = Drive(PolynomialFunction{{0.0, 0.0, 20.0}});
      for (EffectChoice spatial : {EffectChoice::automatic, EffectChoice::on}) {
        if (type == JointType::cylindrical && spatial == EffectChoice::on) continue;  // slides
        EXPECT_NEAR(turn_of(scene, spatial, 0.1), sense * 20.0 * 0.01, 1e-9);
      }
    }
  }
}

/// A spring of 2 N m/rad that rests at 0.25 rad about the axis, on a beam of moment of inertia
/// m (L² + h²)/12 about its middle; on a planar joint it is free there: φ'' = k s₀ / I at first.
TEST(JointSpring, AboutMinusZPullsInclinedBodiesToItsRest) {
  const double length = 0.3, depth = 0.02, mass = 7850.0 * depth * depth * length;
  const double inertia = mass * (length * length + depth * depth) / 12;
  for (double sense : {1.0, -1.0}) {
    Scene scene = inclined_beams(JointType::planar, {0.0, 0.0, sense});
    scene.loads = {{"spring", JointForce{"joint", DrivenCoordinate::angle, 2.0, 0.0, 0.25, {}}}};
    const double frequency = std::sqrt(2.0 / inertia), time = 0.02;
    const double expected = sense * 0.25 * (1 - std::cos(frequency * time));
    for (EffectChoice spatial : {EffectChoice::automatic, EffectChoice::on}) {
      // The scheme's error: (ω h)²/12 of the answer, ω = 15 rad/s.
      EXPECT_NEAR(turn_of(scene, spatial, time) / expected, 1.0, 1e-3);
    }
  }
}

/// A cylindrical joint has two freedoms: two joints on one axis drive one of them each.
TEST(Drive, OfBothFreedomsOfACylindricalJointMakesAScrew) {
  Scene scene = inclined_beams(JointType::cylindrical, {0.0, 0.0, -1.0});
  scene.joints.back().drive = Drive(PolynomialFunction{{0.0, 0.0, 20.0}}, DrivenCoordinate::angle);
  Joint slide = scene.joints.back();
  slide.name = "slide";
  slide.drive = Drive(PolynomialFunction{{0.0, 0.0, 5.0}}, DrivenCoordinate::displacement);
  scene.joints.push_back(slide);
  Model model = build_model(scene, {}, {}, {});
  const Trajectory trajectory =
      simulate(model.mechanism, {{.end_time = 0.1, .step = 1e-3, .spectral_radius = 0.8}});
  State state = last_state(trajectory);
  const FrameMotion<double> motion = frame_of(model.body("second"), state);
  const double angle = 1.9 - 20.0 * 0.01;
  EXPECT_NEAR(motion.A(0, 0), std::cos(angle), 1e-9);
  EXPECT_NEAR(motion.A(1, 0), std::sin(angle), 1e-9);
  EXPECT_LE((motion.r - Eigen::Vector3d(0.1, 0.0, -5.0 * 0.01)).norm(), 1e-9);
}

constexpr int max_size = JointLinearization::max_size;
using Wide = DualOf<max_size>;

/// On a body in space, at a place that has all elastic coordinates.
Marker spatial_marker() {
  Marker marker;
  marker.frame.rotation = RotationCoordinates::rotation_vector;
  marker.elastic = {6, 7, 8, 9, 10, 11};
  return marker;
}

/// On a body that moves in a plane, at a place that has the elastic coordinates of this motion.
Marker planar_marker() {
  Marker marker;
  BodyFrame& frame = marker.frame;
  frame.rotation = RotationCoordinates::angle;
  frame.axis = Eigen::Vector3d(0.6, 0.0, 0.8);
  frame.reference << Eigen::Vector3d(0.0, 1.0, 0.0), Eigen::Vector3d(-0.8, 0.0, 0.6), frame.axis;
  frame.basis = frame.reference.leftCols<2>();
  marker.elastic = {3, 4, -1, -1, -1, 5};
  return marker;
}

/// Between two bodies that move in space; in a plane if the equation is for that only.
JointTopology topology_with(const JointEquation& equation) {
  const bool is_planar = equation.kind == EquationKind::planar_angle;
  JointTopology topology;
  topology.markers[0] = is_planar ? planar_marker() : spatial_marker();
  topology.markers[1] = topology.markers[0];
  topology.equations = {equation};
  topology.is_driven = true;
  return topology;
}

JointData<double> data() {
  JointData<double> data;
  data.points = {Eigen::Vector3d(0.3, -0.2, 0.5), Eigen::Vector3d(-0.7, 0.1, 0.4)};
  data.directions = {Eigen::Vector3d(0.8, 0.6, 0.0), Eigen::Vector3d(-0.48, 0.64, 0.6),
                     Eigen::Vector3d(0.36, -0.48, 0.8)};
  data.offset = 0.4;
  data.length = 0.9;
  data.drive = {TimeLaw<double>::Kind::harmonic, {0.3, 5.0, 0.4, 0.2}, {}};
  return data;
}

JointEquation equation_of(EquationKind kind) {
  JointEquation equation{kind};
  equation.fixed = Eigen::Vector3d(0.6, 0.0, 0.8);
  equation.first = 0;
  equation.second = 1;
  equation.third = 2;
  equation.sense = -1.0;
  equation.is_driven = true;
  return equation;
}

/// Lengths, rotations of frames and elastic rotations of up to one.
std::array<double, max_size> random_coordinates() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::array<double, max_size> q{};
  for (double& entry : q) entry = uniform(random);
  return q;
}

class JointEquations : public testing::TestWithParam<EquationTraits> {
 protected:
  JointLinearization linearization_at(double time) const {
    return JointLinearization(topology_, data_, time, q_.data(), size_);
  }

  static constexpr double time_ = 0.13;
  JointEquation equation_ = equation_of(GetParam().kind);
  JointTopology topology_ = topology_with(equation_);
  JointData<double> data_ = data();
  std::array<double, max_size> q_ = random_coordinates();
  int size_ = int_size(local_coordinates(topology_.markers));
};

/// Value and gradient are those of the template, and gradient and Hessian its derivatives in dual
/// numbers. Rounding of sums of some ten products of order one.
TEST_P(JointEquations, ByHandAreThoseOfTheTemplate) {
  constexpr double weight = -1.7;
  JointLinearization joint = linearization_at(time_);
  joint.evaluate(equation_, weight);
  std::array<Wide, max_size> q, rest;
  for (int i = 0; i < max_size; ++i) {
    q[i] = Wide(q_[i]);
    q[i].derivatives()[i] = 1.0;
    rest[i] = Wide(0.0);
  }
  const JointData<Wide> wide_data = cast_data<Wide>(data_);
  JointEvaluation<Wide> evaluation(topology_, wide_data, time_, q.data(), rest.data(), rest.data());
  const Wide one(1.0);
  Wide value;
  evaluation.evaluate(ConstraintLevel::position, &one, &value);
  EXPECT_NEAR(value.value(), joint.value(), 1e-14);
  const Eigen::VectorXd gradient = value.derivatives().head(size_);
  EXPECT_LE((gradient - joint.gradient()).lpNorm<Eigen::Infinity>(), 1e-13);
  for (int i = 0; i < size_; ++i) {
    const Wide& force = evaluation.forces()[i];
    EXPECT_NEAR(force.value(), joint.gradient()(i), 1e-13) << i;
    const Eigen::VectorXd row = joint.hessian().row(i), slope = force.derivatives().head(size_);
    EXPECT_LE((weight * slope - row).lpNorm<Eigen::Infinity>(), 2e-13) << i;
  }
}

TEST_P(JointEquations, HaveTheRatesOfTheirGradientAndValue) {
  JointLinearization joint = linearization_at(time_);
  joint.evaluate(equation_, 1.0);
  const Eigen::VectorXd expected = derivative_at_zero(
      [&](double t) {
        JointLinearization later = linearization_at(time_ + t);
        later.evaluate(equation_, 1.0);
        Eigen::VectorXd all(joint.gradient().size() + 1);
        all << later.gradient(), later.value();
        return all;
      },
      1e-3);
  // (1e-3)⁴ of fifth derivatives of some 5⁵ · 0.3.
  const Eigen::Index n = expected.size() - 1;
  EXPECT_LE((joint.gradient_rate() - expected.head(n)).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_NEAR(joint.rate(), expected(n), 1e-9);
}

/// Whatever the order, and whether points or directions were asked for before.
TEST_P(JointEquations, AddTheirHessiansToTheSum) {
  const JointEquation other = equation_of(EquationKind::coincident);
  JointLinearization first = linearization_at(time_), second = first, both = first;
  first.evaluate(equation_, 2.0);
  second.evaluate(other, -3.0);
  both.evaluate(other, -3.0);
  both.evaluate(equation_, 2.0);
  const Eigen::MatrixXd expected = first.hessian() + second.hessian();
  EXPECT_LE((both.hessian() - expected).lpNorm<Eigen::Infinity>(), 1e-13);
  both.clear_hessian();
  EXPECT_TRUE(both.hessian().isZero(0.0));
}

INSTANTIATE_TEST_SUITE_P(Kinds, JointEquations, testing::ValuesIn(equation_kinds),
                         named_by(&EquationTraits::word));

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// From nothing to beyond all elasticity, and both sides of where the series end.
const double angles[] = {0.0, 1e-9, 1e-3, 0.12, 0.5, 0.999999, 1.000001, 2.0, 3.1};
const Vector3d axis(0.48, -0.6, 0.64), s(0.3, 0.8, -0.52), rate(-0.7, 0.4, 1.1),
    acceleration(0.9, 1.3, -0.4), moment(1.2, -0.3, 0.8);

TEST(ElasticRotation, TurnsDirectionsByTheAngleOfItsVectorAboutItsVector) {
  for (double angle : angles) {
    const ElasticRotation<double> rotation(angle * axis);
    const Vector3d expected = Eigen::AngleAxisd(angle, axis) * s;
    EXPECT_LE((rotation.turned(s) - expected).norm(), 1e-15) << angle;  // round-off
  }
}

/// Differences of the fourth order with steps of 1e-3: 1e-12 of fifth derivatives of a few units.
TEST(ElasticRotation, SpinsAsItsDirectionsMove) {
  for (double angle : angles) {
    const auto at = [&](double t) {
      return ElasticRotation<double>(angle * axis + t * rate + 0.5 * t * t * acceleration);
    };
    const Vector3d velocity =
        derivative_at_zero([&](double t) -> Vector3d { return at(t).turned(s); }, 1e-3);
    const Vector3d spin = at(0).spin(rate);
    EXPECT_LE((velocity - spin.cross(at(0).turned(s))).norm(), 1e-11) << angle;
    const Vector3d growth = derivative_at_zero(
        [&](double t) -> Vector3d { return at(t).spin(rate + t * acceleration); }, 1e-3);
    EXPECT_LE((growth - at(0).spin_rate(rate, acceleration)).norm(), 1e-11) << angle;
  }
}

TEST(ElasticRotation, GivesAMomentItsWorkOnTheTrueRotation) {
  for (double angle : angles) {
    const ElasticRotation<double> rotation(angle * axis);
    EXPECT_NEAR(rotation.generalized(moment).dot(rate), moment.dot(rotation.spin(rate)), 1e-15);
    EXPECT_LE((rotation.tangent() * rate - rotation.spin(rate)).norm(), 1e-15);
  }
}

TEST(ElasticRotation, HasTheCurvatureOfItsTurnedDirections) {
  for (double angle : angles) {
    const Vector3d psi = angle * axis;
    const ElasticRotation<double> rotation(psi);
    const Matrix3d found = rotation.curvature(rotation.tangent(), rotation.turned(s), moment);
    for (int j = 0; j < 3; ++j) {
      const Vector3d expected = derivative_at_zero(
          [&](double t) -> Vector3d {
            const ElasticRotation<double> moved(psi + t * Vector3d::Unit(j));
            return moved.generalized(moved.turned(s).cross(moment));
          },
          1e-3);
      EXPECT_LE((found.col(j) - expected).norm(), 1e-11) << angle;
    }
    EXPECT_LE((found - found.transpose()).norm(), 1e-15) << angle;
  }
}

/// In a plane angles add: nothing else turns, to round-off.
TEST(ElasticRotation, AboutOneAxisSpinsWithTheRateOfItsAngle) {
  for (double angle : angles) {
    const ElasticRotation<double> rotation(angle * axis);
    EXPECT_LE((rotation.spin(2.0 * axis) - 2.0 * axis).norm(), 1e-15);
    EXPECT_LE((rotation.spin_rate(2.0 * axis, -3.0 * axis) + 3.0 * axis).norm(), 1e-14);
    EXPECT_LE((rotation.generalized(2.0 * axis) - 2.0 * axis).norm(), 1e-15);
  }
}

/// Derivatives of the template against those by hand.
TEST(ElasticRotation, CarriesDualNumbers) {
  for (double angle : angles) {
    Vector3<Dual> psi;
    for (int i = 0; i < 3; ++i) {
      psi(i) = Dual(angle * axis(i), Dual::Derivatives::Constant(rate(i)));
    }
    const Vector3<Dual> turned = ElasticRotation<Dual>(psi).turned(s.cast<Dual>());
    const ElasticRotation<double> rotation(angle * axis);
    const Vector3d expected = rotation.spin(rate).cross(rotation.turned(s));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(derivative_of(turned(i)), expected(i), 1e-14) << angle;
  }
}

}  // namespace
}  // namespace pleuel::test::drive_sense_test
