#include <array>
#include <fstream>
#include <random>

#include <sys/stat.h>

#include "record/run_database.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::resume_test {
namespace {

// Runs that are killed go on as if nothing had happened, and answers do not depend on how many
// processes find them.

namespace fs = std::filesystem;

using Resumed = ComparedRuns;

TEST_F(Resumed, OptimizationEndsAsIfItHadNotBeenKilled) {
  const std::string words = quick_run("optimize");
  ASSERT_EQ(folder_.run_line(words + " -o whole").exit_code, 0);
  std::mt19937 random(1);
  for (int run = 0; run < 4; ++run) {
    const std::string name = fmt::format("killed{}", run);
    kill_and_end(words, name, 3, random);
    expect_same(name, "whole", "history.csv");
  }
}

TEST_F(Resumed, SeveralStartsEndAsIfTheyHadNotBeenKilled) {
  const std::string words = quick_run("optimize") + " --starts 3 --jobs 2";
  ASSERT_EQ(folder_.run_line(words + " -o whole").exit_code, 0);
  std::mt19937 random(2);
  kill_and_end(words, "killed", 6, random);
  expect_same("killed", "whole", "history.csv");
}

/// Between the objective and a limit, and between two responses, with points in the gaps, and of
/// sizes from lists: searches with other objectives, which must not take each other's evaluations
/// from the record.
struct AskedFront {
  std::string words;
  int exit_code;
};
const std::array<AskedFront, 4> fronts = {
    AskedFront{" --set /pareto/points=4", 0},
    // 4: the stiffest rod is too stubby to be verified.
    AskedFront{R"( --set '/pareto={"responses": ["crank_and_rod", "rod_bow"], "points": 4}')", 4},
    AskedFront{" --gap 40%", 0},
    AskedFront{R"( --set '/variables/crank_diameter={"choices": ["24 mm", "26 mm", "28 mm"]}')"
               R"( --set '/variables/rod_diameter={"choices": ["12 mm", "15 mm", "18 mm"]}')",
               0}};

TEST_F(Resumed, FrontEndsAsIfItHadNotBeenKilled) {
  for (std::size_t i = 0; i < fronts.size(); ++i) {
    const std::string words = quick_run("pareto") + fronts[i].words + " --jobs 2";
    const std::string whole = fmt::format("whole{}", i), killed = fmt::format("killed{}", i);
    ASSERT_EQ(folder_.run_line(words + " -o " + whole).exit_code, fronts[i].exit_code);
    std::mt19937 random(3);
    kill_and_end(words, killed, 6, random, fronts[i].exit_code);
    expect_same(killed, whole, "pareto.csv");
  }
}

TEST_F(Resumed, SamplesEndAsIfTheyHadNotBeenKilled) {
  const std::string words =
      quick_run("uncertainty") +
      R"( --jobs 2 --set '/uncertainty={"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}, )"
      R"("samples": 40}')";
  ASSERT_EQ(folder_.run_line(words + " -o whole").exit_code, 0);
  std::mt19937 random(4);
  kill_and_end(words, "killed", 6, random);
  expect_same("killed", "whole", "uncertainty.csv");
  EXPECT_EQ(count_evaluations(folder_.path() / "whole"), 40);
}

/// Times are measured: only those of parts that were kept come back. Values and errors are the
/// same.
TEST_F(Resumed, AccuracyStudyEndsAsIfItHadNotBeenKilled) {
  const std::string words =
      quick_run("accuracy") +
      " --set '/accuracy/steps=[4e-4, 2e-4]' --set '/accuracy/elements=[2, 4]'";
  ASSERT_EQ(folder_.run_line(words + " -o whole").exit_code, 0);
  std::mt19937 random(5);
  kill_and_end(words, "killed", 6, random);
  const nlohmann::json whole = result("whole"), killed = result("killed");
  EXPECT_EQ(killed.at("reference").at("values"), whole.at("reference").at("values"));
  EXPECT_EQ(killed.at("reference").at("errors"), whole.at("reference").at("errors"));
  ASSERT_EQ(killed.at("runs").size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(killed.at("runs").at(i).at("errors"), whole.at("runs").at(i).at("errors"));
    EXPECT_EQ(killed.at("runs").at(i).at("gradient_errors"),
              whole.at("runs").at(i).at("gradient_errors"));
  }
}

