#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::reduced_gradient_test {
namespace {

ResponseSettings response(const std::string& name, ResponseType type, const std::string& body,
                          double at, OverTime over_time) {
  ResponseSettings settings;
  settings.name = name;
  settings.type = type;
  settings.bodies = {body};
  settings.at = at;
  settings.direction = 1;
  settings.over_time = over_time;
  return settings;
}

/// What a designer asks of beams with modes: where places are, how far they bend. No response
/// depends on the choice of a basis within its span.
ProblemFile problem_of(const SampleScene& sample) {
  ProblemFile problem;
  problem.scene = sample.scene;
  problem.effects = sample.effects;
  problem.simulation.end_time = 0.02;
  problem.simulation.step = 1e-3;
  problem.simulation.newton_tolerance = 1e-12;
  for (std::size_t i = 0; i < sample.design.size(); ++i) {
    DesignVariable variable;
    variable.name = sample.variables[i];
    variable.start = sample.design[i];
    problem.variables.push_back(variable);
  }
  problem.responses = {
      response("tip of crank", ResponseType::position, "crank", 1.0, OverTime::final),
      response("bow of crank", ResponseType::deflection, "crank", 0.5, OverTime::final),
      response("place on rod", ResponseType::position, "rod", 0.35, OverTime::final),
      response("bow of rod", ResponseType::deflection, "rod", 0.6, OverTime::rms),
      response("root of flag", ResponseType::deflection, "flag", 0.0, OverTime::rms),
      response("tip of flag", ResponseType::position, "flag", 1.0, OverTime::final),
      response("end of arm", ResponseType::position, "arm", 1.0, OverTime::final),
      response("bow of arm", ResponseType::deflection, "arm", 1.0, OverTime::final)};
  return problem;
}

class ReducedBodies : public testing::TestWithParam<int> {};

/// Every neighbouring design is reduced anew. Central differences at the best step of a V-curve,
/// of what a relative change of a variable does, against the largest such effect: 1e-7 as for full
/// models. The round bars have pairs of equal frequencies in space.
TEST_P(ReducedBodies, HaveTheGradientsOfModelsThatAreReducedAnew) {
  const SampleScene sample = all_samples()[GetParam()];
  const ProblemFile problem = problem_of(sample);
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
  Eigen::MatrixXd best = Eigen::MatrixXd::Ones(direct.rows(), direct.cols());
  for (double step : {1e-3, 1e-4}) {
    const Eigen::MatrixXd wide = central_differences(problem, x, step) * x.asDiagonal();
    const Eigen::MatrixXd narrow = central_differences(problem, x, step / 2) * x.asDiagonal();
    best = best.cwiseMin(((4 * narrow - wide) / 3 - direct).cwiseAbs());
    best = best.cwiseMin((narrow - direct).cwiseAbs());
  }
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const double scale = direct.row(i).lpNorm<Eigen::Infinity>();
    for (Eigen::Index j = 0; j < direct.cols(); ++j) {
      EXPECT_LE(best(i, j), 1e-7 * scale)
          << problem.responses[i].name << ", " << sample.variables[j];
    }
    EXPECT_GT(scale, 0.0);
  }
}

/// The reduced samples.
INSTANTIATE_TEST_SUITE_P(Samples, ReducedBodies, testing::Values(5, 6), sample_name);

}  // namespace
}  // namespace pleuel::test::reduced_gradient_test
