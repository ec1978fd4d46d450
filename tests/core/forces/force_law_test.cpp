#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/effects/floating_frame_body.hpp"
#include "core/forces/joint_force.hpp"
#include "core/forces/point_load.hpp"
#include "core/forces/spring_damper.hpp"
#include "core/system/system.hpp"
#include "tests/core/forces/force_samples.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::force_law_test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr auto position_level = ConstraintLevel::position;

TimeLaw<double> constant(double value) {
  return {TimeLaw<double>::Kind::polynomial, {value}, {}};
}

class EveryInternalForce : public testing::TestWithParam<ForceSample> {
 protected:
  ForceSample sample_ = GetParam();
  State state_ = sample_.random_state();

  /// ds/dε along q ⊕ ε · direction. Differences as in the derivative test: 1e-10.
  double slope(const VectorXd& direction) const {
    return derivative_at_zero(
        [&](double s) { return sample_.coordinate(sample_.advanced(state_.q, s * direction)); },
        1e-3);
  }
};

/// R = ∂(½ k (s − s₀)²)/∂q.
TEST_P(EveryInternalForce, HasASpringWithAPotential) {
  const double stretch = sample_.coordinate(state_.q) - sample_.rest;
  const VectorXd found = residual_of(*sample_.make_spring(), state_, position_level);
  for (Eigen::Index i = 0; i < state_.q.size(); ++i) {
    const double expected = sample_.stiffness * stretch * slope(VectorXd::Unit(state_.q.size(), i));
    EXPECT_NEAR(found(i), expected, 1e-9 * std::max(found.lpNorm<Eigen::Infinity>(), 1.0)) << i;
  }
}

/// R · v = c ṡ²; ω is the rate of right perturbations.
TEST_P(EveryInternalForce, HasADamperThatTakesEnergyByTheSquareOfTheRate) {
  const double rate = slope(state_.v);
  const VectorXd found = residual_of(*sample_.make_damper(), state_, position_level);
  const double expected = sample_.damping * rate * rate;
  EXPECT_NEAR(found.dot(state_.v), expected, 1e-9 * std::max(expected, 1.0));
}

class EveryInternalForceInSpace : public EveryInternalForce {};

/// Sums over the frames: forces are the translation rows, moments about the origin of space
/// r × F + A T with the rotation rows T (body axes).
TEST_P(EveryInternalForceInSpace, HasNeitherTotalForceNorTotalMoment) {
  const VectorXd residual = residual_of(*sample_.make(), state_, position_level);
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
  for (const Marker& marker : sample_.mount.markers) {
    const int first = marker.frame.offset;
    const Vector3d r = state_.q.segment<3>(first), F = residual.segment<3>(first);
    force += F;
    moment += r.cross(F) + rotation_of(state_.q.segment<3>(first + 3)) *
                               Vector3d(residual.segment<3>(first + 3));
  }
  EXPECT_GT(residual.norm(), 0.1);
  EXPECT_LE(force.norm(), 1e-14 * residual.norm());  // round-off
  EXPECT_LE(moment.norm(), 1e-14 * residual.norm());
}

/// Turning everything turns forces, and leaves moments and elastic forces, which are in body axes.
TEST_P(EveryInternalForceInSpace, IsTheSameInATurnedSpace) {
  const auto term = sample_.make();
  const VectorXd before = residual_of(*term, state_, position_level);
  const Eigen::Matrix3d turn = rotation_of(Vector3d(0.4, -1.1, 0.7));
  State turned = state_;
  VectorXd expected = before;
  for (const Marker& marker : sample_.mount.markers) {
    const int first = marker.frame.offset;
    turned.q.segment<3>(first) = turn * state_.q.segment<3>(first);
    turned.v.segment<3>(first) = turn * state_.v.segment<3>(first);
    turned.q.segment<3>(first + 3) =
        rotation_vector(turn * rotation_of(state_.q.segment<3>(first + 3)));
    expected.segment<3>(first) = turn * before.segment<3>(first);
  }
  EXPECT_LE(relative_difference(residual_of(*term, turned, position_level), expected), 1e-13);
}

