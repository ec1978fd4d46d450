#include <cstdlib>
#include <fstream>
#include <optional>

#include "cli/commands/progress_line.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::completion_test {
namespace {

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
  const ProgramRun run = folder_.run({"completion", "fish"});
  EXPECT_EQ(run.exit_code, 2);
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
  const ProgramRun run = folder_.run_line(sampled(64));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, Not(HasSubstr("\x1b")));
  EXPECT_THAT(run.err, HasSubstr("  64 of 64 samples\n"));
}

}  // namespace
}  // namespace pleuel::test::completion_test
