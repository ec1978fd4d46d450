#include "core/integration/step_equations.hpp"

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/configuration.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/scheme_case.hpp"

namespace pleuel::test::step_equations_test {
namespace {

class EquationsOfAStep : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = all_samples()[GetParam()];
  Model model_ = sample_.build();
};

Eigen::VectorXd random_direction(Eigen::Index size) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
}

/// Of all formulations, at a state far from any solution, along a random change of the unknowns.
TEST_P(EquationsOfAStep, HaveTheTangentOfTheirResidual) {
  for (const Formulation& formulation : {index_3, stabilized, index_1, baumgarte}) {
    StepEquations equations(model_.mechanism, make_scheme(alpha, 1e-2, 0.8), formulation);
    StepState old = equations.make_state(random_state(model_, 3));
    equations.begin(old);
    StepState state = old;
    state.increment.setZero();
    equations.apply(1e-3 * random_direction(equations.size()), state);
    const Eigen::Index n = model_.mechanism.system->coordinates();
    Eigen::VectorXd along = 1e-3 * random_direction(equations.size()).reverse();
    along.head(n) = along.head(n).cwiseProduct(model_.mechanism.scale.cwiseMin(1.0)).eval();
    const auto residual_at = [&](double s) {
      StepState moved = state;
      equations.apply(s * along, moved);
      Eigen::VectorXd residual(equations.size());
      equations.residual(moved, residual);
      return residual;
    };
    System::Matrix matrix = equations.make_matrix();
    Eigen::VectorXd residual(equations.size());
    equations.linearize(state, residual, matrix);
    EXPECT_LE((residual - residual_at(0.0)).lpNorm<Eigen::Infinity>(),
              1e-13 * residual.lpNorm<Eigen::Infinity>());
    const Eigen::VectorXd expected = derivative_at_zero(residual_at, 1e-1);
    EXPECT_LE(relative_difference(Eigen::VectorXd(matrix * along), expected), 1e-6)
        << static_cast<int>(formulation.constraints);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EquationsOfAStep, testing::Range(0, sample_count), sample_name);

}  // namespace
}  // namespace pleuel::test::step_equations_test
