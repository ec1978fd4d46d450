#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

/// Long commands end in good order when they are asked to, with what they know by then.
namespace pleuel::test::interruption_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Interrupted : public testing::Test {
 protected:
  /// Asks a command to end as soon as its first result is there; exit code and standard error.
  ProgramRun run_until(const std::string& result, const std::string& words,
                       const std::string& signal = "TERM") const {
    const std::string path = folder_.path().string();
    return run_line(folder_.path(),
                    fmt::format("{0} -o {1}/run >{1}/out & p=$!; i=0; "
                                "while [ ! -s {1}/{2} ] && [ $i -lt 3000 ]; "
                                "do sleep 0.01; i=$((i + 1)); done; kill -{3} $p; wait $p; echo $?",
                                words, path, result, signal));
  }
  nlohmann::json result() const {
    return nlohmann::json::parse(read_file(folder_.path() / "run/result.json"));
  }
  std::string out() const { return read_file(folder_.path() / "out"); }

  const TemporaryFolder folder_;
};

TEST_F(Interrupted, ParetoKeepsItsPoints) {
  const ProgramRun run =
      run_until("run/pareto.csv", "pareto " + problem("slider_crank_round") +
                                      " --set '/simulation/end_time=60 ms' --set "
                                      "/pareto/points=200 --set '/simulation/step=0.1 ms'");
  EXPECT_EQ(run.out, "4\n");
  EXPECT_EQ(result().at("status"), "interrupted");
  const auto rows = read_csv(folder_.path() / "run/pareto.csv");
  ASSERT_GE(rows.size(), 2u);
  EXPECT_EQ(result().at("points").size(), rows.size() - 1);
  EXPECT_THAT(out(), HasSubstr("INTERRUPTED: "));
}

TEST_F(Interrupted, AccuracyKeepsItsRunsAndRecommendsNone) {
  const ProgramRun run = run_until(
      "run/accuracy.csv", "accuracy " + problem("slider_crank_round") +
                              " --set '/accuracy={\"steps\": [\"50 us\", \"51 us\", \"52 us\"], "
                              "\"elements\": [2, 4, 6]}'");
  EXPECT_EQ(run.out, "4\n");
  EXPECT_EQ(result().at("status"), "interrupted");
  EXPECT_EQ(result().at("runs").size() + 2, read_csv(folder_.path() / "run/accuracy.csv").size());
  EXPECT_TRUE(result().at("recommended").is_null());
}

TEST_F(Interrupted, StabilityKeepsItsRuns) {
  const ProgramRun run =
      run_until("run/stability.csv", "stability " + problem("slider_crank_round"), "HUP");
  EXPECT_EQ(run.out, "4\n");
  EXPECT_EQ(result().at("status"), "interrupted");
  EXPECT_EQ(result().at("runs").size() + 1, read_csv(folder_.path() / "run/stability.csv").size());
}

/// What was simulated is kept where the checks of it, which take as long, are not awaited.
TEST_F(Interrupted, SimulateKeepsWhatItHasSimulated) {
  const std::string path = folder_.path().string();
  const ProgramRun run = run_line(
      folder_.path(),
      fmt::format("simulate {0} -o {1}/run --set '/simulation/step=4 us' >{1}/out 2>{1}/err & "
                  "p=$!; i=0; while [ ! -s {1}/err ] && [ $i -lt 3000 ]; "
                  "do sleep 0.01; i=$((i + 1)); done; kill -TERM $p; wait $p; echo $?",
                  problem("slider_crank_round"), path));
  EXPECT_EQ(run.out, "4\n");
  EXPECT_EQ(result().at("status"), "interrupted");
  EXPECT_FALSE(result().at("responses").empty());
  EXPECT_GE(read_csv(folder_.path() / "run/trajectory.csv").size(), 1000u);
  EXPECT_THAT(out(), HasSubstr("interrupted while the numbers were checked"));
}

/// Samples are told after each batch of 64.
TEST_F(Interrupted, UncertaintyKeepsItsSamples) {
  const std::string path = folder_.path().string();
  const ProgramRun run = run_line(
      folder_.path(),
      fmt::format("uncertainty {0} -o {1}/run --set '/simulation/step=0.2 ms' --set "
                  "'/simulation/end_time=20 ms' --set '/uncertainty={{\"parameters\": "
                  "{{\"rod_diameter\": {{\"deviation\": \"0.1 mm\"}}}}, \"samples\": 100000}}' "
                  ">{1}/out 2>{1}/err & p=$!; i=0; while ! grep -q '^  64 of' {1}/err && "
                  "[ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; kill -TERM $p; wait $p; "
                  "echo $?",
                  problem("slider_crank_round"), path));
  EXPECT_EQ(run.out, "4\n");
  EXPECT_EQ(result().at("status"), "interrupted");
  const int samples = result().at("samples");
  EXPECT_GE(samples, 64);
  EXPECT_LT(samples, 100000);
  EXPECT_EQ(samples % 64, 0);
  EXPECT_GT(result().at("responses").at("rod_bow").at("sampled").at("deviation"), 0.0);
}