const auto name_of = [](const auto& test) { return test.param.name; };
INSTANTIATE_TEST_SUITE_P(Forces, EveryInternalForce,
                         testing::ValuesIn(force_samples(ForceChoice::internal)), name_of);
INSTANTIATE_TEST_SUITE_P(Forces, EveryInternalForceInSpace,
                         testing::ValuesIn(force_samples(ForceChoice::internal_spatial)), name_of);

/// A body in space with all elastic coordinates of a marker.
class PointLoad : public testing::Test {
 protected:
  Mount mount_ = all_mounts()[2];
  Marker marker_ = mount_.markers[1];
  ForceSample moving_{"", mount_};
  State state_ = moving_.random_state();
  Eigen::Matrix3d A_ = rotation_of(state_.q.segment<3>(3));
  Vector3d u_ = state_.q.segment<3>(6), psi_ = state_.q.segment<3>(9);
  const Vector3d point_{0.3, -0.2, 0.5}, direction_{0.6, 0.48, 0.64};
};

/// R = −∂(F · P)/∂q with P = r + A (p + u): a weight has a potential.
TEST_F(PointLoad, InSpaceIsTheGradientOfForceTimesPosition) {
  const auto term = make_point_load_term({"f", marker_}, {point_, direction_, constant(7.0)}, {});
  const VectorXd found = residual_of(*term, state_, position_level);
  for (Eigen::Index i = 0; i < state_.q.size(); ++i) {
    const auto potential = [&](double s) {
      const VectorXd q = moving_.advanced(state_.q, s * VectorXd::Unit(state_.q.size(), i));
      const Vector3d local = point_ + q.segment<3>(6);
      return -7.0 * direction_.dot(q.head<3>() + rotation_of(q.segment<3>(3)) * local);
    };
    EXPECT_NEAR(found(i), derivative_at_zero(potential, 1e-3), 1e-10) << i;
  }
}

/// In body axes: force f R s with R = exp(ψ̃), moment (p + u) × force, nothing on elastic rotations.
TEST_F(PointLoad, OnTheBodyTurnsWithIt) {
  const auto term = make_point_load_term({"f", marker_, LoadKind::force, LoadDirection::body},
                                         {point_, direction_, constant(7.0)}, {});
  const VectorXd Q = -residual_of(*term, state_, position_level);
  const Vector3d local = 7.0 * (rotation_of(psi_) * direction_);
  EXPECT_LE((Q.head<3>() - A_ * local).norm(), 1e-14);
  EXPECT_LE((Q.segment<3>(3) - (point_ + u_).cross(local)).norm(), 1e-14);
  EXPECT_LE((Q.segment<3>(6) - local).norm(), 1e-14);
  EXPECT_EQ(Q.segment<3>(9), Vector3d::Zero());
}

/// Both are one while nothing has turned.
TEST_F(PointLoad, InSpaceAndOnTheBodyAgreeBeforeAnyRotation) {
  state_.q.setZero();
  VectorXd forces[2];
  for (LoadDirection direction : {LoadDirection::space, LoadDirection::body}) {
    const auto term = make_point_load_term({"f", marker_, LoadKind::force, direction},
                                           {point_, direction_, constant(7.0)}, {});
    forces[static_cast<int>(direction)] = residual_of(*term, state_, position_level);
  }
  EXPECT_LE((forces[0] - forces[1]).norm(), 1e-14);
}

