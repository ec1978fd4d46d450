#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/dense.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

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
    const auto& element = body.beam.elements[static_cast<std::size_t>(e)];
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

/// λ of flapping of a rotating cantilever without hub, η = Ω√(ρAL⁴/EI) (Wright et
/// al. 1982). EA is so large that only the force of the stretch counts.
struct RotatingCantilever {
  static constexpr double length = 10.0, depth = 0.1;
  int elements;

  Eigen::VectorXd flapping_numbers(double eta) const {
    Scene scene = swinging_beam(length, RectangleSection{depth, 10 * depth}, elements);
    scene.gravity = {0.0, 0.0, 0.0};
    Model model = build_model(scene, {.spatial_motion = EffectChoice::on}, {}, {});
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
    const int first = body.elastic_offset(), n = body.coordinates->size();
    for (int iteration = 0; iteration < 5; ++iteration) {
      state.q.segment(first, n) -= tangent(model, state, {.q = 1.0})
                                       .block(first, first, n, n)
                                       .fullPivLu()
                                       .solve(forces(model, state).segment(first, n));
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
    return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(k, m)
               .eigenvalues()
               .cwiseSqrt() /
           unit;
  }
};

TEST(GeometricStiffening, RaisesTheFlappingFrequenciesOfARotatingCantilever) {
  struct Row {
    double eta, first, second;
  };
  for (const auto& [eta, first, second] :
       {Row{0, 3.516015, 22.034492}, Row{1, 3.681647, 22.181011}, Row{2, 4.137320, 22.614922},
        Row{4, 5.585001, 24.273349}, Row{6, 7.360373, 26.809082}, Row{12, 13.170150, 37.603112}}) {
    const auto numbers = RotatingCantilever{16}.flapping_numbers(eta);
    // Measured: below 1e-3 (constant force an element, and rotary inertia (depth/length)²).
    EXPECT_NEAR(numbers(0) / first, 1.0, 2e-3) << "eta " << eta;
    EXPECT_NEAR(numbers(1) / second, 1.0, 2e-3) << "eta " << eta;
  }
}

}  // namespace
