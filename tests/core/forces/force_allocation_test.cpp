#include "core/base/eager_matrices.hpp"
#include "tests/core/counted_allocations.hpp"
#include "tests/core/forces/force_samples.hpp"
#include "tests/support/test.hpp"

#ifdef PLEUEL_COUNTS_ALLOCATIONS
namespace pleuel::test::force_allocation_test {
namespace {

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
}  // namespace pleuel::test::force_allocation_test
#endif
