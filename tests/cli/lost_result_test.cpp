#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/cli/program.hpp"

/// What goes wrong around a run must not cost its result, nor that of another one.
namespace pleuel::test::lost_result_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

std::string line_of(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : joined(words, quick())) line += "'" + word + "' ";
  return line;
}

std::string optimization(const std::string& folder) {
  return line_of({"optimize", problem("slider_crank_round"), "-o", folder});
}

nlohmann::json read_json_if_whole(const fs::path& path) {
  return nlohmann::json::parse(read_file(path), nullptr, /*allow_exceptions=*/false);
}

class LostResult : public testing::Test {
 protected:
  /// No file may be longer than so many blocks of the shell.
  ProgramRun run_limited(const std::string& blocks, const std::string& line) const {
    // The shell that sets the limit writes no files itself; its streams are pipes.
    const ProgramRun run =
        run_line(folder_.path(),
                 fmt::format("--version >/dev/null; (ulimit -f {}; {} {} 2>&1; echo $?) | cat",
                             blocks, PLEUEL_PROGRAM, line));
    const std::size_t end = run.out.rfind('\n', run.out.size() - 2);
    return {std::stoi(run.out.substr(end + 1)), run.out.substr(0, end), run.out.substr(0, end)};
  }

  const TemporaryFolder folder_;
};

/// 8 kB a file hold the result but not the trajectories, as a disk that fills up.
TEST_F(LostResult, OfAFullDiskIsNotTheVerdict) {
  const ProgramRun run = run_limited("16", optimization("run"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("VERIFIED: "));
  EXPECT_THAT(run.err, AllOf(HasSubstr("run/trajectory-start.csv cannot be written: "),
                             HasSubstr("run/trajectory-optimum.csv")));
  EXPECT_EQ(read_json_if_whole(folder_.path() / "run/result.json").value("status", ""), "verified");
  // What is there is whole lines.
  EXPECT_THAT(read_file(folder_.path() / "run/trajectory-start.csv"), EndsWith("\n"));
}

TEST_F(LostResult, OfADiskWithoutAnyRoomIsTheFilesOnly) {
  const ProgramRun run = run_limited("0", optimization("run"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("VERIFIED: "));
  EXPECT_THAT(run.err, HasSubstr("run/result.json cannot be written: "));
}

/// 250 kB hold the record of the first evaluations, but not of all.
TEST_F(LostResult, OfADiskThatFillsUpEndsTheRunAndTheRecordGoesOn) {
  const ProgramRun whole = run_line(folder_.path(), optimization("whole") + "--no-report");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const std::string line = optimization("run") + "--no-report";
  const ProgramRun run = run_limited("500", line);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, AllOf(HasSubstr("INTERRUPTED: "), HasSubstr("the best design among them")));
  EXPECT_THAT(run.err, AllOf(HasSubstr("run/run.sqlite cannot be written: "),
                             HasSubstr("the run stops"), HasSubstr("--resume")));
  const ProgramRun resumed = run_line(folder_.path(), line + " --resume");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.out, testing::ContainsRegex("[1-9][0-9]* of [0-9]+ evaluations were known"));
  const auto result = [&](const char* name) {
    return read_json_if_whole(folder_.path() / name / "result.json");
  };
  EXPECT_EQ(result("run").at("objective"), result("whole").at("objective"));
  EXPECT_EQ(result("run").at("variables"), result("whole").at("variables"));
}

TEST_F(LostResult, OfClosedStreamsIsWhatTheyWouldHaveShown) {
  EXPECT_EQ(run_line(folder_.path(), optimization("run") + ">&- 2>&- <&-; echo $?").out, "0\n");
  const auto history = read_csv(folder_.path() / "run/history.csv");
  for (const auto& row : history) EXPECT_GE(row.size() + 1, history.front().size());
  EXPECT_EQ(history.size(), 1 + read_json_if_whole(folder_.path() / "run/result.json")
                                    .at("evaluations")
                                    .get<std::size_t>());
}

TEST_F(LostResult, OfAFullStandardErrorIsNothingElse) {
  EXPECT_EQ(
      run_line(folder_.path(), line_of({"stability", problem("slider_crank_round"), "-o", "run"}) +
                                   "2>/dev/full; echo $?")
          .out.substr(0, 8),
      "  case  ");
  EXPECT_EQ(run_line(folder_.path(), "simulate nothing.json 2>/dev/full; echo $?").out, "2\n");
}

TEST_F(LostResult, OfAPipeThatNobodyReadsIsNotTheRun) {
  run_line(folder_.path(), optimization("run") + "| true");
  EXPECT_EQ(read_json_if_whole(folder_.path() / "run/run_card.json").value("finished", false),
            true);
}

