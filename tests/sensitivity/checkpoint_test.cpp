#include "core/base/error.hpp"
#include "core/integration/checkpointed_loop.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/method_choice.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

/// Trajectories that do not fit into the memory: the same numbers, bit by bit, for at most one more
/// simulation.
namespace pleuel::test::checkpoint_test {
namespace {

/// The least memory for equal steps, in bytes.
double least_memory(const Mechanism& mechanism, const SimulationOptions& options) {
  const double n = mechanism.system->coordinates(), m = mechanism.system->multipliers();
  const bool is_stabilized = options.formulation.constraints == ConstraintForm::stabilized_index_2;
  const double projected = options.formulation.is_projected ? 2 * n : 0;
  const double state = 3 * n + (is_stabilized ? 2 : 1) * m + projected;
  // Besides the state: w, the increment, the shift, and how a and λ changed last.
  const double checkpoint = state + (is_stabilized ? 4 : 3) * n + m;
  const CheckpointPlan plan{8 * state, 8 * checkpoint, 0.0};
  return plan.least_memory(step_count(options) + 1);
}

void expect_same_states(const Trajectory& found, const Trajectory& expected, bool backwards) {
  ASSERT_EQ(found.time, expected.time);
  RecordedState a, b;
  for (int i = 0; i <= expected.steps(); ++i) {
    const int step = backwards ? expected.steps() - i : i;
    found.states->load_record(step, a);
    expected.states->load_record(step, b);
    ASSERT_EQ(a.time, b.time);
    ASSERT_EQ(a.q, b.q) << "step " << step;
    ASSERT_EQ(a.v, b.v) << "step " << step;
    ASSERT_EQ(a.a, b.a) << "step " << step;
    ASSERT_EQ(a.lambda, b.lambda) << "step " << step;
    ASSERT_EQ(a.eta, b.eta) << "step " << step;
    ASSERT_EQ(a.drifted_q, b.drifted_q) << "step " << step;
    ASSERT_EQ(a.drifted_v, b.drifted_v) << "step " << step;
  }
}

class Checkpoints : public testing::TestWithParam<int> {};

/// All samples, with the least memory, in every formulation.
TEST_P(Checkpoints, LeadToTheSameStatesBitByBit) {
  const SampleScene sample = all_samples()[GetParam()];
  for (const Formulation& formulation :
       {Formulation{}, Formulation{ConstraintForm::stabilized_index_2},
        Formulation{ConstraintForm::index_1}, Formulation{ConstraintForm::index_1, 0.0, true}}) {
    Model model = sample.build();
    SimulationOptions options{0.12, 1e-3, 0.8};
    options.formulation = formulation;
    const Trajectory whole = simulate(model.mechanism, options);
    ASSERT_FALSE(whole.recomputed());
    options.memory = least_memory(model.mechanism, options);
    const Trajectory part = simulate(model.mechanism, options);
    ASSERT_TRUE(part.recomputed());
    EXPECT_THROW(part.columns(), std::logic_error);
    const RecomputedStates& states = *part.recomputed();
    // 120 steps: of the order of 2 √120 states and checkpoints, which are a little larger.
    EXPECT_LE(states.checkpoints() + states.most_held(), 26);
    expect_same_states(part, whole, true);
    // The last stretch was still there.
    EXPECT_LT(states.recomputed_steps(), whole.steps());
    expect_same_states(part, whole, false);
    EXPECT_LE(states.recomputed_steps(), 2 * whole.steps());
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, Checkpoints, testing::Range(0, sample_count), sample_name);

/// Steps that were halved where Newton's method failed are halved again.
TEST(Checkpoints, RepeatSplitSteps) {
  Model model = smooth_planar_sample().build();
  SimulationOptions options{0.3, 5e-3, 0.8};
  options.newton_tolerance = 1e-12;
  options.max_newton_iterations = 4;
  const Trajectory whole = simulate(model.mechanism, options);
  ASSERT_GT(whole.split_steps, 0);
  options.memory = 2.5 * least_memory(model.mechanism, options);
  const Trajectory part = simulate(model.mechanism, options);
  ASSERT_TRUE(part.recomputed());
  EXPECT_EQ(part.split_steps, whole.split_steps);
  expect_same_states(part, whole, true);
}

ProblemFile controlled(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"/simulation/formulation=stabilized-index-2",
                                        "/simulation/step=4 ms", "/simulation/local_error=1e-6",
                                        "/simulation/end_time=0.4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return sample_problem("hard/dead_centres", overrides);
}

/// The number of steps is not known beforehand, and much larger than that of the regular ones:
/// checkpoints are given up on the way.
TEST(Checkpoints, RepeatStepsThatFollowTheLocalError) {
  const ProblemFile problem = controlled();
  const auto whole = analyze(problem, start_design(problem));
  ASSERT_GT(whole->trajectory.rejected_steps, 0);
  ASSERT_GT(whole->trajectory.steps(), 300);
  // A third of what all states take.
  StateColumns& states = whole->trajectory.columns();
  const double all = 8.0 * static_cast<double>(states.capacity()) *
                     static_cast<double>(3 * states.q().rows() + 2 * states.lambda().rows());
  ProblemFile limited = problem;
  limited.sensitivity.memory = all / 3;
  const auto part = analyze(limited, start_design(limited));
  ASSERT_TRUE(part->trajectory.recomputed());
  expect_same_states(part->trajectory, whole->trajectory, true);
  expect_same_states(part->trajectory, whole->trajectory, false);
  // Those of the very steps, too.
  ProblemFile repeated = with_steps_of(whole->trajectory, problem);
  const auto again = analyze(repeated, start_design(problem));
  repeated.sensitivity.memory = all / 3;
  const auto again_in_part = analyze(repeated, start_design(problem));
  ASSERT_TRUE(again_in_part->trajectory.recomputed());
  expect_same_states(again_in_part->trajectory, again->trajectory, true);
}

/// Values and gradients by both methods; deflections against the rigid mechanism have two
/// trajectories.
TEST(Checkpoints, GiveTheSameGradientsBitByBit) {
  std::vector<std::string> overrides = {
      "/simulation/end_time=20 ms", "/simulation/step=0.1 ms",
      "/scene/joints/bearing/drive/ramp=20 ms",
      R"(/responses/lag={"type": "deflection", "body": "rod", "at": 0.5, "direction": "y",)"
      R"( "against": "rigid-mechanism", "over_time": "rms"})"};
  const ProblemFile whole = sample_problem("slider_crank", overrides);
  overrides.emplace_back(R"(/sensitivity={"memory": "60 kB"})");
  const ProblemFile limited = sample_problem("slider_crank", overrides);
  const auto a = analyze(whole, start_design(whole)), b = analyze(limited, start_design(limited));
  ASSERT_FALSE(a->trajectory.recomputed());
  ASSERT_TRUE(b->trajectory.recomputed());
  EXPECT_EQ(values_of(*a), values_of(*b));
  const RecomputedStates& states = *b->trajectory.recomputed();
  for (auto method : {ExactMethod::direct, ExactMethod::adjoint}) {
    const int before = states.recomputed_steps();
    EXPECT_EQ(sampled_gradients(*a, response_values(*a), method),
              sampled_gradients(*b, response_values(*b), method))
        << to_string(method);
    EXPECT_LE(states.recomputed_steps() - before, b->trajectory.steps()) << to_string(method);
  }
}

/// The choice works on such a trajectory, whose steps its measurement takes from the end, and says
/// that both methods simulate again.
TEST(Checkpoints, AreKnownToTheChoiceOfTheMethod) {
  std::vector<std::string> overrides = {"/simulation/end_time=20 ms", "/simulation/step=0.1 ms",
                                        "/scene/joints/bearing/drive/ramp=20 ms",
                                        R"(/sensitivity={"memory": "60 kB"})"};
  const ProblemFile problem = sample_problem("slider_crank", overrides);
  const auto analysis = analyze(problem, start_design(problem));
  const auto all = response_values(*analysis);
  const MethodChoice choice = choose_method(*analysis, {all[1]});
  EXPECT_THAT(choice.reason, HasSubstr("simulated again"));
}

TEST(Checkpoints, SayHowMuchMemoryTheyNeed) {
  Model model = smooth_planar_sample().build();
  SimulationOptions options{0.1, 1e-3, 0.8};
  const double least = least_memory(model.mechanism, options);
  options.memory = 0.9 * least;
  const std::string said = thrown<InputError>([&] { simulate(model.mechanism, options); });
  EXPECT_THAT(said, HasSubstr("/sensitivity/memory is too little"));
  EXPECT_THAT(said, HasSubstr(fmt::format("of 100 steps; at least {:.3g} MB", 1.01e-6 * least)));
}

/// K checkpoints and stretches of L states hold K L states: within a factor of what two levels can
/// do at best, B²/(4 s c).
TEST(CheckpointPlan, HoldsWhatItSaysItDoes) {
  for (const double ratio : {1.0, 1.4, 2.0}) {
    for (const int states : {2, 10, 101, 4001, 1000001}) {
      CheckpointPlan plan{800.0, 800.0 * ratio, 0.0};
      plan.memory = plan.least_memory(states);
      EXPECT_GE(plan.most_states(), states);
      EXPECT_LE(plan.stretch_for(states), plan.longest_stretch());
      EXPECT_LE(plan.memory, 800.0 * (2 * std::sqrt(ratio * states) + 2 * ratio + 4));
      plan.memory *= 0.5;
      EXPECT_LT(plan.most_states(), states);
    }
  }
}

}  // namespace
}  // namespace pleuel::test::checkpoint_test
