#include <gtest/gtest.h>

#include "sensitivity/direct.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

/// The driven slider-crank alone, one element a segment, without gravity: at rest at first.
SampleScene smooth_sample() {
  SampleScene sample = planar_sample();
  std::erase_if(sample.scene.bodies,
                [](const Body& b) { return b.name == "block" || b.name == "arm"; });
  std::erase_if(sample.scene.joints,
                [](const Joint& j) { return j.name == "slide" || j.name == "weld"; });
  sample.scene.gravity = {0.0, 0.0, 0.0};
  for (Body& body : sample.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      for (Segment& segment : beam->segments) segment.elements = 1;
    }
  }
  return sample;
}

struct End {
  Eigen::MatrixXd q, lambda;  ///< per relative change of each variable
};

End end_with(int steps) {
  const SampleScene sample = smooth_sample();
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
