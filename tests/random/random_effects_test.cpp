#include "core/base/eager_matrices.hpp"
#include "core/response/effect_measurement.hpp"
#include "tests/random/seeds.hpp"
#include "tests/random/simulated_scene.hpp"
#include "tests/support/test.hpp"

/// What a tolerance promises of effects that are left out.
namespace pleuel::test::random_effects_test {
namespace {

/// So many seeds at most: each takes some simulations for each of three tolerances.
constexpr unsigned most_seeds = 45;

int count_left_out(const ProblemFile& problem) {
  int count = 0;
  for (const auto& [name, effect] : problem.effects.decisions.measured)
    count += effect.is_needed ? 0 : 1;
  return count;
}

TEST(RandomEffects, ThatAreLeftOutChangeNoResponseByMoreThanTheTolerance) {
  int left_out = 0;
  for (unsigned seed = first_seed; seed < std::min(end_seed, first_seed + most_seeds); ++seed) {
    const SimulatedScene scene = simulated_scene(seed);
    if (!scene.analysis) continue;
    ProblemFile complete = scene.problem;
    complete.effects = {};
    const Eigen::VectorXd x = start_design(complete);
    const auto everything = analyze(complete, x);
    for (const double tolerance : {0.1, 1e-2, 1e-3}) {
      ProblemFile lean = complete;
      lean.effects.tolerance = tolerance;
      decide_effects(lean);
      left_out += count_left_out(lean);
      const LargestChange change = largest_change(lean, *everything, *analyze(lean, x));
      EXPECT_LE(change.relative, tolerance) << "seed " << seed << ": " << change.response;
    }
  }
  EXPECT_GT(left_out, 0) << "nothing was left out: this shows nothing";
}

}  // namespace
}  // namespace pleuel::test::random_effects_test