/// All parts are known then, with their times.
TEST_F(Resumed, AccuracyStudyThatHadEndedMeasuresNothing) {
  const std::string words = quick_run("accuracy") +
                            " --set '/accuracy/steps=[4e-4]' --set '/accuracy/elements=[2]' -o run";
  ASSERT_EQ(folder_.run_line(words).exit_code, 0);
  const std::string before = read_file(folder_.path() / "run/result.json");
  const ProgramRun again = exits(0, folder_.run_line(words + " --resume"));
  EXPECT_EQ(read_file(folder_.path() / "run/result.json"), before);
  EXPECT_THAT(again.out, HasSubstr("parts of the study were known from run/run.sqlite"));
}

TEST_F(Resumed, RunThatHadEndedEvaluatesNothing) {
  const std::string words = quick_run("optimize") + " -o run";
  ASSERT_EQ(folder_.run_line(words).exit_code, 0);
  const int evaluations = count_evaluations(folder_.path() / "run");
  const ProgramRun again = exits(0, folder_.run_line(words + " --resume"));
  EXPECT_EQ(count_evaluations(folder_.path() / "run"), evaluations);
  EXPECT_THAT(again.out, HasSubstr("evaluations were known from run/run.sqlite"));
}

TEST_F(Resumed, InterruptedRunSaysHow) {
  const std::string words = "optimize " + problem("slider_crank_round") + " --starts 4 --jobs 2";
  const ProgramRun run = folder_.run_line(
      fmt::format("{0} >out & p=$!; i=0; "
                  "while [ $(cat runs/*/history.csv 2>/dev/null | wc -l) -lt 4 ] && "
                  "[ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; "
                  "c=$(cat /proc/$p/task/$p/children); kill -TERM $p; wait $p; echo $?; "
                  "for q in $c; do [ ! -e /proc/$q ] || echo left $q; done",
                  words));
  EXPECT_EQ(run.out, "4\n");  // and no process is left
  const std::string out = read_file(folder_.path() / "out");
  EXPECT_THAT(unwrapped(out), AllOf(HasSubstr("To go on from there: "),
                                    HasSubstr("--jobs 2 -o runs/slider_crank_round-optimize "
                                              "--resume")));
}

TEST_F(Resumed, RunOfAnotherProblemIsRefused) {
  const std::string words = quick_run("optimize") + " -o run";
  ASSERT_EQ(folder_.run_line(words).exit_code, 0);
  const std::string before = read_file(folder_.path() / "run/result.json");
  EXPECT_THAT(
      exits(2, folder_.run_line(words + " --resume --set /simulation/spectral_radius=0.7")).err,
      AllOf(HasSubstr("--resume: run holds a run with another problem: "
                      "/simulation/spectral_radius is "),
            HasSubstr(" there and 0.7 here")));
  const ProgramRun start = exits(2, folder_.run_line(words + " --resume --set rod_diameter=15mm"));
  const ProgramRun starts = folder_.run_line(words + " --resume --starts 2");
  EXPECT_THAT(starts.err, HasSubstr("/starts is 1 there and 2 here"));
  EXPECT_EQ(read_file(folder_.path() / "run/result.json"), before);
}

/// What a file says is part of the problem.
TEST_F(Resumed, RunWithAnotherCatalogueIsRefused) {
  const std::string words = quick_run("optimize") + " --set /scene/catalogue=" +
                            (folder_.path() / "sections.json").string() + " -o run";
  const std::string section = R"({"type": "circle", "diameter": )";
  const auto make = [&](const std::string& diameter) {
    folder_.run_line("--version; echo '{\"sections\": {\"round\": " + section + diameter +
                     "}}}' >sections.json");
  };
  make("0.01");
  const ProgramRun first = exits(0, folder_.run_line(words));
  EXPECT_EQ(folder_.run_line(words + " --resume").exit_code, 0);
  make("0.02");
  const ProgramRun other = exits(2, folder_.run_line(words + " --resume"));
  EXPECT_THAT(other.err, HasSubstr("another file that the problem names"));
}

