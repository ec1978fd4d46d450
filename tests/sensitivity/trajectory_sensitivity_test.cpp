#include <algorithm>
#include <array>
#include <functional>
#include <ostream>
#include <tuple>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/configuration.hpp"
#include "sensitivity/direct.hpp"
#include "tests/support/common_basis.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::trajectory_sensitivity_test {
namespace {

/// Large steps: the gradient is that of the scheme at any step, and differences of accelerations,
/// which are Δq/h²β, have the less round-off.
SimulationOptions short_run(const Formulation& formulation) {
  SimulationOptions options{0.02, 2e-3, 0.8};
  options.newton_tolerance = 1e-12;
  options.formulation = formulation;
  return options;
}

struct NamedFormulation {
  std::string name;
  Formulation formulation;

  friend std::ostream& operator<<(std::ostream& stream, const NamedFormulation& named) {
    return stream << (named.name.empty() ? "Index3" : named.name);
  }
};
const NamedFormulation plain{"", {}};
const NamedFormulation stabilized{"StabilizedIndex2", {ConstraintForm::stabilized_index_2}};
const NamedFormulation baumgarte{"Baumgarte", {ConstraintForm::index_1, 50.0}};
const NamedFormulation projected{"Projected", {ConstraintForm::index_1, 0.0, true}};

/// q, v, a, λ of the last step.
std::array<Eigen::VectorXd, 4> end_of(const Trajectory& trajectory) {
  const int last = trajectory.steps();
  return {trajectory.columns().q().col(last), trajectory.columns().v().col(last),
          trajectory.columns().a().col(last), trajectory.columns().lambda().col(last)};
}

using DirectCase = std::tuple<int, NamedFormulation>;

class DirectDifferentiation : public testing::TestWithParam<DirectCase> {
 protected:
  SampleScene sample_ = all_samples()[std::get<0>(GetParam())];
  SimulationOptions options_ = short_run(std::get<1>(GetParam()).formulation);
};

class DifferentiatedConstraints : public DirectDifferentiation {};

/// The whole state after ten steps, every variable, against simulating anew: central differences at
/// the best step of a V-curve, or the first that is good enough. Fast modes change their phase
/// quickly with a design, and accelerations have the round-off of positions over h². Measured at
/// worst 1e-9, 3e-7, 1e-6, 2e-6; times ten.
TEST_P(DirectDifferentiation, IsTheDifferenceOfNeighbouringTrajectories) {
  Model model = sample_.build();
  const Trajectory trajectory = simulate(model.mechanism, options_);
  StateSensitivity s;
  differentiate(model.mechanism, trajectory,
                [&](int step, const State&, const StateSensitivity& now) {
                  if (step == trajectory.steps()) s = now;
                });
  const auto at = end_of(trajectory);
  const std::array<double, 4> tolerance = {1e-8, 3e-6, 1e-5, 2e-5};
  for (int j = 0; j < model.mechanism.system->variables(); ++j) {
    const auto index = static_cast<std::size_t>(j);
    const double x = sample_.design[index];
    const std::array<Eigen::VectorXd, 4> found = {s.q.col(j), s.v.col(j), s.a.col(j),
                                                  s.lambda.col(j)};
    std::array<double, 4> best = {1.0, 1.0, 1.0, 1.0};
    const auto is_found = [&] {
      return std::equal(best.begin(), best.end(), tolerance.begin(), std::less_equal<>());
    };
    for (double relative : {1e-4, 1e-5, 1e-3}) {
      const auto end_at = [&](double change) {
        auto design = sample_.design;
        design[index] += change;
        Model neighbour = sample_.build_at(design);
        auto end = end_of(simulate(neighbour.mechanism, options_));
        const Eigen::MatrixXd basis = change_of_basis(model, neighbour, j, change);
        for (std::size_t i = 0; i < 3; ++i) end[i] = solve_dense(basis, end[i]);
        return end;
      };
      const double h = relative * std::abs(x);
      const auto up = end_at(h), down = end_at(-h);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto change = [&](const Eigen::VectorXd& value) -> Eigen::VectorXd {
          if (i > 0) return value - at[i];
          return difference(model.mechanism.rotations, value, at[i]);
        };
        const Eigen::VectorXd expected = (change(up[i]) - change(down[i])) / (2 * h);
        const double scale = std::max(expected.lpNorm<Eigen::Infinity>(),
                                      at[i].lpNorm<Eigen::Infinity>() / std::abs(x));
        const double error = (found[i] - expected).lpNorm<Eigen::Infinity>() / scale;
        best[i] = std::min(best[i], error);
      }
      if (is_found()) break;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LE(best[i], tolerance[i])
          << std::array{"q", "v", "a", "lambda"}[i] << ", variable " << sample_.variables[index];
    }
  }
}

/// The sensitivities stay on the differentiated constraints: measured 1.7e-12 of the largest at
/// worst.
TEST_P(DifferentiatedConstraints, AreKept) {
  Model model = sample_.build();
  System& system = *model.mechanism.system;
  const Trajectory trajectory = simulate(model.mechanism, options_);
  System::Matrix matrix = system.make_matrix();
  Eigen::MatrixXd columns;
  differentiate(
      model.mechanism, trajectory, [&](int, const State& state, const StateSensitivity& s) {
        system.tangent(state, {.q = 1.0}, ConstraintLevel::position, matrix);
        system.design_derivative(state, ConstraintLevel::position, columns);
        const Eigen::MatrixXd phi_x = columns.bottomRows(system.multipliers());
        const Eigen::MatrixXd total =
            (matrix.leftCols(system.coordinates()) * s.q).bottomRows(system.multipliers()) + phi_x;
        const Eigen::RowVectorXd scale =
            phi_x.cwiseAbs().colwise().maxCoeff() + s.q.cwiseAbs().colwise().maxCoeff();
        for (Eigen::Index j = 0; j < total.cols(); ++j) {
          ASSERT_LE(total.col(j).lpNorm<Eigen::Infinity>(), 1e-11 * (scale(j) + 1e-12));
        }
      });
}

std::string direct_case_name(const testing::TestParamInfo<DirectCase>& info) {
  const auto sample = static_cast<std::size_t>(std::get<0>(info.param));
  return all_samples()[sample].name + std::get<1>(info.param).name;
}
INSTANTIATE_TEST_SUITE_P(Samples, DirectDifferentiation,
                         testing::Combine(testing::Range(0, sample_count),
                                          testing::Values(plain, stabilized, baumgarte, projected)),
                         direct_case_name);
INSTANTIATE_TEST_SUITE_P(Samples, DifferentiatedConstraints,
                         testing::Combine(testing::Range(0, sample_count),
                                          testing::Values(plain, stabilized, projected)),
                         direct_case_name);

}  // namespace
}  // namespace pleuel::test::trajectory_sensitivity_test
