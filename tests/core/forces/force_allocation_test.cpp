#include <atomic>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/core/forces/force_samples.hpp"

// Counts every allocation of this executable; see tests/core/integration/allocation_test.cpp.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
namespace {
std::atomic<long> allocations{0};
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT: name of the C library

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}

namespace {

using namespace pleuel;

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
  const long before = allocations;
  term->add_residual(state, ConstraintLevel::position, residual);
  term->linearize(state, weights, ConstraintLevel::position, residual,
                  {values.data(), static_cast<std::ptrdiff_t>(entries.size())});
  term->add_design_derivative(state, ConstraintLevel::position, columns);
  EXPECT_EQ(allocations - before, 0);
  std::vector<double>(1000).swap(values);
  EXPECT_GT(allocations - before, 0) << "the counter does not count";
}

INSTANTIATE_TEST_SUITE_P(Forces, ForceTermMemory, testing::ValuesIn(force_samples(Choice::all)),
                         [](const auto& test) { return test.param.name; });

}  // namespace
#endif
