#include "picture/thinned.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel::test::thinned_test {
namespace {

TEST(Thinned, KeepsThePeaksOfEveryStretch) {
  Eigen::VectorXd values(10000);
  for (Eigen::Index i = 0; i < values.size(); ++i) values(i) = std::sin(0.7 * double(i));
  values(1234) = 5.0;  // one instant only
  values(8765) = -6.0;
  const std::vector<int> kept = thinned(values, 400, {4321});
  EXPECT_LE(kept.size(), 400 + 3);  // two a stretch, both ends, and the one that must be there
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const int index : {0, 1234, 4321, 8765, 9999}) {
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), index)) << index;
  }
}

TEST(Thinned, LeavesShortCurvesAsTheyAre) {
  EXPECT_EQ(thinned(Eigen::Vector4d(3, 1, 2, 0), 10), (std::vector<int>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace pleuel::test::thinned_test
