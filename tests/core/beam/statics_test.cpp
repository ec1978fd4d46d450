#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
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

// Stubby, and with κ A of its own along each axis.
constexpr double wide = 0.15, high = 0.3;
constexpr double shear_modulus = young / 2.6, area = wide * high;
constexpr double area_y = 0.8 * area, area_z = 0.6 * area;
constexpr double deep_inertia_z = wide * high * high * high / 12;
constexpr double deep_inertia_y = high * wide * wide * wide / 12;

template <class Scalar = double>
Beam<Scalar> sheared_beam(int elements, double factor = 1.0) {
  Beam<Scalar> beam =
      uniform_beam<Scalar>(elements, Scalar(length), rectangle_section<Scalar>(wide, high),
                           Scalar(young), Scalar(density));
  for (BeamElement<Scalar>& element : beam.elements) {
    element.shear_compliance_y = factor / (shear_modulus * area_y);
    element.shear_compliance_z = factor / (shear_modulus * area_z);
  }
  return beam;
}

/// A clamped beam under a load at the nodes of its other end.
struct ShearedCantilever {
  Beam<double> beam;
  ElasticCoordinates coordinates = tangent_coordinates(beam.node_count(), all_active);
  Invariants<double> body = beam_invariants(beam, coordinates);

  Eigen::VectorXd deformed(const Eigen::VectorXd& load) const {
    return solve_dense(dense(body.pattern, body.stiffness), load);
  }
  int at_tip(int displacement) const {
    return coordinates.index(beam.node_count() - 1, displacement);
  }
  double tip(int displacement, int loaded) const {
    return deformed(Eigen::VectorXd::Unit(body.size(), at_tip(loaded)))(at_tip(displacement));
  }
};

/// L³/3EI + L/κGA, in one element and in several; sections turn by L²/2EI, with and without shear.
TEST(ShearedBeam, BendsUnderATipForceByTimoshenkosClosedForm) {
  const double shear_y = length / (shear_modulus * area_y);
  const double shear_z = length / (shear_modulus * area_z);
  const double tip_y = std::pow(length, 3) / (3 * young * deep_inertia_z) + shear_y;
  const double tip_z = std::pow(length, 3) / (3 * young * deep_inertia_y) + shear_z;
  ASSERT_GT(shear_y, 0.1 * tip_y);
  for (const int elements : {1, 4}) {
    const ShearedCantilever cantilever{sheared_beam(elements)};
    EXPECT_NEAR(cantilever.tip(1, 1) / tip_y, 1.0, round_off);
    EXPECT_NEAR(cantilever.tip(2, 2) / tip_z, 1.0, round_off);
    const double turned = length * length / 2 / young;
    EXPECT_NEAR(cantilever.tip(5, 1) * deep_inertia_z / turned, 1.0, round_off);
    EXPECT_NEAR(cantilever.tip(4, 2) * deep_inertia_y / turned, -1.0, round_off);
  }
}

/// q L⁴/8EI + q L²/2κGA: loads between the nodes are those of the same shapes.
TEST(ShearedBeam, BendsUnderItsWeightByTimoshenkosClosedForm) {
  const ShearedCantilever cantilever{sheared_beam(2)};
  const Eigen::VectorXd load = cantilever.body.shape.transpose() * Eigen::Vector3d(0.0, 9.81, 0.0);
  const double q = 9.81 * density * area;
  const double expected = q * std::pow(length, 4) / (8 * young * deep_inertia_z) +
                          q * length * length / (2 * shear_modulus * area_y);
  EXPECT_NEAR(cantilever.deformed(load)(cantilever.at_tip(1)) / expected, 1.0, round_off);
}

/// v₁ θ₁ v₂ θ₂ of Przemieniecki, Theory of Matrix Structural Analysis (1968), §5.6 and §11.4.
struct Textbook {
  Eigen::Matrix4d stiffness, mass;