TEST_F(Resumed, RecordThatIsNoneIsRefused) {
  const std::string words = quick_run("optimize") + " -o run";
  ASSERT_EQ(folder_.run_line(words).exit_code, 0);
  folder_.run_line("--version; head -c 9000 /dev/zero | tr '\\0' x >run/run.sqlite");
  const ProgramRun run = exits(2, folder_.run_line(words + " --resume"));
  EXPECT_THAT(run.err, HasSubstr("--resume: run/run.sqlite: "));
}

TEST_F(Resumed, ResultsWithoutRecordAreKept) {
  const std::string words = quick_run("optimize") + " -o run";
  ASSERT_EQ(folder_.run_line(words + "; rm run/run.sqlite*").exit_code, 0);
  const std::string before = read_file(folder_.path() / "run/result.json");
  const ProgramRun run = exits(2, folder_.run_line(words + " --resume"));
  EXPECT_THAT(run.err, HasSubstr("there is nothing to resume"));
  EXPECT_EQ(read_file(folder_.path() / "run/result.json"), before);
}

/// Problems whose keys stand in another order are told as such.
TEST_F(Resumed, RunWithKeysInAnotherOrderIsRefusedWithThatReason) {
  const auto write = [&](bool is_turned) {
    const auto text = read_file(problem("slider_crank_round"));
    auto document = nlohmann::ordered_json::parse(text);
    const auto variables = document.at("variables");
    document["variables"] = nlohmann::ordered_json::object();
    std::vector<std::string> names;
    for (const auto& [name, value] : variables.items()) names.push_back(name);
    if (is_turned) std::reverse(names.begin(), names.end());
    for (const std::string& name : names) document["variables"][name] = variables.at(name);
    std::ofstream(folder_.path() / "problem.json") << document.dump(2);
  };
  const std::string words = "optimize problem.json" + quick_line() + " -o run";
  write(false);
  ASSERT_EQ(folder_.run_line(words).exit_code, 0);
  write(true);
  const ProgramRun run = exits(2, folder_.run_line(words + " --resume"));
  EXPECT_THAT(run.err, HasSubstr("the keys of /variables stand in another order"));
}

TEST_F(Resumed, NothingBeginsAnew) {
  const std::string words = quick_run("optimize");
  const ProgramRun begun = exits(0, folder_.run_line(words + " -o run --resume"));
  EXPECT_THAT(begun.err, HasSubstr("run has no run.sqlite: there is nothing to resume"));
  EXPECT_EQ(folder_.run_line(words + " -o run --resume --overwrite").exit_code, 2);
}

/// A record that cannot be written ends no run; the exit code tells.
TEST_F(Resumed, RecordThatCannotBeWrittenIsNamed) {
  const std::string words = quick_run("optimize") + " -o run";
  ASSERT_EQ(folder_.run_line(words).exit_code, 0);
  fs::remove(folder_.path() / "run/run.sqlite");
  fs::create_directories(folder_.path() / "run/run.sqlite/not_a_file");
  const ProgramRun run = exits(1, folder_.run_line(words + " --overwrite"));
  EXPECT_THAT(run.out, HasSubstr("VERIFIED"));
  EXPECT_THAT(run.err, HasSubstr("run.sqlite"));
}

class Jobs : public Resumed {};

TEST_F(Jobs, DoNotChangeTheAnswerOfSeveralStarts) {
  for (const int jobs : {1, 2, 3}) {
    ASSERT_EQ(folder_
                  .run_line(fmt::format("optimize {}{} --starts 3 --jobs {} -o with{}",
                                        problem("slider_crank_round"), quick_line(), jobs, jobs))
                  .exit_code,
              0);
  }
  expect_same("with2", "with1", "history.csv");
  expect_same("with3", "with1", "history.csv");
}