/// The marker stands in space as A exp(ψ̃). Whatever coordinate changes, a torque does the work of
/// the rotation vector by which the marker turns, found by differences.
TEST_F(PointLoad, OfATorqueDoesItsWorkOnTheRotationOfItsMarker) {
  const auto in_space = make_point_load_term({"m", marker_, LoadKind::torque},
                                             {point_, direction_, constant(7.0)}, {});
  const auto on_body = make_point_load_term({"m", marker_, LoadKind::torque, LoadDirection::body},
                                            {point_, direction_, constant(7.0)}, {});
  const auto marker_at = [&](const VectorXd& q) -> Eigen::Matrix3d {
    return rotation_of(q.segment<3>(3)) * rotation_of(q.segment<3>(9));
  };
  const Vector3d fixed = 7.0 * direction_;
  const Vector3d following = 7.0 * (marker_at(state_.q) * direction_);
  for (const auto& [term, torque] :
       {std::pair{in_space.get(), fixed}, {on_body.get(), following}}) {
    const VectorXd Q = -residual_of(*term, state_, position_level);
    for (Eigen::Index i = 0; i < Q.size(); ++i) {
      const Vector3d turned = derivative_at_zero(
          [&](double s) -> Vector3d {
            const VectorXd q = moving_.advanced(state_.q, s * VectorXd::Unit(Q.size(), i));
            return rotation_vector(marker_at(q) * marker_at(state_.q).transpose());
          },
          1e-3);
      // Fourth powers of the step, of a torque of 7.
      EXPECT_NEAR(Q(i), torque.dot(turned), 1e-10) << i;
    }
  }
}

/// f(t) = 2 + 3 t at t = 0.13.
TEST_F(PointLoad, HasTheValueOfItsTimeLaw) {
  const TimeLaw<double> law{TimeLaw<double>::Kind::polynomial, {2.0, 3.0}, {}};
  const auto term = make_point_load_term({"f", marker_}, {point_, direction_, law}, {});
  const VectorXd Q = -residual_of(*term, state_, position_level);
  EXPECT_LE((Q.head<3>() - 2.39 * direction_).norm(), 1e-14);
}

/// Two rigid bodies that turn about their common z axis by 0.3 and 1.0 rad, with 2 and 5 rad/s:
/// s = 0.7, ṡ = 3, so that τ = 4 − 6 (0.7 − 0.2) − 0.5 · 3 = −0.5 about the axis.
TEST(JointForce, TurnsTheSecondBodyAboutTheAxisAndTheFirstBack) {
  Marker first, second;
  first.frame.rotation = second.frame.rotation = RotationCoordinates::rotation_vector;
  second.frame.offset = 6;
  JointForceData<double> data;
  data.directions = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitX()};
  data.stiffness = 6.0;
  data.rest = 0.2;
  data.damping = 0.5;
  data.motor = constant(4.0);
  const auto term =
      make_joint_force({"j", {first, second}, RelativeCoordinate::angle}, data, {}).term;
  State state(12, 0);
  state.q(5) = 0.3;
  state.q(11) = 1.0;
  state.v(5) = 2.0;
  state.v(11) = 5.0;
  VectorXd expected = VectorXd::Zero(12);
  expected(5) = 0.5;
  expected(11) = -0.5;
  EXPECT_LE((-residual_of(*term, state, position_level) - expected).norm(), 1e-14);
}

/// 6 (s − 0.2) with s = 7 rad, more than a turn.
TEST(JointForce, CountsWholeTurnsInThePlane) {
  Marker ground, wheel;
  ground.frame = ground_frame();
  wheel.frame.rotation = RotationCoordinates::angle;
  wheel.frame.basis.resize(3, 0);
  JointForceData<double> data;
  data.stiffness = 6.0;
  data.rest = 0.2;
  const auto term = make_joint_force({"j", {ground, wheel}}, data, {}).term;
  State state(1, 0);
  state.q(0) = 7.0;
  EXPECT_NEAR(residual_of(*term, state, position_level)(0), 40.8, 1e-13);
}

