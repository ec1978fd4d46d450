#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"
#include "tests/support/source_folder.hpp"

/// Problem files that `new` writes to begin with, and the schema beside them.
namespace pleuel::test::starter_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

const std::vector<std::string> kinds = {"cantilever", "slider-crank", "four-bar", "robot", "press"};

class Starter : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_EQ(run({"new", GetParam(), "begin.json"}).exit_code, 0); }
  ProgramRun run(const std::vector<std::string>& words) const {
    return run_program(folder_.path(), words);
  }

  const TemporaryFolder folder_;
};

TEST_P(Starter, HasAVerifiedOptimumThatIsLighter) {
  const ProgramRun optimum = run({"optimize", "begin.json", "--json", "--no-report"});
  EXPECT_EQ(optimum.exit_code, 0) << optimum.err;
  const nlohmann::json document = optimum.document();
  EXPECT_EQ(document.at("status"), "verified");
  EXPECT_LT(document.at("objective").at("value"), document.at("objective").at("start"));
  EXPECT_EQ(document.at("warnings"), nlohmann::json::array());
}

TEST_P(Starter, IsCheckedWithoutWarning) {
  const ProgramRun check = run({"check", "begin.json", "--json"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_EQ(check.document().at("warnings"), nlohmann::json::array());
  EXPECT_EQ(check.document().at("rigid_motion").at("free"), 0);
  for (const auto& [name, response] : check.document().at("responses").items()) {
    EXPECT_NE(response.at("derivatives").at("verdict"), "differs") << name;
  }
}

TEST_P(Starter, NamesTheSchemaThatLiesBesideIt) {
  const auto problem = nlohmann::json::parse(read_file(folder_.path() / "begin.json"));
  const fs::path schema = folder_.path() / problem.at("$schema").get<std::string>();
  EXPECT_EQ(read_file(schema), read_file(source_folder() + "/problems/problem.schema.json"));
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, Starter, testing::ValuesIn(kinds), [](const auto& kind) {
  std::string name = kind.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(New, AloneListsTheKindsALineEach) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"new"});
  EXPECT_EQ(run.exit_code, 0);
  for (const std::string& kind : kinds) {
    EXPECT_THAT(run.out, ContainsRegex("\n  " + kind + " +a [^\n]+\n"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(New, TakesTheKindForTheNameOfTheFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program(folder.path(), {"new", "press"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "press.json"));
}

TEST(New, ReplacesNoWorkWithoutBeingTold) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "mine.json", schema = folder.path() / "problem.schema.json";
  std::ofstream(file) << "mine";
  std::ofstream(schema) << "mine, too";
  const ProgramRun refused = run_program(folder.path(), {"new", "press", "mine.json"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, "pleuel: mine.json: is there already; --overwrite replaces it\n");
  EXPECT_EQ(read_file(file), "mine");
  EXPECT_EQ(run_program(folder.path(), {"new", "press", "other.json"}).exit_code, 0);
  EXPECT_EQ(read_file(schema), "mine, too");
  EXPECT_EQ(run_program(folder.path(), {"new", "press", "mine.json", "--overwrite"}).exit_code, 0);
  EXPECT_THAT(read_file(file), HasSubstr("\"scene\""));
  EXPECT_THAT(read_file(schema), HasSubstr("\"definitions\""));
}

TEST(New, SaysOnceWhyItCannotWrite) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "";
  const ProgramRun run = run_program(folder.path(), {"new", "press", "file/mine.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.err, "pleuel: file: cannot be created: Not a directory\n");
}

TEST(New, NamesTheKindThatWasProbablyMeant) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"new", "fourbar", "mine.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("did you mean \"four-bar\"?"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Help, IsThatOfTheCommandThatIsNamed) {
  const TemporaryFolder folder;
  const std::string help = run_program(folder.path(), {"pareto", "--help"}).out;
  EXPECT_THAT(help, HasSubstr("pleuel pareto [OPTIONS] FILE"));
  EXPECT_EQ(run_program(folder.path(), {"help", "pareto"}).out, help);
  EXPECT_EQ(run_program(folder.path(), {"help"}).out, run_program(folder.path(), {"--help"}).out);
  EXPECT_EQ(run_program(folder.path(), {"optimise"}).err,
            "pleuel: there is no command \"optimise\"; did you mean \"optimize\"?\n");
}

/// All but the drawing.
TEST(Show, IsInWordsWhereNoPageIsBuilt) {
  const TemporaryFolder folder;
  run_program(folder.path(), {"new", "press"});
  const std::string no_page = "PLEUEL_REPORT_TEMPLATE=nowhere";
  const ProgramRun run = run_line(folder.path(), "backends >/dev/null; export " + no_page + "; " +
                                                     PLEUEL_PROGRAM + " show press.json");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Rigid motion: "));
  EXPECT_THAT(run.out, HasSubstr("No drawing: the template of pages is not built"));
  EXPECT_FALSE(fs::exists(folder.path() / "runs"));
}

TEST(Schema, IsThatOfTheProblems) {
  const TemporaryFolder folder;
  const std::string schema = read_file(source_folder() + "/problems/problem.schema.json");
  EXPECT_EQ(run_program(folder.path(), {"schema"}).out, schema);
  EXPECT_EQ(run_program(folder.path(), {"schema", "my.schema.json"}).exit_code, 0);
  EXPECT_EQ(read_file(folder.path() / "my.schema.json"), schema);
}

}  // namespace
}  // namespace pleuel::test::starter_test
