#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/response/stress_signal.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

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
  const auto signal = make_stress_signal(model.body("beam"), model.gravity, StressPart::von_mises,
                                         OutlinePoints::most_stressed, {});
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

constexpr double pull = 3e4, shake = 190.0, rod_length = 0.4, diameter = 0.02;

/// Mean, rms and integral over two periods of the largest normal and von Mises stress of a rod that is
/// pulled and shaken.
Eigen::VectorXd averages(const std::string& spatial_motion) {
  std::string responses;
  for (const char* part : {"normal", "von-mises"}) {
    for (const char* over_time : {"mean", "rms", "integral"}) {
      responses += fmt::format(
          R"({}"{}-{}": {{"type": "stress", "body": "rod", "part": "{}", "over_time": "{}",
                          "from": 0.2, "to": 0.6}})",
          responses.empty() ? "" : ", ", part, over_time, part, over_time);
    }
  }
  const ProblemFile problem = problem_from(fmt::format(
      R"({{"scene": {{
          "bodies": {{"rod": {{"type": "beam", "from": [0, 0, 0], "to": [{}, 0, 0],
                              "material": "steel", "elements": 2, "section": {{"type": "circle", "diameter": {}}},
                              "damping": {{"stiffness": "1e-4 s"}}}}}},
          "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "rod"], "at": [0, 0, 0]}}}},
          "loads": {{
            "pull": {{"type": "force", "body": "rod", "at": [{}, 0, 0], "direction": [1, 0, 0],
                     "value": {{"type": "step", "to": {}, "rise": 0.1}}}},
            "shake": {{"type": "force", "body": "rod", "at": [{}, 0, 0], "direction": [0, 1, 0],
                      "value": {{"type": "harmonic", "amplitude": {}, "frequency": "5 Hz"}}}}}}}},
        "effects": {{"geometric_stiffening": "off", "spatial_motion": "{}"}},
        "simulation": {{"end_time": 0.6, "step": 0.001}}, "responses": {{{}}}}})",
      rod_length, diameter, rod_length, pull, rod_length, shake, spatial_motion, responses));
  return values_of(*analyze(problem, start_design(problem)));
}

/// The points of a section stay where they are, in space, too: at each the mean of what shakes is N/A.
TEST(AveragedStress, IsThatOfAPointThatStaysWhereItIs) {
  const Eigen::VectorXd in_plane = averages("off"), in_space = averages("on");
  for (Eigen::Index i = 0; i < in_plane.size(); ++i) {
    EXPECT_NEAR(in_space(i), in_plane(i), 1e-6 * in_plane(i)) << i;
  }
  const double axial = pull / (std::numbers::pi * diameter * diameter / 4.0);
  EXPECT_NEAR(in_space(0), axial, 2e-3 * axial);  // the rod vibrates a little
}

// Loads a little beside nodes of the mesh, as written coordinates are rounded.

/// A clamped bar of 1 m, 40 mm in diameter, at rest.
Eigen::VectorXd values(const std::string& loads, const std::string& responses) {
  const ProblemFile problem = problem_from(fmt::format(R"j({{"scene": {{
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 4,
      "section": {{"type": "circle", "diameter": "40 mm"}}}}}},
    "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}}},
    "loads": {{{}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"}},
  "responses": {{{}}}}})j",
                                                       loads, responses));
  return values_of(*analyze(problem, start_design(problem)));
}

class Offsets : public testing::TestWithParam<double> {};

/// A couple of 50 N m bends all before it, M/W with W = π d³/32, and nothing behind it.
TEST_P(Offsets, LeaveTheJumpOfTheMomentWhereItIs) {
  const Eigen::VectorXd found = values(
      fmt::format(
          R"("turn": {{"type": "torque", "body": "bar", "at": [{:.17g}, 0, 0], "direction": [0, 0, 1],
                     "value": "50 N m"}})",
          0.5 + GetParam()),
      R"("stress": {"type": "stress", "body": "bar", "at": 0.5, "over_time": "final"},
         "before": {"type": "section-force", "body": "bar", "at": 0.5, "part": "moment-z", "side": "before",
                    "over_time": "final"},
         "behind": {"type": "section-force", "body": "bar", "at": 0.5, "part": "moment-z", "side": "behind",
                    "over_time": "final"})");
  const double stress = 50.0 * 32.0 / (M_PI * std::pow(0.04, 3));
  EXPECT_NEAR(found(0), stress, 1e-6 * stress);
  EXPECT_NEAR(std::abs(found(1)), 50.0, 1e-5);
  EXPECT_NEAR(found(2), 0.0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(OfALoad, Offsets, testing::Values(0.0, 1e-8, 5e-7, -5e-7, 5e-6),
                         [](const auto& test) { return fmt::format("Number{}", test.index); });

/// 50 kN at 2.4 mm from the clamp, a hundredth of the element, and 500 N at the tip.
TEST(AForceBesideAClamp, IsThereInSectionForces) {
  const Eigen::VectorXd found = values(
      R"("near": {"type": "force", "body": "bar", "at": ["2.4 mm", 0, 0], "direction": [0, -1, 0], "value": "50 kN"},
         "tip": {"type": "force", "body": "bar", "at": [1, 0, 0], "direction": [0, -1, 0], "value": "500 N"})",
      R"("shear": {"type": "section-force", "body": "bar", "at": 0, "part": "shear-y", "over_time": "final"},
         "moment": {"type": "section-force", "body": "bar", "at": 0, "part": "moment-z", "over_time": "final"})");
  EXPECT_NEAR(std::abs(found(0)), 50500.0, 0.5);
  EXPECT_NEAR(std::abs(found(1)), 50e3 * 2.4e-3 + 500.0, 1e-2);
}

}  // namespace
}  // namespace pleuel::test::stress_test
