#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include <unistd.h>

#include "cli/commands/progress_line.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

/// Problem files that `new` writes to begin with, and the schema beside them.

namespace pleuel::test::command_line_test {
namespace {

using ::testing::Eq;

/// Exit code 2, one line that begins with the program's name, nothing on standard output.
void expect_complaint(const std::vector<std::string>& words, const std::string& part) {
  const ProgramFolder folder;
  const ProgramRun run = exits(2, folder.run(words));
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: "), HasSubstr(part)));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1);
  EXPECT_THAT(run.out, Eq(""));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "bad input must leave no run folder";
}

using BadInput = InProgramFolder;

TEST_F(BadInput, MissingFileIsNamed) {
  expect_complaint({"simulate", "nothing.json"}, "nothing.json: there is no such file");
}

TEST_F(BadInput, WrongValueIsNamedByItsPointer) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--set", "/simulation/step=-1 s"},
                   "/simulation/step");
}

/// Commands that simulate, and those that only look at instants.
TEST_F(BadInput, StepsThatNoMachineHoldsAreRefusedBeforeAnyLoop) {
  for (const char* command : {"show", "simulate", "optimize"}) {
    expect_complaint(
        {command, problem("slider_crank_round"), "--set", "/simulation/step=1.2e-10 s"},
        "but the machine has");
  }
}

TEST_F(BadInput, LongTextsAreToldByTheirBeginnings) {
  const std::string text(1'000'000, 'x');
  for (const auto& [place, value] :
       {std::pair{"name", nlohmann::json(1)}, std::pair{"scene", nlohmann::json(text)},
        std::pair{"objective", nlohmann::json{{"minimize", text}}},
        std::pair{"objective", nlohmann::json{{"minimize", "= " + text}}},
        std::pair{"simulation", nlohmann::json{{text, 1}}}}) {
    nlohmann::json document = read_json(problem("slider_crank_round"));
    document[place] = value;
    std::ofstream(folder_.path() / "long.json") << document;
    const ProgramRun run = folder_.run({"show", "long.json"});
    EXPECT_EQ(run.exit_code, 2) << place;
    EXPECT_THAT(run.err, StartsWith("pleuel: long.json: /")) << place;
    EXPECT_LT(run.err.size(), 5000) << place;
  }
}

TEST_F(BadInput, SeveralMistakesAreALineEach) {
  const ProgramRun run = exits(
      2,
      run_program(TemporaryFolder().path(),
                  {"simulate", problem("slider_crank"), "--set", "/scene/bodies/crank/elements=0",
                   "--set", "/scene/bodies/rod/elements=0", "--set", "/simulation/step=-1 s"}));
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: 3 mistakes:\n"),
                             HasSubstr("\n" + problem("slider_crank") +
                                       ": /scene/bodies/crank/elements must be "),
                             HasSubstr(": /scene/bodies/rod/elements must be "),
                             HasSubstr(": /simulation/step must be ")));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 4);
}

/// 0.1 in place of "0.2 mm" would be 100 mm.
TEST_F(BadInput, OverrideWithoutTheUnitOfTheFileHasTwoReadings) {
  expect_complaint(
      {"simulate", problem("slider_crank"), "--set", "/constraints/rod_stiffness/upper=0.1"},
      "the file has \"0.2 mm\" there: write \"0.1 mm\", or \"100 mm\" if the number is in SI");
  expect_complaint({"simulate", problem("slider_crank"), "--set", "rod_height=0.012"},
                   "write \"0.012 mm\", or \"12 mm\" if");
  // What is no place of the file is refused as that.
  expect_complaint({"simulate", problem("slider_crank"), "--set", "/scene/a~2=1"}, "neither ~0");
  // A number in place of a number says what it is.
  expect_complaint({"simulate", problem("slider_crank"), "--set", "/scene/bodies/rod/elements=0"},
                   "/scene/bodies/rod/elements must be");
}

TEST_F(BadInput, OverrideOfNothingIsRefused) {
  expect_complaint({"check", problem("slider_crank_round"), "--set", "/simulation/stp/x=1"}, "stp");
}

TEST_F(BadInput, UnknownBackendListsThoseThereAre) {
  expect_complaint({"optimize", problem("slider_crank_round"), "--backend", "magic"},
                   "nlopt-mma, nlopt-ccsaq, nlopt-slsqp, ipopt");
}

TEST_F(BadInput, UnknownMethodListsThoseThereAre) {
  expect_complaint({"gradient", problem("slider_crank_round"), "--method", "guess"},
                   "auto, direct, adjoint, forward-difference, central-difference");
}

TEST_F(BadInput, DifferenceStepOutOfRangeIsRefused) {
  expect_complaint({"gradient", problem("slider_crank_round"), "--step", "-1"}, "--step must be");
}

TEST_F(BadInput, UnknownCommandListsThoseThereAre) {
  expect_complaint({"optimise", problem("slider_crank_round")}, "optimize");
}

TEST_F(BadInput, UnknownOptionIsNamed) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--fast"}, "--fast");
}

