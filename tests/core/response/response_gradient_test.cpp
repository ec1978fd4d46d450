#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/sample_name.hpp"

namespace pleuel::test::response_gradient_test {
namespace {

using namespace response_samples;

class GradientsOfResponses : public testing::TestWithParam<int> {
 protected:
  GradientsOfResponses() {
    const SampleScene sample = sample_with_strength(GetParam());
    problem_ = sample.problem();
    problem_.simulation.end_time = 8e-3;
    problem_.simulation.step = 1e-3;
    problem_.simulation.newton_tolerance = 1e-13;
    problem_.responses = all_histories(sample.build());
    for (ResponseSettings& response : problem_.responses) {
      response.over_time = OverTime::final;
      // Along a whole beam the place of the largest stress jumps.
      const bool is_stress =
          response.type == ResponseType::stress || response.type == ResponseType::shear_stress ||
          response.type == ResponseType::fatigue || response.type == ResponseType::fatigue_damage;
      if (is_stress) response.station = 0.37;
    }
    // A member of that one would buckle out of the plane: modes that grow, and meet.
    if (sample.name == "PlanarJoints") return;
    for (int mode = 0; mode < 3; ++mode) {
      ResponseSettings frequency;
      frequency.type = ResponseType::frequency;
      frequency.name = "frequency " + std::to_string(mode);
      frequency.mode.number = mode;
      problem_.responses.push_back(frequency);
    }
  }
  ProblemFile problem_;
};

/// Round-off of differences, per relative change of a variable: positions carry 1e-16 m, and
/// accelerations and reactions 1/h² of that.
double noise_of(ResponseType type) {
  switch (type) {
    case ResponseType::stress:
    case ResponseType::shear_stress:
      return 1e-2;  // [Pa]
    case ResponseType::acceleration:
    case ResponseType::angular_acceleration:
    case ResponseType::reaction_force:
      return 1e-5;
    case ResponseType::frequency:
      return 1e-4;  // [rad/s]: soft modes, of 0.3 rad/s, beside stiff members
    default:
      return 1e-7;
  }
}

/// Direct differentiation against differences of fourth order of re-simulated designs, both as
/// changes per relative change of a variable, at the better of two steps, the second of which is taken
/// where the first is not good enough. 5e-6: measured 2.4e-6 of an acceleration, 1e-6 of all else.
TEST_P(GradientsOfResponses, AreThoseOfDifferencesOfSimulations) {
  const Eigen::VectorXd x = start_design(problem_);
  const auto analysis = analyze(problem_, x);
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
  constexpr double any = 1e300;
  Eigen::VectorXd allowed = Eigen::VectorXd::Constant(direct.rows(), any);
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const ResponseSettings& response = problem_.responses[i];
    const double value = std::abs(analysis->reductions[i].value);
    // The magnitude of what vanishes has a kink.
    if (response.direction == magnitude_direction && value < 1e-6) continue;
    const double slope = direct.row(i).lpNorm<Eigen::Infinity>();
    if (response.type == ResponseType::shear_stress && value < 1e-2 * slope) continue;
    allowed(i) = 5e-6 * (slope + value) + noise_of(response.type);
  }
  Eigen::VectorXd best = Eigen::VectorXd::Constant(direct.rows(), any);
  for (double step : {8e-3, 1e-3}) {
    const Eigen::MatrixXd wide = central_differences(problem_, x, step) * x.asDiagonal();
    const Eigen::MatrixXd narrow = central_differences(problem_, x, step / 2) * x.asDiagonal();
    const Eigen::MatrixXd error = (4.0 * narrow - wide) / 3.0 - direct;
    best = best.cwiseMin(error.cwiseAbs().rowwise().maxCoeff());
    if ((best.array() <= allowed.array()).all()) break;
  }
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LE(best(i), allowed(i)) << problem_.responses[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, GradientsOfResponses, testing::Range(0, sample_count),
                         sample_name);

}  // namespace
}  // namespace pleuel::test::response_gradient_test