TEST(SpringDamper, SaysWhereItsEndsCoincide) {
  Marker ground, mass;
  ground.frame = ground_frame();
  const ForceElement buffer = make_spring_damper(
      {"buffer", {ground, mass}}, {.stiffness = 1.0, .damping = 1.0, .free_length = 0.1}, {});
  State state(3, 0);
  state.time = 0.25;
  const std::string from_residual =
      thrown<SimulationError>([&] { residual_of(*buffer.term, state, position_level); });
  EXPECT_THAT(from_residual, HasSubstr("buffer"));
  EXPECT_THAT(from_residual, HasSubstr("t = 0.25 s"));
  EXPECT_EQ(
      thrown<SimulationError>([&] { tangent_of(*buffer.term, state, {.q = 1.0}, position_level); }),
      from_residual);
  EXPECT_EQ(thrown<SimulationError>([&] { (void)buffer.gauge->read(state, Reading::force); }),
            from_residual);
}

TEST(JointForce, SaysWhereItsAngleHasNoValue) {
  Marker ground, body;
  ground.frame = ground_frame();
  body.frame.rotation = RotationCoordinates::rotation_vector;
  JointForceData<double> data;
  data.directions = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};  // along the axis
  const auto term =
      make_joint_force({"hinge", {ground, body}, RelativeCoordinate::angle}, data, {}).term;
  const State state(6, 0);
  EXPECT_THAT(thrown<SimulationError>([&] { residual_of(*term, state, position_level); }),
              HasSubstr("hinge"));
}

constexpr auto at_position = ConstraintLevel::position;

class EveryForce : public testing::TestWithParam<ForceSample> {
 protected:
  ForceSample sample_ = GetParam();
  std::unique_ptr<Term> term_ = sample_.make();
  State state_ = sample_.random_state();
  Eigen::Index n_ = state_.q.size();

  /// Compares ∂(residual)/∂(part of the state) with `expected`, column by column. The fifth
  /// derivatives of these formulas are some 1e3 times their first; (1e-3)⁴ of that is 1e-9.
  template <class Shift>
  void expect_derivative(const Eigen::MatrixXd& expected, const Shift& shift) {
    for (Eigen::Index j = 0; j < n_; ++j) {
      const Eigen::VectorXd found = derivative_at_zero(
          [&](double s) {
            State moved = state_;
            shift(moved, s * Eigen::VectorXd::Unit(n_, j));
            return residual_of(*term_, moved, at_position);
          },
          1e-3);
      const double scale = std::max(expected.lpNorm<Eigen::Infinity>(), 1.0);
      EXPECT_LE((found - expected.col(j)).lpNorm<Eigen::Infinity>(), 1e-9 * scale)
          << "column " << j;
    }
  }
};

/// Rotation vectors are perturbed from the right: A exp(ε̃).
TEST_P(EveryForce, HasTheTangentOfItsResidualInThePositions) {
  expect_derivative(
      tangent_of(*term_, state_, {.q = 1.0}, at_position),
      [&](State& at, const Eigen::VectorXd& step) { at.q = sample_.advanced(state_.q, step); });
}

TEST_P(EveryForce, HasTheTangentOfItsResidualInTheVelocities) {
  expect_derivative(tangent_of(*term_, state_, {.v = 1.0}, at_position),
                    [&](State& at, const Eigen::VectorXd& step) { at.v += step; });
}

TEST_P(EveryForce, HasTheWeightedSumOfItsTangents) {
  const auto part = [&](const Weights& w) { return tangent_of(*term_, state_, w, at_position); };
  const Eigen::MatrixXd sum = 0.7 * part({.q = 1.0}) - 1.3 * part({.v = 1.0});
  const Eigen::MatrixXd difference = part({0.7, -1.3, 2.1}) - sum;
  EXPECT_LE(difference.norm(), 1e-13 * std::max(sum.norm(), 1.0));  // round-off
}

TEST_P(EveryForce, HasOneResidualHoweverItIsAskedFor) {
  EntryList entries;
  term_->declare_entries(entries);
  const std::array<Weights, 2> weights = {Weights{0.7, -1.3, 2.1}, Weights{.v = 1.0}};
  std::vector<double> values(2 * entries.size());
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(n_);
  term_->linearize(state_, weights, at_position, residual,
                   {values.data(), static_cast<std::ptrdiff_t>(entries.size())});
  EXPECT_EQ(residual, residual_of(*term_, state_, at_position));
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n_, n_);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    second(entries[i].first, entries[i].second) += values[entries.size() + i];
  }
  EXPECT_EQ(second, tangent_of(*term_, state_, weights[1], at_position));
}

