#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/integration/simulate.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

/// A flexible slider-crank in bending that is soft enough for steps in the asymptotic range, driven
/// smoothly from rest: no initial transient, nothing but the order of the scheme.
class SchemeOrder : public testing::Test {
 protected:
  static constexpr double end_time = 0.06;

  struct End {
    Eigen::VectorXd q, v, lambda;
  };

  static End simulate_with(double step, double spectral_radius) {
    const SampleScene sample = smooth_planar_sample();
    Model model = sample.build();
    SimulationOptions options{end_time, step, spectral_radius};
    options.newton_tolerance = 1e-14;
    const Trajectory trajectory = simulate(model.mechanism, options);
    const int last = trajectory.steps();
    return {trajectory.q.col(last), trajectory.v.col(last), trajectory.lambda.col(last)};
  }

  struct Orders {
    double q, v, lambda;
  };
  /// Against half the step: round-off of λ, which grows as h⁻², spoils a much finer reference.
  static Orders observe(double spectral_radius) {
    std::vector<double> steps, q, v, lambda;
    for (int n : {1500, 2121, 3000}) {
      const End end = simulate_with(end_time / n, spectral_radius);
      const End fine = simulate_with(end_time / (2 * n), spectral_radius);
      steps.push_back(end_time / n);
      q.push_back((end.q - fine.q).norm());
      v.push_back((end.v - fine.v).norm());
      lambda.push_back((end.lambda - fine.lambda).norm());
    }
    return {observed_order(steps, q), observed_order(steps, v), observed_order(steps, lambda)};
  }
};

class DampedSchemeOrder : public SchemeOrder, public testing::WithParamInterface<double> {};

TEST_P(DampedSchemeOrder, PositionsVelocitiesAndMultipliersAreOfSecondOrder) {
  const Orders orders = observe(GetParam());
  EXPECT_NEAR(orders.q, 2.0, 0.1);
  EXPECT_NEAR(orders.v, 2.0, 0.1);
  // Arnold & Brüls 2007 prove second order for λ, too, after a smooth start. Weakly damped parts of
  // it fall faster (2.16 at ρ∞ = 0.9).
  EXPECT_GE(orders.lambda, 1.9);
}

/// ρ∞ = 1 keeps for ever what round-off and the start leave in λ, and little by little in v.
TEST_F(SchemeOrder, IsLostByTheMultipliersWithoutNumericalDamping) {
  const Orders orders = observe(1.0);
  EXPECT_NEAR(orders.q, 2.0, 0.1);
  EXPECT_LT(orders.lambda, 0.5);  // measured: 0.00
}

INSTANTIATE_TEST_SUITE_P(SpectralRadii, DampedSchemeOrder, testing::Values(0.0, 0.5, 0.8, 0.9));

}  // namespace
