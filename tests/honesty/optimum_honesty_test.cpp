#include <utility>

#include "core/trust/refined_runs.hpp"
#include "optimization/design/design_solve.hpp"
#include "tests/honesty/judged_values.hpp"
#include "tests/honesty/shipped_problems.hpp"
#include "tests/support/test.hpp"

/// The error bars of optima beside optima of finer simulations. Prints a table, which docs/accuracy.md sums up.
namespace pleuel::test::optimum_honesty_test {
namespace {

/// Relative errors from which on a bar has to be of the size of the error, and how wide it may be
/// then at the settings of the file.
constexpr double small_error = 1e-5, widest = 2.0;

Result optimum(const ShippedProblem& problem, const Coarseness& coarseness) {
  ProblemFile file = refined(read_shipped(problem), {coarseness.step, coarseness.elements});
  for (std::size_t i = 0; i < file.variables.size(); ++i) {
    file.variables[i].start = problem.optimum[i];
  }
  DesignProblem design(std::move(file));
  return solve_design(design, {});
}

/// A problem whose optimum takes a minute at the settings of its file, and many at an eighth of the
/// step, is judged at coarser ones only.
bool is_slow(const ShippedProblem& problem) {
  return problem.optimum.size() > 4;
}

class OptimumError : public testing::TestWithParam<std::size_t> {};

/// Each optimum beside that of an eighth of its step and twice its elements.
TEST_P(OptimumError, CoversTheOptimumOfAFinerSimulation) {
  const ShippedProblem& problem = shipped_problems()[GetParam()];
  for (const Coarseness& coarseness :
       {Coarseness{1.0, 1.0}, Coarseness{4.0, 0.5}, Coarseness{8.0, 1.0}, Coarseness{16.0, 1.0}}) {
    const bool is_own = coarseness.step == 1.0;
    if (is_own && is_slow(problem)) continue;
    const Result found = optimum(problem, coarseness),
                 fine = optimum(problem, {coarseness.step / 8.0, 2.0 * coarseness.elements});
    ASSERT_TRUE(found.error) << found.message;
    const double value = found.evaluation.objective;
    const double missing = fine.evaluation.objective / value - 1.0;
    const double change = found.error->change() / value, bound = found.error->bound() / value;
    fmt::print("| {} | × {} | × {} | {:.6f} kg | {:+.4f} % | {:+.4f} % | {} {:.4f} % | {:.1f} |\n",
               problem.name, coarseness.step, coarseness.elements, value, 100.0 * missing,
               100.0 * change, found.error->is_resolved() ? "±" : "not resolved, ±", 100.0 * bound,
               bound / std::abs(missing));
    if (!found.error->is_resolved()) continue;
    EXPECT_LE(std::abs(missing), bound);
    if (is_own && std::abs(missing) > small_error) {
      EXPECT_LE(bound, widest * std::abs(missing));
    }
  }
}

std::string name_of(const testing::TestParamInfo<std::size_t>& info) {
  return shipped_problems()[info.param].name;
}

INSTANTIATE_TEST_SUITE_P(Shipped, OptimumError, testing::Range<std::size_t>(0, 6), name_of);

}  // namespace
}  // namespace pleuel::test::optimum_honesty_test
