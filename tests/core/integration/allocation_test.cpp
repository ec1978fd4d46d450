#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "tests/core/counted_allocations.hpp"
#include "tests/core/forces/force_samples.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

#ifdef PLEUEL_COUNTS_ALLOCATIONS
namespace pleuel::test::allocation_test {
namespace {

long allocations_of(const SampleScene& sample, int steps, const Formulation& formulation) {
  Model model = sample.build();
  SimulationOptions options{steps * 2e-5, 2e-5, 0.8};
  options.formulation = formulation;
  const long before = allocations();
  const Trajectory trajectory = simulate(model.mechanism, options);
  EXPECT_EQ(trajectory.steps(), steps);
  return allocations() - before;
}

class TimeLoop : public testing::TestWithParam<int> {};

/// The storage of the trajectory is one block whatever its length. KLU may choose pivots anew,
/// which allocates a handful of blocks, but not in these few steps.
TEST_P(TimeLoop, AllocatesNothing) {
  const SampleScene sample = all_samples()[GetParam()];
  for (const Formulation& formulation :
       {Formulation{}, Formulation{ConstraintForm::index_1, 0.0, true}}) {
    EXPECT_EQ(allocations_of(sample, 100, formulation), allocations_of(sample, 50, formulation));
  }
}

TEST(TimeLoop, IsWatchedByACounterThatCounts) {
  const long before = allocations();
  std::vector<double> block(1000);
  block[0] = 1.0;
  EXPECT_GT(allocations(), before);
}

INSTANTIATE_TEST_SUITE_P(Samples, TimeLoop, testing::Range(0, sample_count), sample_name);

class ForceTermMemory : public testing::TestWithParam<ForceSample> {};

TEST_P(ForceTermMemory, IsAllocatedAtConstruction) {
  const auto term = GetParam().make();
  const State state = GetParam().random_state();
  EntryList entries;
  term->declare_entries(entries);
  std::vector<double> values(2 * entries.size());
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(state.q.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(state.q.size(), GetParam().numbers);
  const std::array<Weights, 2> weights = {Weights{1.0, 2.0, 3.0}, Weights{0.0, 1.0, 0.0}};
  const long before = allocations();
  term->add_residual(state, ConstraintLevel::position, residual);
  term->linearize(state, weights, ConstraintLevel::position, residual,
                  {values.data(), static_cast<std::ptrdiff_t>(entries.size())});
  term->add_design_derivative(state, ConstraintLevel::position, columns);
  EXPECT_EQ(allocations() - before, 0);
  std::vector<double>(1000).swap(values);
  EXPECT_GT(allocations() - before, 0) << "the counter does not count";
}

INSTANTIATE_TEST_SUITE_P(Forces, ForceTermMemory,
                         testing::ValuesIn(force_samples(ForceChoice::all)),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pleuel::test::allocation_test
#endif
