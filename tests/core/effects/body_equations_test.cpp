#include <complex>
#include <random>

#include "core/base/eager_matrices.hpp"
#include "core/effects/floating_frame_body.hpp"
#include "core/effects/general_body_equations.hpp"
#include "core/effects/make_body_equations.hpp"
#include "core/effects/planar_body_equations.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_beams.hpp"
#include "tests/support/test.hpp"

/// The equations for special motions are those for any motion.

namespace pleuel::test::body_equations_test {
namespace {

constexpr Weights weights{.q = 0.7, .v = -1.3, .a = 0.4};

Eigen::VectorXd random_vector(Eigen::Index size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
}

/// A frame that turns about an oblique axis and moves in so many directions, the third out of the
/// plane; its reference is any rotation.
BodyFrame turning_frame(int translations) {
  BodyFrame frame;
  frame.rotation = RotationCoordinates::angle;
  frame.axis = Eigen::Vector3d(0.36, 0.48, 0.8);
  frame.reference =
      Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, -2).normalized()).toRotationMatrix();
  Eigen::Matrix3d directions;
  directions << Eigen::Vector3d(0.8, -0.6, 0.0), frame.axis.cross(Eigen::Vector3d(0.8, -0.6, 0.0)),
      frame.axis;
  frame.basis = directions.leftCols(translations);
  return frame;
}

struct Case {
  const char* name;
  int translations;
  int elements;
  bool is_spatial;  ///< elastic coordinates out of the plane, and twist, too
};

class EquationsInAPlane : public testing::TestWithParam<Case> {
 protected:
  EquationsInAPlane() {
    const Case& c = GetParam();
    frame_ = turning_frame(c.translations);
    if (c.elements == 0) {
      const Eigen::Matrix3d half = random_vector(9, 5).reshaped(3, 3);
      body_ = rigid_invariants<double>(3.7, random_vector(3, 4), half * half.transpose());
    } else {
      auto beam = uniform_beam(c.elements, 0.6, rectangle_section(0.05, 0.08), 2.1e11, 7850.0);
      beam.elements.front().length = 0.23;
      beam.stiffness_damping = 1e-5;
      NodalFlags active = all_active;
      if (!c.is_spatial) active = {true, true, false, false, false, true};
      body_ = beam_invariants(beam, tangent_coordinates(c.elements + 1, active));
    }
    const Eigen::Index size = frame_.size() + body_.size();
    Eigen::VectorXd q = random_vector(size, 1);
    q.tail(body_.size()) *= 1e-3;  // elastic forces do not hide those of inertia
    set_body_motion(frame_, {3.0, -9.81, 2.0}, q, random_vector(size, 2),
                    100.0 * random_vector(size, 3), motion_);
  }

  void expect_same(BodyEquations& found, BodyEquations& expected) {
    const Eigen::Index size = frame_.size() + body_.size();
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(size), expected_forces = forces;
    EntryList entries;
    declare_body_entries(frame_, body_.pattern, entries);
    Eigen::VectorXd tangent(entries.size()), expected_tangent(entries.size());
    found.evaluate(motion_);
    expected.evaluate(motion_);
    found.add_forces(motion_, forces);
    expected.add_forces(motion_, expected_forces);
    EXPECT_LE(relative_difference(forces, expected_forces), 1e-14);
    for (const Weights& w : {weights, Weights{.q = 1.0}, Weights{.v = 1.0}, Weights{.a = 1.0}}) {
      found.write_tangent(motion_, w, tangent.data());
      expected.write_tangent(motion_, w, expected_tangent.data());
      EXPECT_LE(relative_difference(tangent, expected_tangent), 1e-14) << w.q << w.v << w.a;
    }
  }

  BodyFrame frame_;
  Invariants<double> body_;
  BodyMotion motion_;
};

// Round-off of sums of some ten products, relative to the largest entry.

TEST_P(EquationsInAPlane, AreThoseOfAnyMotion) {
  PlanarBodyEquations planar(frame_, body_);
  GeneralBodyEquations general(frame_, body_);
  expect_same(planar, general);
}

