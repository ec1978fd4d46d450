#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reduction/reduce.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/temporary_folder.hpp"

/// Points of stress in groups that responses can name.
namespace pleuel::test::stress_groups_test {
namespace {

ReducedBody with_groups(const std::string& more) {
  const TemporaryFolder folder;
  const Block block;
  const auto path = write_block_model(folder.path(), block, make_block(block), "rigid",
                                      R"(, "modes": 0, "stress": {"nodes": {
                             "top": {"box": [[0.1, 0.02, -1], [0.3, 0.02, 1]]},
                             "middle": {"box": [[0.2, -1, -1], [0.2, 1, 1]]}},
                             "strength": 3e8, "endurance_limit": 1e8)" +
                                          more + "}");
  return reduce(read_reduction_model(path.string()));
}

/// The three corners on the top in the middle are in both: 5 × 3 and 3 × 3 nodes.
TEST(StressGroups, ShareTheirPoints) {
  const StressRecovery stress = *with_groups("").file.constants.stress;
  ASSERT_EQ(stress.groups.size(), 2U);
  EXPECT_EQ(stress.groups[0].name, "top");
  EXPECT_EQ(named_points(stress, "top").size(), 15U);
  EXPECT_EQ(named_points(stress, "middle").size(), 9U);
  EXPECT_EQ(stress.points.size(), 21U);
  EXPECT_EQ(stress.strengths.endurance_limit, 1e8);
}

TEST(StressGroups, KeepThePointsOfEachThatCanBeLargest) {
  const StressRecovery stress = *with_groups(", \"most\": 4").file.constants.stress;
  for (const char* name : {"top", "middle"}) {
    EXPECT_FALSE(named_points(stress, name).empty()) << name;
    EXPECT_LE(named_points(stress, name).size(), 4U) << name;
  }
}

}  // namespace
}  // namespace pleuel::test::stress_groups_test
