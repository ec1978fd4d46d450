#include "sensitivity/initial_sensitivity.hpp"

#include <random>

#include <gtest/gtest.h>

#include "core/base/rotation_vector.hpp"
#include "core/integration/configuration.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

struct Case {
  int sample;
  double looseness;  ///< of the given positions and velocities, 0: consistent
};

/// q, v, a, λ on top of each other.
Eigen::VectorXd stacked(const State& state) {
  Eigen::VectorXd all(3 * state.q.size() + state.lambda.size());
  all << state.q, state.v, state.a, state.lambda;
  return all;
}

class StartSensitivity : public testing::TestWithParam<Case> {
 protected:
  SampleScene sample_ = all_samples()[static_cast<std::size_t>(GetParam().sample)];

  StartSensitivity() {
    // From speed at once: velocities, centripetal accelerations and forces depend on the lengths.
    for (Joint& joint : sample_.scene.joints) {
      if (!joint.drive || !std::holds_alternative<RampToSpeedDrive>(joint.drive->motion)) continue;
      joint.drive = ConstantSpeedDrive{std::get<RampToSpeedDrive>(joint.drive->motion).speed};
    }
  }
  Model build_at(const Design<double>& design) const {
    Model model = sample_.build_at(design);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Eigen::VectorXd disturbance(model.mechanism.guess.q.size());
    for (Eigen::Index i = 0; i < model.mechanism.guess.q.size(); ++i) {
      const double loose = GetParam().looseness * model.mechanism.scale(i);
      disturbance(i) = loose * uniform(random);
      model.mechanism.guess.v(i) += 10 * loose * uniform(random);
    }
    const Eigen::VectorXd start = model.mechanism.guess.q;
    model.mechanism.guess.q += disturbance;
    for (int i : model.mechanism.rotations) {
      // Turned before the design turns it: its derivative, a right perturbation, stays what it is.
      model.mechanism.guess.q.segment<3>(i) =
          compose(disturbance.segment<3>(i), start.segment<3>(i));
    }
    return model;
  }
};

TEST_P(StartSensitivity, IsTheDifferenceOfStartsOfNeighbouringDesigns) {
  Model model = build_at(sample_.design);
  const InitialState initial = initial_state(model.mechanism);
  const StateSensitivity s = initial_sensitivity(model.mechanism, initial);
  const auto n = initial.state.q.size();
  for (int j = 0; j < model.mechanism.system->variables(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const double x = sample_.design[index];
    const Eigen::VectorXd expected = derivative_at_zero(
        [&](double step) {
          auto design = sample_.design;
          design[index] += step;
          Model moved = build_at(design);
          State state = initial_state(moved.mechanism).state;
          state.q = difference(model.mechanism.rotations, state.q, initial.state.q);
          return stacked(state);
        },
        3e-3 * std::abs(x));  // 1e-2 and 3e-4 show truncation and round-off above 1e-7
    Eigen::VectorXd found(expected.size());
    found << s.q.col(j), s.v.col(j), s.a.col(j), s.lambda.col(j);
    const Eigen::VectorXd at = stacked(initial.state);
    const auto expect_part = [&](Eigen::Index first, Eigen::Index size, const char* what) {
      const double scale =
          std::max(expected.segment(first, size).lpNorm<Eigen::Infinity>(),
                   at.segment(first, size).lpNorm<Eigen::Infinity>() / std::abs(x));
      const double difference = (found - expected).segment(first, size).lpNorm<Eigen::Infinity>();
      EXPECT_LE(difference, 1e-7 * scale) << what << ", variable " << sample_.variables[index];
    };
    expect_part(0, n, "q");
    expect_part(n, n, "v");
    expect_part(2 * n, n, "a");
    expect_part(3 * n, initial.state.lambda.size(), "lambda");
  }
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return all_samples()[static_cast<std::size_t>(info.param.sample)].name +
         (info.param.looseness == 0.0 ? "Consistent" : "Loose");
}
INSTANTIATE_TEST_SUITE_P(Samples, StartSensitivity,
                         testing::Values(Case{0, 0.0}, Case{1, 0.0}, Case{2, 0.0}, Case{0, 0.01},
                                         Case{1, 0.01}, Case{2, 0.01}),
                         case_name);

}  // namespace
