#include "sensitivity/adjoint.hpp"

#include <ostream>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "sensitivity/direct.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::adjoint_test {
namespace {

struct NamedRun {
  std::string name;
  SimulationOptions options;

  friend std::ostream& operator<<(std::ostream& stream, const NamedRun& run) {
    return stream << run.name;
  }
};

NamedRun named_run(const std::string& name, SchemeType scheme, ConstraintForm form,
                   double baumgarte = 0.0) {
  NamedRun run{name, {}};
  run.options.end_time = 0.02;
  run.options.step = 2e-3;
  run.options.scheme = scheme;
  run.options.formulation = {form, baumgarte};
  return run;
}

NamedRun projected_run(const std::string& name, SchemeType scheme) {
  NamedRun run = named_run(name, scheme, ConstraintForm::index_1);
  run.options.formulation.is_projected = true;
  return run;
}

using AdjointCase = std::tuple<int, NamedRun>;

class Adjoint : public testing::TestWithParam<AdjointCase> {
 protected:
  /// J_k = Σ weights · (q, v, a, λ) of the instants `first`, first + 3 …: different weights for
  /// each.
  struct Functions {
    int first = 0;
    std::vector<Eigen::MatrixXd> q, v, a, lambda;  ///< one an instant, rows × functions
  };
  static constexpr int count = 3;

  Functions random_functions(const Trajectory& trajectory, int first) {
    Functions functions;
    functions.first = first;
    const auto random = [this](Eigen::Index rows) -> Eigen::MatrixXd {
      return Eigen::MatrixXd::NullaryExpr(rows, count, [this] { return uniform_(generator_); });
    };
    for (int step = 0; step <= trajectory.steps(); ++step) {
      functions.q.push_back(random(trajectory.columns().q().rows()));
      functions.v.push_back(1e-2 * random(trajectory.columns().q().rows()));
      functions.a.push_back(1e-4 * random(trajectory.columns().q().rows()));
      functions.lambda.push_back(1e-4 * random(trajectory.columns().lambda().rows()));
    }
    return functions;
  }
  static bool counts(const Functions& functions, int step) { return step % 3 == functions.first; }

  std::mt19937 generator_{3};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  SampleScene sample_ = all_samples()[std::get<0>(GetParam())];
  SimulationOptions options_ = std::get<1>(GetParam()).options;
};

/// Two ways through the same linear map, forwards and backwards: all that differs is round-off,
/// relative to the parts that a gradient is the sum of, and amplified by the step matrices:
/// measured 3e-9 at worst (reduced bodies in steps of 2 ms), 1e-11 for most.
TEST_P(Adjoint, IsDirectDifferentiationTransposed) {
  Model model = sample_.build();
  const Trajectory trajectory = simulate(model.mechanism, options_);
  for (int first : {0, 1}) {
    const Functions functions = random_functions(trajectory, first);
    Eigen::MatrixXd direct = Eigen::MatrixXd::Zero(model.mechanism.system->variables(), count);
    Eigen::MatrixXd parts = direct;
    differentiate(
        model.mechanism, trajectory, [&](int step, const State&, const StateSensitivity& s) {
          if (!counts(functions, step)) return;
          const auto i = static_cast<std::size_t>(step);
          const auto add = [&](const Eigen::MatrixXd& sensitivity, const Eigen::MatrixXd& weights) {
            direct += sensitivity.transpose() * weights;
            parts += sensitivity.cwiseAbs().transpose() * weights.cwiseAbs();
          };
          add(s.q, functions.q[i]);
          add(s.v, functions.v[i]);
          add(s.a, functions.a[i]);
          add(s.lambda, functions.lambda[i]);
        });
    const Eigen::MatrixXd adjoint = adjoint_gradients(
        model.mechanism, trajectory, count, [&](int step, const State&, StateAdjoint& of) {
          if (!counts(functions, step)) return count;
          const auto i = static_cast<std::size_t>(step);
          of.q += functions.q[i];
          of.v += functions.v[i];
          of.a += functions.a[i];
          of.lambda += functions.lambda[i];
          return count;
        });
    for (Eigen::Index j = 0; j < direct.rows(); ++j) {
      EXPECT_LE((adjoint - direct).row(j).lpNorm<Eigen::Infinity>(),
                1e-7 * parts.row(j).lpNorm<Eigen::Infinity>())
          << sample_.variables[j];
    }
  }
}

/// Functions of the first instants only, as columns that come alive late.
TEST_P(Adjoint, MayBeginWithLaterFunctions) {
  Model model = sample_.build();
  const Trajectory trajectory = simulate(model.mechanism, options_);
  const Functions functions = random_functions(trajectory, 0);
  // Function k counts the instant 9 − 3k.
  const auto function_at = [](int step) { return step % 3 == 0 ? (9 - step) / 3 : -1; };
  const auto add = [&](int columns) {
    return adjoint_gradients(model.mechanism, trajectory, count,
                             [&](int step, const State&, StateAdjoint& of) {
                               const int k = function_at(step);
                               if (k < 0 || k >= count)
                                 return std::min(count, std::max(columns, 1 + (9 - step) / 3));
                               of.q.col(k) += functions.q[step].col(k);
                               return std::min(count, std::max(columns, k + 1));
                             });
  };
  const Eigen::MatrixXd late = add(0), always = add(count);
  EXPECT_LE((late - always).lpNorm<Eigen::Infinity>(), 1e-14 * always.lpNorm<Eigen::Infinity>());
}

std::string adjoint_case_name(const testing::TestParamInfo<AdjointCase>& info) {
  const auto sample = static_cast<std::size_t>(std::get<0>(info.param));
  return all_samples()[sample].name + std::get<1>(info.param).name;
}

using enum SchemeType;
using enum ConstraintForm;
INSTANTIATE_TEST_SUITE_P(
    Samples, Adjoint,
    testing::Combine(
        testing::Range(0, sample_count),
        testing::Values(named_run("Index3", generalized_alpha, index_3),
                        named_run("StabilizedIndex2", generalized_alpha, stabilized_index_2),
                        named_run("Index1", generalized_alpha, index_1),
                        named_run("Baumgarte", generalized_alpha, index_1, 50.0),
                        projected_run("Projected", generalized_alpha),
                        projected_run("ProjectedNewmark", newmark),
                        named_run("Newmark", newmark, index_3),
                        named_run("ImplicitEuler", implicit_euler, stabilized_index_2))),
    adjoint_case_name);

}  // namespace
}  // namespace pleuel::test::adjoint_test
