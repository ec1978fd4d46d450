#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

/// What a shell offers for a word that is begun.
namespace pleuel::test::completion_test {
namespace {

using ::testing::HasSubstr;

/// @param words  of the command line, the last one begun; quoted for a shell where needed
std::string offered(const std::string& words) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_line(folder.path(),
               "completion bash > script && bash -c '. ./script; COMP_WORDS=(pleuel " + words +
                   "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _pleuel; echo \"${COMPREPLY[*]}\"'");
  EXPECT_EQ(run.err, "");
  return run.out;
}

TEST(Completion, OffersCommands) {
  EXPECT_EQ(offered("opt"), "optimize\n");
  EXPECT_EQ(offered("s"), "show simulate stability schema\n");
}

TEST(Completion, OffersOptionsOfTheCommand) {
  EXPECT_EQ(offered("optimize file.json --b"), "--backend\n");
  EXPECT_EQ(offered("accuracy file.json --o"), "--overwrite --output --optimum\n");
  EXPECT_EQ(offered("check file.json --x"), "\n");
}

TEST(Completion, OffersWordsWhereAFewAreKnown) {
  EXPECT_EQ(offered("new pr"), "press\n");
  EXPECT_EQ(offered("optimize file.json --backend ip"), "ipopt\n");
  EXPECT_EQ(offered("gradient file.json --method adj"), "adjoint\n");
}

/// Files are left to the shell.
TEST(Completion, OffersNothingWhereAFileStands) {
  EXPECT_EQ(offered("optimize fi"), "\n");
}

TEST(Completion, OfZshHasTheSameCommandsWithWhatTheyDo) {
  const TemporaryFolder folder;
  const std::string script = run_program(folder.path(), {"completion", "zsh"}).out;
  EXPECT_THAT(script,
              HasSubstr("'optimize:find the best design within the limits, and verify it'"));
  EXPECT_THAT(script, HasSubstr("\n    simulate) options=("));
}

TEST(Completion, KnowsWhichShellsThereAre) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"completion", "fish"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("known are bash, zsh"));
}

}  // namespace
}  // namespace pleuel::test::completion_test