/// Each number of the data is a variable; the term is built anew with neighbouring numbers.
TEST_P(EveryForce, HasTheDesignDerivativeOfItsResidual) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n_, sample_.numbers);
  term_->add_design_derivative(state_, at_position, columns);
  for (int j = 0; j < sample_.numbers; ++j) {
    const Eigen::VectorXd found = derivative_at_zero(
        [&](double s) { return residual_of(*sample_.make_shifted(j, s), state_, at_position); },
        1e-3);
    const double scale = std::max(columns.lpNorm<Eigen::Infinity>(), 1.0);
    // As for the tangent.
    EXPECT_LE((found - columns.col(j)).lpNorm<Eigen::Infinity>(), 1e-9 * scale) << "number " << j;
  }
}

class EverySpatialForce : public EveryForce {};

/// By blocks: translations, rotations, elastic displacements and rotations of each body, three
/// coordinates each. A block that is zero in a random state always is.
TEST_P(EverySpatialForce, DeclaresOnlyBlocksThatCanDifferFromZero) {
  EntryList entries;
  term_->declare_entries(entries);
  const Eigen::MatrixXd tangent = tangent_of(*term_, state_, {0.7, -1.3, 0.0}, at_position);
  for (const auto& [row, col] : entries) {
    const auto block = tangent.block<3, 3>(row / 3 * 3, col / 3 * 3);
    EXPECT_GT(block.norm(), 1e-3) << "row " << row << ", column " << col;
  }
}

INSTANTIATE_TEST_SUITE_P(Forces, EverySpatialForce,
                         testing::ValuesIn(force_samples(ForceChoice::spatial)),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Forces, EveryForce, testing::ValuesIn(force_samples(ForceChoice::all)),
                         [](const auto& test) { return test.param.name; });

using Eigen::Matrix3d;
using Eigen::MatrixXd;

constexpr double mass = 2.0;  // [kg]

std::unique_ptr<Term> rigid_body(const BodyFrame& frame, const Matrix3d& second_moment) {
  return std::make_unique<FloatingFrameBody>(
      "body", frame, rigid_invariants<double>(mass, Vector3d::Zero(), second_moment),
      std::vector<DesignDerivative<Invariants<double>>>{}, Vector3d::Zero());
}

System make_system(int coordinates, std::vector<std::unique_ptr<Term>>&& terms) {
  return {coordinates, 0, 0, std::move(terms)};
}

MatrixXd tangent(System& system, const Weights& weights) {
  System::Matrix matrix = system.make_matrix();
  const State state(system.coordinates(), 0);
  system.tangent(state, weights, ConstraintLevel::position, matrix);
  return matrix;
}

/// The largest ω² of K φ = ω² M φ about q = 0 at rest.
double largest_square_frequency(System& system) {
  const MatrixXd K = tangent(system, {.q = 1.0}), M = tangent(system, {.a = 1.0});
  return natural_modes(K, M).lambda.maxCoeff();
}

/// ∫ρ x xᵀ with moments of inertia 0.3, 0.4 and 0.5 kg m².
Matrix3d second_moment() {
  return Vector3d(0.3, 0.2, 0.1).asDiagonal();
}

BodyFrame wheel_frame() {
  BodyFrame frame;
  frame.rotation = RotationCoordinates::angle;
  frame.basis.resize(3, 0);
  return frame;
}

// Residuals are evaluated in closed form; only round-off separates them from the formulas: 1e-13.

