#include <gtest/gtest.h>

#include "sensitivity/direct.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

struct End {
  Eigen::MatrixXd q, lambda;  ///< per relative change of each variable
};

End end_with(int steps) {
  const SampleScene sample = smooth_planar_sample();
  Model model = sample.build();
  SimulationOptions options{0.06, 0.06 / steps, 0.8};
  options.newton_tolerance = 1e-14;
  const Trajectory trajectory = simulate(model.mechanism, options);
  End end;
  differentiate(model.mechanism, trajectory,
                [&](int step, const State&, const StateSensitivity& s) {
                  if (step == trajectory.steps()) end = {s.q, s.lambda};
                });
  const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(sample.design.data(), end.q.cols());
  end.q *= x.asDiagonal();
  end.lambda *= x.asDiagonal();
  return end;
}

/// Not with smaller steps: round-off of Φ_x comes into s_λ divided by h²β.
TEST(SensitivityOrder, IsThatOfTheScheme) {
  const End reference = end_with(4000);
  std::vector<double> steps, q, lambda;
  for (int n : {250, 354, 500, 707}) {
    const End end = end_with(n);
    steps.push_back(0.06 / n);
    q.push_back((end.q - reference.q).norm());
    lambda.push_back((end.lambda - reference.lambda).norm());
  }
  EXPECT_NEAR(observed_order(steps, q), 2.0, 0.1);
  EXPECT_NEAR(observed_order(steps, lambda), 2.0, 0.1);
}

}  // namespace
