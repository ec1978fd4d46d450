#include <atomic>
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/integration/simulate.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"

// Counts every allocation of this executable: the allocator of the C library stands behind
// operator new, Eigen and KLU alike. (Sanitizers bring their own.)
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define PLEUEL_COUNTS_ALLOCATIONS
namespace {
std::atomic<long> allocations{0};
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT: names of the C library
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* pointer, std::size_t size) {
  ++allocations;
  return __libc_realloc(pointer, size);
}
}
#endif

namespace {

using namespace pleuel;

#ifdef PLEUEL_COUNTS_ALLOCATIONS

long allocations_of(const SampleScene& sample, int steps, const Formulation& formulation) {
  Model model = sample.build();
  SimulationOptions options{steps * 2e-5, 2e-5, 0.8};
  options.formulation = formulation;
  const long before = allocations;
  const Trajectory trajectory = simulate(model.mechanism, options);
  EXPECT_EQ(trajectory.steps(), steps);
  return allocations - before;
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
  const long before = allocations;
  std::vector<double> block(1000);
  block[0] = 1.0;
  EXPECT_GT(allocations, before);
}

INSTANTIATE_TEST_SUITE_P(Samples, TimeLoop, testing::Range(0, sample_count), sample_name);

#endif

}  // namespace
