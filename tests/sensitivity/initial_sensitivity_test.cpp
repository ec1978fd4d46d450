#include "sensitivity/initial_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/mechanism/configuration.hpp"
#include "tests/support/common_basis.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::initial_sensitivity_test {
namespace {

struct StartCase {
  int sample;
  double looseness;  ///< of the given positions and velocities, 0: consistent
};

/// q, v, a, λ on top of each other.
Eigen::VectorXd stacked(const State& state) {
  Eigen::VectorXd all(3 * state.q.size() + state.lambda.size());
  all << state.q, state.v, state.a, state.lambda;
  return all;
}

class StartSensitivity : public testing::TestWithParam<StartCase> {
 protected:
  SampleScene sample_ = all_samples()[GetParam().sample];

  StartSensitivity() {
    // From speed at once: velocities, centripetal accelerations and forces depend on the lengths.
    for (Joint& joint : sample_.scene.joints) {
      if (!joint.drive || !std::holds_alternative<RampToSpeedDrive>(joint.drive->motion)) continue;
      joint.drive = ConstantSpeedDrive{std::get<RampToSpeedDrive>(joint.drive->motion).speed};
    }
  }
  /// Disturbs the guess in the coordinates q of q_model = basis · q.
  void loosen(Model& model, const Eigen::VectorXd& scale, const Eigen::MatrixXd& basis) const {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Eigen::VectorXd start = model.mechanism.guess.q;
    Eigen::VectorXd disturbance(start.size()), rate(start.size());
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      const double loose = GetParam().looseness * scale(i);
      disturbance(i) = loose * uniform(random);
      rate(i) = 10 * loose * uniform(random);
    }
    model.mechanism.guess.q += basis * disturbance;
    model.mechanism.guess.v += basis * rate;
    for (int i : model.mechanism.rotations) {
      // Turned before the design turns it: its derivative, a right perturbation, stays what it is.
      model.mechanism.guess.q.segment<3>(i) =
          compose(disturbance.segment<3>(i), start.segment<3>(i));
    }
  }
};

/// At the best of three steps, or the first that is good enough: accelerations of stiff bodies leave
/// little room between truncation and round-off.
TEST_P(StartSensitivity, IsTheDifferenceOfStartsOfNeighbouringDesigns) {
  Model model = sample_.build();
  const auto size = model.mechanism.guess.q.size();
  loosen(model, model.mechanism.scale, Eigen::MatrixXd::Identity(size, size));
  const InitialState initial = initial_state(model.mechanism);
  const StateSensitivity s = initial_sensitivity(model.mechanism, initial);
  const Eigen::VectorXd at = stacked(initial.state);
  for (int j = 0; j < model.mechanism.system->variables(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const double x = sample_.design[index];
    const auto start_at = [&](double step) {
      auto design = sample_.design;
      design[index] += step;
      Model moved = sample_.build_at(design);
      const Eigen::MatrixXd basis = change_of_basis(model, moved, j, step);
      loosen(moved, model.mechanism.scale, basis);
      State state = initial_state(moved.mechanism).state;
      state.q = solve_dense(basis, state.q);
      state.v = solve_dense(basis, state.v);
      state.a = solve_dense(basis, state.a);
      state.q = difference(model.mechanism.rotations, state.q, initial.state.q);
      return stacked(state);
    };
    Eigen::VectorXd found(at.size());
    found << s.q.col(j), s.v.col(j), s.a.col(j), s.lambda.col(j);
    const std::array<Eigen::Index, 5> parts = {0, size, 2 * size, 3 * size, at.size()};
    std::array<double, 4> best = {1.0, 1.0, 1.0, 1.0};
    constexpr double tolerance = 1e-7;
    for (double relative : {3e-3, 1e-2, 1e-3}) {
      const Eigen::VectorXd expected = derivative_at_zero(start_at, relative * std::abs(x));
      for (std::size_t i = 0; i < 4; ++i) {
        const auto part = [&](const Eigen::VectorXd& all) {
          return all.segment(parts[i], parts[i + 1] - parts[i]);
        };
        const double scale = std::max(part(expected).lpNorm<Eigen::Infinity>(),
                                      part(at).lpNorm<Eigen::Infinity>() / std::abs(x));
        const double error = (part(found) - part(expected)).lpNorm<Eigen::Infinity>();
        best[i] = std::min(best[i], scale > 0.0 ? error / scale : error);
      }
      if (*std::max_element(best.begin(), best.end()) <= tolerance) break;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LE(best[i], tolerance)
          << std::array{"q", "v", "a", "lambda"}[i] << ", variable " << sample_.variables[index];
    }
  }
}

std::string start_case_name(const testing::TestParamInfo<StartCase>& info) {
  return all_samples()[info.param.sample].name +
         (info.param.looseness == 0.0 ? "Consistent" : "Loose");
}
std::vector<StartCase> all_cases() {
  std::vector<StartCase> cases;
  for (double looseness : {0.0, 0.01}) {
    for (int sample = 0; sample < sample_count; ++sample) cases.push_back({sample, looseness});
  }
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Samples, StartSensitivity, testing::ValuesIn(all_cases()),
                         start_case_name);

}  // namespace
}  // namespace pleuel::test::initial_sensitivity_test
