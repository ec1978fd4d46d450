#include "core/joints/joint_linearization.hpp"

#include <random>

#include <gtest/gtest.h>

#include "core/frame/number_data.hpp"
#include "core/joints/joint_residual.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::joint_linearization_test {
namespace {

constexpr int size = JointLinearization::max_size;
using Wide = DualOf<size>;

/// Between two bodies in space whose places have all elastic coordinates.
JointTopology topology_with(const JointEquation& equation) {
  JointTopology topology;
  for (int m = 0; m < 2; ++m) {
    Marker& marker = topology.markers[m];
    marker.frame.offset = 12 * m;
    marker.frame.rotation = RotationCoordinates::rotation_vector;
    for (int i = 0; i < 6; ++i) marker.elastic[i] = 12 * m + 6 + i;
  }
  topology.equations = {equation};
  topology.is_driven = true;
  topology.multiplier = size;
  return topology;
}

JointData<double> data() {
  JointData<double> data;
  data.points = {Eigen::Vector3d(0.3, -0.2, 0.5), Eigen::Vector3d(-0.7, 0.1, 0.4)};
  data.directions = {Eigen::Vector3d(0.8, 0.6, 0.0), Eigen::Vector3d(-0.48, 0.64, 0.6),
                     Eigen::Vector3d(0.36, -0.48, 0.8)};
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
  return equation;
}

/// Lengths, rotations of frames and elastic rotations of up to one.
std::array<double, size> random_coordinates() {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::array<double, size> q{};
  for (double& entry : q) entry = uniform(random);
  return q;
}

class JointEquations : public testing::TestWithParam<EquationKind> {
 protected:
  static constexpr double time_ = 0.13;
  JointEquation equation_ = equation_of(GetParam());
  JointTopology topology_ = topology_with(equation_);
  JointData<double> data_ = data();
  std::array<double, size> q_ = random_coordinates();
};

/// Value and gradient are those of the template, and gradient and Hessian its derivatives in dual
/// numbers. Rounding of sums of some ten products of order one.
TEST_P(JointEquations, ByHandAreThoseOfTheTemplate) {
  constexpr double weight = -1.7;
  JointLinearization joint(topology_, data_, time_, q_.data(), size);
  joint.evaluate(equation_, weight);
  std::array<Wide, size> q, rest;
  for (std::size_t i = 0; i < size; ++i) {
    q[i] = Wide(q_[i]);
    q[i].derivatives()[static_cast<int>(i)] = 1.0;
    rest[i] = Wide(0.0);
  }
  const JointData<Wide> wide_data = cast_data<Wide>(data_);
  JointEvaluation<Wide> evaluation(topology_, wide_data, time_, q.data(), rest.data(), rest.data());
  const Wide one(1.0);
  Wide value;
  evaluation.evaluate(ConstraintLevel::position, &one, &value);
  EXPECT_NEAR(value.value(), joint.value(), 1e-14);
  EXPECT_LE((value.derivatives() - joint.gradient()).lpNorm<Eigen::Infinity>(), 1e-13);
  for (int i = 0; i < size; ++i) {
    const Wide& force = evaluation.forces()[i];
    EXPECT_NEAR(force.value(), joint.gradient()(i), 1e-13) << i;
    const Eigen::VectorXd row = joint.hessian().row(i);
    EXPECT_LE((weight * force.derivatives() - row).lpNorm<Eigen::Infinity>(), 2e-13) << i;
  }
}

TEST_P(JointEquations, HaveTheRatesOfTheirGradientAndValue) {
  JointLinearization joint(topology_, data_, time_, q_.data(), size);
  joint.evaluate(equation_, 1.0);
  const Eigen::VectorXd expected = derivative_at_zero(
      [&](double t) {
        JointLinearization later(topology_, data_, time_ + t, q_.data(), size);
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
  JointLinearization first(topology_, data_, time_, q_.data(), size), second = first, both = first;
  first.evaluate(equation_, 2.0);
  second.evaluate(other, -3.0);
  both.evaluate(other, -3.0);
  both.evaluate(equation_, 2.0);
  const Eigen::MatrixXd expected = first.hessian() + second.hessian();
  EXPECT_LE((both.hessian() - expected).lpNorm<Eigen::Infinity>(), 1e-13);
  both.clear_hessian();
  EXPECT_TRUE(both.hessian().isZero(0.0));
}

INSTANTIATE_TEST_SUITE_P(Kinds, JointEquations,
                         testing::Values(EquationKind::coincident, EquationKind::on_plane,
                                         EquationKind::perpendicular, EquationKind::drive,
                                         EquationKind::slide, EquationKind::distance),
                         named_by([](EquationKind kind) {
                           switch (kind) {
                             case EquationKind::coincident:
                               return "coincident";
                             case EquationKind::on_plane:
                               return "on_plane";
                             case EquationKind::perpendicular:
                               return "perpendicular";
                             case EquationKind::drive:
                               return "drive";
                             case EquationKind::slide:
                               return "slide";
                             default:
                               return "distance";
                           }
                         }));

}  // namespace
}  // namespace pleuel::test::joint_linearization_test