/// ω² = k / I, I = 0.3 + 0.2.
TEST(TorsionSpring, MakesAWheelSwingAsTheTextbookSays) {
  Marker ground, wheel;
  ground.frame = ground_frame();
  wheel.frame = wheel_frame();
  JointForceData<double> data;
  data.stiffness = 20.0;
  std::vector<std::unique_ptr<Term>> terms;
  terms.push_back(rigid_body(wheel.frame, second_moment()));
  terms.push_back(make_joint_force({"spring", {ground, wheel}}, data, {}).term);
  System system = make_system(1, std::move(terms));
  EXPECT_NEAR(largest_square_frequency(system), 20.0 / 0.5, 40.0 * 1e-13);
}

/// In space, about local y: I = 0.3 + 0.1. Nothing else is held.
TEST(TorsionSpring, MakesABodyInSpaceSwingAsTheTextbookSays) {
  Marker ground, body;
  ground.frame = ground_frame();
  body.frame.rotation = RotationCoordinates::rotation_vector;
  JointForceData<double> data;
  data.stiffness = 20.0;
  data.directions = {Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitZ()};
  std::vector<std::unique_ptr<Term>> terms;
  terms.push_back(rigid_body(body.frame, second_moment()));
  terms.push_back(
      make_joint_force({"spring", {ground, body}, RelativeCoordinate::angle}, data, {}).term);
  System system = make_system(6, std::move(terms));
  EXPECT_NEAR(largest_square_frequency(system), 20.0 / 0.4, 50.0 * 1e-13);
}

/// Weight F at the distance l below the pivot: ω² = F l / I. A force that follows the body does
/// not bring it back.
TEST(PointForce, MakesAPendulumOnlyWhenFixedInSpace) {
  Marker wheel{.frame = wheel_frame()};
  for (const auto& [direction, square] :
       {std::pair{LoadDirection::space, 30.0 * 0.7 / 0.5}, {LoadDirection::body, 0.0}}) {
    const PointLoadData<double> data{
        {0.0, -0.7, 0.0}, {0.0, -1.0, 0.0}, {TimeLaw<double>::Kind::polynomial, {30.0}, {}}};
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(rigid_body(wheel.frame, second_moment()));
    terms.push_back(make_point_load_term({"weight", wheel, LoadKind::force, direction}, data, {}));
    System system = make_system(1, std::move(terms));
    EXPECT_NEAR(largest_square_frequency(system), square, 42.0 * 1e-13);
  }
}

/// Two masses of 2 kg on a spring: ω² = k (1/m₁ + 1/m₂) along it, and the tension k (l − l₀) over
/// the length, ω² = (1/m₁ + 1/m₂) k (l − l₀)/l, across it. C = c on the same pattern.
TEST(SpringDamper, MakesTwoMassesSwingAlongAndAcross) {
  std::array<Marker, 2> masses;
  masses[1].frame.offset = 3;
  masses[1].frame.origin = Vector3d(0.5, 0.0, 0.0);
  std::vector<std::unique_ptr<Term>> terms;
  for (const Marker& marker : masses) terms.push_back(rigid_body(marker.frame, Matrix3d::Zero()));
  terms.push_back(make_spring_damper({"spring", masses},
                                     {.stiffness = 80.0, .damping = 3.0, .free_length = 0.4}, {})
                      .term);
  System system = make_system(6, std::move(terms));
  const MatrixXd K = tangent(system, {.q = 1.0}), M = tangent(system, {.a = 1.0});
  const Eigen::VectorXd squares = natural_modes(K, M).lambda;
  Eigen::VectorXd expected(6);
  expected << 0.0, 0.0, 0.0, 16.0, 16.0, 80.0;
  EXPECT_LE((squares - expected).norm(), 80.0 * 1e-13);
  MatrixXd damping = MatrixXd::Zero(6, 6);
  damping(0, 0) = damping(3, 3) = 3.0;
  damping(0, 3) = damping(3, 0) = -3.0;
  EXPECT_LE((tangent(system, {.v = 1.0}) - damping).norm(), 1e-13);
}

}  // namespace
}  // namespace pleuel::test::force_law_test
