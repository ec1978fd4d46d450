#include <cmath>

#include <gtest/gtest.h>

#include "core/integration/checkpointed_loop.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::checkpoint_plan_test {
namespace {

constexpr double state_bytes = 800.0, checkpoint_bytes = 1100.0;

class PlanOfCheckpoints : public testing::TestWithParam<int> {};

/// With the least memory: K L states are enough, both halves are kept, and stretches cover all.
TEST_P(PlanOfCheckpoints, HoldsSoManyStatesWithTheLeastMemory) {
  const int states = GetParam();
  CheckpointPlan plan{state_bytes, checkpoint_bytes, 0.0};
  plan.memory = plan.least_memory(states);
  EXPECT_GE(plan.most_states(), states);
  EXPECT_LE(plan.most_checkpoints() * checkpoint_bytes, 0.5 * plan.memory);
  EXPECT_LE((plan.longest_stretch() + 1) * state_bytes, 0.5 * plan.memory);
  const int stretch = plan.stretch_for(states);
  EXPECT_LE(stretch, plan.longest_stretch());
  EXPECT_GE(static_cast<double>(stretch) * plan.most_checkpoints(), states);
}

/// Two halves of memory M hold K L = (M/2c)(M/2s) states: M = 2 √(states s c) at least.
TEST_P(PlanOfCheckpoints, NeedsTheRootOfTheStates) {
  const int states = GetParam();
  CheckpointPlan plan{state_bytes, checkpoint_bytes, 0.0};
  plan.memory = 2.0 * std::sqrt(states * state_bytes * checkpoint_bytes) * (1 - 1e-12);
  EXPECT_LT(plan.most_states(), states);
}

INSTANTIATE_TEST_SUITE_P(States, PlanOfCheckpoints,
                         testing::Values(2, 3, 10, 1000, 123'457, 20'000'000), named_by_value());

TEST(CheckpointPlan, HoldsAllStatesWhereTheyFit) {
  const CheckpointPlan plan{state_bytes, checkpoint_bytes, 8000.0};
  EXPECT_TRUE(plan.holds(10));
  EXPECT_FALSE(plan.holds(11));
}

TEST(CheckpointPlan, HasNoCheckpointsWithoutMemory) {
  const CheckpointPlan plan{state_bytes, checkpoint_bytes, 100.0};
  EXPECT_EQ(plan.most_checkpoints(), 0);
  EXPECT_EQ(plan.longest_stretch(), 0);
  EXPECT_EQ(plan.most_states(), 0);
}

}  // namespace
}  // namespace pleuel::test::checkpoint_plan_test
