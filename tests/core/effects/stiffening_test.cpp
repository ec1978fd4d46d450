#include <random>

#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::stiffening_test {
namespace {

Term& find_term(Model& model, const std::string& name) {
  for (const auto& term : model.mechanism.system->terms()) {
    if (term->name().starts_with(name)) return *term;
  }
  throw std::runtime_error("no term " + name);
}

/// ½ κ Σ (g² − Δu²), g = Δu + ½ ∫ v'² + w'² dx, with the integral by its own formula: for cubic v
/// ∫v'² = (36 d² + 3 d ℓ s − …) in closed form (Przemieniecki 1968, geometric stiffness):
///     ∫v'² dx = (1/30ℓ) nᵀ [36 3ℓ −36 3ℓ; 3ℓ 4ℓ² −3ℓ −ℓ²; …] n
double stretching_energy(const BodyModel& body, const State& state) {
  double sum = 0.0;
  for (int e = 0; e < static_cast<int>(body.beam.elements.size()); ++e) {
    const auto& element = body.beam.elements[e];
    const double l = element.length;
    double n[12];
    for (int i = 0; i < 12; ++i) {
      const int index = body.coordinate(e + i / 6, i % 6);
      n[i] = index < 0 ? 0.0 : state.q(index);
    }
    Eigen::Matrix4d slope;
    slope << 36, 3 * l, -36, 3 * l, 3 * l, 4 * l * l, -3 * l, -l * l,  //
        -36, -3 * l, 36, -3 * l, 3 * l, -l * l, -3 * l, 4 * l * l;
    const Eigen::Vector4d v(n[1], n[5], n[7], n[11]), w(n[2], -n[4], n[8], -n[10]);
    const double shortening = 0.5 * (v.dot(slope * v) + w.dot(slope * w)) / (30 * l);
    const double linear = n[6] - n[0], total = linear + shortening;
    sum += 0.5 * element.young * element.section.area / l * (total * total - linear * linear);
  }
  return sum;
}

TEST(GeometricStiffening, IsTheGradientOfThePotentialOfTheMeanStrain) {
  SampleScene sample = spatial_sample();
  for (Body& body : sample.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) beam->damping = {};
  }
  Model model = sample.build();
  const BodyModel& body = model.body("crank");
  Term& term = find_term(model, "geometric stiffening of crank");
  State state = model.mechanism.guess;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  for (double& q : state.q) q += uniform(random);
  state.v.setOnes();  // no damping: rates do nothing
  const Eigen::VectorXd found =
      residual_of(term, state, ConstraintLevel::position).head(state.q.size());
  Eigen::VectorXd expected(state.q.size());
  for (Eigen::Index i = 0; i < state.q.size(); ++i) {
    expected(i) = derivative_at_zero(
        [&](double s) {
          State moved = state;
          moved.q(i) += s;
          return stretching_energy(body, moved);
        },
        1e-4);  // a polynomial of degree four: no truncation error
  }
  EXPECT_LE(relative_difference(found, expected), 1e-10);
}

/// λ of flapping of a rotating cantilever without hub, η = Ω√(ρAL⁴/EI), from the mechanism
/// linearised about its stretched steady state (Wright et al. 1982). So slender that neither rotary
/// inertia nor the stretch itself, both of order (depth/length)², count.
struct RotatingCantilever {
  static constexpr double length = 10.0, depth = 0.01;
  int elements;

  Eigen::VectorXd flapping_numbers(double eta) const {
    Scene scene = swinging_beam(length, RectangleSection{depth, 10 * depth}, elements);
    scene.gravity = {0.0, 0.0, 0.0};
    EffectSettings effects{.spatial_motion = EffectChoice::on};
    Model model = build_model(scene, effects, {}, {});
    const double flap_stiffness = 2.1e11 * depth * depth / 12 / 7850;  // EI/ρA, flap along z
    const double speed = eta * std::sqrt(flap_stiffness) / (length * length);
    State state = model.mechanism.guess;
    state.v(5) = speed;
    stretch(model, state);
    return numbers(model, state, std::sqrt(flap_stiffness) / (length * length));
  }

 private:
  static Eigen::VectorXd forces(Model& model, const State& state) {
    return residual_of(find_term(model, "inertia"), state, ConstraintLevel::position) +
           residual_of(find_term(model, "geometric"), state, ConstraintLevel::position);
  }
  static Eigen::MatrixXd tangent(Model& model, const State& state, const Weights& weights) {
    return tangent_of(find_term(model, "inertia"), state, weights, ConstraintLevel::position) +
           tangent_of(find_term(model, "geometric"), state, weights, ConstraintLevel::position);
  }
  static void stretch(Model& model, State& state) {
    const BodyModel& body = model.body("beam");
    const int first = body.elastic_offset(), n = body.coordinates.size();
    for (int iteration = 0; iteration < 5; ++iteration) {
      state.q.segment(first, n) -=
          solve_dense(tangent(model, state, {.q = 1.0}).block(first, first, n, n),
                      forces(model, state).segment(first, n));
    }
  }
  Eigen::VectorXd numbers(Model& model, const State& state, double unit) const {
    const BodyModel& body = model.body("beam");
    std::vector<int> flap;
    for (int node = 1; node <= elements; ++node) {
      flap.push_back(body.coordinate(node, 2));
      flap.push_back(body.coordinate(node, 4));
    }
    const Eigen::MatrixXd k = tangent(model, state, {.q = 1.0})(flap, flap);
    const Eigen::MatrixXd m = tangent(model, state, {.a = 1.0})(flap, flap);
    return natural_modes(k, m).lambda.cwiseSqrt() / unit;
  }
};

TEST(GeometricStiffening, RaisesTheFlappingFrequenciesOfARotatingCantilever) {
  const RotatingCantilever beam{32};
  for (const auto& [eta, expected] :
       {std::pair{0.0, Eigen::Vector3d(3.516015, 22.034492, 61.697214)},
        std::pair{1.0, Eigen::Vector3d(3.681647, 22.181011, 61.841763)},
        std::pair{2.0, Eigen::Vector3d(4.137320, 22.614922, 62.273184)},
        std::pair{4.0, Eigen::Vector3d(5.585001, 24.273349, 63.966760)},
        std::pair{6.0, Eigen::Vector3d(7.360373, 26.809082, 66.683914)},
        std::pair{12.0, Eigen::Vector3d(13.170150, 37.603112, 79.614478)}}) {
    const Eigen::VectorXd numbers = beam.flapping_numbers(eta);
    const double error =
        (numbers.head(3).cwiseQuotient(expected).array() - 1).matrix().lpNorm<Eigen::Infinity>();
    // Without speed six digits (measured 1e-6). With it the force is constant over each element:
    // measured 8e-6, 3e-5, 7e-5, 1.3e-4, 3e-4.
    EXPECT_LE(error, eta == 0.0 ? 2e-6 : 6e-4) << "eta " << eta;
  }
}

/// … and the error of the constant force falls with the square of the element's length.
TEST(GeometricStiffening, ConvergesToThemWithTheSquareOfTheElementLength) {
  const auto error = [](int elements) {
    return std::abs(RotatingCantilever{elements}.flapping_numbers(12.0)(1) / 37.603112 - 1);
  };
  EXPECT_NEAR(std::log2(error(8) / error(16)), 2.0, 0.2);
  EXPECT_NEAR(std::log2(error(16) / error(32)), 2.0, 0.1);
}

}  // namespace
}  // namespace pleuel::test::stiffening_test
