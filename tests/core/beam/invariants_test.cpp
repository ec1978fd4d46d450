#include <complex>
#include <initializer_list>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::invariants_test {
namespace {

constexpr double length = 0.7, width = 0.02, height = 0.03, young = 2.1e11, density = 7850;

/// Consistent mass of one element as in Przemieniecki, Theory of Matrix Structural Analysis, §11.4
/// (with rotary inertia, without shear), coordinates u v w θx θy θz at each node.
Eigen::Matrix<double, 12, 12> textbook_mass(double l, const SectionProperties<double>& s,
                                            bool has_rotary_inertia) {
  Eigen::Matrix<double, 12, 12> mass = Eigen::Matrix<double, 12, 12>::Zero();
  Eigen::Matrix2d linear;
  linear << 2, 1, 1, 2;
  Eigen::Matrix4d cubic, slope;
  cubic << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l,  //
      54, 13 * l, 156, -22 * l, -13 * l, -3 * l * l, -22 * l, 4 * l * l;
  slope << 36, 3 * l, -36, 3 * l, 3 * l, 4 * l * l, -3 * l, -l * l,  //
      -36, -3 * l, 36, -3 * l, 3 * l, -l * l, -3 * l, 4 * l * l;
  const auto add = [&](const auto& block, const std::vector<int>& at, const auto& sign, double f) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j < at.size(); ++j) {
        const auto r = static_cast<int>(i), c = static_cast<int>(j);
        mass(at[i], at[j]) += f * sign[i] * sign[j] * block(r, c);
      }
    }
  };
  const std::vector<double> plus = {1, 1, 1, 1}, turned = {1, -1, 1, -1};  // θy = −w'
  add(linear, {0, 6}, plus, density * s.area * l / 6);
  add(linear, {3, 9}, plus, density * (s.inertia_y + s.inertia_z) * l / 6);
  add(cubic, {1, 5, 7, 11}, plus, density * s.area * l / 420);
  add(cubic, {2, 4, 8, 10}, turned, density * s.area * l / 420);
  if (has_rotary_inertia) {
    add(slope, {1, 5, 7, 11}, plus, density * s.inertia_z / (30 * l));
    add(slope, {2, 4, 8, 10}, turned, density * s.inertia_y / (30 * l));
  }
  return mass;
}

TEST(BeamInvariants, TracesOfTheMomentsAreTheTextbookMassMatrix) {
  const auto section = rectangle_section(width, height);
  const auto beam = uniform_beam(1, length, section, young, density);
  for (auto rotary : {RotaryInertia::included, RotaryInertia::neglected}) {
    const auto body = beam_invariants(beam, ElasticCoordinates(2, all_active), rotary);
    const auto expected = textbook_mass(length, section, rotary == RotaryInertia::included);
    EXPECT_LE(relative_difference(dense(body.pattern, body.mass_matrix), expected), 1e-14);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(12, 12);
    for (std::size_t p = 0; p < body.pairs.size(); ++p) {
      if (body.pairs[p].first == body.pairs[p].second) {
        sum += dense(body.pattern, Eigen::VectorXd(body.moments.col(static_cast<int>(p))));
      }
    }
    EXPECT_LE(relative_difference(sum, expected), 1e-14);
  }
}

/// Nodal displacements of a free beam moved by t + φ × p.
Eigen::VectorXd rigid_motion(const Beam<double>& beam, const Eigen::Vector3d& t,
                             const Eigen::Vector3d& turn) {
  Eigen::VectorXd q(6 * beam.node_count());
  for (int i = 0; i < beam.node_count(); ++i) {
    const Eigen::Vector3d p(beam.node_position(i), 0, 0);
    q.segment<3>(6 * i) = t + turn.cross(p);
    q.segment<3>(6 * i + 3) = turn;
  }
  return q;
}

