#include <Eigen/Core>
#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/sample_beams.hpp"

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

}  // namespace
}  // namespace pleuel::test::statics_test
