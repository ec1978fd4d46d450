#include "studies/missing_settings.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/studies/quick_problem.hpp"

namespace pleuel::test::missing_settings_test {
namespace {

/// What stands behind "for instance" and the key, which is how the settings would be written.
std::string example_in(const std::string& message, const std::string& key) {
  const std::string start = "for instance \"" + key + "\": ";
  const std::size_t at = message.find(start);
  return at == std::string::npos ? "" : message.substr(at + start.size());
}

template <class Requirement>
std::string complaint(Requirement require, const ProblemFile& problem) {
  try {
    require(problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MissingSettings, ExampleOfAFrontIsOneOfThisProblem) {
  ProblemFile problem = quick_problem();
  problem.pareto.reset();
  const std::string example = example_in(complaint(require_pareto, problem), "pareto");
  const ProblemFile written = quick_problem({"/pareto=" + example});
  ASSERT_TRUE(written.pareto.has_value()) << example;
  const ConstraintSettings& limit = problem.constraints.front();
  EXPECT_EQ(written.pareto->constraint, limit.name);
  EXPECT_NEAR(written.pareto->from, *limit.upper / 2, 0.005 * *limit.upper);
  EXPECT_NEAR(written.pareto->to, *limit.upper * 2, 0.02 * *limit.upper);
}

TEST(MissingSettings, ExampleOfAFrontTakesNoLimitOfTwoSides) {
  ProblemFile problem = quick_problem();
  problem.pareto.reset();
  ASSERT_GT(problem.constraints.size(), 1u);
  problem.constraints.front().lower = 0.5 * *problem.constraints.front().upper;
  const std::string example = example_in(complaint(require_pareto, problem), "pareto");
  EXPECT_THAT(example, testing::HasSubstr(problem.constraints[1].name));
  EXPECT_THAT(example, testing::Not(testing::HasSubstr(problem.constraints[0].name)));
}

TEST(MissingSettings, ExampleOfAFrontVariesALimitInAllLoadCases) {
  ProblemFile problem = read_problem(source_folder() + "/problems/two_loads.json").complete();
  problem.pareto.reset();
  EXPECT_THAT(complaint(require_pareto, problem),
              testing::HasSubstr("\"constraint\": \"crank_strength\", "));
}

TEST(MissingSettings, ExampleOfUncertainParametersIsOneOfThisProblem) {
  ProblemFile problem = quick_problem();
  problem.uncertainty.reset();
  const std::string example = example_in(complaint(require_uncertainty, problem), "uncertainty");
  const ProblemFile written = quick_problem({"/uncertainty=" + example});
  ASSERT_TRUE(written.uncertainty.has_value()) << example;
  ASSERT_EQ(written.uncertainty->parameters.size(), 1u);
}

TEST(MissingSettings, WithoutLimitsAndVariablesThereIsNoExample) {
  ProblemFile problem = quick_problem();
  problem.constraints.clear();
  problem.variables.clear();
  problem.pareto.reset();
  problem.uncertainty.reset();
  EXPECT_THAT(complaint(require_pareto, problem), testing::EndsWith("which limit to vary"));
  EXPECT_THAT(complaint(require_uncertainty, problem), testing::EndsWith("are uncertain"));
}

TEST(MissingSettings, NothingIsSaidOfWhatIsThere) {
  ProblemFile problem = quick_problem();
  problem.pareto.emplace();
  problem.uncertainty.emplace();
  EXPECT_EQ(complaint(require_pareto, problem), "");
  EXPECT_EQ(complaint(require_uncertainty, problem), "");
}

}  // namespace
}  // namespace pleuel::test::missing_settings_test