/// Invariants are taken for a derivative of invariants.
TEST_P(EquationsInAPlane, HaveTheForcesOfADerivative) {
  PlanarDerivativeForces planar(frame_, body_);
  GeneralDerivativeForces general(frame_, body_);
  Eigen::VectorXd found, expected;
  planar.set_forces(motion_, motion_, found);
  general.set_forces(motion_, motion_, expected);
  EXPECT_LE(relative_difference(found, expected), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, EquationsInAPlane,
    testing::Values(Case{"PlanarBeam", 2, 3, false}, Case{"SpatialBeam", 2, 2, true},
                    Case{"BeamThatOnlyTurns", 0, 2, false}, Case{"BeamOnASlide", 1, 2, true},
                    Case{"BeamThatLeavesThePlane", 3, 2, true}, Case{"RigidBody", 2, 0, false}),
    [](const auto& test) { return test.param.name; });

using EquationsOfATranslation = EquationsInAPlane;

TEST_P(EquationsOfATranslation, AreThoseOfAnyMotion) {
  frame_.rotation = RotationCoordinates::none;
  const Eigen::Index size = frame_.size();
  set_body_motion(frame_, {3.0, -9.81, 2.0}, random_vector(size, 1), random_vector(size, 2),
                  random_vector(size, 3), motion_);
  TranslatingBodyEquations translating(frame_, body_.mass);
  GeneralBodyEquations general(frame_, body_);
  expect_same(translating, general);
}

INSTANTIATE_TEST_SUITE_P(Bodies, EquationsOfATranslation,
                         testing::Values(Case{"InSpace", 3, 0, false},
                                         Case{"InAPlane", 2, 0, false},
                                         Case{"OnALine", 1, 0, false}),
                         [](const auto& test) { return test.param.name; });

using Complex = std::complex<double>;
using VectorXc = Eigen::VectorXcd;
using Vector3c = Eigen::Vector3cd;
using Matrix3c = Eigen::Matrix3cd;

/// A body as a cloud of particles: the kinetic energy written from position and velocity of each,
/// knowing nothing of invariants. The particles stand at the points of quadrature rules that are
/// exact for the polynomials of a beam element, so that the cloud has the energy of the solid body.
class Cloud {
 public:
  /// A rectangular beam; coordinates in the order frame, then those that are active.
  Cloud(const Beam<double>& beam, double width, double height,
        const ElasticCoordinates& coordinates, const BodyFrame& frame)
      : coordinates_(coordinates), frame_(frame) {
    // Gauss–Legendre, five points (Abramowitz & Stegun 25.4.30): exact to degree nine.
    const double inner = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3;
    const double outer = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
    const double w_in = (322 + 13 * std::sqrt(70.0)) / 900,
                 w_out = (322 - 13 * std::sqrt(70.0)) / 900;
    const double point[] = {-outer, -inner, 0.0, inner, outer};
    const double weight[] = {w_out, w_in, 128.0 / 225, w_in, w_out};
    const double corner = 1 / std::sqrt(3.0);  // two points: exact to degree three
    for (int e = 0; e < static_cast<int>(beam.elements.size()); ++e) {
      const auto& element = beam.elements[e];
      for (int i = 0; i < 5; ++i) {
        for (double y : {-corner, corner}) {
          for (double z : {-corner, corner}) {
            const double mass = element.density * width * height * element.length * weight[i] / 8;
            particles_.push_back({mass, e, beam.node_position(e), element.length,
                                  (point[i] + 1) / 2 * element.length, y * height / 2,
                                  z * width / 2});
          }
        }
      }
    }
  }

  /// T + ∫ρ g·r at coordinates q with rates v.
  Complex lagrangian(const VectorXc& q, const VectorXc& v, const Eigen::Vector3d& gravity) const {
    Vector3c r, r_dot;
    Matrix3c a, a_dot;
    move_frame(q, v, r, r_dot, a, a_dot);
    Complex sum = 0.0;
    for (const Particle& particle : particles_) {
      Vector3c p = displacement(particle, q);
      p += Vector3c(Complex(particle.start + particle.x), Complex(particle.y), Complex(particle.z));
      const Vector3c velocity = r_dot + a_dot * p + a * displacement(particle, v);
      const Vector3c position = r + a * p;
      for (int i = 0; i < 3; ++i) {
        sum += particle.mass * (0.5 * velocity(i) * velocity(i) + gravity(i) * position(i));
      }
    }
    return sum;
  }

  int size() const { return frame_.size() + coordinates_.size(); }

 private:
  struct Particle {
    double mass;
    int element;
    double start, length, x, y, z;
  };

  /// Bernoulli's hypothesis, with cubic deflections as polynomials in x.
  Vector3c displacement(const Particle& particle, const VectorXc& q) const {
    Complex n[12];
    for (int i = 0; i < 12; ++i) {
      const int index = coordinates_.index(particle.element + i / 6, i % 6);
      n[i] = index < 0 ? Complex(0.0) : q(frame_.size() + index);
    }
    const double x = particle.x, l = particle.length;
    const auto cubic = [&](Complex w1, Complex s1, Complex w2, Complex s2, Complex& slope) {
      const Complex c2 = 3.0 * (w2 - w1) / (l * l) - (2.0 * s1 + s2) / l;
      const Complex c3 = 2.0 * (w1 - w2) / (l * l * l) + (s1 + s2) / (l * l);
      slope = s1 + 2.0 * c2 * x + 3.0 * c3 * x * x;
      return w1 + s1 * x + c2 * x * x + c3 * x * x * x;
    };
    Complex v_slope, w_slope;
    const Complex v = cubic(n[1], n[5], n[7], n[11], v_slope);
    const Complex w = cubic(n[2], -n[4], n[8], -n[10], w_slope);
    const Complex u = n[0] + (n[6] - n[0]) * x / l, twist = n[3] + (n[9] - n[3]) * x / l;
    return {u - particle.y * v_slope - particle.z * w_slope, v - particle.z * twist,
            w + particle.y * twist};
  }

  void move_frame(const VectorXc& q, const VectorXc& v, Vector3c& r, Vector3c& r_dot, Matrix3c& a,
                  Matrix3c& a_dot) const {
    const int k = frame_.translations();
    r = frame_.origin.cast<Complex>() + frame_.basis.cast<Complex>() * q.head(k);
    r_dot = frame_.basis.cast<Complex>() * v.head(k);
    // Ȧ by the complex step would clash with the one in use: A is quadratic or harmonic.
    if (frame_.rotation == RotationCoordinates::angle) {
      const Eigen::Vector3d n = frame_.axis;
      Eigen::Matrix3d cross;
      cross << 0, -n(2), n(1), n(2), 0, -n(0), -n(1), n(0), 0;
      const Matrix3c c = cross.cast<Complex>(), cc = (cross * cross).cast<Complex>();
      const Matrix3c reference = frame_.reference.cast<Complex>();
      a = (Matrix3c::Identity() + std::sin(q(k)) * c + (1.0 - std::cos(q(k))) * cc) * reference;
      a_dot = v(k) * (std::cos(q(k)) * c + std::sin(q(k)) * cc) * reference;
      return;
    }
    // Lagrange's coordinates are those of A = A₀ exp(ε̃) about ε = 0, the imaginary part of q. There
    // ε̇ = ω, ε̈ = ω̇ and ω = (I − ½ ε̃) ε̇ to first order, which is all that complex steps see.
    const Eigen::Vector3d psi = q.segment<3>(k).real();
    const Vector3c epsilon = q.segment<3>(k) - psi.cast<Complex>(), rate = v.segment<3>(k);
    const Matrix3c start =
        Eigen::AngleAxisd(psi.norm(), psi.normalized()).toRotationMatrix().cast<Complex>();
    const auto tilde = [](const Vector3c& w) {
      Matrix3c matrix;
      matrix << 0.0, -w(2), w(1), w(2), 0.0, -w(0), -w(1), w(0), 0.0;
      return matrix;
    };
    a = start * (Matrix3c::Identity() + tilde(epsilon));
    a_dot = a * tilde(rate - 0.5 * tilde(epsilon) * rate);
  }

  ElasticCoordinates coordinates_;
  BodyFrame frame_;
  std::vector<Particle> particles_;
};

/// d/dt ∂L/∂v − ∂L/∂q along (q, v, a): L is quadratic in v, so that L(v + e) − L(v − e) is twice
/// its derivative; the derivatives in time and in q are complex steps. No truncation error
/// anywhere.
Eigen::VectorXd lagrange_equations(const Cloud& cloud, const State& state,
                                   const Eigen::Vector3d& gravity) {
  const double tiny = 1e-30;
  const int n = cloud.size();
  Eigen::VectorXd result(n);
  const VectorXc q = state.q.cast<Complex>(), v = state.v.cast<Complex>();
  const VectorXc q_ahead = q + Complex(0, tiny) * state.v.cast<Complex>();
  const VectorXc v_ahead = v + Complex(0, tiny) * state.a.cast<Complex>();
  for (int i = 0; i < n; ++i) {
    const VectorXc unit = VectorXc::Unit(n, i);
    const Complex momentum = 0.5 * (cloud.lagrangian(q_ahead, v_ahead + unit, gravity) -
                                    cloud.lagrangian(q_ahead, v_ahead - unit, gravity));
    const Complex force = cloud.lagrangian(q + Complex(0, tiny) * unit, v, gravity);
    result(i) = (momentum.imag() - force.imag()) / tiny;
  }
  return result;
}

/// ∂²T/∂v_i∂v_j, exactly, T being a quadratic form.
Eigen::MatrixXd energy_mass_matrix(const Cloud& cloud, const State& state) {
  const int n = cloud.size();
  const VectorXc q = state.q.cast<Complex>();
  const auto energy = [&](const VectorXc& v) {
    return cloud.lagrangian(q, v, Eigen::Vector3d::Zero()).real();
  };
  Eigen::MatrixXd mass(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const VectorXc a = VectorXc::Unit(n, i), b = VectorXc::Unit(n, j);
      mass(i, j) = 0.5 * (energy(a + b) - energy(a - b));
    }
  }
  return mass;
}