  Textbook(double inertia, double shear_area) {
    const double l = length, phi = 12 * young * inertia / (shear_modulus * shear_area * l * l);
    stiffness << 12, 6 * l, -12, 6 * l, 6 * l, (4 + phi) * l * l, -6 * l, (2 - phi) * l * l,  //
        -12, -6 * l, 12, -6 * l, 6 * l, (2 - phi) * l * l, -6 * l, (4 + phi) * l * l;
    stiffness *= young * inertia / (l * l * l * (1 + phi));
    const double r2 = inertia / area / (l * l), p2 = phi * phi;  // (r/ℓ)²
    const double vv = 13. / 35 + 7 * phi / 10 + p2 / 3 + 1.2 * r2;
    const double vt = (11. / 210 + 11 * phi / 120 + p2 / 24 + (0.1 - phi / 2) * r2) * l;
    const double v2 = 9. / 70 + 3 * phi / 10 + p2 / 6 - 1.2 * r2;
    const double t2 = (13. / 420 + 3 * phi / 40 + p2 / 24 - (0.1 - phi / 2) * r2) * l;
    const double tt = (1. / 105 + phi / 60 + p2 / 120 + (2. / 15 + phi / 6 + p2 / 3) * r2) * l * l;
    const double tu = (1. / 140 + phi / 60 + p2 / 120 + (1. / 30 + phi / 6 - p2 / 6) * r2) * l * l;
    mass << vv, vt, v2, -t2, vt, tt, t2, -tu, v2, t2, vv, -vt, -t2, -tu, -vt, tt;
    mass *= density * area * l / ((1 + phi) * (1 + phi));
  }
};

TEST(ShearedBeam, HasTheTextbooksStiffnessAndMass) {
  const auto body = beam_invariants(sheared_beam(1), ElasticCoordinates(2, all_active));
  const Eigen::MatrixXd stiffness = dense(body.pattern, body.stiffness);
  const Eigen::MatrixXd mass = dense(body.pattern, body.mass_matrix);
  const Eigen::Vector4d turned(1, -1, 1, -1);  // θy = −w'
  for (const bool is_y : {true, false}) {
    const Textbook expected(is_y ? deep_inertia_z : deep_inertia_y, is_y ? area_y : area_z);
    const std::vector<int> at = is_y ? std::vector{1, 5, 7, 11} : std::vector{2, 4, 8, 10};
    const Eigen::Vector4d sign = is_y ? Eigen::Vector4d::Ones() : turned;
    const auto part = [&](const Eigen::MatrixXd& all) {
      return Eigen::Matrix4d(sign.asDiagonal() * all(at, at) * sign.asDiagonal());
    };
    EXPECT_LE((part(stiffness) - expected.stiffness).norm(), 1e-13 * expected.stiffness.norm());
    EXPECT_LE((part(mass) - expected.mass).norm(), 1e-13 * expected.mass.norm());
  }
}

/// As κGA grows, elements become Euler and Bernoulli's. 1e-13: a compliance of that share.
TEST(ShearedBeam, IsEulersAndBernoullisWhereNothingShears) {
  const ElasticCoordinates coordinates(3, all_active);
  const auto body = beam_invariants(sheared_beam(2, 1e-14), coordinates);
  const auto plain = beam_invariants(sheared_beam(2, 0.0), coordinates);
  EXPECT_LE((body.stiffness - plain.stiffness).norm(), 1e-13 * plain.stiffness.norm());
  EXPECT_LE((body.moments - plain.moments).norm(), 1e-13 * plain.moments.norm());
  EXPECT_LE((body.mixed - plain.mixed).norm(), 1e-13 * plain.mixed.norm());
  EXPECT_LE((body.shape - plain.shape).norm(), 1e-13 * plain.shape.norm());
}

