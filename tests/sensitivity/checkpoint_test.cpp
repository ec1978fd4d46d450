#include <ostream>
#include <random>
#include <tuple>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/checkpointed_loop.hpp"
#include "sensitivity/adjoint.hpp"
#include "sensitivity/direct.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/method_choice.hpp"
#include "tests/support/at_start.hpp"
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
  const auto [problem, x, whole] = AtStart(controlled());
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
  const auto [problem, x, analysis] = AtStart(sample_problem("slider_crank", overrides));
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

struct NamedRun {
  std::string name;
  SimulationOptions options;

  friend std::ostream& operator<<(std::ostream& stream, const NamedRun& run) {
    return stream << run.name;
  }
};

NamedRun named_run(const std::string& name, SchemeType scheme, ConstraintForm form,
                   double baumgarte = 0.0) {
  NamedRun run{name, {}};
  run.options.end_time = 0.02;
  run.options.step = 2e-3;
  run.options.scheme = scheme;
  run.options.formulation = {form, baumgarte};
  return run;
}

NamedRun projected_run(const std::string& name, SchemeType scheme) {
  NamedRun run = named_run(name, scheme, ConstraintForm::index_1);
  run.options.formulation.is_projected = true;
  return run;
}

using AdjointCase = std::tuple<int, NamedRun>;

class Adjoint : public testing::TestWithParam<AdjointCase> {
 protected:
  /// J_k = Σ weights · (q, v, a, λ) of the instants `first`, first + 3 …: different weights for
  /// each.
  struct Functions {
    int first = 0;
    std::vector<Eigen::MatrixXd> q, v, a, lambda;  ///< one an instant, rows × functions
  };
  static constexpr int count = 3;

  Functions random_functions(const Trajectory& trajectory, int first) {
    Functions functions;
    functions.first = first;
    const auto random = [this](Eigen::Index rows) -> Eigen::MatrixXd {
      return Eigen::MatrixXd::NullaryExpr(rows, count, [this] { return uniform_(generator_); });
    };
    for (int step = 0; step <= trajectory.steps(); ++step) {
      functions.q.push_back(random(trajectory.columns().q().rows()));
      functions.v.push_back(1e-2 * random(trajectory.columns().q().rows()));
      functions.a.push_back(1e-4 * random(trajectory.columns().q().rows()));
      functions.lambda.push_back(1e-4 * random(trajectory.columns().lambda().rows()));
    }
    return functions;
  }
  static bool counts(const Functions& functions, int step) { return step % 3 == functions.first; }

  std::mt19937 generator_{3};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  SampleScene sample_ = all_samples()[std::get<0>(GetParam())];
  SimulationOptions options_ = std::get<1>(GetParam()).options;
};

/// Two ways through the same linear map, forwards and backwards: all that differs is round-off,
/// relative to the parts that a gradient is the sum of, and amplified by the step matrices:
/// measured 3e-9 at worst (reduced bodies in steps of 2 ms), 1e-11 for most.
TEST_P(Adjoint, IsDirectDifferentiationTransposed) {
  Model model = sample_.build();
  const Trajectory trajectory = simulate(model.mechanism, options_);
  for (int first : {0, 1}) {
    const Functions functions = random_functions(trajectory, first);
    Eigen::MatrixXd direct = Eigen::MatrixXd::Zero(model.mechanism.system->variables(), count);
    Eigen::MatrixXd parts = direct;
    differentiate(
        model.mechanism, trajectory, [&](int step, const State&, const StateSensitivity& s) {
          if (!counts(functions, step)) return;
          const auto i = static_cast<std::size_t>(step);
          const auto add = [&](const Eigen::MatrixXd& sensitivity, const Eigen::MatrixXd& weights) {
            direct += sensitivity.transpose() * weights;
            parts += sensitivity.cwiseAbs().transpose() * weights.cwiseAbs();
          };
          add(s.q, functions.q[i]);
          add(s.v, functions.v[i]);
          add(s.a, functions.a[i]);
          add(s.lambda, functions.lambda[i]);
        });
    const Eigen::MatrixXd adjoint = adjoint_gradients(
        model.mechanism, trajectory, count, [&](int step, const State&, StateAdjoint& of) {
          if (!counts(functions, step)) return count;
          const auto i = static_cast<std::size_t>(step);
          of.q += functions.q[i];
          of.v += functions.v[i];
          of.a += functions.a[i];
          of.lambda += functions.lambda[i];
          return count;
        });
    for (Eigen::Index j = 0; j < direct.rows(); ++j) {
      EXPECT_LE((adjoint - direct).row(j).lpNorm<Eigen::Infinity>(),
                1e-7 * parts.row(j).lpNorm<Eigen::Infinity>())
          << sample_.variables[j];
    }
  }
}