/// ∫ρ (t + φ×p)·(t' + φ'×p) of a rigid box, closed form, through the elastic coordinates.
TEST(BeamInvariants, RigidMotionsHaveTheInertiaOfTheSolidBox) {
  const auto beam = uniform_beam(3, length, rectangle_section(width, height), young, density);
  const auto body = beam_invariants(beam, ElasticCoordinates(4, all_active));
  const Eigen::MatrixXd mass = dense(body.pattern, body.mass_matrix);
  const double m = density * width * height * length;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the end of the axis
  inertia(0, 0) = m * (width * width + height * height) / 12;
  inertia(1, 1) = m * (length * length / 3 + width * width / 12);
  inertia(2, 2) = m * (length * length / 3 + height * height / 12);
  const Eigen::Vector3d first(m * length / 2, 0, 0);
  for (int i = 0; i < 3; ++i) {
    const auto move = rigid_motion(beam, Eigen::Vector3d::Unit(i), Eigen::Vector3d::Zero());
    const auto turn = rigid_motion(beam, Eigen::Vector3d::Zero(), Eigen::Vector3d::Unit(i));
    EXPECT_LE((body.shape * move - m * Eigen::Vector3d::Unit(i)).norm(), 1e-13 * m);
    EXPECT_LE((body.shape * turn - Eigen::Vector3d::Unit(i).cross(first)).norm(), 1e-13 * m);
    EXPECT_NEAR(move.dot(mass * move), m, 1e-13 * m);
    EXPECT_NEAR(turn.dot(mass * turn), inertia(i, i), 1e-13 * inertia(2, 2));
  }
  EXPECT_NEAR(body.mass, m, 1e-14 * m);
  EXPECT_LE((body.first_moment - first).norm(), 1e-14 * first.norm());
  const Eigen::Matrix3d found =
      body.second_moment.trace() * Eigen::Matrix3d::Identity() - body.second_moment;
  EXPECT_LE(relative_difference(found, inertia), 1e-14);
}

/// A beam that spins about its axis has the polar inertia of its sections: without it a rod between
/// spherical joints could not be accelerated, and a mean axis not be found in space. Twist is a
/// spin of its own, so that frame and twist can share one.
TEST(BeamInvariants, WithoutRotaryInertiaKeepThePolarInertia) {
  const auto beam = uniform_beam(3, length, rectangle_section(width, height), young, density);
  const auto body =
      beam_invariants(beam, ElasticCoordinates(4, all_active), RotaryInertia::neglected);
  const double m = density * width * height * length;
  const double polar = m * (width * width + height * height) / 12;
  const Eigen::Matrix3d found =
      body.second_moment.trace() * Eigen::Matrix3d::Identity() - body.second_moment;
  const Eigen::Matrix3d expected =
      Eigen::Vector3d(polar, m * length * length / 3, m * length * length / 3).asDiagonal();
  EXPECT_LE((found - expected).norm(), 1e-14 * expected.norm());
  EXPECT_NEAR(found(0, 0), polar, 1e-12 * polar);
  const Eigen::VectorXd spin =
      rigid_motion(beam, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  EXPECT_NEAR(spin.dot(dense(body.pattern, body.mass_matrix) * spin), polar, 1e-13 * polar);
  const Eigen::VectorXd mixed = body.mixed * spin;  // ∫ρ (p₀ × S)ₓ
  EXPECT_NEAR(mixed(3 * 1 + 2) - mixed(3 * 2 + 1), polar, 1e-13 * polar);
}

TEST(BeamInvariants, CylinderHasTheInertiaTensorOfTheTextbook) {
  const double d = 0.04;
  const auto body = beam_invariants(uniform_beam(2, length, round_section(d, 0.0), young, density),
                                    ElasticCoordinates(3, all_active));
  const double m = density * std::numbers::pi * d * d / 4 * length, r = d / 2;
  const Eigen::Matrix3d inertia =
      body.second_moment.trace() * Eigen::Matrix3d::Identity() - body.second_moment;
  EXPECT_NEAR(inertia(0, 0), m * r * r / 2, 1e-13 * m * r * r);
  EXPECT_NEAR(inertia(1, 1), m * (length * length / 3 + r * r / 4), 1e-13 * m);
  EXPECT_NEAR(inertia(2, 2), inertia(1, 1), 1e-14 * m);
}

/// H_kl = ∫ρ p₀_k S_l: with q a rigid turn about i, ∫ρ p₀ (φ × p₀)ᵀ = J₀ φ̃ᵀ.
TEST(BeamInvariants, MixedMomentsTurnTheSecondMoment) {
  const auto beam = uniform_beam(3, length, rectangle_section(width, height), young, density);
  const auto body = beam_invariants(beam, ElasticCoordinates(4, all_active));
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    const Eigen::VectorXd flat = body.mixed * rigid_motion(beam, Eigen::Vector3d::Zero(), axis);
    Eigen::Matrix3d found, cross;
    for (int k = 0; k < 3; ++k) {
      cross.col(k) = axis.cross(Eigen::Vector3d::Unit(k));
      for (int l = 0; l < 3; ++l) found(k, l) = flat(3 * k + l);
    }
    EXPECT_LE((found - body.second_moment * cross.transpose()).norm(),
              1e-13 * body.second_moment.norm());
  }
}