/// A rigid body's motion strains nothing, and has the momentum and the inertia of the rigid body.
TEST(ShearedBeam, MovesRigidlyAsARigidBody) {
  const Beam<double> beam = sheared_beam(3);
  const auto body = beam_invariants(beam, ElasticCoordinates(4, all_active));
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(24, 6);
  for (int node = 0; node < 4; ++node) {
    const double x = beam.node_position(node);
    motions.middleRows(6 * node, 6).setIdentity();
    motions(6 * node + 2, 4) = -x;
    motions(6 * node + 1, 5) = x;
  }
  const Eigen::MatrixXd stiffness = dense(body.pattern, body.stiffness);
  const Eigen::MatrixXd mass = dense(body.pattern, body.mass_matrix);
  EXPECT_LE((stiffness * motions).norm(), 1e-12 * stiffness.norm());
  const Eigen::MatrixXd rigid = motions.transpose() * mass * motions;
  const double m = body.mass, third = m * length * length / 3;
  EXPECT_NEAR(rigid(1, 1), m, 1e-12 * m);
  EXPECT_NEAR(rigid(1, 5), m * length / 2, 1e-12 * m);
  EXPECT_NEAR(rigid(5, 5), third + m * deep_inertia_z / area, 1e-12 * third);
  EXPECT_NEAR(rigid(4, 4), third + m * deep_inertia_y / area, 1e-12 * third);
}

/// ω of the wave number k of a simply supported Timoshenko beam (Timoshenko 1921; the lower root):
///     ρ²I/(κG) ω⁴ − (ρA + ρI k² (1 + E/κG)) ω² + EI k⁴ = 0,   κ = area_y/A
double pinned_frequency(double k) {
  const double modulus = shear_modulus * area_y / area;  // κG
  const double a = density * density * deep_inertia_z / modulus;
  const double b = density * area + density * deep_inertia_z * k * k * (1 + young / modulus);
  const double c = young * deep_inertia_z * std::pow(k, 4);
  return std::sqrt(2 * c / (b + std::sqrt(b * b - 4 * a * c)));
}

/// On pins. Shear angles are constant in an element: frequencies fall with ℓ².
TEST(ShearedBeam, VibratesWithTimoshenkosFrequencies) {
  std::vector<double> sizes, first, second;
  for (const int elements : {8, 16, 32}) {
    const auto omega = frequencies(
        beam_invariants(sheared_beam(elements), chord_coordinates(elements + 1, bending_y)));
    const double k = std::numbers::pi / length;
    sizes.push_back(1.0 / elements);
    first.push_back(std::abs(omega(0) / pinned_frequency(k) - 1));
    second.push_back(std::abs(omega(1) / pinned_frequency(2 * k) - 1));
  }
  EXPECT_NEAR(observed_order(sizes, first), 2.0, 0.05);
  EXPECT_NEAR(observed_order(sizes, second), 2.0, 0.05);
  EXPECT_LT(first.back(), 2e-4);
  EXPECT_LT(second.back(), 2e-3);
}

/// The axial force N adds N ∫v'² of the axis. P/(1 + P/κGA) with Euler's load P on pins (Engesser;
/// Timoshenko & Gere, Theory of Elastic Stability, art. 2.17).
TEST(ShearedBeam, BucklesUnderEngessersLoad) {
  const int elements = 32;
  const Beam<double> beam = sheared_beam(elements);
  const ElasticCoordinates coordinates = chord_coordinates(elements + 1, bending_y);
  const auto body = beam_invariants(beam, coordinates);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(body.size(), body.size());
  for (int e = 0; e < elements; ++e) {
    const auto indices = coordinates.element_indices(e);
    const auto element = slope_matrix(form_of(beam.elements[static_cast<std::size_t>(e)]));
    for (std::size_t i = 0; i < 12; ++i) {
      for (std::size_t j = 0; j < 12; ++j) {
        if (indices[i] < 0 || indices[j] < 0) continue;
        slopes(indices[i], indices[j]) += element(static_cast<int>(i), static_cast<int>(j));
      }
    }
  }
  const Eigen::MatrixXd stiffness = dense(body.pattern, body.stiffness);
  const double found = eigenvalues_of_symmetric(stiffness, slopes)(0);
  const double euler = std::pow(std::numbers::pi / length, 2) * young * deep_inertia_z;
  const double expected = euler / (1 + euler / (shear_modulus * area_y));
  ASSERT_LT(expected, 0.7 * euler);
  // A shear angle that is constant in an element: some (π/32)²/12 of the share of shear.
  EXPECT_NEAR(found / expected, 1.0, 5e-4);
}

}  // namespace
}  // namespace pleuel::test::statics_test