struct LagrangeCase {
  std::string name;
  bool is_spatial, is_chord;
  int elements;
};

class LagrangesEquations : public testing::TestWithParam<LagrangeCase> {
 protected:
  static constexpr double width_ = 0.05, height_ = 0.08;  // stout: rotary inertia counts

  LagrangesEquations() {
    const LagrangeCase& c = GetParam();
    // Without stiffness; the elements differ, so that nothing cancels by symmetry.
    beam_ = uniform_beam(c.elements, 0.6, rectangle_section(width_, height_), 0.0, 7850.0);
    beam_.elements.front().length = 0.23;
    frame_.offset = 0;
    if (c.is_spatial) {
      frame_.rotation = RotationCoordinates::rotation_vector;
    } else {
      frame_.rotation = RotationCoordinates::angle;
      frame_.axis = Eigen::Vector3d(0.36, 0.48, 0.8);
      frame_.basis.resize(3, 2);
      frame_.basis.col(0) = Eigen::Vector3d(0.8, -0.6, 0.0);
      frame_.basis.col(1) = frame_.axis.cross(Eigen::Vector3d(0.8, -0.6, 0.0));
      frame_.reference.col(0) = frame_.basis.col(0);
      frame_.reference.col(1) = frame_.basis.col(1);
      frame_.reference.col(2) = frame_.axis;
      frame_.origin = 0.3 * frame_.axis;
    }
    NodalFlags active = all_active;
    if (!c.is_spatial) active = {true, true, false, false, false, true};
    coordinates_ = c.is_chord ? chord_coordinates(c.elements + 1, active)
                              : tangent_coordinates(c.elements + 1, active);
    set_random_state();
  }

