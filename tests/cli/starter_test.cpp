#include <fstream>

#include "tests/cli/program.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/test.hpp"

/// Problem files that `new` writes to begin with, and the schema beside them.
namespace pleuel::test::starter_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kinds = {"cantilever", "slider-crank", "four-bar", "robot", "press"};

class Starter : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_EQ(run({"new", GetParam(), "begin.json"}).exit_code, 0); }
  ProgramRun run(const std::vector<std::string>& words) const { return folder_.run(words); }

  const ProgramFolder folder_;
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
  const auto problem = read_json(folder_.path() / "begin.json");
  const fs::path schema = folder_.path() / problem.at("$schema").get<std::string>();
  EXPECT_EQ(read_file(schema), read_file(source_folder() + "/problems/problem.schema.json"));
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, Starter, testing::ValuesIn(kinds), [](const auto& kind) {
  std::string name = kind.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

using New = InProgramFolder;

TEST_F(New, AloneListsTheKindsALineEach) {
  const ProgramRun run = folder_.run({"new"});
  EXPECT_EQ(run.exit_code, 0);
  for (const std::string& kind : kinds) {
    EXPECT_THAT(run.out, ContainsRegex("\n  " + kind + " +a [^\n]+\n"));
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(New, TakesTheKindForTheNameOfTheFile) {
  EXPECT_EQ(folder_.run({"new", "press"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "press.json"));
}

TEST_F(New, ReplacesNoWorkWithoutBeingTold) {
  const fs::path file = folder_.path() / "mine.json",
                 schema = folder_.path() / "problem.schema.json";
  std::ofstream(file) << "mine";
  std::ofstream(schema) << "mine, too";
  const ProgramRun refused = folder_.run({"new", "press", "mine.json"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, "pleuel: mine.json: is there already; --overwrite replaces it\n");
  EXPECT_EQ(read_file(file), "mine");
  EXPECT_EQ(folder_.run({"new", "press", "other.json"}).exit_code, 0);
  EXPECT_EQ(read_file(schema), "mine, too");
  EXPECT_EQ(folder_.run({"new", "press", "mine.json", "--overwrite"}).exit_code, 0);
  EXPECT_THAT(read_file(file), HasSubstr("\"scene\""));
  EXPECT_THAT(read_file(schema), HasSubstr("\"definitions\""));
}

TEST_F(New, SaysOnceWhyItCannotWrite) {
  std::ofstream(folder_.path() / "file") << "";
  const ProgramRun run = folder_.run({"new", "press", "file/mine.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.err, "pleuel: file: cannot be created: Not a directory\n");
}

TEST_F(New, NamesTheKindThatWasProbablyMeant) {
  const ProgramRun run = folder_.run({"new", "fourbar", "mine.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("did you mean \"four-bar\"?"));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

using Help = InProgramFolder;

TEST_F(Help, IsThatOfTheCommandThatIsNamed) {
  const std::string help = folder_.run({"pareto", "--help"}).out;
  EXPECT_THAT(help, HasSubstr("pleuel pareto [OPTIONS] FILE"));
  EXPECT_EQ(folder_.run({"help", "pareto"}).out, help);
  EXPECT_EQ(folder_.run({"help"}).out, folder_.run({"--help"}).out);
  EXPECT_EQ(folder_.run({"optimise"}).err,
            "pleuel: there is no command \"optimise\"; did you mean \"optimize\"?\n");
}

using Show = InProgramFolder;

/// All but the drawing.
TEST_F(Show, IsInWordsWhereNoPageIsBuilt) {
  folder_.run({"new", "press"});
  const std::string no_page = "PLEUEL_REPORT_TEMPLATE=nowhere";
  const ProgramRun run = folder_.run_line("backends >/dev/null; export " + no_page + "; " +
                                          PLEUEL_PROGRAM + " show press.json");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Rigid motion: "));
  EXPECT_THAT(run.out, HasSubstr("No drawing: the template of pages is not built"));
  EXPECT_FALSE(fs::exists(folder_.path() / "runs"));
}

TEST(Schema, IsThatOfTheProblems) {
  const ProgramFolder folder;
  const std::string schema = read_file(source_folder() + "/problems/problem.schema.json");
  EXPECT_EQ(folder.run({"schema"}).out, schema);
  EXPECT_EQ(folder.run({"schema", "my.schema.json"}).exit_code, 0);
  EXPECT_EQ(read_file(folder.path() / "my.schema.json"), schema);
}

}  // namespace
}  // namespace pleuel::test::starter_test
