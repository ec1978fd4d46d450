#include "core/base/eager_matrices.hpp"
#include "core/integration/checkpointed_loop.hpp"
#include "core/integration/simulation_options.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::local_error_control_test {
namespace {

/// Two coordinates with scales of 1 and 10; ten regular steps of 0.1 s, at least an eighth of them.
class ControlOfTheLocalError : public testing::Test {
 protected:
  ControlOfTheLocalError() : control_(mechanism(), options()) {}

  const Mechanism& mechanism() {
    mechanism_.scale = Eigen::Vector2d(1.0, 10.0);
    return mechanism_;
  }
  static SimulationOptions options() {
    SimulationOptions options{1.0, 0.1};
    options.local_error = 1e-3;
    options.smallest_step = 0.0125;
    return options;
  }
  static State with_acceleration(double first, double second) {
    State state(2, 0);
    state.a = Eigen::Vector2d(first, second);
    return state;
  }

  Mechanism mechanism_;
  LocalErrorControl control_;
};

TEST_F(ControlOfTheLocalError, HalvesDownToTheSmallestStep) {
  EXPECT_EQ(control_.parts(), 8);
  EXPECT_EQ(control_.end_of_part(0), 8);
  for (const int end : {4, 2, 1}) {
    ASSERT_TRUE(control_.refine());
    EXPECT_EQ(control_.end_of_part(0), end);
  }
  EXPECT_FALSE(control_.refine());
}

/// A part of four eighths cannot begin at one of them.
TEST_F(ControlOfTheLocalError, BeginsPartsAtMultiplesOfTheirSize) {
  EXPECT_EQ(control_.end_of_part(4), 8);
  EXPECT_EQ(control_.end_of_part(6), 8);
  EXPECT_EQ(control_.end_of_part(7), 8);
  EXPECT_EQ(control_.level(), 3);
}

TEST_F(ControlOfTheLocalError, TakesLargerPartsAfterSmallErrors) {
  control_.set_level(2);
  control_.accept(0.2);
  EXPECT_EQ(control_.level(), 2);
  control_.accept(0.1);
  EXPECT_EQ(control_.level(), 1);
  control_.accept(0.1);
  control_.accept(0.1);
  EXPECT_EQ(control_.level(), 0);
}

/// c h³ q⃛ with q⃛ = (a⁺ − a)/h in each of the parts, relative to scale and allowance.
TEST_F(ControlOfTheLocalError, MeasuresTheErrorOfARegularStep) {
  Scheme scheme = make_scheme(SchemeType::generalized_alpha, 0.05, 0.8);
  const State old = with_acceleration(1.0, 5.0), found = with_acceleration(1.3, 11.0);
  control_.set_level(1);
  // The scheme's local_error is c h³; the second coordinate's 6/10 is twice the first one's 0.3/1.
  const double expected = 2.0 * std::abs(scheme.local_error) * 0.6 / 0.05 / 1e-3;
  EXPECT_NEAR(control_.relative_error(old, found, scheme), expected, 1e-12 * expected);
  EXPECT_EQ(control_.worst_coordinate(old, found, scheme), 1);
}

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
}  // namespace pleuel::test::local_error_control_test
