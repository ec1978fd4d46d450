#include <algorithm>
#include <array>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/cli/compared_runs.hpp"
#include "tests/cli/program.hpp"

/// Runs that are killed go on as if nothing had happened, and answers do not depend on how many
/// processes find them.
namespace pleuel::test::resume_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Resumed = ComparedRuns;

TEST_F(Resumed, OptimizationEndsAsIfItHadNotBeenKilled) {
  const std::string words = "optimize " + problem("slider_crank_round") + quick_line();
  ASSERT_EQ(run_line(folder_.path(), words + " -o whole").exit_code, 0);
  std::mt19937 random(1);
  for (int run = 0; run < 4; ++run) {
    const std::string name = fmt::format("killed{}", run);
    kill_and_end(words, name, 3, random);
    expect_same(name, "whole", "history.csv");
  }
}

TEST_F(Resumed, SeveralStartsEndAsIfTheyHadNotBeenKilled) {
  const std::string words =
      "optimize " + problem("slider_crank_round") + quick_line() + " --starts 3 --jobs 2";
  ASSERT_EQ(run_line(folder_.path(), words + " -o whole").exit_code, 0);
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
    const std::string words =
        "pareto " + problem("slider_crank_round") + quick_line() + fronts[i].words + " --jobs 2";
    const std::string whole = fmt::format("whole{}", i), killed = fmt::format("killed{}", i);
    ASSERT_EQ(run_line(folder_.path(), words + " -o " + whole).exit_code, fronts[i].exit_code);
    std::mt19937 random(3);
    kill_and_end(words, killed, 6, random, fronts[i].exit_code);
    expect_same(killed, whole, "pareto.csv");
  }
}

TEST_F(Resumed, SamplesEndAsIfTheyHadNotBeenKilled) {
  const std::string words =
      "uncertainty " + problem("slider_crank_round") + quick_line() +
      R"( --jobs 2 --set '/uncertainty={"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}, )"
      R"("samples": 40}')";
  ASSERT_EQ(run_line(folder_.path(), words + " -o whole").exit_code, 0);
  std::mt19937 random(4);
  kill_and_end(words, "killed", 6, random);
  expect_same("killed", "whole", "uncertainty.csv");
  EXPECT_EQ(count_evaluations(folder_.path() / "whole"), 40);
}

/// Times are measured: only those of parts that were kept come back. Values and errors are the
/// same.
TEST_F(Resumed, AccuracyStudyEndsAsIfItHadNotBeenKilled) {
  const std::string words =
      "accuracy " + problem("slider_crank_round") + quick_line() +
      " --set '/accuracy/steps=[4e-4, 2e-4]' --set '/accuracy/elements=[2, 4]'";
  ASSERT_EQ(run_line(folder_.path(), words + " -o whole").exit_code, 0);
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
  const std::string words = "accuracy " + problem("slider_crank_round") + quick_line() +
                            " --set '/accuracy/steps=[4e-4]' --set '/accuracy/elements=[2]' -o run";
  ASSERT_EQ(run_line(folder_.path(), words).exit_code, 0);
  const std::string before = read_file(folder_.path() / "run/result.json");
  const ProgramRun again = run_line(folder_.path(), words + " --resume");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_file(folder_.path() / "run/result.json"), before);
  EXPECT_THAT(again.out, HasSubstr("parts of the study were known from run/run.sqlite"));
}

TEST_F(Resumed, RunThatHadEndedEvaluatesNothing) {
  const std::string words = "optimize " + problem("slider_crank_round") + quick_line() + " -o run";
  ASSERT_EQ(run_line(folder_.path(), words).exit_code, 0);
  const int evaluations = count_evaluations(folder_.path() / "run");
  const ProgramRun again = run_line(folder_.path(), words + " --resume");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(count_evaluations(folder_.path() / "run"), evaluations);
  EXPECT_THAT(again.out, HasSubstr("evaluations were known from run/run.sqlite"));
}

TEST_F(Resumed, InterruptedRunSaysHow) {
  const std::string words = "optimize " + problem("slider_crank_round") + " --starts 4 --jobs 2";
  const ProgramRun run =
      run_line(folder_.path(),
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
  const std::string words = "optimize " + problem("slider_crank_round") + quick_line() + " -o run";
  ASSERT_EQ(run_line(folder_.path(), words).exit_code, 0);
  const std::string before = read_file(folder_.path() / "run/result.json");
  const ProgramRun other =
      run_line(folder_.path(), words + " --resume --set /simulation/spectral_radius=0.7");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr("--resume: run holds a run with another problem: "
                                         "/simulation/spectral_radius is "),
                               HasSubstr(" there and 0.7 here")));
  const ProgramRun start = run_line(folder_.path(), words + " --resume --set rod_diameter=15mm");
  EXPECT_EQ(start.exit_code, 2);
  const ProgramRun starts = run_line(folder_.path(), words + " --resume --starts 2");
  EXPECT_THAT(starts.err, HasSubstr("/starts is 1 there and 2 here"));
  EXPECT_EQ(read_file(folder_.path() / "run/result.json"), before);
}