TEST_F(Jobs, DoNotChangeTheFront) {
  for (const auto& [front, exit_code] : fronts) {
    for (const int jobs : {1, 2, 3}) {
      const ProgramRun run =
          exits(exit_code, folder_.run_line(fmt::format(
                               "pareto {}{}{} --jobs {} -o with{} --overwrite",
                               problem("slider_crank_round"), quick_line(), front, jobs, jobs)));
      EXPECT_THAT(run.out, HasSubstr(" points verified"));
    }
    expect_same("with2", "with1", "pareto.csv");
    expect_same("with3", "with1", "pareto.csv");
  }
}

/// The search that is killed is tried once more, and is heard once.
TEST_F(Jobs, MayLoseAProcess) {
  const std::string words = quick_run("optimize") + " --starts 3 --jobs 2 -o ";
  ASSERT_EQ(folder_.run_line(words + "whole").exit_code, 0);
  const ProgramRun run = folder_.run_line(
      words +
      "hurt >out & p=$!; i=0; while [ $(cat hurt/history.csv 2>/dev/null | wc -l) -lt 3 ] "
      "&& [ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; "
      "kill -9 $(cut -d' ' -f1 /proc/$p/task/$p/children) && echo killed; wait $p; echo $?");
  EXPECT_EQ(run.out, "killed\n0\n") << run.err;
  expect_same("hurt", "whole", "history.csv");
}

TEST_F(Jobs, AreTakenFromTheEnvironment) {
  const std::string words = "uncertainty " + problem("slider_crank_round");
  EXPECT_THAT(
      exits(2, folder_.run_line("--version; PLEUEL_JOBS=none " PLEUEL_PROGRAM " " + words)).err,
      HasSubstr("PLEUEL_JOBS must be a whole number from 1 to 1024, got \"none\""));
}

// What goes wrong around a run must not cost its result, nor that of another one.

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
    const ProgramRun run = folder_.run_line(
        fmt::format("--version >/dev/null; (ulimit -f {}; {} {} 2>&1; echo $?) | cat", blocks,
                    PLEUEL_PROGRAM, line));
    const std::size_t end = run.out.rfind('\n', run.out.size() - 2);
    return {std::stoi(run.out.substr(end + 1)), run.out.substr(0, end), run.out.substr(0, end)};
  }

  const ProgramFolder folder_;
};

/// 8 kB a file hold the result but not the trajectories, as a disk that fills up.
TEST_F(LostResult, OfAFullDiskIsNotTheVerdict) {
  const ProgramRun run = exits(1, run_limited("16", optimization("run")));
  EXPECT_THAT(run.out, HasSubstr("VERIFIED: "));
  EXPECT_THAT(run.err, AllOf(HasSubstr("run/trajectory-start.csv cannot be written: "),
                             HasSubstr("run/trajectory-optimum.csv")));
  EXPECT_EQ(read_json_if_whole(folder_.path() / "run/result.json").value("status", ""), "verified");
  // What is there is whole lines.
  EXPECT_THAT(read_file(folder_.path() / "run/trajectory-start.csv"), EndsWith("\n"));
}

TEST_F(LostResult, OfADiskWithoutAnyRoomIsTheFilesOnly) {
  const ProgramRun run = exits(1, run_limited("0", optimization("run")));
  EXPECT_THAT(run.out, HasSubstr("VERIFIED: "));
  EXPECT_THAT(run.err, HasSubstr("run/result.json cannot be written: "));
}

