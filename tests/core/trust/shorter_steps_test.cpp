#include <algorithm>

#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/trust/sudden_jumps.hpp"

namespace pleuel::test::shorter_steps_test {
namespace {

using testing::ElementsAre;

Trajectory with_steps_of_one() {
  Trajectory trajectory;
  trajectory.time = Eigen::VectorXd::LinSpaced(11, 0.0, 10.0);
  return trajectory;
}

TEST(ShorterSteps, OfNoneAreThoseOfTheTrajectory) {
  EXPECT_THAT(instants_with(with_steps_of_one(), {}),
              ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
}

/// Short from the jump at 2 to 2.5, with one before it; then no step is 1.3 times as long as the
/// last.
TEST(ShorterSteps, AreShortBehindTheJumpAndGrowSlowly) {
  const Trajectory trajectory = with_steps_of_one();
  const std::vector<double> found = instants_with(trajectory, {{2.0, 2.5, 0.1}});
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  for (const double time : trajectory.time) EXPECT_TRUE(std::ranges::count(found, time)) << time;
  const auto jump = std::ranges::find(found, 2.0);
  EXPECT_NEAR(*(jump - 1), 1.9, 1e-12);
  EXPECT_EQ(*(jump - 2), 1.0);
  for (auto at = jump; at + 1 != found.end(); ++at) {
    const double step = *(at + 1) - *at;
    EXPECT_LE(step, *at < 2.5 ? 0.1 + 1e-12 : 1.0) << *at;
    EXPECT_LE(step, 1.3 * (*at - *(at - 1))) << *at;
  }
  EXPECT_EQ(found.back(), 10.0);
  EXPECT_LT(found.size(), 50u);
}

/// The first instant has no step before it.
TEST(ShorterSteps, BeginWithTheTrajectory) {
  const std::vector<double> found = instants_with(with_steps_of_one(), {{0.0, 0.5, 0.25}});
  EXPECT_EQ(found[0], 0.0);
  EXPECT_EQ(found[1], 0.25);
}

}  // namespace
}  // namespace pleuel::test::shorter_steps_test