TEST_F(BadInput, MisspeltOptionIsGuessed) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--accurcy", "1%"},
                   "--accurcy; did you mean --accuracy?");
  expect_complaint({"simulate", problem("slider_crank_round"), "--overwrit"},
                   "did you mean --overwrite?");
}

TEST_F(BadInput, NoCommandAtAllIsBadInput) {
  expect_complaint({}, " --help");
}

TEST_F(BadInput, OptimizingWithoutVariablesNamesFileAndPointer) {
  expect_complaint({"optimize", problem("slider_crank_exudyn")},
                   "slider_crank_exudyn.json: /variables is missing");
}

TEST_F(BadInput, StudyWithoutSettingsNamesFileAndPointer) {
  expect_complaint({"uncertainty", problem("slider_crank_exudyn")},
                   "slider_crank_exudyn.json: /uncertainty is missing");
}

TEST_F(BadInput, WithJsonTheErrorIsADocument) {
  const nlohmann::json error =
      exits(2, folder_.run({"check", "nothing.json", "--json"})).document().at("error");
  EXPECT_EQ(error.at("exit_code"), 2);
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("nothing.json"));
}

TEST(SimulationFailure, HasItsOwnExitCodeAndSaysWhen) {
  const ProgramFolder folder;
  // One Newton iteration is too few for any step of a mechanism that moves.
  const ProgramRun run =
      exits(3, folder.run_quick({"simulate", problem("slider_crank_round"), "--set",
                                 "/simulation/max_newton_iterations=1"}));
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: "), HasSubstr("t = ")));
}

using Help = InProgramFolder;

TEST_F(Help, IsNoError) {
  EXPECT_THAT(exits(0, folder_.run({"--help"})).out, HasSubstr("optimize"));
}

TEST_F(Help, FitsIntoAHundredColumns) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--help"}, {"optimize", "--help"}, {"gradient", "--help"}}) {
    std::istringstream lines(folder_.run(words).out);
    for (std::string line; std::getline(lines, line);) {
      const auto is_character = [](char byte) { return (byte & 0xC0) != 0x80; };  // of UTF-8
      EXPECT_LE(std::count_if(line.begin(), line.end(), is_character), 100) << line;
    }
  }
}

TEST(WrappedText, FillsItsLinesToTheLastCharacter) {
  EXPECT_EQ(wrapped("one two six", "  ", 7), "one two\n  six");
  EXPECT_EQ(wrapped("one two six", "  ", 6), "one\n  two\n  six");
}

TEST(LineWidth, IsWhatTheScreenHas) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // the width is asked for once
  for (const auto& [columns, width] : {std::pair("", 100), {"40", 80}, {"90", 90}, {"500", 160}}) {
    const auto leave_with_width = [columns = columns] {
      ::close(STDOUT_FILENO);
      ::setenv("COLUMNS", columns, 1);
      std::exit(static_cast<int>(line_width()));
    };
    EXPECT_EXIT(leave_with_width(), testing::ExitedWithCode(width), "") << columns;
  }
}

/// The last column has 24 characters then, as few as can be read; with one less it is as it is.
TEST(Table, BreaksTextsWhereALineCannotHoldThem) {
  const std::string once(12, 'a'), again(12, 'b');
  for (const bool is_broken : {true, false}) {
    const std::string key(line_width() - (is_broken ? 28 : 27), 'k'), end = is_broken ? "\n" : " ";
    Table table({left_aligned("key"), left_aligned("text")});
    table.add_row({key, once + " " + again});
    EXPECT_EQ(table.text(), "  " + padded("key", key.size(), Table::Align::left) + "  text\n  " +
                                key + "  " + once + end +
                                (is_broken ? std::string(key.size() + 4, ' ') : "") + again + "\n");
  }
}

TEST(Table, IsDividedWhereALineCannotHoldItsColumns) {
  const std::string wide(line_width() / 2, '7');
  Table table({left_aligned("name"), wide, wide});
  table.add_row({"rod", "1", "2"});
  const std::string row = "  rod   " + std::string(wide.size() - 1, ' ');
  EXPECT_EQ(table.text(),
            "  name  " + wide + "\n" + row + "1\n\n  name  " + wide + "\n" + row + "2\n");
}

// What a shell offers for a word that is begun.

/// @param words  of the command line, the last one begun; quoted for a shell where needed
std::string offered(const std::string& words) {
  const ProgramFolder folder;
  const ProgramRun run = folder.run_line(
      "completion bash > script && bash -c '. ./script; COMP_WORDS=(pleuel " + words +
      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _pleuel; echo \"${COMPREPLY[*]}\"'");
  EXPECT_EQ(run.err, "");
  return run.out;
}

using Completion = InProgramFolder;

TEST_F(Completion, OffersCommands) {
  EXPECT_EQ(offered("opt"), "optimize\n");
  EXPECT_EQ(offered("s"), "show simulate stability schema\n");
}

TEST_F(Completion, OffersOptionsOfTheCommand) {
  EXPECT_EQ(offered("optimize file.json --b"), "--backend\n");
  EXPECT_EQ(offered("accuracy file.json --o"), "--overwrite --output --optimum\n");
  EXPECT_EQ(offered("check file.json --x"), "\n");
}

