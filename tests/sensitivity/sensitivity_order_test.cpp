#include <ostream>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/direct.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/scheme_case.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::sensitivity_order_test {
namespace {

struct SensitivityCase : SchemeCase {
  int coarsest = 354;  ///< steps of the longest run, in the asymptotic range
};

class SensitivityOrder : public testing::TestWithParam<SensitivityCase> {
 protected:
  struct End {
    Eigen::MatrixXd q, v, lambda;  ///< per relative change of each variable
  };

  static End end_with(int steps) {
    const SampleScene sample = smooth_planar_sample();
    Model model = sample.build();
    SimulationOptions options{0.06, 0.06 / steps};
    options.newton_tolerance = 1e-14;
    GetParam().set(options);
    const Trajectory trajectory = simulate(model.mechanism, options);
    End end;
    differentiate(model.mechanism, trajectory,
                  [&](int step, const State&, const StateSensitivity& s) {
                    if (step == trajectory.steps()) end = {s.q, s.v, s.lambda};
                  });
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(sample.design.data(), end.q.cols());
    for (auto* part : {&end.q, &end.v, &end.lambda}) *part *= x.asDiagonal();
    return end;
  }
};

/// Against half the step. Index 3 not with smaller steps: round-off of Φ_x comes into s_λ divided
/// by h²β. Index 1 is in the asymptotic range later. Weakly damped parts of s_λ may fall faster.
TEST_P(SensitivityOrder, IsThatOfTheScheme) {
  std::vector<double> steps, q, v, lambda;
  for (double factor : {1.0, std::numbers::sqrt2, 2.0}) {
    const int n = static_cast<int>(std::lround(factor * GetParam().coarsest));
    const End end = end_with(n), fine = end_with(2 * n);
    steps.push_back(0.06 / n);
    q.push_back((end.q - fine.q).norm());
    v.push_back((end.v - fine.v).norm());
    lambda.push_back((end.lambda - fine.lambda).norm());
  }
  EXPECT_NEAR(observed_order(steps, q), GetParam().order, 0.15);
  EXPECT_NEAR(observed_order(steps, v), GetParam().order, 0.15);
  EXPECT_GE(observed_order(steps, lambda), GetParam().order - 0.15);
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, SensitivityOrder,
    testing::Values(
        SensitivityCase{{"Index3", alpha, 0.8, index_3, 2.0}, 354},
        SensitivityCase{{"StabilizedIndex2", alpha, 0.8, stabilized, 2.0}, 354},
        SensitivityCase{{"Index1", alpha, 0.8, index_1, 2.0}, 1400},
        SensitivityCase{{"Baumgarte", alpha, 0.8, baumgarte, 2.0}, 1400},
        SensitivityCase{{"Projected", alpha, 0.8, projected, 2.0}, 1400},
        SensitivityCase{{"NewmarkStabilized", SchemeType::newmark, 1.0, stabilized, 2.0}, 354},
        SensitivityCase{{"NewmarkIndex1", SchemeType::newmark, 1.0, index_1, 2.0}, 1400},
        SensitivityCase{{"ImplicitEuler", SchemeType::implicit_euler, 0.0, index_3, 1.0}, 354},
        SensitivityCase{
            {"ImplicitEulerStabilized", SchemeType::implicit_euler, 0.0, stabilized, 1.0}, 354},
        SensitivityCase{{"ImplicitEulerIndex1", SchemeType::implicit_euler, 0.0, index_1, 1.0},
                        354}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pleuel::test::sensitivity_order_test
