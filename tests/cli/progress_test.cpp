#include <cstdlib>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "cli/commands/progress_line.hpp"
#include "tests/cli/program.hpp"

namespace pleuel::test::progress_test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ProgressLine, TellsTheTimeThatIsLeftAsRoughlyAsItIsKnown) {
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

TEST(ProgressLine, IsOnATerminalWhileTheWorkTakesLong) {
  ASSERT_EQ(std::system("command -v script >/dev/null"), 0) << "script(1) of bsdutils is missing";
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "command") << PLEUEL_PROGRAM << ' ' << sampled(384);
  const std::string line =
      fmt::format("cd {} && script -qec '. ./command' /dev/null >out 2>&1", folder.path().string());
  ASSERT_EQ(std::system(line.c_str()), 0);
  const std::string out = read_file(folder.path() / "out");
  EXPECT_THAT(
      out, ContainsRegex("\r\x1b\\[K  [0-9]+ of 384 samples, [0-9]+ (s|min), about [0-9]+ (s|min) "
                         "left"));
  EXPECT_THAT(out, Not(ContainsRegex("samples\r?\n")));  // no line for each batch
}

TEST(ProgressLine, IsNotInAFile) {
  const TemporaryFolder folder;
  const ProgramRun run = run_line(folder.path(), sampled(64));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, Not(HasSubstr("\x1b")));
  EXPECT_THAT(run.err, HasSubstr("  64 of 64 samples\n"));
}

}  // namespace
}  // namespace pleuel::test::progress_test