TEST(BeamInvariants, MomentsAreTransposedByTheTransposedPair) {
  const auto beam = uniform_beam(2, length, rectangle_section(width, height), young, density);
  const auto body = beam_invariants(beam, tangent_coordinates(3, all_active));
  EXPECT_EQ(body.pairs.size(), 9U);
  for (std::size_t p = 0; p < body.pairs.size(); ++p) {
    for (std::size_t r = 0; r < body.pairs.size(); ++r) {
      if (body.pairs[p] != std::pair(body.pairs[r].second, body.pairs[r].first)) continue;
      const auto one = dense(body.pattern, Eigen::VectorXd(body.moments.col(static_cast<int>(p))));
      const auto two = dense(body.pattern, Eigen::VectorXd(body.moments.col(static_cast<int>(r))));
      EXPECT_LE((one - two.transpose()).norm(), 1e-15 * body.mass);
    }
  }
}

/// Six numbers of a beam with a section of each kind: length, E, ρ and up to two of the section.
template <class Scalar>
Beam<Scalar> beam_of(int kind, const std::array<Scalar, 5>& x) {
  const SectionProperties<Scalar> section =
      kind == 0 ? rectangle_section(x[3], x[4])
                : round_section<Scalar>(x[4], kind == 1 ? Scalar(0) : x[3]);
  Beam<Scalar> beam = uniform_beam(2, x[0], section, x[1], x[2]);
  beam.mass_damping = Scalar(3.0);
  beam.stiffness_damping = Scalar(1e-5);
  return beam;
}

class InvariantDerivatives : public testing::TestWithParam<int> {};

/// 1e-13: round-off of sums of some ten products.
TEST_P(InvariantDerivatives, OfDualNumbersAreThoseOfTheComplexStep) {
  using Complex = std::complex<double>;
  const double tiny = 1e-60;
  const std::array<double, 5> value = {length, young, density, width, height};
  for (std::size_t variable = 0; variable < 5; ++variable) {
    std::array<Complex, 5> step;
    std::array<Dual, 5> seeded;
    for (std::size_t i = 0; i < 5; ++i) {
      step[i] = Complex(value[i], i == variable ? tiny : 0.0);
      seeded[i] = Dual(value[i]);
      seeded[i].derivatives()[0] = i == variable ? 1.0 : 0.0;
    }
    const auto coordinates = chord_coordinates(3, all_active);
    const auto complex = beam_invariants(beam_of(GetParam(), step), coordinates);
    const auto dual = beam_invariants(beam_of(GetParam(), seeded), coordinates);
    const auto expect_same = [&](const auto& d, const auto& c, const char* what) {
      const Eigen::MatrixXd expected = c.imag() / tiny;
      EXPECT_LE(relative_difference(derivative_matrix(d), expected), 1e-13)
          << what << ", variable " << variable;
    };
    EXPECT_NEAR(derivative_of(dual.mass) * tiny, complex.mass.imag(),
                1e-13 * std::abs(complex.mass.imag()));
    expect_same(dual.first_moment, complex.first_moment, "first moment");
    expect_same(dual.second_moment, complex.second_moment, "second moment");
    expect_same(dual.shape, complex.shape, "shape");
    expect_same(dual.mixed, complex.mixed, "mixed");
    expect_same(dual.moments, complex.moments, "moments");
    expect_same(dual.mass_matrix, complex.mass_matrix, "mass");
    expect_same(dual.stiffness, complex.stiffness, "stiffness");
    expect_same(dual.damping, complex.damping, "damping");
  }
}

