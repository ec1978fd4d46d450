#include <gmock/gmock.h>

#include "tests/cli/program.hpp"
#include "tests/cli/report_data.hpp"

/// report.html of check and gradient.
namespace pleuel::test::study_report_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(Check, WritesAPageIfAFolderIsNamed) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), joined({"check", problem("slider_crank_round"), "-o", "one"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json data = data_of(folder.path() / "one/report.html");
  EXPECT_EQ(data.at("card").at("command"), "check");
  EXPECT_TRUE(data.at("result").at("responses").at("crank_stress").contains("derivatives"));
  EXPECT_FALSE(named(data.at("picture").at("designs"), "start").at("responses").empty());
}

TEST(GradientReport, ComparesAllMethods) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(),
      joined({"gradient", problem("slider_crank_round"), "--compare", "-o", "one"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Effort and accuracy of the methods"));
  const json result = data_of(folder.path() / "one/report.html").at("result");
  // Two exact ones, and two differences with seven steps each.
  EXPECT_EQ(result.at("comparison").size(), 2u + 2u * 7u);
}

}  // namespace
}  // namespace pleuel::test::study_report_test
