#include <random>

#include "core/base/eager_matrices.hpp"
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

}  // namespace
}  // namespace pleuel::test::body_equations_test