/// 250 kB hold the record of the first evaluations, but not of all.
TEST_F(LostResult, OfADiskThatFillsUpEndsTheRunAndTheRecordGoesOn) {
  const ProgramRun whole = exits(0, folder_.run_line(optimization("whole") + "--no-report"));
  const std::string line = optimization("run") + "--no-report";
  const ProgramRun run = exits(1, run_limited("500", line));
  EXPECT_THAT(run.out, AllOf(HasSubstr("INTERRUPTED: "), HasSubstr("the best design among them"),
                             ContainsRegex("rod_diameter +[0-9.]+ +[0-9.]+")));
  EXPECT_THAT(run.err, AllOf(HasSubstr("run/run.sqlite cannot be written: "),
                             HasSubstr("the run stops"), HasSubstr("--resume")));
  const ProgramRun resumed = exits(0, folder_.run_line(line + " --resume"));
  EXPECT_THAT(resumed.out, ContainsRegex("[1-9][0-9]* of [0-9]+ evaluations were known"));
  const auto result = [&](const char* name) {
    return read_json_if_whole(folder_.path() / name / "result.json");
  };
  EXPECT_EQ(result("run").at("objective"), result("whole").at("objective"));
  EXPECT_EQ(result("run").at("variables"), result("whole").at("variables"));
}

TEST_F(LostResult, OfClosedStreamsIsWhatTheyWouldHaveShown) {
  EXPECT_EQ(folder_.run_line(optimization("run") + ">&- 2>&- <&-; echo $?").out, "0\n");
  const auto history = read_csv(folder_.path() / "run/history.csv");
  for (const auto& row : history) EXPECT_GE(row.size() + 1, history.front().size());
  EXPECT_EQ(history.size(), 1 + read_json_if_whole(folder_.path() / "run/result.json")
                                    .at("evaluations")
                                    .get<std::size_t>());
}

TEST_F(LostResult, OfAFullStandardErrorIsNothingElse) {
  EXPECT_EQ(folder_
                .run_line(line_of({"stability", problem("slider_crank_round"), "-o", "run"}) +
                          "2>/dev/full; echo $?")
                .out.substr(0, 8),
            "  case  ");
  EXPECT_EQ(folder_.run_line("simulate nothing.json 2>/dev/full; echo $?").out, "2\n");
}

TEST_F(LostResult, OfAPipeThatNobodyReadsIsNotTheRun) {
  folder_.run_line(optimization("run") + "| true");
  EXPECT_EQ(read_json_if_whole(folder_.path() / "run/run_card.json").value("finished", false),
            true);
}

TEST_F(LostResult, OfAStandardOutputThatIsFullIsAFailure) {
  const ProgramRun run = folder_.run_line(optimization("run") + ">/dev/full; echo $?");
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
    const ProgramRun run = folder_.run_line(line);
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
  const ProgramRun run = folder_.run_line(line);
  EXPECT_EQ(run.out, "2\n4\n");
  EXPECT_THAT(run.err, HasSubstr("one: another run is at work"));
  EXPECT_EQ(read_json_if_whole(folder_.path() / "one/result.json").value("status", ""),
            "interrupted");
}