TEST_F(LostResult, OfAStandardOutputThatIsFullIsAFailure) {
  const ProgramRun run = run_line(folder_.path(), optimization("run") + ">/dev/full; echo $?");
  EXPECT_EQ(run.out, "1\n");
  EXPECT_THAT(run.err, HasSubstr("standard output cannot be written"));
  EXPECT_EQ(read_json_if_whole(folder_.path() / "run/run_card.json").value("finished", false),
            true);
}

/// A pipe without a writer would be waited for.
TEST_F(LostResult, OfAPipeInPlaceOfAFileIsRefused) {
  const fs::path pipe = folder_.path() / "pipe.json";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string crank = problem("slider_crank_round");
  for (const std::string& line :
       {std::string("simulate pipe.json"), "simulate " + crank + " --design pipe.json",
        "simulate " + crank + " -o pipe.json",
        "invariants " + crank + " --body rod -o pipe.json"}) {
    const ProgramRun run = run_line(folder_.path(), line);
    EXPECT_EQ(run.exit_code, 2) << line;
    EXPECT_THAT(run.err, HasSubstr("pipe.json: is ")) << line;
  }
}

/// The one is interrupted as soon as the other one has been refused.
TEST_F(LostResult, OfTwoRunsInOneFolderIsNone) {
  const std::string path = folder_.path().string();
  const std::string line = fmt::format(
      "optimize {0} -o {1}/one >/dev/null & p=$!; i=0; "
      "while [ ! -f {1}/one/history.csv ] && [ $i -lt 3000 ]; "
      "do sleep 0.01; i=$((i + 1)); done; "
      "{2} optimize {0} -o {1}/one --overwrite; echo $?; kill -TERM $p; wait $p; echo $?",
      problem("slider_crank_round"), path, PLEUEL_PROGRAM);
  const ProgramRun run = run_line(folder_.path(), line);
  EXPECT_EQ(run.out, "2\n4\n");
  EXPECT_THAT(run.err, HasSubstr("one: another run is at work"));
  EXPECT_EQ(read_json_if_whole(folder_.path() / "one/result.json").value("status", ""),
            "interrupted");
}

TEST_F(LostResult, OfABodyThatIsCalledResultIsNot) {
  auto document = nlohmann::json::parse(read_file(problem("slider_crank")));
  for (const char* name : {"result", "run_card", "../up", "="}) {
    nlohmann::json renamed = document;
    std::string text = renamed.dump();
    for (std::size_t at = 0; (at = text.find("\"rod\"", at)) != std::string::npos;) {
      text.replace(at, 5, nlohmann::json(name).dump());
    }
    std::ofstream(folder_.path() / "renamed.json") << text;
    const ProgramRun run =
        run_program(folder_.path(), {"invariants", "renamed.json", "-o", "run", "--overwrite"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json result = read_json_if_whole(folder_.path() / "run/result.json");
    ASSERT_TRUE(result.contains("bodies")) << name;
    EXPECT_EQ(result.at("bodies").size(), 2u);
    EXPECT_EQ(read_json_if_whole(folder_.path() / "run/run_card.json").value("finished", false),
              true);
    for (const auto& body : result.at("bodies")) {
      const fs::path file = folder_.path() / body.at("file").get<std::string>();
      EXPECT_EQ(file.parent_path(), folder_.path() / "run/bodies");
      EXPECT_EQ(read_json_if_whole(file).value("format", ""), "pleuel-invariants");
    }
  }
}

/// Neither a result nor its draft goes where a link points.
TEST_F(LostResult, OfAnotherFileIsNotBehindALink) {
  ASSERT_EQ(run_line(folder_.path(), optimization("run")).exit_code, 0);
  std::ofstream(folder_.path() / "precious") << "mine\n";
  for (const char* name : {"result.json", "history.csv", "run_card.json.draft"}) {
    fs::remove(folder_.path() / "run" / name);
    fs::create_symlink(folder_.path() / "precious", folder_.path() / "run" / name);
  }
  ASSERT_EQ(run_line(folder_.path(), optimization("run") + "--overwrite").exit_code, 0);
  EXPECT_EQ(read_file(folder_.path() / "precious"), "mine\n");
}

TEST_F(LostResult, OfAFileOfInvariantsIsReplacedOnlyIfAskedFor) {
  const std::vector<std::string> words = {
      "invariants", problem("slider_crank"), "--body", "rod", "-o", "rod.json"};
  ASSERT_EQ(run_program(folder_.path(), words).exit_code, 0);
  const ProgramRun refused = run_program(folder_.path(), words);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("-o rod.json: "), HasSubstr("--overwrite")));
  EXPECT_EQ(run_program(folder_.path(), joined(words, {"--overwrite"})).exit_code, 0);
}

}  // namespace
}  // namespace pleuel::test::lost_result_test
