#include "sensitivity/history_gradients.hpp"

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/direct.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::history_gradients_test {
namespace {

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
}  // namespace pleuel::test::history_gradients_test
