#include "core/jobs/parallel.hpp"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace pleuel::test::parallel_test {
namespace {

TEST(ParallelWork, IsDoneOnceEach) {
  for (int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> calls(50);
    for_each_in_parallel(50, threads, [&](int i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelWork, PassesOnTheFirstFailure) {
  for (int threads : {1, 4}) {
    try {
      for_each_in_parallel(20, threads, [](int i) {
        if (i >= 3) throw std::runtime_error(std::to_string(i));
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3");
    }
  }
}

TEST(ParallelWork, MayBeNone) {
  for_each_in_parallel(0, 4, [](int) { FAIL(); });
}

}  // namespace
}  // namespace pleuel::test::parallel_test