/// What a file says is part of the problem.
TEST_F(Resumed, RunWithAnotherCatalogueIsRefused) {
  const std::string words =
      "optimize " + problem("slider_crank_round") + quick_line() +
      " --set /scene/catalogue=" + (folder_.path() / "sections.json").string() + " -o run";
  const std::string section = R"({"type": "circle", "diameter": )";
  const auto make = [&](const std::string& diameter) {
    run_line(folder_.path(), "--version; echo '{\"sections\": {\"round\": " + section + diameter +
                                 "}}}' >sections.json");
  };
  make("0.01");
  const ProgramRun first = run_line(folder_.path(), words);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(run_line(folder_.path(), words + " --resume").exit_code, 0);
  make("0.02");
  const ProgramRun other = run_line(folder_.path(), words + " --resume");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("another file that the problem names"));
}

TEST_F(Resumed, RecordThatIsNoneIsRefused) {
  const std::string words = "optimize " + problem("slider_crank_round") + quick_line() + " -o run";
  ASSERT_EQ(run_line(folder_.path(), words).exit_code, 0);
  run_line(folder_.path(), "--version; head -c 9000 /dev/zero | tr '\\0' x >run/run.sqlite");
  const ProgramRun run = run_line(folder_.path(), words + " --resume");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--resume: run/run.sqlite: "));
}

TEST_F(Resumed, ResultsWithoutRecordAreKept) {
  const std::string words = "optimize " + problem("slider_crank_round") + quick_line() + " -o run";
  ASSERT_EQ(run_line(folder_.path(), words + "; rm run/run.sqlite*").exit_code, 0);
  const std::string before = read_file(folder_.path() / "run/result.json");
  const ProgramRun run = run_line(folder_.path(), words + " --resume");
  EXPECT_EQ(run.exit_code, 2);
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
  ASSERT_EQ(run_line(folder_.path(), words).exit_code, 0);
  write(true);
  const ProgramRun run = run_line(folder_.path(), words + " --resume");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("the keys of /variables stand in another order"));
}

TEST_F(Resumed, NothingBeginsAnew) {
  const std::string words = "optimize " + problem("slider_crank_round") + quick_line();
  const ProgramRun begun = run_line(folder_.path(), words + " -o run --resume");
  EXPECT_EQ(begun.exit_code, 0);
  EXPECT_THAT(begun.err, HasSubstr("run has no run.sqlite: there is nothing to resume"));
  EXPECT_EQ(run_line(folder_.path(), words + " -o run --resume --overwrite").exit_code, 2);
}

/// A record that cannot be written ends no run; the exit code tells.
TEST_F(Resumed, RecordThatCannotBeWrittenIsNamed) {
  const std::string words = "optimize " + problem("slider_crank_round") + quick_line() + " -o run";
  ASSERT_EQ(run_line(folder_.path(), words).exit_code, 0);
  fs::remove(folder_.path() / "run/run.sqlite");
  fs::create_directories(folder_.path() / "run/run.sqlite/not_a_file");
  const ProgramRun run = run_line(folder_.path(), words + " --overwrite");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("VERIFIED"));
  EXPECT_THAT(run.err, HasSubstr("run.sqlite"));
}

class Jobs : public Resumed {};

TEST_F(Jobs, DoNotChangeTheAnswerOfSeveralStarts) {
  for (const int jobs : {1, 2, 3}) {
    ASSERT_EQ(run_line(folder_.path(),
                       fmt::format("optimize {}{} --starts 3 --jobs {} -o with{}",
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
          run_line(folder_.path(),
                   fmt::format("pareto {}{}{} --jobs {} -o with{} --overwrite",
                               problem("slider_crank_round"), quick_line(), front, jobs, jobs));
      ASSERT_EQ(run.exit_code, exit_code) << run.out << run.err;
      EXPECT_THAT(run.out, HasSubstr(" points verified"));
    }
    expect_same("with2", "with1", "pareto.csv");
    expect_same("with3", "with1", "pareto.csv");
  }
}

/// The search that is killed is tried once more, and is heard once.
TEST_F(Jobs, MayLoseAProcess) {
  const std::string words =
      "optimize " + problem("slider_crank_round") + quick_line() + " --starts 3 --jobs 2 -o ";
  ASSERT_EQ(run_line(folder_.path(), words + "whole").exit_code, 0);
  const ProgramRun run = run_line(
      folder_.path(),
      words +
          "hurt >out & p=$!; i=0; while [ $(cat hurt/history.csv 2>/dev/null | wc -l) -lt 3 ] "
          "&& [ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; "
          "kill -9 $(cut -d' ' -f1 /proc/$p/task/$p/children) && echo killed; wait $p; echo $?");
  EXPECT_EQ(run.out, "killed\n0\n") << run.err;
  expect_same("hurt", "whole", "history.csv");
}

TEST_F(Jobs, AreTakenFromTheEnvironment) {
  const std::string words = "uncertainty " + problem("slider_crank_round");
  const ProgramRun run =
      run_line(folder_.path(), "--version; PLEUEL_JOBS=none " PLEUEL_PROGRAM " " + words);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("PLEUEL_JOBS must be a whole number from 1 to 1024, got \"none\""));
}

}  // namespace
}  // namespace pleuel::test::resume_test