/// The derivatives are not verified then; what is known before them is told.
TEST_F(Interrupted, CheckTellsTheDesign) {
  const std::string path = folder_.path().string();
  const ProgramRun run = run_line(
      folder_.path(),
      fmt::format("check {0} --json >{1}/out 2>{1}/err & p=$!; i=0; while [ ! -s {1}/err ] && "
                  "[ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; kill -TERM $p; wait $p; "
                  "echo $?",
                  problem("slider_crank_round"), path));
  EXPECT_EQ(run.out, "4\n");
  const nlohmann::json document = nlohmann::json::parse(out());
  EXPECT_EQ(document.at("status"), "interrupted");
  EXPECT_TRUE(document.at("responses").at("rod_bow").contains("value"));
}

/// The best of what was evaluated: the lightest within the limits, else the one nearest to them.
TEST_F(Interrupted, OptimizationKeepsItsBestDesignNotItsLast) {
  const std::string path = folder_.path().string();
  const ProgramRun run = run_line(
      folder_.path(),
      fmt::format("optimize {0} --backend nlopt-mma -o {1}/run >{1}/out & p=$!; i=0; "
                  "while [ $(cat {1}/run/history.csv 2>/dev/null | wc -l) -lt 5 ] && "
                  "[ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; kill -TERM $p; wait $p; "
                  "echo $?",
                  problem("slider_crank_round"), path));
  EXPECT_EQ(run.out, "4\n");
  const CsvRows rows = read_csv(folder_.path() / "run/history.csv");
  const auto cell = [&](std::size_t row, const std::string& title) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    return std::stod(rows[row].at(found - rows[0].begin()));
  };
  std::size_t best = 1;
  for (std::size_t row = 2; row < rows.size(); ++row) {
    const bool is_within = cell(row, "max_violation") <= 1e-4;
    const bool best_is_within = cell(best, "max_violation") <= 1e-4;
    const bool is_better = is_within && best_is_within
                               ? cell(row, "objective") < cell(best, "objective")
                               : cell(row, "max_violation") < cell(best, "max_violation");
    if (is_better) best = row;
  }
  for (const char* name : {"crank_diameter", "rod_diameter"}) {
    EXPECT_EQ(result().at("variables").at(name).at("value"),
              cell(best, std::string("variable:") + name));
  }
}

/// The answer is there before what is simulated for its report.
TEST_F(Interrupted, OptimizationKeepsItsVerdictAfterItsSearch) {
  const ProgramRun run =
      run_until("run/result.json", "optimize " + problem("slider_crank_round") +
                                       " --set /optimizer/max_iterations=1 --set "
                                       "'/simulation/step=20 us'");
  EXPECT_EQ(run.out, "4\n");
  EXPECT_NE(result().at("status"), "interrupted");
  EXPECT_THAT(result().at("interrupted").get<std::string>(), HasSubstr("its result stands"));
  EXPECT_FALSE(result().contains("monitors"));
  EXPECT_THAT(unwrapped(out()), HasSubstr("its result stands"));
}

/// A coarse stage has errors that a fine one has not: the best is that of the last one.
TEST_F(Interrupted, OptimizationInStagesKeepsTheBestOfItsLastSetting) {
  const std::string path = folder_.path().string();
  const ProgramRun run = run_line(
      folder_.path(),
      fmt::format("optimize {0} --accuracy 0.1% -o {1}/run >{1}/out & p=$!; i=0; "
                  "while [ $(awk -F, 'NR == 1 {{for (i = 1; i <= NF; i++) if ($i == "
                  "\"time_step\") c = i}} NR > 1 {{if (!($c in s)) n++; s[$c] = 1}} "
                  "END {{print n + 0}}' {1}/run/history.csv 2>/dev/null || echo 0) -lt 2 ] && "
                  "[ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; kill -TERM $p; wait $p; "
                  "echo $?",
                  problem("slider_crank_round"), path));
  EXPECT_EQ(run.out, "4\n");
  const CsvRows rows = read_csv(folder_.path() / "run/history.csv");
  const auto cell = [&](const std::vector<std::string>& row, const std::string& title) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    return std::stod(row.at(found - rows[0].begin()));
  };
  const double step = cell(rows.back(), "time_step");
  ASSERT_NE(cell(rows[1], "time_step"), step);
  bool is_of_last_setting = false;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    if (cell(rows[row], "time_step") != step) continue;
    is_of_last_setting =
        is_of_last_setting || result().at("variables").at("rod_diameter").at("value") ==
                                  cell(rows[row], "variable:rod_diameter");
  }
  EXPECT_TRUE(is_of_last_setting);
  EXPECT_FALSE(result().contains("stages"));
  EXPECT_FALSE(result().contains("setting"));
}

/// Nothing is known of a motion that has not ended; no folder stays.
TEST_F(Interrupted, SimulationLeavesNothing) {
  const std::string path = folder_.path().string();
  const ProgramRun run = run_line(
      folder_.path(),
      fmt::format("simulate {0} -o {1}/run --set '/simulation/step=1 us' & p=$!; i=0; "
                  "while [ ! -d {1}/run ] && [ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; "
                  "kill -TERM $p; wait $p; echo $?",
                  problem("slider_crank_round"), path));
  EXPECT_EQ(run.out, "4\n");
  EXPECT_THAT(run.err, HasSubstr("pleuel: interrupted"));
  EXPECT_FALSE(fs::exists(folder_.path() / "run"));
}

}  // namespace
}  // namespace pleuel::test::interruption_test
