#include <cmath>
#include <numbers>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "sensitivity/direct.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/sample_scenes.hpp"

namespace {

using namespace pleuel;

struct SchemeCase {
  std::string name;
  SchemeType scheme;
  double spectral_radius;
  Formulation formulation;
  double order;
  int coarsest;  ///< steps of the longest run, in the asymptotic range

  friend std::ostream& operator<<(std::ostream& stream, const SchemeCase& scheme_case) {
    return stream << scheme_case.name;
  }
};

class SensitivityOrder : public testing::TestWithParam<SchemeCase> {
 protected:
  struct End {
    Eigen::MatrixXd q, v, lambda;  ///< per relative change of each variable
  };

  static End end_with(int steps) {
    const SampleScene sample = smooth_planar_sample();
    Model model = sample.build();
    SimulationOptions options{0.06, 0.06 / steps, GetParam().spectral_radius};
    options.newton_tolerance = 1e-14;
    options.scheme = GetParam().scheme;
    options.formulation = GetParam().formulation;
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

constexpr SchemeType alpha = SchemeType::generalized_alpha;
constexpr Formulation index_3{};
constexpr Formulation stabilized{ConstraintForm::stabilized_index_2};
constexpr Formulation index_1{ConstraintForm::index_1};
constexpr Formulation baumgarte{ConstraintForm::index_1, 200.0};

INSTANTIATE_TEST_SUITE_P(
    Schemes, SensitivityOrder,
    testing::Values(SchemeCase{"Index3", alpha, 0.8, index_3, 2.0, 354},
                    SchemeCase{"StabilizedIndex2", alpha, 0.8, stabilized, 2.0, 354},
                    SchemeCase{"Index1", alpha, 0.8, index_1, 2.0, 1400},
                    SchemeCase{"Baumgarte", alpha, 0.8, baumgarte, 2.0, 1400},
                    SchemeCase{"NewmarkStabilized", SchemeType::newmark, 1.0, stabilized, 2.0, 354},
                    SchemeCase{"NewmarkIndex1", SchemeType::newmark, 1.0, index_1, 2.0, 1400},
                    SchemeCase{"ImplicitEuler", SchemeType::implicit_euler, 0.0, index_3, 1.0, 354},
                    SchemeCase{"ImplicitEulerStabilized", SchemeType::implicit_euler, 0.0,
                               stabilized, 1.0, 354},
                    SchemeCase{"ImplicitEulerIndex1", SchemeType::implicit_euler, 0.0, index_1, 1.0,
                               354}),
    [](const auto& test) { return test.param.name; });

}  // namespace
