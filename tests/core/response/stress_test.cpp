#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/response/stress_signal.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::stress_test {
namespace {

constexpr double length = 0.8, width = 0.02, height = 0.03, density = 7850, gravity = 9.81;

/// Elastic coordinates at which the beam rests in its (possibly turning) frame.
void find_rest(Model& model, State& state) {
  const BodyModel& body = model.body("beam");
  const int first = body.elastic_offset(), n = body.coordinates.size();
  for (int iteration = 0; iteration < 8; ++iteration) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(n, n);
    for (const auto& term : model.mechanism.system->terms()) {
      if (term->name().starts_with("joint") || term->name().starts_with("norm")) continue;
      force += residual_of(*term, state, ConstraintLevel::position).segment(first, n);
      tangent +=
          tangent_of(*term, state, {.q = 1.0}, ConstraintLevel::position).block(first, first, n, n);
    }
    state.q.segment(first, n) -= solve_dense(tangent, force);
  }
}

Eigen::VectorXd stresses(const Model& model, const State& state) {
  const auto signal =
      make_stress_signal(model.body("beam"), model.gravity, StressPart::von_mises, false, {});
  Eigen::VectorXd values(signal->channels());
  signal->observe(state, values);
  return values;
}

struct Setting {
  int elements;
  EffectChoice spatial;
};

class StressOfABeam : public testing::TestWithParam<Setting> {
 protected:
  Model build(const Point& weight) const {
    Scene scene = swinging_beam(length, RectangleSection{width, height}, GetParam().elements);
    scene.gravity = weight;
    return build_model(
        scene, {.spatial_motion = GetParam().spatial, .geometric_stiffening = EffectChoice::off},
        {}, {});
  }
};

/// Moment wL²/2 at the root of a cantilever under its own weight, whatever the number of elements.
/// 1e-9: the frame rests by Newton's method, and stiffness is badly conditioned.
TEST_P(StressOfABeam, IsThatOfItsOwnWeightAtTheRoot) {
  Model model = build({0.0, -gravity, 0.0});
  State state = model.mechanism.guess;
  find_rest(model, state);
  const double moment = density * width * height * gravity * length * length / 2;
  const double expected = moment * 6 / (width * height * height);
  EXPECT_NEAR(stresses(model, state).maxCoeff() / expected, 1.0, 1e-9);
}

/// A beam that hangs along its axis pulls with its weight: σ = ρ g L.
TEST_P(StressOfABeam, IsThatOfItsOwnWeightAlongTheAxis) {
  Model model = build({gravity, 0.0, 0.0});
  State state = model.mechanism.guess;
  find_rest(model, state);
  EXPECT_NEAR(stresses(model, state).maxCoeff() / (density * gravity * length), 1.0, 1e-9);
}

/// Centrifugal tension ρΩ²L²/2 at the root; more exactly E (1/cos kL − 1), k² = ρΩ²/E, since what
/// is stretched pulls more (u″ + k²u = −k²x). One linear element misses a part of that: 1e-6.
TEST_P(StressOfABeam, IsTheCentrifugalTensionOfATurningBeam) {
  Model model = build({0.0, 0.0, 0.0});
  State state = model.mechanism.guess;
  const double speed = 20.0;
  state.v(GetParam().spatial == EffectChoice::on ? 5 : 2) = speed;
  find_rest(model, state);
  const double k = std::sqrt(density * speed * speed / 2.1e11);
  const double expected = 2.1e11 * (1 / std::cos(k * length) - 1);
  EXPECT_NEAR(expected / (density * speed * speed * length * length / 2), 1.0, 5e-6);
  EXPECT_NEAR(stresses(model, state).maxCoeff() / expected, 1.0, 1e-6);
}

/// Angular acceleration α: w = ρAαx, root moment ρAαL³/3 — linear load, exact too.
TEST_P(StressOfABeam, IsThatOfItsAngularAcceleration) {
  Model model = build({0.0, 0.0, 0.0});
  State state = model.mechanism.guess;
  const double alpha = 3.0;
  state.a(GetParam().spatial == EffectChoice::on ? 5 : 2) = alpha;
  find_rest(model, state);
  const double moment = density * width * height * alpha * std::pow(length, 3) / 3;
  const double expected = moment * 6 / (width * height * height);
  // The sections' own rotary inertia ρIα is missing in the recovered load: (h/L)²/4 of the whole.
  EXPECT_NEAR(stresses(model, state).maxCoeff() / expected, 1.0, 5e-4);
}