/// What is left out adds nothing, to the last digit: where one element changes, where those behind it
/// move with it, and where all do.
TEST(VariedInvariants, HaveTheDerivativeOfAll) {
  using Change = std::pair<const char*, void (*)(Beam<Dual>&, const Dual&)>;
  Dual factor(1.0);
  factor.derivatives()[0] = 0.7;
  for (const auto& [what, change] : std::initializer_list<Change>{
           {"area", [](Beam<Dual>&beam, const Dual&f) { beam.elements[2].section.area *= f; }},
           {"bending",
            [](Beam<Dual>&beam, const Dual&f) { beam.elements[2].section.inertia_z *= f; }},
           {"twist", [](Beam<Dual>&beam, const Dual&f) { beam.elements[2].section.torsion *= f; }},
           {"modulus", [](Beam<Dual>&beam, const Dual&f) { beam.elements[2].young *= f; }},
           {"density", [](Beam<Dual>&beam, const Dual&f) { beam.elements[2].density *= f; }},
           {"length", [](Beam<Dual>&beam, const Dual&f) { beam.elements[2].length *= f; }},
           {"damping", [](Beam<Dual>&beam, const Dual&f) { beam.stiffness_damping *= f; }}}) {
    Beam<Dual> beam = uniform_beam<Dual>(5, Dual(length), rectangle_section<Dual>(width, height),
                                         Dual(young), Dual(density));
    beam.mass_damping = 3.0;
    beam.stiffness_damping = 1e-5;
    change(beam, factor);
    const auto coordinates = chord_coordinates(6, all_active);
    const auto all = beam_invariants(beam, coordinates, RotaryInertia::included);
    const auto varied = varied_invariants(beam, coordinates, RotaryInertia::included);
    const auto expect_same = [&, name = what](const auto& found, const auto& expected) {
      EXPECT_EQ(derivative_matrix(found), derivative_matrix(expected)) << name;
    };
    EXPECT_EQ(derivative_of(varied.mass), derivative_of(all.mass)) << what;
    expect_same(varied.first_moment, all.first_moment);
    expect_same(varied.second_moment, all.second_moment);
    expect_same(varied.shape, all.shape);
    expect_same(varied.mixed, all.mixed);
    expect_same(varied.moments, all.moments);
    expect_same(varied.mass_matrix, all.mass_matrix);
    expect_same(varied.stiffness, all.stiffness);
    expect_same(varied.damping, all.damping);
    EXPECT_GT(derivative_matrix(varied.stiffness).norm() +
                  derivative_matrix(varied.damping).norm() + std::abs(derivative_of(varied.mass)),
              0.0)
        << what;
  }
}

std::string section_name(const testing::TestParamInfo<int>& kind) {
  return kind.param == 0 ? "Rectangle" : kind.param == 1 ? "Circle" : "Tube";
}
INSTANTIATE_TEST_SUITE_P(Sections, InvariantDerivatives, testing::Values(0, 1, 2), section_name);

TEST(BeamInvariants, DampingIsRayleighs) {
  Beam<double> beam = uniform_beam(2, length, rectangle_section(width, height), young, density);
  beam.mass_damping = 3.0;
  beam.stiffness_damping = 1e-5;
  const auto body = beam_invariants(beam, chord_coordinates(3, all_active));
  const Eigen::VectorXd expected = 3.0 * body.mass_matrix + 1e-5 * body.stiffness;
  EXPECT_LE(relative_difference(body.damping, expected), 1e-15);
}

}  // namespace
}  // namespace pleuel::test::invariants_test