  void set_random_state() {
    const int n = frame_.size() + coordinates_.size();
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    state_ = State(n, 0);
    for (auto* part : {&state_.q, &state_.v, &state_.a}) {
      for (double& entry : *part) entry = uniform(random);
    }
    state_.q.tail(coordinates_.size()) *= 0.1;
  }

  FloatingFrameBody body(const Eigen::Vector3d& gravity) const {
    return {"beam", frame_, beam_invariants(beam_, coordinates_), {}, gravity};
  }
  Cloud cloud() const { return {beam_, width_, height_, coordinates_, frame_}; }

  Beam<double> beam_;
  BodyFrame frame_;
  ElasticCoordinates coordinates_{0, all_active};
  State state_;
};

// Round-off of sums over some hundred particles: 1e-13.

TEST_P(LagrangesEquations, HoldForTheResidualOfAFreeBody) {
  FloatingFrameBody term = body(Eigen::Vector3d::Zero());
  const Eigen::VectorXd found = residual_of(term, state_, ConstraintLevel::position);
  const Eigen::VectorXd expected = lagrange_equations(cloud(), state_, Eigen::Vector3d::Zero());
  EXPECT_LE(relative_difference(found, expected), 1e-12);
}

TEST_P(LagrangesEquations, HoldForTheResidualUnderGravity) {
  const Eigen::Vector3d gravity(20, -98.1, 40);
  FloatingFrameBody term = body(gravity);
  const Eigen::VectorXd found = residual_of(term, state_, ConstraintLevel::position);
  const Eigen::VectorXd expected = lagrange_equations(cloud(), state_, gravity);
  EXPECT_LE(relative_difference(found, expected), 1e-12);
}

