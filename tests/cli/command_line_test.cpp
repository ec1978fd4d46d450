#include <cstdlib>
#include <optional>
#include <sstream>

#include <unistd.h>

#include "cli/commands/progress_line.hpp"
#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "tests/cli/program.hpp"

/// What the command line refuses, offers and explains; problem files that `new` writes.

namespace pleuel::test::command_line_test {
namespace {

using CommandLine = InProgramFolder;

/// Exit code 2, one line that begins with the program's name, nothing on standard output.
TEST_F(CommandLine, RefusesBadInputInOneLine) {
  const std::string not_held = "but the machine has";
  for (const auto& [line, expected] : std::vector<std::pair<std::string, std::string>>{
           {"simulate nothing.json", "nothing.json: there is no such file"},
           {"simulate $crank --set '/simulation/step=-1 s'", "/simulation/step"},
           // Before any loop, by commands that simulate, and those that only look at instants.
           {"show $crank --set '/simulation/step=1.2e-10 s'", not_held},
           {"simulate $crank --set '/simulation/step=1.2e-10 s'", not_held},
           {"optimize $crank --set '/simulation/step=1.2e-10 s'", not_held},
           // 0.1 in place of "0.2 mm" would be 100 mm.
           {"simulate $problems/slider_crank.json --set /constraints/rod_stiffness/upper=0.1",
            "the file has \"0.2 mm\" there: write \"0.1 mm\", or \"100 mm\" if the number is in "
            "SI"},
           {"simulate $problems/slider_crank.json --set rod_height=0.012",
            "write \"0.012 mm\", or \"12 mm\" if"},
           // What is no place of the file is refused as that.
           {"simulate $problems/slider_crank.json --set /scene/a~2=1", "neither ~0"},
           // A number in place of a number says what it is.
           {"simulate $problems/slider_crank.json --set /scene/bodies/rod/elements=0",
            "/scene/bodies/rod/elements must be"},
           {"check $crank --set /simulation/stp/x=1", "stp"},
           {"check $crank --set /optimizer/backend=slsqp", "/optimizer/backend"},
           {"optimize $crank --backend magic", "nlopt-mma, nlopt-ccsaq, nlopt-slsqp, ipopt"},
           {"gradient $crank --method guess",
            "auto, direct, adjoint, forward-difference, central-difference"},
           {"gradient $crank --step -1", "--step must be"},
           {"optimise $crank", "there is no command \"optimise\"; did you mean \"optimize\"?"},
           {"simulate $crank --fast", "--fast"},
           {"simulate $crank --accurcy 1%", "--accurcy; did you mean --accuracy?"},
           {"simulate $crank --overwrit", "did you mean --overwrite?"},
           {"", " --help"},
           {"optimize $problems/slider_crank_exudyn.json",
            "slider_crank_exudyn.json: /variables is missing"},
           {"uncertainty $problems/slider_crank_exudyn.json",
            "slider_crank_exudyn.json: /uncertainty is missing"},
           {"uncertainty $crank", "/uncertainty is missing"},
           {"completion fish", "known are bash, zsh"},
           {"new fourbar mine.json", "did you mean \"four-bar\"?"}}) {
    const ProgramRun refused = run(line, 2);
    EXPECT_THAT(refused.err, AllOf(StartsWith("pleuel: "), HasSubstr(expected))) << line;
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << line;
    EXPECT_EQ(refused.out, "") << line;
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << line << " leaves files";
  }
}

TEST_F(CommandLine, TellsLongTextsByTheirBeginnings) {
  const std::string text(1'000'000, 'x');
  for (const auto& [place, value] : {std::pair{"name", json(1)}, std::pair{"scene", json(text)},
                                     std::pair{"objective", json{{"minimize", text}}},
                                     std::pair{"objective", json{{"minimize", "= " + text}}},
                                     std::pair{"simulation", json{{text, 1}}}}) {
    json document = read_problem("slider_crank_round");
    document[place] = value;
    folder_.write("long.json", document);
    const std::string said = run("show long.json", 2).err;
    EXPECT_THAT(said, StartsWith("pleuel: long.json: /")) << place;
    EXPECT_LT(said.size(), 5000) << place;
  }
}

TEST_F(CommandLine, TellsSeveralMistakesALineEach) {
  const std::string said = run("simulate $problems/slider_crank.json "
                               "--set /scene/bodies/crank/elements=0 "
                               "--set /scene/bodies/rod/elements=0 --set '/simulation/step=-1 s'",
                               2)
                               .err;
  EXPECT_THAT(said, AllOf(StartsWith("pleuel: 3 mistakes:\n"),
                          HasSubstr("\n" + problem("slider_crank") +
                                    ": /scene/bodies/crank/elements must be "),
                          HasSubstr(": /scene/bodies/rod/elements must be "),
                          HasSubstr(": /simulation/step must be ")));
  EXPECT_EQ(std::ranges::count(said, '\n'), 4);
}

TEST_F(CommandLine, WritesAnErrorAsADocumentWithJson) {
  const json error = document("check nothing.json", 2).at("error");
  EXPECT_EQ(error.at("exit_code"), 2);
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("nothing.json"));
}

TEST_F(CommandLine, HasAnExitCodeForFailedSimulationsAndSaysWhen) {
  // One Newton iteration is too few for any step of a mechanism that moves.
  EXPECT_THAT(run("simulate $crank $quick --set /simulation/max_newton_iterations=1", 3).err,
              AllOf(StartsWith("pleuel: "), HasSubstr("t = ")));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << "a run folder is left behind";
}

TEST_F(CommandLine, HasHelpInAHundredColumns) {
  for (const std::string line : {"--help", "optimize --help", "gradient --help"}) {
    const std::string help = run(line).out;
    EXPECT_THAT(help, HasSubstr(line == "gradient --help" ? "gradient" : "optimize"));
    std::istringstream lines(help);
    for (std::string one; std::getline(lines, one);) {
      const auto is_character = [](char byte) { return (byte & 0xC0) != 0x80; };  // of UTF-8
      EXPECT_LE(std::ranges::count_if(one, is_character), 100) << one;
    }
  }
  const std::string help = run("pareto --help").out;
  EXPECT_THAT(help, HasSubstr("pleuel pareto [OPTIONS] FILE"));
  EXPECT_EQ(run("help pareto").out, help);
  EXPECT_EQ(run("help").out, run("--help").out);
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

/// What a shell offers for the last of these words; files are left to it.
TEST_F(CommandLine, CompletesWordsInAShell) {
  for (const auto& [words, offered] : {std::pair{"opt", "optimize"},
                                       {"s", "show simulate stability schema"},
                                       {"optimize file.json --b", "--backend"},
                                       {"accuracy file.json --o", "--overwrite --output --optimum"},
                                       {"check file.json --x", ""},
                                       {"new pr", "press"},
                                       {"optimize file.json --backend ip", "ipopt"},
                                       {"gradient file.json --method adj", "adjoint"},
                                       {"optimize fi", ""}}) {
    const ProgramRun shell =
        run(fmt::format("completion bash > script && bash -c '. ./script; COMP_WORDS=(pleuel {}); "
                        "COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _pleuel; "
                        "echo \"${{COMPREPLY[*]}}\"'",
                        words));
    EXPECT_EQ(shell.out, std::string(offered) + "\n") << words;
    EXPECT_EQ(shell.err, "") << words;
  }
  EXPECT_THAT(run("completion zsh").out,
              AllOf(HasSubstr("'optimize:find the best design within the limits, and verify it'"),
                    HasSubstr("\n    simulate) options=(")));
}

TEST(ProgressLine, TellsTheTimeThatIsLeftAsRoughlyAsItIsKnown) {
  EXPECT_EQ(progress_text("3 of 7 runs", 4.2, 5.6), "  3 of 7 runs, 4 s, about 6 s left");
  EXPECT_EQ(progress_text("3 of 7 runs", 240.0, 7300.0), "  3 of 7 runs, 4 min, about 2 h left");
  EXPECT_EQ(progress_text("the reference", 4.2, std::nullopt), "  the reference, 4 s");
}

/// 384 take some six seconds.
std::string sampled(int samples) {
  return fmt::format(
      "uncertainty $crank --no-report --jobs 1 --set /simulation/step=0.1ms --set '/uncertainty={{"
      "\"parameters\": {{\"rod_diameter\": {{\"interval\": \"0.1 mm\"}}}}, \"samples\": {}}}'",
      samples);
}

TEST_F(CommandLine, ShowsProgressOnATerminalWhileTheWorkTakesLong) {
  ASSERT_EQ(std::system("command -v script >/dev/null"), 0) << "script(1) of bsdutils is missing";
  run("--version >/dev/null; cat >command <<\\end\n$pleuel " + sampled(384) +
      "\nend\nscript -qec '. ./command' /dev/null >out 2>&1");
  const std::string out = folder_.text("out");
  EXPECT_THAT(
      out, ContainsRegex("\r\x1b\\[K  [0-9]+ of 384 samples, [0-9]+ (s|min), about [0-9]+ (s|min) "
                         "left"));
  EXPECT_THAT(out, Not(ContainsRegex("samples\r?\n")));  // no line for each batch
}

TEST_F(CommandLine, ShowsNoProgressInAFile) {
  EXPECT_THAT(run(sampled(64)).err,
              AllOf(Not(HasSubstr("\x1b")), HasSubstr("  64 of 64 samples\n")));
}

const std::vector<std::string> kinds = {"cantilever", "slider-crank", "four-bar", "robot", "press"};

class Starter : public InProgramFolder, public testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override { run("new " + GetParam() + " begin.json"); }
};

TEST_P(Starter, HasAVerifiedOptimumThatIsLighter) {
  const json optimum = document("optimize begin.json --no-report");
  EXPECT_EQ(optimum.at("status"), "verified");
  EXPECT_LT(at(optimum, "objective/value"), at(optimum, "objective/start"));
  EXPECT_EQ(optimum.at("warnings"), json::array());
}

TEST_P(Starter, IsCheckedWithoutWarningAndNamesTheSchemaBesideIt) {
  const json check = document("check begin.json");
  EXPECT_EQ(check.at("warnings"), json::array());
  EXPECT_EQ(at(check, "rigid_motion/free"), 0);
  for (const auto& [name, response] : check.at("responses").items()) {
    EXPECT_NE(at(response, "derivatives/verdict"), "differs") << name;
  }
  EXPECT_EQ(folder_.text(folder_.read("begin.json").at("$schema")),
            read_file(source_folder() + "/problems/problem.schema.json"));
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, Starter, testing::ValuesIn(kinds), [](const auto& kind) {
  std::string name = kind.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

using New = InProgramFolder;

TEST_F(New, AloneListsTheKindsALineEach) {
  const std::string out = run("new").out;
  for (const std::string& kind : kinds) {
    EXPECT_THAT(out, ContainsRegex("\n  " + kind + " +a [^\n]+\n"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(New, ReplacesNoWorkWithoutBeingTold) {
  run("new press");
  EXPECT_TRUE(folder_.has("press.json"));
  folder_.write("mine.json", "mine");
  folder_.write("problem.schema.json", "mine, too");
  EXPECT_EQ(run("new press mine.json", 2).err,
            "pleuel: mine.json: is there already; --overwrite replaces it\n");
  EXPECT_EQ(folder_.text("mine.json"), "mine");
  run("new press other.json");
  EXPECT_EQ(folder_.text("problem.schema.json"), "mine, too");
  run("new press mine.json --overwrite");
  EXPECT_THAT(folder_.text("mine.json"), HasSubstr("\"scene\""));
  EXPECT_THAT(folder_.text("problem.schema.json"), HasSubstr("\"definitions\""));
  // Why it cannot write is said once.
  EXPECT_EQ(run("new press mine.json/mine.json", 2).err,
            "pleuel: mine.json: cannot be created: Not a directory\n");
}

/// All but the drawing.
TEST_F(New, IsShownInWordsWhereNoPageIsBuilt) {
  run("new press");
  const std::string no_page = "PLEUEL_REPORT_TEMPLATE=nowhere $pleuel show press.json";
  EXPECT_THAT(run("backends >/dev/null; " + no_page).out,
              AllOf(HasSubstr("Rigid motion: "),
                    HasSubstr("No drawing: the template of pages is not built")));
  EXPECT_FALSE(folder_.has("runs"));
}

TEST_F(CommandLine, WritesTheSchemaOfTheProblems) {
  const std::string schema = read_file(source_folder() + "/problems/problem.schema.json");
  EXPECT_EQ(run("schema").out, schema);
  run("schema my.schema.json");
  EXPECT_EQ(folder_.text("my.schema.json"), schema);
}

}  // namespace
}  // namespace pleuel::test::command_line_test
