#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/mechanism.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::term_derivative_test {
namespace {

struct Case {
  int sample;
  ConstraintLevel level;
};

class EveryTerm : public testing::TestWithParam<Case> {
 protected:
  SampleScene sample_ = all_samples()[GetParam().sample];
  Model model_ = sample_.build();
  State state_ = random_state(model_, 7);

  /// Compares ∂(residual)/∂(part of the state) with `expected`, column by column.
  template <class Shift>
  void expect_derivative(Term& term, const Eigen::MatrixXd& expected, Eigen::Index columns,
                         const Eigen::VectorXd& steps, Shift&& shift, const char* what) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      const Eigen::VectorXd found = derivative_at_zero(
          [&](double s) {
            State moved = state_;
            shift(moved, j, s);
            return residual_of(term, moved, GetParam().level);
          },
          steps(j));
      // Round-off of a difference: 1e-16 of the residual, over the step.
      const double noise =
          1e-14 * residual_of(term, state_, GetParam().level).lpNorm<Eigen::Infinity>() / steps(j);
      const double difference = (found - expected.col(j)).lpNorm<Eigen::Infinity>();
      EXPECT_LE(difference, 1e-8 * expected.lpNorm<Eigen::Infinity>() + noise)
          << term.name() << ", " << what << ", column " << j;
    }
  }
};

TEST_P(EveryTerm, HasTheTangentOfItsResidualInThePositions) {
  const auto n = state_.q.size();
  for (const auto& term : model_.mechanism.system->terms()) {
    const auto tangent = tangent_of(*term, state_, {.q = 1.0}, GetParam().level).leftCols(n).eval();
    expect_derivative(
        *term, tangent, n, Eigen::VectorXd::Constant(n, 5e-4),
        [&](State& at, Eigen::Index j, double s) {
          const Eigen::VectorXd start = at.q;
          advance(model_.mechanism.rotations, start, s * Eigen::VectorXd::Unit(n, j), at.q);
        },
        "q");
  }
}

TEST_P(EveryTerm, HasTheTangentOfItsResidualInTheVelocities) {
  const auto n = state_.q.size();
  for (const auto& term : model_.mechanism.system->terms()) {
    const auto tangent = tangent_of(*term, state_, {.v = 1.0}, GetParam().level).leftCols(n).eval();
    expect_derivative(
        *term, tangent, n, Eigen::VectorXd::Constant(n, 1.0),
        [](State& at, Eigen::Index j, double s) { at.v(j) += s; }, "v");
  }
}

TEST_P(EveryTerm, HasTheTangentOfItsResidualInTheAccelerations) {
  const auto n = state_.q.size();
  for (const auto& term : model_.mechanism.system->terms()) {
    const auto tangent = tangent_of(*term, state_, {.a = 1.0}, GetParam().level).leftCols(n).eval();
    expect_derivative(
        *term, tangent, n, Eigen::VectorXd::Constant(n, 10.0),
        [](State& at, Eigen::Index j, double s) { at.a(j) += s; }, "a");
  }
}

TEST_P(EveryTerm, HasTheTangentOfItsResidualInTheMultipliers) {
  const auto m = state_.lambda.size();
  for (const auto& term : model_.mechanism.system->terms()) {
    const auto tangent = tangent_of(*term, state_, {}, GetParam().level).rightCols(m).eval();
    expect_derivative(
        *term, tangent, m, Eigen::VectorXd::Ones(m),
        [](State& at, Eigen::Index j, double s) { at.lambda(j) += s; }, "lambda");
  }
}

TEST_P(EveryTerm, HasTheWeightedSumOfItsTangents) {
  const Weights weights{0.7, -1.3, 2.1};
  const auto n = state_.q.size();
  for (const auto& term : model_.mechanism.system->terms()) {
    const auto part = [&](const Weights& w) {
      return tangent_of(*term, state_, w, GetParam().level).leftCols(n).eval();
    };
    const Eigen::MatrixXd sum =
        0.7 * part({.q = 1.0}) - 1.3 * part({.v = 1.0}) + 2.1 * part({.a = 1.0});
    EXPECT_LE(relative_difference(part(weights), sum), 1e-14) << term->name();
  }
}

