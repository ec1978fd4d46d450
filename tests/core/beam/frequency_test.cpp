#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "tests/support/sample_beams.hpp"

namespace pleuel::test::frequency_test {
namespace {

constexpr double length = 0.7, width = 0.02, height = 0.03, young = 2.1e11, density = 7850;

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
}  // namespace pleuel::test::frequency_test