/// Functions of the first instants only, as columns that come alive late.
TEST_P(Adjoint, MayBeginWithLaterFunctions) {
  Model model = sample_.build();
  const Trajectory trajectory = simulate(model.mechanism, options_);
  const Functions functions = random_functions(trajectory, 0);
  // Function k counts the instant 9 − 3k.
  const auto function_at = [](int step) { return step % 3 == 0 ? (9 - step) / 3 : -1; };
  const auto add = [&](int columns) {
    return adjoint_gradients(model.mechanism, trajectory, count,
                             [&](int step, const State&, StateAdjoint& of) {
                               const int k = function_at(step);
                               if (k < 0 || k >= count)
                                 return std::min(count, std::max(columns, 1 + (9 - step) / 3));
                               of.q.col(k) += functions.q[step].col(k);
                               return std::min(count, std::max(columns, k + 1));
                             });
  };
  const Eigen::MatrixXd late = add(0), always = add(count);
  EXPECT_LE((late - always).lpNorm<Eigen::Infinity>(), 1e-14 * always.lpNorm<Eigen::Infinity>());
}

std::string adjoint_case_name(const testing::TestParamInfo<AdjointCase>& info) {
  const auto sample = static_cast<std::size_t>(std::get<0>(info.param));
  return all_samples()[sample].name + std::get<1>(info.param).name;
}

using enum SchemeType;
using enum ConstraintForm;
INSTANTIATE_TEST_SUITE_P(
    Samples, Adjoint,
    testing::Combine(
        testing::Range(0, sample_count),
        testing::Values(named_run("Index3", generalized_alpha, index_3),
                        named_run("StabilizedIndex2", generalized_alpha, stabilized_index_2),
                        named_run("Index1", generalized_alpha, index_1),
                        named_run("Baumgarte", generalized_alpha, index_1, 50.0),
                        projected_run("Projected", generalized_alpha),
                        projected_run("ProjectedNewmark", newmark),
                        named_run("Newmark", newmark, index_3),
                        named_run("ImplicitEuler", implicit_euler, stabilized_index_2))),
    adjoint_case_name);

class Histories : public testing::Test {
 protected:
  Histories()
      : problem_(sample_problem(
            "slider_crank",
            {"/simulation/end_time=20 ms", "/simulation/step=0.1 ms",
             "/scene/joints/bearing/drive/ramp=20 ms", "/simulation/newton_tolerance=1e-13",
             R"(/responses/balance={"type": "energy-balance"})",
             R"(/responses/lag={"type": "deflection", "body": "rod", "at": 0.5, "direction": "y",)"
             R"( "against": "rigid-mechanism", "over_time": "rms"})"})),
        x_(start_design(problem_)),
        analysis_(analyze(problem_, x_)),
        histories_(history_gradients(*analysis_)) {}

  ProblemFile problem_;
  Eigen::VectorXd x_;
  std::unique_ptr<Analysis> analysis_;
  std::vector<HistoryGradients> histories_;
};

TEST_F(Histories, ComeWithTheGradientsOfTheValuesByTheSameRun) {
  const ResponseDerivatives all = response_derivatives(*analysis_);
  const Eigen::MatrixXd alone = gradients(problem_, x_, *analysis_, GradientMethod::adjoint);
  ASSERT_EQ(all.values.rows(), alone.rows());
  for (Eigen::Index i = 0; i < alone.rows(); ++i) {
    EXPECT_LT((all.values.row(i) - alone.row(i)).norm(), 1e-8 * alone.row(i).norm()) << i;
  }
  ASSERT_EQ(all.histories.size(), histories_.size());
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    EXPECT_EQ(all.histories[i].gradients, histories_[i].gradients) << i;
  }
}