/// What residual and several tangents share may not change any of them.
TEST_P(EveryTerm, HasOneResidualAndOneTangentHoweverTheyAreAskedFor) {
  const std::array<Weights, 2> weights = {Weights{0.7, -1.3, 2.1}, Weights{.v = 1.0}};
  for (const auto& term : model_.mechanism.system->terms()) {
    EntryList entries;
    term->declare_entries(entries);
    const auto size = entries.size();
    std::vector<double> values(2 * size + 3);
    Eigen::VectorXd found = Eigen::VectorXd::Zero(model_.mechanism.system->size());
    term->linearize(state_, weights, GetParam().level, found,
                    {values.data(), static_cast<std::ptrdiff_t>(size) + 3});
    EXPECT_LE(relative_difference(found, residual_of(*term, state_, GetParam().level)), 1e-13)
        << term->name();
    for (std::size_t block = 0; block < 2; ++block) {
      Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(found.size(), found.size());
      for (std::size_t i = 0; i < size; ++i) {
        tangent(entries[i].first, entries[i].second) += values[block * (size + 3) + i];
      }
      const auto alone = tangent_of(*term, state_, weights[block], GetParam().level);
      EXPECT_LE(relative_difference(tangent, alone), 1e-14) << term->name();
    }
  }
}

/// By building the whole model anew at neighbouring designs.
TEST_P(EveryTerm, HasTheDesignDerivativeOfItsResidual) {
  System& system = *model_.mechanism.system;
  const auto terms = system.terms().size();
  for (int j = 0; j < system.variables(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const double x = sample_.design[index];
    // Column i: the residual of term i.
    const auto residuals_at = [&](double s) {
      auto design = sample_.design;
      design[index] += s;
      const Model moved = sample_.build_at(design);
      const Eigen::MatrixXd basis = change_of_basis(model_, moved, j, s);
      State state = state_;
      state.q = basis * state_.q;
      state.v = basis * state_.v;
      state.a = basis * state_.a;
      Eigen::MatrixXd residuals(system.size(), static_cast<Eigen::Index>(terms));
      for (std::size_t i = 0; i < terms; ++i) {
        residuals.col(i) =
            residual_of(*moved.mechanism.system->terms()[i], state, GetParam().level);
      }
      residuals.topRows(basis.rows()) =
          (basis.transpose() * residuals.topRows(basis.rows())).eval();
      return residuals;
    };
    const Eigen::MatrixXd found = derivative_at_zero(residuals_at, 2e-3 * std::abs(x));
    for (std::size_t i = 0; i < terms; ++i) {
      Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(system.size(), system.variables());
      system.terms()[i]->add_design_derivative(state_, GetParam().level, columns);
      const double scale = std::max(
          residual_of(*system.terms()[i], state_, GetParam().level).lpNorm<Eigen::Infinity>(),
          std::abs(x) * columns.col(j).lpNorm<Eigen::Infinity>());
      const double difference = (found.col(i) - columns.col(j)).lpNorm<Eigen::Infinity>();
      EXPECT_LE(difference * std::abs(x), 1e-8 * scale)
          << system.terms()[i]->name() << ", variable " << sample_.variables[index];
    }
  }
}

/// The sums of several instants, multiplied with the derivatives of the data afterwards, against
/// the columns of each instant, multiplied with μ.
TEST_P(EveryTerm, SumsWhatMultipliesItsDesignDerivatives) {
  const System& system = *model_.mechanism.system;
  const State other = random_state(model_, 8);
  const Eigen::MatrixXd mu = Eigen::MatrixXd::Random(system.size(), 3);
  for (const auto& term : system.terms()) {
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(system.variables(), 3);
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(term->parameter_adjoint_count(), 3);
    for (const State& state : {state_, other}) {
      Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(system.size(), system.variables());
      term->add_design_derivative(state, GetParam().level, columns);
      expected += columns.transpose() * mu;
      term->add_parameter_adjoints(state, GetParam().level, mu, sums);
    }
    Eigen::MatrixXd found = Eigen::MatrixXd::Zero(system.variables(), 3);
    term->add_design_gradients(sums, found);
    const double residual = residual_of(*term, state_, GetParam().level).lpNorm<Eigen::Infinity>();
    for (Eigen::Index j = 0; j < found.rows(); ++j) {
      const double x = std::abs(sample_.design[j]);
      const double scale = std::max(residual, x * expected.row(j).lpNorm<Eigen::Infinity>());
      EXPECT_LE(x * (found - expected).row(j).lpNorm<Eigen::Infinity>(), 1e-10 * scale)
          << term->name() << ", variable " << j;
    }
  }
}

class EverySample : public testing::TestWithParam<int> {
 protected:
  SampleScene sample_ = all_samples()[GetParam()];
  Model model_ = sample_.build();
  State state_ = random_state(model_, 7);
};

/// The multipliers' part of the dynamic rows is Φ_qᵀ λ, with Φ_q from differences of Φ.
TEST_P(EverySample, PushesAlongTheGradientsOfItsConstraints) {
  const auto n = state_.q.size(), m = state_.lambda.size();
  for (const auto& term : model_.mechanism.system->terms()) {
    Eigen::VectorXd expected(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      expected(j) = derivative_at_zero(
          [&](double s) {
            State moved = state_;
            advance(model_.mechanism.rotations, state_.q, s * Eigen::VectorXd::Unit(n, j), moved.q);
            return residual_of(*term, moved, ConstraintLevel::position).tail(m).dot(state_.lambda);
          },
          1e-3);
    }
    State free = state_;
    free.lambda.setZero();
    const Eigen::VectorXd found = (residual_of(*term, state_, ConstraintLevel::position) -
                                   residual_of(*term, free, ConstraintLevel::position))
                                      .head(n);
    EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(),
              1e-9 * expected.lpNorm<Eigen::Infinity>())
        << term->name();
  }
}

