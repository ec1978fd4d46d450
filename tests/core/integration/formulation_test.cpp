#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::formulation_test {
namespace {

/// Largest |Φ| and |dΦ/dt| of a trajectory.
struct Drift {
  double position = 0.0, velocity = 0.0;
};

Drift drift_of(System& system, const Trajectory& trajectory) {
  Drift drift;
  State state;
  Eigen::VectorXd residual;
  const auto largest = [&](ConstraintLevel level) {
    system.residual(state, level, residual);
    return residual.tail(system.multipliers()).lpNorm<Eigen::Infinity>();
  };
  for (int step = 1; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    drift.position = std::max(drift.position, largest(ConstraintLevel::position));
    drift.velocity = std::max(drift.velocity, largest(ConstraintLevel::velocity));
  }
  return drift;
}

class Formulations : public testing::TestWithParam<int> {
 protected:
  Drift drift_with(const Formulation& formulation, double end_time = 0.1) {
    const SampleScene sample = all_samples()[GetParam()];
    Model model = sample.build();
    SimulationOptions options{end_time, 2e-4, 0.8};
    options.formulation = formulation;
    return drift_of(*model.mechanism.system, simulate(model.mechanism, options));
  }
};

/// Constraints that are equations of a step hold to what Newton's method leaves: 1e-10 of the
/// scale.
TEST_P(Formulations, KeepTheConstraintsThatTheyImpose) {
  const Drift index_3 = drift_with({});
  EXPECT_LE(index_3.position, 1e-10);
  const Drift stabilized = drift_with({ConstraintForm::stabilized_index_2});
  EXPECT_LE(stabilized.position, 1e-10);
  EXPECT_LE(stabilized.velocity, 1e-7);
}

/// A projection leaves round-off of both. Measured 4e-14 and 3e-12 at worst.
TEST_P(Formulations, OfIndexOneKeepAllConstraintsByProjection) {
  const Drift projected = drift_with({ConstraintForm::index_1, 0.0, true});
  EXPECT_LE(projected.position, 1e-12);
  EXPECT_LE(projected.velocity, 1e-10);
}

/// Without stabilization positions drift; Baumgarte's terms hold them back.
TEST_P(Formulations, OfIndexOneDriftUnlessStabilized) {
  const Drift free = drift_with({ConstraintForm::index_1});
  const Drift held = drift_with({ConstraintForm::index_1, 200.0});
  EXPECT_GE(free.position, 1e-9);
  EXPECT_LE(held.position, 0.5 * free.position);
}

INSTANTIATE_TEST_SUITE_P(Samples, Formulations, testing::Range(0, sample_count),
                         [](const auto& test) { return all_samples()[test.param].name; });

}  // namespace
}  // namespace pleuel::test::formulation_test