/// Direct differentiation ends with the last sample: what is asked for at an instant does not
/// depend on what else is.
TEST_F(Histories, HaveTheGradientsOfTheirInstantsAlone) {
  const int step = analysis_->trajectory.steps() / 3;
  for (const HistoryGradients& history : histories_) {
    if (analysis_->responses[history.response].history()->map) continue;  // of several instants
    const SampledValue alone{history.response, {{step, history.place, 1.0}}};
    const Eigen::MatrixXd found = sampled_gradients(*analysis_, {alone}, ExactMethod::direct);
    EXPECT_EQ(found.row(0), history.gradients.row(step)) << history.response;
  }
}

TEST_F(Histories, AreDifferentiatedAsFarAsIsAskedFor) {
  int last = -1;
  differentiate_until(7, analysis_->model.mechanism, analysis_->trajectory,
                      [&](int step, const State&, const StateSensitivity&) { last = step; });
  EXPECT_EQ(last, 7);
}

/// Central differences of the simulated histories, extrapolated once; largest over time and
/// variables, relative to the largest derivative by a relative change of a variable. Balances and
/// positions are small differences of large numbers: what counts there is the round-off of the
/// energy (100 J) and of the mechanism's size over the step.
TEST_F(Histories, HaveTheDerivativesOfCentralDifferences) {
  ASSERT_EQ(histories_.size(), analysis_->responses.size() - 1) << "all but the mass";
  const auto differences = [&](const HistoryGradients& history, double step) {
    return central_differences(problem_, x_, step, 1, [&](const Analysis& analysis) {
      return Eigen::VectorXd(analysis.histories[history.response].row(history.place).transpose());
    });
  };
  for (const HistoryGradients& history : histories_) {
    const Response& response = analysis_->responses[history.response];
    const Eigen::MatrixXd found = history.gradients * x_.asDiagonal();
    const Eigen::MatrixXd expected =
        (4 * differences(history, 5e-4) - differences(history, 1e-3)) / 3 * x_.asDiagonal();
    double round_off = 0.0;
    if (response.history()->map) round_off = 1e-9 * 100;
    if (response.name == "slider_end") round_off = 1e-12;
    EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(),
              1e-6 * expected.lpNorm<Eigen::Infinity>() + round_off)
        << response.name;
  }
}

/// Where a value is that of one instant or of all, its gradient is what the history says.
TEST_F(Histories, LeadToTheGradientsOfTheValues) {
  const Eigen::MatrixXd gradients = direct_gradients(*analysis_);
  const Eigen::VectorXd& time = analysis_->trajectory.time;
  for (const HistoryGradients& history : histories_) {
    const Response& response = analysis_->responses[history.response];
    const auto row = static_cast<Eigen::Index>(history.response);
    const Eigen::RowVectorXd last = history.gradients.bottomRows(1);
    Eigen::RowVectorXd expected;
    if (response.is_reduced_by(OverTime::final)) expected = last;
    if (response.name == "torque_rms") {
      const Eigen::VectorXd& y = history.values;  // equal steps: trapezoidal weights
      Eigen::VectorXd weights = Eigen::VectorXd::Constant(y.size(), 1.0 / double(y.size() - 1));
      weights(0) = weights(y.size() - 1) = 0.5 / double(y.size() - 1);
      const double rms = std::sqrt(weights.dot(y.cwiseAbs2()));
      expected = weights.cwiseProduct(y).transpose() * history.gradients / rms;
    }
    if (expected.size() == 0) continue;
    EXPECT_LE((gradients.row(row) - expected).lpNorm<Eigen::Infinity>(),
              1e-9 * expected.lpNorm<Eigen::Infinity>())
        << response.name;
  }
  EXPECT_EQ(time.size(), histories_.front().gradients.rows());
}

}  // namespace
}  // namespace pleuel::test::checkpoint_test
