#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/effects/floating_frame_body.hpp"
#include "core/forces/joint_force.hpp"
#include "core/forces/point_load.hpp"
#include "core/forces/spring_damper.hpp"
#include "core/system/system.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::vibration_test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

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
  Marker wheel;
  wheel.frame = wheel_frame();
  for (const auto& [direction, square] :
       {std::pair{LoadDirection::space, 30.0 * 0.7 / 0.5}, {LoadDirection::body, 0.0}}) {
    const PointForceData<double> data{
        {0.0, -0.7, 0.0}, {0.0, -1.0, 0.0}, {TimeLaw<double>::Kind::polynomial, {30.0}, {}}};
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(rigid_body(wheel.frame, second_moment()));
    terms.push_back(make_point_force_term({"weight", wheel, direction}, data, {}));
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
}  // namespace pleuel::test::vibration_test