std::string setting_name(const testing::TestParamInfo<Setting>& info) {
  return (info.param.spatial == EffectChoice::on ? "Spatial" : "Planar") +
         std::to_string(info.param.elements);
}
INSTANTIATE_TEST_SUITE_P(Meshes, StressOfABeam,
                         testing::Values(Setting{1, EffectChoice::off},
                                         Setting{4, EffectChoice::off},
                                         Setting{1, EffectChoice::on},
                                         Setting{4, EffectChoice::on}),
                         setting_name);

/// Saint-Venant's series of a rectangle a ≤ b (Timoshenko & Goodier, §109), with c = π b/2a:
///     J = a³b/3 (1 − 192a/(π⁵b) Σ tanh(nc)/n⁵),   τ = T a/J (1 − 8/π² Σ 1/(n² cosh nc)),  n = 1,
///     3, …
/// at the middle of the longer side; σ_vM = √3 τ.
TEST(Stress, OfATwistedBarIsRootThreeTimesItsShear) {
  constexpr double pi = std::numbers::pi;
  const double a = std::min(width, height), b = std::max(width, height), c = pi * b / (2 * a);
  double stiffness = 0.0, at_side = 0.0;
  for (int n = 1; n < 60; n += 2) {
    stiffness += std::tanh(n * c) / std::pow(n, 5);
    at_side += 1.0 / (n * n * std::cosh(n * c));
  }
  const double shear_modulus = 2.1e11 / 2.6, twist = 1e-3;
  // T/J = G twist/length
  const double shear = shear_modulus * twist / length * a * (1 - 8 / (pi * pi) * at_side);
  const double torque = shear_modulus * twist / length * a * a * a * b / 3 *
                        (1 - 192 * a / (std::pow(pi, 5) * b) * stiffness);
  Scene scene = swinging_beam(length, RectangleSection{width, height}, 1);
  scene.gravity = {0.0, 0.0, 0.0};
  Model model = build_model(scene, {.spatial_motion = EffectChoice::on}, {}, {});
  State state = model.mechanism.guess;
  const int coordinate = model.body("beam").coordinate(1, 3);
  state.q(coordinate) = twist;
  // The fit of the section is good to some 1e-4.
  EXPECT_NEAR(stresses(model, state).maxCoeff() / (std::sqrt(3.0) * shear), 1.0, 1e-3);
  Eigen::VectorXd residual;
  model.mechanism.system->residual(state, ConstraintLevel::position, residual);
  EXPECT_NEAR(residual(coordinate) / torque, 1.0, 1e-3);
}

/// Weight across both axes of an ellipse, along none: the moments ρAgL²/2 of the two directions
/// meet between the axes, σ = √((M_z a/I_z)² + (M_y b/I_y)²).
TEST(Stress, OfAnEllipseIsLargestBetweenItsAxes) {
  Scene scene = swinging_beam(length, EllipseSection{width, height}, 2);
  scene.gravity = {0.0, -gravity, 0.7 * gravity};
  Model model = build_model(
      scene, {.spatial_motion = EffectChoice::on, .geometric_stiffening = EffectChoice::off}, {},
      {});
  State state = model.mechanism.guess;
  find_rest(model, state);
  const double a = height / 2, b = width / 2, area = std::numbers::pi * a * b;
  const double moment = density * area * gravity * length * length / 2;
  const double expected =
      std::hypot(moment * a / (area * a * a / 4), 0.7 * moment * b / (area * b * b / 4));
  EXPECT_NEAR(stresses(model, state).maxCoeff() / expected, 1.0, 1e-9);  // Newton's method
}

/// A general section with a point in the centroid sees tension there, and no bending.
TEST(Stress, OfAGeneralSectionIsThatAtItsPoints) {
  const double side = 0.02, inertia = std::pow(side, 4) / 12;
  for (const EffectChoice spatial : {EffectChoice::off, EffectChoice::on}) {
    Scene scene = swinging_beam(
        length, GeneralSection{side * side, inertia, inertia, 2 * inertia, {{0.0, 0.0, 0.0}}}, 2);
    scene.gravity = {gravity, -gravity, 0.0};
    Model model = build_model(
        scene, {.spatial_motion = spatial, .geometric_stiffening = EffectChoice::off}, {}, {});
    State state = model.mechanism.guess;
    find_rest(model, state);
    EXPECT_NEAR(stresses(model, state).maxCoeff() / (density * gravity * length), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace pleuel::test::stress_test
