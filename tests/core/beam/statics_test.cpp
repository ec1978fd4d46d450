#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::statics_test {
namespace {

constexpr double length = 0.7, width = 0.02, height = 0.03, young = 2.1e11, density = 7850;

/// A cantilever of three unequal elements under a load at its nodes.
struct Cantilever {
  Beam<double> beam = uniform_beam(3, length, rectangle_section(width, height), young, density);
  ElasticCoordinates coordinates = tangent_coordinates(4, all_active);

  Cantilever() {
    beam.elements[0].length = 0.1;
    beam.elements[1].length = 0.35;
    beam.elements[2].length = 0.25;
  }
  /// Displacement of the tip under a unit load there.
  double tip(int displacement, int loaded) const {
    const auto body = beam_invariants(beam, coordinates);
    const Eigen::VectorXd load = Eigen::VectorXd::Unit(body.size(), coordinates.index(3, loaded));
    const Eigen::VectorXd q = solve_dense(dense(body.pattern, body.stiffness), load);
    return q(coordinates.index(3, displacement));
  }
};

// Nodal values of Euler–Bernoulli elements are exact; only round-off of the stiffness is left.
constexpr double round_off = 1e-10;

TEST(BeamStatics, TipForceBendsByPL3Over3EI) {
  const Cantilever cantilever;
  const double iz = width * std::pow(height, 3) / 12, iy = height * std::pow(width, 3) / 12;
  EXPECT_NEAR(cantilever.tip(1, 1) * 3 * young * iz / std::pow(length, 3), 1.0, round_off);
  EXPECT_NEAR(cantilever.tip(2, 2) * 3 * young * iy / std::pow(length, 3), 1.0, round_off);
}

/// A moment about +z bends towards +y, one about +y towards −z.
TEST(BeamStatics, TipMomentBendsByML2Over2EIWithTheSignOfARightHandedAxis) {
  const Cantilever cantilever;
  const double iz = width * std::pow(height, 3) / 12, iy = height * std::pow(width, 3) / 12;
  EXPECT_NEAR(cantilever.tip(1, 5) * 2 * young * iz / (length * length), 1.0, round_off);
  EXPECT_NEAR(cantilever.tip(2, 4) * 2 * young * iy / (length * length), -1.0, round_off);
}

TEST(BeamStatics, TorqueTwistsByTLOverGJAndForceStretchesByPLOverEA) {
  const Cantilever cantilever;
  const double torsion = rectangle_section(width, height).torsion;
  EXPECT_NEAR(cantilever.tip(3, 3) * young / 2.6 * torsion / length, 1.0, round_off);
  EXPECT_NEAR(cantilever.tip(0, 0) * young * width * height / length, 1.0, round_off);
}

/// S̄ᵀ g is the consistent nodal load of the weight: tip deflection q L⁴/8EI, exactly.
TEST(BeamStatics, OwnWeightBendsByQL4Over8EI) {
  const Cantilever cantilever;
  const auto body = beam_invariants(cantilever.beam, cantilever.coordinates);
  const Eigen::VectorXd load = body.shape.transpose() * Eigen::Vector3d(0, 9.81, 0);
  const Eigen::VectorXd q = solve_dense(dense(body.pattern, body.stiffness), load);
  const double per_length = density * width * height * 9.81;
  const double inertia = width * std::pow(height, 3) / 12;
  EXPECT_NEAR(q(cantilever.coordinates.index(3, 1)) * 8 * young * inertia /
                  (per_length * std::pow(length, 4)),
              1.0, round_off);
}

Beam<double> beam(int elements) {
  return uniform_beam(elements, length, rectangle_section(width, height), young, density);
}

/// λ = ω √(ρAL⁴/EI), without the rotary inertia of the sections.
Eigen::VectorXd bending_numbers(const ElasticCoordinates& coordinates, double inertia) {
  const auto omega = frequencies(
      beam_invariants(beam(coordinates.node_count() - 1), coordinates, RotaryInertia::neglected));
  return omega * std::sqrt(density * width * height * std::pow(length, 4) / (young * inertia));
}

const double inertia_z = width * height * height * height / 12;
const double inertia_y = height * width * width * width / 12;

/// Consistent-mass Euler–Bernoulli elements; computed independently, all digits.
TEST(BeamFrequencies, OfACantileverAreThoseOfConsistentMassElements) {
  struct Case {
    int elements;
    double first, second;
  };
  for (const auto& [elements, first, second] :
       {Case{1, 3.532732, 34.806893}, Case{2, 3.517715, 22.221474}, Case{4, 3.516130, 22.060166},
        Case{8, 3.516023, 22.036253}}) {
    const auto in_y = bending_numbers(tangent_coordinates(elements + 1, bending_y), inertia_z);
    const auto in_z = bending_numbers(tangent_coordinates(elements + 1, bending_z), inertia_y);
    EXPECT_NEAR(in_y(0), first, 6e-7) << elements;
    EXPECT_NEAR(in_y(1), second, 6e-7) << elements;
    EXPECT_NEAR(in_z(0), first, 6e-7) << elements;
    EXPECT_NEAR(in_z(1), second, 6e-7) << elements;
  }
}

/// The chord frame is a beam on two pins; computed independently.
TEST(BeamFrequencies, BetweenPinsAreThoseOfConsistentMassElements) {
  struct Case {
    int elements;
    double first;
  };
  for (const auto& [elements, first] : {Case{1, 10.954451}, Case{2, 9.908559}, Case{4, 9.872167}}) {
    const auto in_y = bending_numbers(chord_coordinates(elements + 1, bending_y), inertia_z);
    const auto in_z = bending_numbers(chord_coordinates(elements + 1, bending_z), inertia_y);
    EXPECT_NEAR(in_y(0), first, 6e-7) << elements;
    EXPECT_NEAR(in_z(0), first, 6e-7) << elements;
  }
}

/// Free–free roots of cos βL cosh βL = 1; the two rigid motions come first. Element error ~
/// (βℓ)⁴/720.
TEST(BeamFrequencies, OfAFreeBeamTendToTheClosedForm) {
  const auto numbers = bending_numbers(ElasticCoordinates(33, bending_y), inertia_z);
  EXPECT_NEAR(numbers(1), 0.0, 1e-3);
  EXPECT_NEAR(numbers(2) / 22.37328544806132, 1.0, 1e-6);
  EXPECT_NEAR(numbers(3) / 61.67282286792025, 1.0, 4e-6);
}

/// Linear elements with consistent mass: ω = (c/ℓ) √(6 (1 − cos kℓ)/(2 + cos kℓ)), k = (2n−1)π/2L,
/// the dispersion relation of a rod (Hughes, The Finite Element Method, §7.3).
TEST(BeamFrequencies, AxialAndTorsionalFollowTheDispersionRelationOfLinearElements) {
  const int n = 5;
  const auto section = rectangle_section(width, height);
  const double axial_speed = std::sqrt(young / density);
  const double polar = section.inertia_y + section.inertia_z;
  const double torsional_speed = std::sqrt(young / 2.6 * section.torsion / (density * polar));
  for (const auto& [active, speed] :
       {std::pair{axial_only, axial_speed}, std::pair{torsion_only, torsional_speed}}) {
    const auto omega = frequencies(beam_invariants(beam(n), tangent_coordinates(n + 1, active)));
    for (int mode = 0; mode < n; ++mode) {
      const double cell = length / n, c = std::cos((2 * mode + 1) * std::numbers::pi / 2 / n);
      EXPECT_NEAR(omega(mode) / (speed / cell * std::sqrt(6 * (1 - c) / (2 + c))), 1.0, 1e-12);
    }
  }
}

/// dω/dh = ω/h (bending in h), dω/dL = −2ω/L, dω/dE = ω/2E, dω/dρ = −ω/2ρ, dω/db = 0. Of one simple
/// eigenvalue, by Nelson: dω = φᵀ(dK − ω² dM)φ / 2ω with φᵀMφ = 1.
TEST(BeamFrequencies, DerivativesFollowTheScalingLaws) {
  const auto coordinates = tangent_coordinates(5, bending_y);
  const auto body = beam_invariants(beam(4), coordinates, RotaryInertia::neglected);
  const NaturalModes modes =
      natural_modes(dense(body.pattern, body.stiffness), dense(body.pattern, body.mass_matrix));
  const double omega = std::sqrt(modes.lambda(0));
  const Eigen::VectorXd mode = modes.shapes.col(0);
  const double value[] = {height, length, young, density, width};
  const double law[] = {omega / height, -2 * omega / length, omega / (2 * young),
                        -omega / (2 * density), 0.0};
  for (int variable = 0; variable < 5; ++variable) {
    Dual x[5];
    for (int i = 0; i < 5; ++i) x[i] = Dual(value[i]);
    x[variable].derivatives()[0] = 1.0;
    const auto seeded = beam_invariants(
        uniform_beam<Dual>(4, x[1], rectangle_section<Dual>(x[4], x[0]), x[2], x[3]), coordinates,
        RotaryInertia::neglected);
    const Eigen::MatrixXd dk = derivative_matrix(dense(seeded.pattern, seeded.stiffness));
    const Eigen::MatrixXd dm = derivative_matrix(dense(seeded.pattern, seeded.mass_matrix));
    const double found = mode.dot((dk - omega * omega * dm) * mode) / (2 * omega);
    EXPECT_NEAR(found * value[variable], law[variable] * value[variable], 1e-10 * omega)
        << variable;
  }
}

}  // namespace
}  // namespace pleuel::test::statics_test
