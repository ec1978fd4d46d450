#include "core/system/linear_forces.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/mechanism.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::linear_forces_test {
namespace {

constexpr auto on_acceleration_level = ConstraintLevel::acceleration;

class LinearForcesOf : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = all_samples()[GetParam()];
  Model model_ = sample_.build();
  System& system_ = *model_.mechanism.system;
  State state_ = random_state(model_, 7);
  int n_ = system_.coordinates(), m_ = system_.multipliers();

  /// R with a and λ, of which F is a difference: elastic forces are far larger than F here.
  Eigen::VectorXd residual_at_rest() {
    State at_rest = state_;
    at_rest.v.setZero();
    Eigen::VectorXd residual;
    system_.residual(at_rest, on_acceleration_level, residual);
    return residual;
  }
};

/// The tangent in accelerations and multipliers knows of no difference of residuals.
TEST_P(LinearForcesOf, AreTheTangentTimesAccelerationsAndMultipliers) {
  System::Matrix tangent = system_.make_matrix();
  system_.tangent(state_, {.a = 1.0}, on_acceleration_level, tangent);
  Eigen::VectorXd a_and_lambda(n_ + m_);
  a_and_lambda << state_.a, state_.lambda;
  const Eigen::VectorXd expected = tangent * a_and_lambda;
  LinearForces on_accelerations(system_, on_acceleration_level), on_positions(system_);
  on_accelerations.set(state_, state_.a, state_.lambda);
  on_positions.set(state_, state_.a, state_.lambda);
  const double round_off = 1e-14 * residual_at_rest().lpNorm<Eigen::Infinity>();
  EXPECT_LE((on_accelerations.residual() - expected).lpNorm<Eigen::Infinity>(), round_off);
  EXPECT_LE((on_positions.residual() - expected).head(n_).lpNorm<Eigen::Infinity>(), round_off);
  EXPECT_TRUE(on_positions.residual().tail(m_).isZero());
}

TEST_P(LinearForcesOf, OfMultipliersAloneHaveNoAccelerations) {
  LinearForces alone(system_), both(system_);
  alone.set(state_, state_.lambda);
  both.set(state_, Eigen::VectorXd::Zero(n_), state_.lambda);
  EXPECT_EQ(alone.residual(), both.residual());
}

TEST_P(LinearForcesOf, HaveTheTangentOfTheirResidual) {
  LinearForces forces(system_, on_acceleration_level);
  const auto residual_at = [&](const State& place, const Eigen::VectorXd& lambda) {
    forces.set(place, state_.a, lambda);
    return Eigen::VectorXd(forces.residual());
  };
  System::Matrix tangent = system_.make_matrix();
  forces.set(state_, state_.a, state_.lambda);
  forces.tangent(tangent);
  Eigen::MatrixXd expected(n_ + m_, n_ + m_);
  for (int j = 0; j < n_; ++j) {
    const auto moved = [&](double s) {
      State place = state_;
      advance(model_.mechanism.rotations, state_.q, s * Eigen::VectorXd::Unit(n_, j), place.q);
      return residual_at(place, state_.lambda);
    };
    expected.col(j) = derivative_at_zero(moved, 5e-4);
  }
  for (int j = 0; j < m_; ++j) {
    expected.col(n_ + j) = residual_at(state_, state_.lambda + Eigen::VectorXd::Unit(m_, j)) -
                           residual_at(state_, state_.lambda);
  }
  EXPECT_LE(relative_difference(Eigen::MatrixXd(tangent), expected), 1e-8);
}

/// By building the whole model anew at neighbouring designs.
TEST_P(LinearForcesOf, HaveTheDesignDerivativeOfTheirResidual) {
  LinearForces forces(system_);
  forces.set(state_, state_.a, state_.lambda);
  const Eigen::VectorXd here = forces.residual().head(n_);
  for (int j = 0; j < system_.variables(); ++j) {
    const double x = sample_.design[j];
    const auto residual_at = [&](double s) {
      auto design = sample_.design;
      design[j] += s;
      const Model moved = sample_.build_at(design);
      const Eigen::MatrixXd basis = change_of_basis(model_, moved, j, s);
      State place = state_;
      place.q = basis * state_.q;
      LinearForces there(*moved.mechanism.system);
      there.set(place, basis * state_.a, state_.lambda);
      return Eigen::VectorXd(basis.transpose() * there.residual().head(n_));
    };
    const Eigen::VectorXd expected = derivative_at_zero(residual_at, 2e-3 * std::abs(x));
    const Eigen::VectorXd found = forces.design_derivative().col(j).head(n_);
    const double scale =
        std::max(here.lpNorm<Eigen::Infinity>(), std::abs(x) * expected.lpNorm<Eigen::Infinity>());
    EXPECT_LE(std::abs(x) * (found - expected).lpNorm<Eigen::Infinity>(), 1e-8 * scale)
        << sample_.variables[j];
  }
}

TEST_P(LinearForcesOf, SumWhatMultipliesTheirDesignDerivatives) {
  LinearForces forces(system_, on_acceleration_level);
  forces.set(state_, state_.a, state_.lambda);
  const Eigen::MatrixXd mu = Eigen::MatrixXd::Random(system_.size(), 3);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(system_.parameter_adjoint_count(), 3);
  forces.add_parameter_adjoints(mu, sums);
  const Eigen::MatrixXd found = system_.design_gradients(sums);
  const Eigen::MatrixXd expected = forces.design_derivative().transpose() * mu;
  const double residual = forces.residual().lpNorm<Eigen::Infinity>();
  for (Eigen::Index j = 0; j < found.rows(); ++j) {
    const double x = std::abs(sample_.design[j]);
    const double scale = std::max(residual, x * expected.row(j).lpNorm<Eigen::Infinity>());
    EXPECT_LE(x * (found - expected).row(j).lpNorm<Eigen::Infinity>(), 1e-10 * scale) << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, LinearForcesOf, testing::Range(0, sample_count), sample_name);

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
}  // namespace pleuel::test::linear_forces_test