TEST_F(Completion, OffersWordsWhereAFewAreKnown) {
  EXPECT_EQ(offered("new pr"), "press\n");
  EXPECT_EQ(offered("optimize file.json --backend ip"), "ipopt\n");
  EXPECT_EQ(offered("gradient file.json --method adj"), "adjoint\n");
}

/// Files are left to the shell.
TEST_F(Completion, OffersNothingWhereAFileStands) {
  EXPECT_EQ(offered("optimize fi"), "\n");
}

TEST_F(Completion, OfZshHasTheSameCommandsWithWhatTheyDo) {
  const std::string script = folder_.run({"completion", "zsh"}).out;
  EXPECT_THAT(script,
              HasSubstr("'optimize:find the best design within the limits, and verify it'"));
  EXPECT_THAT(script, HasSubstr("\n    simulate) options=("));
}

TEST_F(Completion, KnowsWhichShellsThereAre) {
  const ProgramRun run = exits(2, folder_.run({"completion", "fish"}));
  EXPECT_THAT(run.err, HasSubstr("known are bash, zsh"));
}

using ProgressLine = InProgramFolder;

TEST_F(ProgressLine, TellsTheTimeThatIsLeftAsRoughlyAsItIsKnown) {
  EXPECT_EQ(progress_text("3 of 7 runs", 4.2, 5.6), "  3 of 7 runs, 4 s, about 6 s left");
  EXPECT_EQ(progress_text("3 of 7 runs", 240.0, 7300.0), "  3 of 7 runs, 4 min, about 2 h left");
  EXPECT_EQ(progress_text("the reference", 4.2, std::nullopt), "  the reference, 4 s");
}

/// 384 take some six seconds.
std::string sampled(int samples) {
  return fmt::format(
      "uncertainty {} --no-report --jobs 1 --set /simulation/step=0.1ms --set '/uncertainty={{"
      "\"parameters\": {{\"rod_diameter\": {{\"interval\": \"0.1 mm\"}}}}, \"samples\": {}}}'",
      problem("slider_crank_round"), samples);
}

TEST_F(ProgressLine, IsOnATerminalWhileTheWorkTakesLong) {
  ASSERT_EQ(std::system("command -v script >/dev/null"), 0) << "script(1) of bsdutils is missing";
  std::ofstream(folder_.path() / "command") << PLEUEL_PROGRAM << ' ' << sampled(384);
  const std::string line = fmt::format("cd {} && script -qec '. ./command' /dev/null >out 2>&1",
                                       folder_.path().string());
  ASSERT_EQ(std::system(line.c_str()), 0);
  const std::string out = read_file(folder_.path() / "out");
  EXPECT_THAT(
      out, ContainsRegex("\r\x1b\\[K  [0-9]+ of 384 samples, [0-9]+ (s|min), about [0-9]+ (s|min) "
                         "left"));
  EXPECT_THAT(out, Not(ContainsRegex("samples\r?\n")));  // no line for each batch
}

TEST_F(ProgressLine, IsNotInAFile) {
  const ProgramRun run = exits(0, folder_.run_line(sampled(64)));
  EXPECT_THAT(run.err, Not(HasSubstr("\x1b")));
  EXPECT_THAT(run.err, HasSubstr("  64 of 64 samples\n"));
}

namespace fs = std::filesystem;

const std::vector<std::string> kinds = {"cantilever", "slider-crank", "four-bar", "robot", "press"};

class Starter : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_EQ(run({"new", GetParam(), "begin.json"}).exit_code, 0); }
  ProgramRun run(const std::vector<std::string>& words) const { return folder_.run(words); }

  const ProgramFolder folder_;
};

TEST_P(Starter, HasAVerifiedOptimumThatIsLighter) {
  const nlohmann::json document =
      exits(0, run({"optimize", "begin.json", "--json", "--no-report"})).document();
  EXPECT_EQ(document.at("status"), "verified");
  EXPECT_LT(document.at("objective").at("value"), document.at("objective").at("start"));
  EXPECT_EQ(document.at("warnings"), nlohmann::json::array());
}

TEST_P(Starter, IsCheckedWithoutWarning) {
  const ProgramRun check = exits(0, run({"check", "begin.json", "--json"}));
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
  const ProgramRun run = exits(0, folder_.run({"new"}));
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
  const ProgramRun refused = exits(2, folder_.run({"new", "press", "mine.json"}));
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
  const ProgramRun run = exits(2, folder_.run({"new", "press", "file/mine.json"}));
  EXPECT_EQ(run.err, "pleuel: file: cannot be created: Not a directory\n");
}

TEST_F(New, NamesTheKindThatWasProbablyMeant) {
  const ProgramRun run = exits(2, folder_.run({"new", "fourbar", "mine.json"}));
  EXPECT_THAT(run.err, HasSubstr("did you mean \"four-bar\"?"));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

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
  const ProgramRun run = exits(0, folder_.run_line("backends >/dev/null; export " + no_page + "; " +
                                                   PLEUEL_PROGRAM + " show press.json"));
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
}  // namespace pleuel::test::command_line_test
