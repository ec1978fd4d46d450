#include <array>
#include <functional>
#include <ostream>
#include <tuple>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/mechanism.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/direct.hpp"
#include "tests/support/common_basis.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

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

/// Too few iterations for such steps, so that some are split.
SimulationOptions impatient() {
  SimulationOptions options{0.06, 5e-3, 0.8};
  options.newton_tolerance = 1e-12;
  options.max_newton_iterations = 4;
  return options;
}

/// A step that fails is halved until it works, and the instants that were asked for are met.
TEST(SplitSteps, LeadToEveryRegularInstant) {
  Model model = smooth_planar_sample().build();
  const SimulationOptions options = impatient();
  const Trajectory trajectory = simulate(model.mechanism, options);
  ASSERT_GT(trajectory.split_steps, 0);
  EXPECT_EQ(trajectory.steps(), step_count(options) + trajectory.split_steps);
  for (int step = 0; step <= step_count(options); ++step) {
    const double instant = options.end_time * step / step_count(options);
    EXPECT_LE((trajectory.time.array() - instant).abs().minCoeff(), 1e-15) << step;
  }
  SimulationOptions patient = options;
  patient.max_newton_iterations = 20;
  const Trajectory whole = simulate(model.mechanism, patient);
  EXPECT_EQ(whole.split_steps, 0);
  // The same motion up to the error of the large steps.
  const Eigen::VectorXd end = trajectory.columns().q().col(trajectory.steps()),
                        other = whole.columns().q().col(whole.steps());
  EXPECT_LE((end - other).norm(), 0.05 * other.norm());
}

/// The sequence of steps that ran is differentiated.
TEST(SplitSteps, AreDifferentiatedAsTheyRan) {
  const SampleScene sample = smooth_planar_sample();
  Model model = sample.build();
  const Trajectory trajectory = simulate(model.mechanism, impatient());
  ASSERT_GT(trajectory.split_steps, 0);
  Eigen::MatrixXd s;
  differentiate(model.mechanism, trajectory,
                [&](int, const State&, const StateSensitivity& now) { s = now.q; });
  for (std::size_t j = 0; j < sample.design.size(); ++j) {
    const double h = 1e-5 * sample.design[j];
    const auto end_at = [&](double change) -> Eigen::VectorXd {
      auto design = sample.design;
      design[j] += change;
      Model neighbour = sample.build_at(design);
      const Trajectory found = simulate(neighbour.mechanism, impatient());
      EXPECT_EQ(found.steps(), trajectory.steps()) << "not the same sequence of steps";
      return found.columns().q().col(found.steps());
    };
    const Eigen::VectorXd expected = (end_at(h) - end_at(-h)) / (2 * h);
    const Eigen::VectorXd found = s.col(j);
    EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(),
              1e-5 * found.lpNorm<Eigen::Infinity>() + 1e-9)
        << sample.variables[j];
  }
}

/// A mechanism in motion sets out with velocities that belong to the size of the first step. Where
/// that fails, the halves have to set out from the initial values, not from where it did.
TEST(SplitSteps, OfTheFirstStepSetOutFromTheInitialValues) {
  const ProblemFile problem =
      sample_problem("hard/dead_centres", {"/simulation/step=16 ms", "/simulation/end_time=64 ms",
                                           "/simulation/max_newton_iterations=4"});
  const Eigen::VectorXd x = start_design(problem);
  const auto split = analyze(problem, x);
  ASSERT_LT(split->trajectory.time(1), 0.01) << "the first step was to be split";
  ProblemFile patient = with_steps_of(split->trajectory, problem);
  patient.simulation.instants.assign(split->trajectory.time.begin(), split->trajectory.time.end());
  patient.simulation.max_newton_iterations = 20;
  const auto whole = analyze(patient, x);
  ASSERT_EQ(whole->trajectory.split_steps, 0);
  ASSERT_EQ(whole->trajectory.steps(), split->trajectory.steps());
  State found, expected;
  for (int step = 0; step <= split->trajectory.steps(); ++step) {
    split->trajectory.states->load(step, found);
    whole->trajectory.states->load(step, expected);
    // What Newton's method leaves, 1e-10, in another number of iterations.
    EXPECT_LE((found.v - expected.v).norm(), 1e-7 * expected.v.norm()) << step;
  }
}

}  // namespace
}  // namespace pleuel::test::trajectory_sensitivity_test