TEST_F(LostResult, OfABodyThatIsCalledResultIsNot) {
  auto document = read_json(problem("slider_crank"));
  for (const char* name : {"result", "run_card", "../up", "="}) {
    nlohmann::json renamed = document;
    std::string text = renamed.dump();
    for (std::size_t at = 0; (at = text.find("\"rod\"", at)) != std::string::npos;) {
      text.replace(at, 5, nlohmann::json(name).dump());
    }
    std::ofstream(folder_.path() / "renamed.json") << text;
    const ProgramRun run =
        exits(0, folder_.run({"invariants", "renamed.json", "-o", "run", "--overwrite"}));
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
  ASSERT_EQ(folder_.run_line(optimization("run")).exit_code, 0);
  std::ofstream(folder_.path() / "precious") << "mine\n";
  for (const char* name : {"result.json", "history.csv", "run_card.json.draft"}) {
    fs::remove(folder_.path() / "run" / name);
    fs::create_symlink(folder_.path() / "precious", folder_.path() / "run" / name);
  }
  ASSERT_EQ(folder_.run_line(optimization("run") + "--overwrite").exit_code, 0);
  EXPECT_EQ(read_file(folder_.path() / "precious"), "mine\n");
}

TEST_F(LostResult, OfAFileOfInvariantsIsReplacedOnlyIfAskedFor) {
  const std::vector<std::string> words = {
      "invariants", problem("slider_crank"), "--body", "rod", "-o", "rod.json"};
  ASSERT_EQ(folder_.run(words).exit_code, 0);
  const ProgramRun refused = exits(2, folder_.run(words));
  EXPECT_THAT(refused.err, AllOf(HasSubstr("-o rod.json: "), HasSubstr("--overwrite")));
  EXPECT_EQ(folder_.run(joined(words, {"--overwrite"})).exit_code, 0);
}

// Records that are damaged, or of another build, give no other numbers.

class DamagedRecord : public ComparedRuns {
 protected:
  void SetUp() override {
    ASSERT_EQ(folder_.run_line(words_ + "whole").exit_code, 0);
    fs::copy(folder_.path() / "whole", folder_.path() / "run", fs::copy_options::recursive);
  }

  ProgramRun resumed() const { return folder_.run_line(words_ + "run --resume"); }
  fs::path file() const { return folder_.path() / "run/run.sqlite"; }

  const std::string words_ = quick_run("optimize") + " --no-report -o ";
};

/// With checksums that are right: the evaluations that the verdict rests on are made again.
TEST_F(DamagedRecord, OfOtherNumbersIsNotVerified) {
  std::vector<NumberedEvaluation> all;
  RunDatabase(file()).read_evaluations([&](const NumberedEvaluation& one) { all.push_back(one); });
  Database(file()).execute("DELETE FROM evaluations");
  {
    RunDatabase record(file());
    for (NumberedEvaluation& one : all) {
      one.stored.evaluation.objective *= 0.9;
      record.keep(one.key, one.stored);
    }
  }
  const ProgramRun run = exits(2, resumed());
  EXPECT_THAT(run.err, AllOf(HasSubstr("run/run.sqlite: row "),
                             HasSubstr("of the table evaluations is not what this program "
                                       "computes"),
                             HasSubstr("--overwrite begins anew")));
}

TEST_F(DamagedRecord, OfAnotherBuildIsRefused) {
  RunDatabase(file()).describe("program", R"("fnv1a64:0")");
  const ProgramRun run = exits(2, resumed());
  EXPECT_THAT(run.err, AllOf(HasSubstr("run holds a run with another build of Pleuel"),
                             HasSubstr("--overwrite begins anew")));
}

TEST_F(DamagedRecord, WithoutWhatIsSaidOfTheRunIsRefused) {
  Database(file()).execute("DELETE FROM run");
  const ProgramRun run = exits(2, resumed());
  EXPECT_THAT(run.err, HasSubstr("run/run.sqlite: the table run has no row command"));
}

TEST_F(DamagedRecord, WithChangedNumbersIsNotExported) {
  Database(file()).execute("UPDATE evaluations SET constraints = zeroblob(7) WHERE id = 2");
  const ProgramRun run = exits(2, folder_.run_line("export run"));
  EXPECT_THAT(run.err, HasSubstr("run/run.sqlite: row 2 of the table evaluations"));
}

/// Bytes that flip, and ends that are lost.
TEST_F(DamagedRecord, IsRefusedOrEndsAsIfItWereWhole) {
  const std::string whole = read_file(file());
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 30; ++round) {
    std::string damaged = whole;
    const std::size_t place =
        std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    if (round % 5 == 0) {
      damaged.resize(place);
    } else {
      damaged[place] = static_cast<char>(damaged[place] ^ (1 << round % 8));
    }
    std::ofstream(file(), std::ios::binary) << damaged;
    const ProgramRun run = resumed();
    if (run.exit_code == 0) {
      EXPECT_EQ(result("run"), result("whole")) << place;
      continue;
    }
    ++refused;
    EXPECT_EQ(run.exit_code, 2) << place << run.err;
    EXPECT_THAT(run.err, HasSubstr("run/run.sqlite: ")) << place;
    fs::copy(folder_.path() / "whole", folder_.path() / "run",
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace pleuel::test::resume_test
