/// Bounds may allow sections that cannot be. The optimizer must not end at one.

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "tests/support/files.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::impossible_section_test {
namespace {

/// The round slider-crank, coarse and only its ramp, with a tube of at least 4 mm wall for a rod.
/// It may bend so much that a bar of 8 mm is stiff and strong enough; a "tube" of less diameter
/// with this wall would have less mass by its formula, πt (D − t).
ProblemFile tube_problem(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {
      R"(/scene/bodies/rod/section={"type": "tube", "outer_diameter": {"variable": "rod_diameter"}, "thickness": {"variable": "wall"}})",
      R"(/variables/wall={"start": "4 mm", "lower": "4 mm", "upper": "5 mm"})",
      "/simulation/step=0.2 ms",
      "/simulation/end_time=20 ms",
      "/scene/joints/bearing/drive/ramp=20 ms",
      "/constraints/rod_stiffness/upper=2 mm",
      "/constraints/rod_strength/upper=1 GPa"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return read_problem(source_folder() + "/problems/slider_crank_round.json", overrides).complete();
}

Result optimum_of(ProblemFile file, const std::string& backend) {
  DesignProblem problem(std::move(file));
  return solve_design(problem, {.backend = backend});
}

constexpr Eigen::Index diameter = 1, wall = 2;

TEST(ImpossibleSection, IsNotSimulated) {
  const ProblemFile problem = tube_problem();
  EXPECT_EQ(thrown<SimulationError>([&] { analyze(problem, Eigen::Vector3d(0.03, 0.007, 0.004)); }),
            "the body \"rod\" is impossible: its section's thickness must not exceed the "
            "radius 0.0035 [m] of the tube, got 0.004")
      << "a tube of 7 mm has a wall of 4 mm";
}

class OptimumOfTube : public testing::TestWithParam<const char*> {};

TEST_P(OptimumOfTube, IsAPossibleSection) {
  const Result result = optimum_of(tube_problem(), GetParam());
  EXPECT_LE(result.x(wall), 0.5 * result.x(diameter) * (1.0 + 1e-3));
}

/// As `check` suggests: then the bar of 8 mm is the optimum.
TEST_P(OptimumOfTube, IsABarWithALinearConstraint) {
  const Result result = optimum_of(
      tube_problem(
          {R"(/constraints/fits={"linear": {"rod_diameter": -0.5, "wall": 1}, "upper": 0})"}),
      GetParam());
  EXPECT_EQ(to_string(result.status), "verified") << result.message;
  EXPECT_NEAR(result.x(diameter), 0.008, 1e-3 * 0.008);
  EXPECT_NEAR(result.x(wall), 0.004, 1e-3 * 0.004);
}

/// A wall between two diameters that are variables: no bound of theirs keeps it positive, and less
/// than nothing would have less mass than nothing.
TEST_P(OptimumOfTube, HasAWallWhereItIsAFormula) {
  const ProblemFile problem = tube_problem(
      {R"(/scene/bodies/rod/section/thickness== (rod_diameter - wall)/2)",
       R"(/variables/wall={"start": "20 mm", "lower": "10 mm", "upper": "29 mm"})",
       R"(/variables/rod_diameter={"start": "30 mm", "lower": "21 mm", "upper": "50 mm"})"});
  const Result result = optimum_of(problem, GetParam());
  EXPECT_GT(result.x(diameter), result.x(wall)) << to_string(result.status);
  EXPECT_GT(result.evaluation.objective, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Backends, OptimumOfTube,
                         testing::Values("nlopt-slsqp", "nlopt-mma", "ipopt"), named_by_value());

}  // namespace
}  // namespace pleuel::test::impossible_section_test