/// Φ̇ and Φ̈ are the time derivatives of Φ along q(t) = q + v t + a t²/2. The steps are small against
/// the ramps of the drives (0.04 s); what is left is their fourth power, and round-off.
TEST_P(EverySample, HasTheTimeDerivativesOfItsConstraints) {
  const auto m = state_.lambda.size();
  for (const auto& term : model_.mechanism.system->terms()) {
    const auto position = [&](double t) -> Eigen::VectorXd {
      State moved = state_;
      moved.time += t;
      advance(model_.mechanism.rotations, state_.q, t * state_.v + 0.5 * t * t * state_.a, moved.q);
      return residual_of(*term, moved, ConstraintLevel::position).tail(m);
    };
    const auto expect_rate = [&](ConstraintLevel level, const Eigen::VectorXd& expected) {
      const Eigen::VectorXd found = residual_of(*term, state_, level).tail(m);
      EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(),
                1e-7 * (1.0 + expected.lpNorm<Eigen::Infinity>()))
          << term->name() << ", level " << static_cast<int>(level);
    };
    expect_rate(ConstraintLevel::velocity, derivative_at_zero(position, 2e-4));
    expect_rate(ConstraintLevel::acceleration, second_derivative_at_zero(position, 4e-4));
  }
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (int sample = 0; sample < sample_count; ++sample) {
    for (auto level :
         {ConstraintLevel::position, ConstraintLevel::velocity, ConstraintLevel::acceleration}) {
      cases.push_back({sample, level});
    }
  }
  return cases;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  const char* levels[] = {"Position", "Velocity", "Acceleration"};
  return all_samples()[info.param.sample].name + levels[static_cast<int>(info.param.level)];
}

INSTANTIATE_TEST_SUITE_P(Samples, EveryTerm, testing::ValuesIn(all_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Samples, EverySample, testing::Range(0, sample_count), sample_name);

}  // namespace
}  // namespace pleuel::test::term_derivative_test
