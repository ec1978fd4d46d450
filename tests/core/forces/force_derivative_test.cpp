#include "core/base/eager_matrices.hpp"
#include "tests/core/forces/force_samples.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::force_derivative_test {
namespace {

constexpr auto at_position = ConstraintLevel::position;

class EveryForce : public testing::TestWithParam<ForceSample> {
 protected:
  ForceSample sample_ = GetParam();
  std::unique_ptr<Term> term_ = sample_.make();
  State state_ = sample_.random_state();
  Eigen::Index n_ = state_.q.size();

  /// Compares ∂(residual)/∂(part of the state) with `expected`, column by column. The fifth
  /// derivatives of these formulas are some 1e3 times their first; (1e-3)⁴ of that is 1e-9.
  template <class Shift>
  void expect_derivative(const Eigen::MatrixXd& expected, const Shift& shift) {
    for (Eigen::Index j = 0; j < n_; ++j) {
      const Eigen::VectorXd found = derivative_at_zero(
          [&](double s) {
            State moved = state_;
            shift(moved, s * Eigen::VectorXd::Unit(n_, j));
            return residual_of(*term_, moved, at_position);
          },
          1e-3);
      const double scale = std::max(expected.lpNorm<Eigen::Infinity>(), 1.0);
      EXPECT_LE((found - expected.col(j)).lpNorm<Eigen::Infinity>(), 1e-9 * scale)
          << "column " << j;
    }
  }
};

/// Rotation vectors are perturbed from the right: A exp(ε̃).
TEST_P(EveryForce, HasTheTangentOfItsResidualInThePositions) {
  expect_derivative(
      tangent_of(*term_, state_, {.q = 1.0}, at_position),
      [&](State& at, const Eigen::VectorXd& step) { at.q = sample_.advanced(state_.q, step); });
}

TEST_P(EveryForce, HasTheTangentOfItsResidualInTheVelocities) {
  expect_derivative(tangent_of(*term_, state_, {.v = 1.0}, at_position),
                    [&](State& at, const Eigen::VectorXd& step) { at.v += step; });
}

TEST_P(EveryForce, HasTheWeightedSumOfItsTangents) {
  const auto part = [&](const Weights& w) { return tangent_of(*term_, state_, w, at_position); };
  const Eigen::MatrixXd sum = 0.7 * part({.q = 1.0}) - 1.3 * part({.v = 1.0});
  const Eigen::MatrixXd difference = part({0.7, -1.3, 2.1}) - sum;
  EXPECT_LE(difference.norm(), 1e-13 * std::max(sum.norm(), 1.0));  // round-off
}

TEST_P(EveryForce, HasOneResidualHoweverItIsAskedFor) {
  EntryList entries;
  term_->declare_entries(entries);
  const std::array<Weights, 2> weights = {Weights{0.7, -1.3, 2.1}, Weights{.v = 1.0}};
  std::vector<double> values(2 * entries.size());
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(n_);
  term_->linearize(state_, weights, at_position, residual,
                   {values.data(), static_cast<std::ptrdiff_t>(entries.size())});
  EXPECT_EQ(residual, residual_of(*term_, state_, at_position));
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(n_, n_);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    second(entries[i].first, entries[i].second) += values[entries.size() + i];
  }
  EXPECT_EQ(second, tangent_of(*term_, state_, weights[1], at_position));
}

/// Each number of the data is a variable; the term is built anew with neighbouring numbers.
TEST_P(EveryForce, HasTheDesignDerivativeOfItsResidual) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n_, sample_.numbers);
  term_->add_design_derivative(state_, at_position, columns);
  for (int j = 0; j < sample_.numbers; ++j) {
    const Eigen::VectorXd found = derivative_at_zero(
        [&](double s) { return residual_of(*sample_.make_shifted(j, s), state_, at_position); },
        1e-3);
    const double scale = std::max(columns.lpNorm<Eigen::Infinity>(), 1.0);
    // As for the tangent.
    EXPECT_LE((found - columns.col(j)).lpNorm<Eigen::Infinity>(), 1e-9 * scale) << "number " << j;
  }
}

class EverySpatialForce : public EveryForce {};

/// By blocks: translations, rotations, elastic displacements and rotations of each body, three
/// coordinates each. A block that is zero in a random state always is.
TEST_P(EverySpatialForce, DeclaresOnlyBlocksThatCanDifferFromZero) {
  EntryList entries;
  term_->declare_entries(entries);
  const Eigen::MatrixXd tangent = tangent_of(*term_, state_, {0.7, -1.3, 0.0}, at_position);
  for (const auto& [row, col] : entries) {
    const auto block = tangent.block<3, 3>(row / 3 * 3, col / 3 * 3);
    EXPECT_GT(block.norm(), 1e-3) << "row " << row << ", column " << col;
  }
}

INSTANTIATE_TEST_SUITE_P(Forces, EverySpatialForce,
                         testing::ValuesIn(force_samples(ForceChoice::spatial)),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Forces, EveryForce, testing::ValuesIn(force_samples(ForceChoice::all)),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pleuel::test::force_derivative_test
