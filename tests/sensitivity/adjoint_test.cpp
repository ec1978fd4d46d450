#include "sensitivity/adjoint.hpp"

#include <ostream>
#include <random>
#include <tuple>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/direct.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::adjoint_test {
namespace {

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
}  // namespace pleuel::test::adjoint_test
