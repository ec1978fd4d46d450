#include "core/joints/joint_linearization.hpp"

#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/frame/marker_kinematics.hpp"
#include "core/frame/number_data.hpp"
#include "core/joints/joint_residual.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::joint_linearization_test {
namespace {

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

}  // namespace
}  // namespace pleuel::test::joint_linearization_test
