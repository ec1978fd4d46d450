#include "core/base/eager_matrices.hpp"
#include "core/system/linear_forces.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::constraint_terms_test {
namespace {

constexpr ConstraintLevel all_levels[] = {ConstraintLevel::position, ConstraintLevel::velocity,
                                          ConstraintLevel::acceleration};

/// Against the whole system, which has bodies, too: what constraints are made from is the same
/// there. Half of the samples' multipliers are left out in a second run.
class ConstraintTermsOf : public testing::TestWithParam<int> {
 protected:
  ConstraintTermsOf() {
    std::vector<int> some;
    for (int i = 0; i < system_.multipliers(); i += 2) some.push_back(i);
    partly_left_out_.mechanism.system->deactivate(some);
  }

  template <class Compare>
  void for_all(const Compare& compare) {
    for (Model* model : {&model_, &partly_left_out_}) {
      System& system = *model->mechanism.system;
      ConstraintTerms constraints(system);
      for (const ConstraintLevel level : all_levels) compare(system, constraints, level);
    }
  }

  SampleScene sample_ = all_samples()[GetParam()];
  Model model_ = sample_.build(), partly_left_out_ = sample_.build();
  System& system_ = *model_.mechanism.system;
  State state_ = random_state(model_, 7);
  int n_ = system_.coordinates(), m_ = system_.multipliers();
};

TEST_P(ConstraintTermsOf, HaveTheConstraintsOfTheSystem) {
  for_all([&](System& system, ConstraintTerms& constraints, ConstraintLevel level) {
    Eigen::VectorXd expected, found;
    system.residual(state_, level, expected);
    for (const int i : system.left_out()) expected(n_ + i) = 0.0;
    constraints.residual(state_, level, found);
    EXPECT_EQ(found.tail(m_), expected.tail(m_));
  });
}

TEST_P(ConstraintTermsOf, HaveTheForcesOfTheMultipliers) {
  LinearForces forces(system_);
  forces.set(state_, state_.lambda);
  ConstraintTerms constraints(system_);
  Eigen::VectorXd found, whole;
  constraints.residual(state_, ConstraintLevel::position, found);
  State at_rest = state_;
  at_rest.v.setZero();
  system_.residual(at_rest, ConstraintLevel::position, whole);
  // Round-off of the difference that LinearForces is made from.
  EXPECT_LE((found - forces.residual()).head(n_).lpNorm<Eigen::Infinity>(),
            1e-14 * whole.lpNorm<Eigen::Infinity>());
}

TEST_P(ConstraintTermsOf, HaveTheTangentOfTheSystemWhereBodiesHaveNone) {
  for_all([&](System& system, ConstraintTerms& constraints, ConstraintLevel level) {
    const Weights weights{.q = 0.3, .v = 1.7, .a = 2.1};
    System::Matrix expected = system.make_matrix(), found = expected;
    system.tangent(state_, weights, level, expected);
    constraints.tangent(state_, weights, level, found);
    EXPECT_TRUE(Eigen::MatrixXd(found.rightCols(m_)) == Eigen::MatrixXd(expected.rightCols(m_)));
    EXPECT_TRUE(Eigen::MatrixXd(found).bottomRows(m_) == Eigen::MatrixXd(expected).bottomRows(m_));
  });
}

TEST_P(ConstraintTermsOf, HaveTheTangentOfTheForcesOfTheMultipliers) {
  LinearForces forces(system_);
  forces.set(state_, state_.lambda);
  System::Matrix expected = system_.make_matrix(), found = expected, whole = expected;
  forces.tangent(expected);
  ConstraintTerms(system_).tangent(state_, {.q = 1.0}, ConstraintLevel::position, found);
  system_.tangent(state_, {.q = 1.0}, ConstraintLevel::position, whole);
  const Eigen::MatrixXd difference = Eigen::MatrixXd(found) - Eigen::MatrixXd(expected);
  EXPECT_LE(difference.topLeftCorner(n_, n_).lpNorm<Eigen::Infinity>(),
            1e-14 * whole.coeffs().abs().maxCoeff());
}

TEST_P(ConstraintTermsOf, HaveTheDesignDerivativesOfTheConstraints) {
  for_all([&](System& system, ConstraintTerms& constraints, ConstraintLevel level) {
    Eigen::MatrixXd expected, found;
    system.design_derivative(state_, level, expected);
    constraints.design_derivative(state_, level, found);
    EXPECT_EQ(found.bottomRows(m_), expected.bottomRows(m_));
  });
}

TEST_P(ConstraintTermsOf, HaveTheParameterAdjointsOfTheConstraints) {
  for_all([&](System& system, ConstraintTerms& constraints, ConstraintLevel level) {
    Eigen::MatrixXd mu = Eigen::MatrixXd::Zero(n_ + m_, 2);
    for (int i = 0; i < m_; ++i) mu.row(n_ + i) << 1.0 + i, 0.5 - i;
    for (const int i : system.left_out()) mu.row(n_ + i).setZero();
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(system.parameter_adjoint_count(), 2);
    Eigen::MatrixXd found = expected;
    system.add_parameter_adjoints(state_, level, mu, expected);
    constraints.add_parameter_adjoints(state_, level, mu, found);
    EXPECT_EQ(system.design_gradients(found), system.design_gradients(expected));
  });
}

INSTANTIATE_TEST_SUITE_P(Samples, ConstraintTermsOf, testing::Range(0, sample_count), sample_name);

}  // namespace
}  // namespace pleuel::test::constraint_terms_test
