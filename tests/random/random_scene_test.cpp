#include "tests/random/random_scene.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/base/relative_error.hpp"
#include "core/response/monitors.hpp"
#include "core/trust/doubts.hpp"
#include "core/trust/nested_runs.hpp"
#include "sensitivity/gradients.hpp"

/// Laws that hold for every mechanism, tried on random ones. The seeds are fixed by the build.
namespace pleuel::test {
namespace {

class RandomScene : public testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override {
    scene_ = random_scene(GetParam());
    problem_ = read(scene_);
    try {
      analysis_ = analyze(problem_, start_design(problem_));
    } catch (const SimulationError& error) {
      GTEST_SKIP() << "no simulation: " << error.what();
    }
    if (monitor(analysis_->model, analysis_->trajectory).elastic_rotation > 0.2) {
      GTEST_SKIP() << "bends too far";  // what is called unstable elsewhere may be chaotic here
    }
    values_ = values_of(*analysis_);
    magnitudes_ = values_.cwiseAbs();
    for (std::size_t i = 0; i < analysis_->histories.size(); ++i) {
      const Eigen::MatrixXd& history = analysis_->histories[i];
      if (history.size() == 0) continue;
      magnitudes_(static_cast<Eigen::Index>(i)) = history.cwiseAbs().maxCoeff();
    }
  }

  const std::string& name(Eigen::Index i) const {
    return problem_.responses[static_cast<std::size_t>(i)].name;
  }

  /// Newton's method takes corrections below 1e-9 that no longer shrink for round-off.
  void expect_same(const Json& other, const char* what) const {
    const ProblemFile problem = read(other);
    const Eigen::VectorXd values = values_of(*analyze(problem, start_design(problem)));
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(values(i) / magnitudes_(i), values_(i) / magnitudes_(i), 1e-8)
          << name(i) << " " << what;
    }
  }

  Json scene_;
  ProblemFile problem_;
  std::unique_ptr<Analysis> analysis_;
  Eigen::VectorXd values_, magnitudes_;
};

TEST_P(RandomScene, AnswersTheSameWhicheverWayItLies) {
  expect_same(rotated(scene_, general_rotation(GetParam())), "turned");
}

TEST_P(RandomScene, AnswersTheSameUnderOtherNames) {
  expect_same(renamed(scene_), "renamed");
}

TEST_P(RandomScene, AnswersTheSameInOtherUnits) {
  expect_same(in_other_units(scene_), "in mm");
}

TEST_P(RandomScene, AnswersTheSameInAPlaneAndInSpace) {
  if (!is_planar(scene_)) GTEST_SKIP() << "moves in space";
  expect_same(in_space(scene_), "in space");
}

/// Changes of responses for relative changes of the design, against the larger of these changes and
/// of the response itself. Direct differentiation and the adjoint are the same formula in another
/// order: what parts them is what Newton's method and round-off leave. Differences have their own
/// errors; peaks move between instants.
TEST_P(RandomScene, HasTheSameGradientsByAllMethods) {
  const Eigen::VectorXd x = start_design(problem_);
  const Eigen::MatrixXd direct = gradients(problem_, x, *analysis_, GradientMethod::direct);
  const Eigen::MatrixXd adjoint = gradients(problem_, x, *analysis_, GradientMethod::adjoint);
  const Eigen::MatrixXd difference =
      gradients(problem_, x, *analysis_, GradientMethod::central_difference);
  for (Eigen::Index i = 0; i < values_.size(); ++i) {
    const Eigen::VectorXd g = direct.row(i);
    EXPECT_LE(gradient_error(adjoint.row(i), g, x, 1e3 * magnitudes_(i)), 1e-7) << name(i);
    EXPECT_LE(gradient_error(difference.row(i), g, x, 1e3 * magnitudes_(i)), 1e-4) << name(i);
  }
}

/// What changes by more than a tenth with a quarter of the step or four times the elements is named
/// by a warning.
TEST_P(RandomScene, WarnsOfWhatItDoesNotResolve) {
  const Eigen::VectorXd x = start_design(problem_);
  const std::vector<Doubt> doubts = find_doubts(problem_, x, *analysis_);
  const auto is_named = [&](const std::string& response) {
    return std::any_of(doubts.begin(), doubts.end(), [&](const Doubt& doubt) {
      return doubt.text.find("\"" + response + "\"") != std::string::npos;
    });
  };
  for (const Refinement refinement : {Refinement{0.25, 1.0}, Refinement{1.0, 4.0}}) {
    const NestedRun fine = make_nested_run(problem_, x, refinement);
    if (fine.has_failed()) continue;
    for (Eigen::Index i = 0; i < values_.size(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      const Eigen::MatrixXd& history = fine.histories[index];
      const double size = history.size() > 0 ? history.cwiseAbs().maxCoeff() : 0.0;
      const double change = value_error(values_(i), fine.values(i), size);
      if (change <= 0.1) continue;
      EXPECT_TRUE(is_named(name(i)))
          << name(i) << " changes by " << 100 * change << " % with "
          << (refinement.step < 1.0 ? "a quarter of the step" : "four times the elements");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScene, testing::Range(PLEUEL_FIRST_SEED, PLEUEL_END_SEED));

}  // namespace
}  // namespace pleuel::test