TEST_P(LagrangesEquations, HaveTheMassMatrixOfTheKineticEnergy) {
  FloatingFrameBody term = body(Eigen::Vector3d::Zero());
  const Eigen::MatrixXd found = tangent_of(term, state_, {.a = 1.0}, ConstraintLevel::position);
  const Eigen::MatrixXd expected = energy_mass_matrix(cloud(), state_);
  EXPECT_LE(relative_difference(found, expected), 1e-12);
  EXPECT_LE(relative_difference(found, found.transpose()), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Bodies, LagrangesEquations,
                         testing::Values(LagrangeCase{"PlanarTangent", false, false, 3},
                                         LagrangeCase{"PlanarChord", false, true, 3},
                                         LagrangeCase{"SpatialTangent", true, false, 2},
                                         LagrangeCase{"SpatialChord", true, true, 2}),
                         [](const auto& test) { return test.param.name; });

/// K q + D q̇ is all that elasticity adds.
TEST(FloatingFrameBody, AddsStiffnessAndDampingTimesTheElasticCoordinates) {
  const auto coordinates = tangent_coordinates(3, all_active);
  auto beam = uniform_beam(2, 0.6, rectangle_section(0.05, 0.08), 2.1e11, 7850.0);
  beam.stiffness_damping = 1e-5;
  const auto stiff = beam_invariants(beam, coordinates);
  for (auto& element : beam.elements) element.young = element.shear = 0.0;
  BodyFrame frame;
  frame.rotation = RotationCoordinates::rotation_vector;
  FloatingFrameBody with("beam", frame, stiff, {}, Eigen::Vector3d::Zero());
  FloatingFrameBody without("beam", frame, beam_invariants(beam, coordinates), {},
                            Eigen::Vector3d::Zero());
  State state(6 + coordinates.size(), 0);
  state.q = Eigen::VectorXd::LinSpaced(state.q.size(), 1e-3, 5e-3);
  state.v = Eigen::VectorXd::LinSpaced(state.q.size(), -1.0, 2.0);
  const Eigen::VectorXd difference = residual_of(with, state, ConstraintLevel::position) -
                                     residual_of(without, state, ConstraintLevel::position);
  const Eigen::VectorXd expected =
      dense(stiff.pattern, stiff.stiffness) *
      (state.q.tail(coordinates.size()) + 1e-5 * state.v.tail(coordinates.size()));
  EXPECT_LE(difference.head(6).norm(), 1e-9 * expected.norm());
  EXPECT_LE(relative_difference(difference.tail(coordinates.size()), expected), 1e-12);
}

}  // namespace
}  // namespace pleuel::test::body_equations_test
