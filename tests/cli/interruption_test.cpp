#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

/// Long commands end in good order when they are asked to, with what they know by then.
namespace pleuel::test::interruption_test {
namespace {

class Interrupted : public testing::Test {
 protected:
  /// Asks a command to end as soon as a test of the shell holds. What it says is in "out" and "err".
  void run_until(const std::string& reached, const std::string& words,
                 const std::string& signal = "TERM") const {
    const ProgramRun run =
        folder_.run_line(words + " >out 2>err & p=$!; i=0; while ! { " + reached +
                         "; } && [ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); done; kill -" +
                         signal + " $p; wait $p; echo $?");
    EXPECT_EQ(run.out, "4\n");
  }
  nlohmann::json result() const { return folder_.result("run"); }
  void expect_interrupted() const { EXPECT_EQ(result().at("status"), "interrupted"); }
  std::string text(const std::string& file) const { return read_file(folder_.path() / file); }
  CsvRows rows(const std::string& file) const { return read_csv(folder_.path() / "run" / file); }

  /// The number below a title.
  static double cell(const CsvRows& rows, std::size_t row, const std::string& title) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    return std::stod(rows[row].at(found - rows[0].begin()));
  }

  const ProgramFolder folder_;
  const std::string file_ = problem("slider_crank_round") + " ";
};

TEST_F(Interrupted, ParetoKeepsItsPoints) {
  run_until("[ -s run/pareto.csv ]",
            "pareto " + file_ +
                "-o run --set '/simulation/end_time=60 ms' --set /pareto/points=200 "
                "--set '/simulation/step=0.1 ms'");
  expect_interrupted();
  ASSERT_GE(rows("pareto.csv").size(), 2u);
  EXPECT_EQ(result().at("points").size(), rows("pareto.csv").size() - 1);
  EXPECT_THAT(text("out"), HasSubstr("INTERRUPTED: "));
}

TEST_F(Interrupted, AccuracyKeepsItsRunsAndRecommendsNone) {
  run_until("[ -s run/accuracy.csv ]",
            "accuracy " + file_ +
                "-o run --set '/accuracy={\"steps\": [\"50 us\", \"51 us\", \"52 us\"], "
                "\"elements\": [2, 4, 6]}'");
  expect_interrupted();
  EXPECT_EQ(result().at("runs").size() + 2, rows("accuracy.csv").size());
  EXPECT_TRUE(result().at("recommended").is_null());
}

TEST_F(Interrupted, StabilityKeepsItsRuns) {
  run_until("[ -s run/stability.csv ]", "stability " + file_ + "-o run", "HUP");
  expect_interrupted();
  EXPECT_EQ(result().at("runs").size() + 1, rows("stability.csv").size());
}

/// What was simulated is kept where the checks of it, which take as long, are not awaited.
TEST_F(Interrupted, SimulateKeepsWhatItHasSimulated) {
  run_until("[ -s err ]", "simulate " + file_ + "-o run --set '/simulation/step=4 us'");
  expect_interrupted();
  EXPECT_FALSE(result().at("responses").empty());
  EXPECT_GE(rows("trajectory.csv").size(), 1000u);
  EXPECT_THAT(text("out"), HasSubstr("interrupted while the numbers were checked"));
}

/// Samples are told after each batch of 64.
TEST_F(Interrupted, UncertaintyKeepsItsSamples) {
  run_until("grep -q '^  64 of' err",
            "uncertainty " + file_ +
                "-o run --set '/simulation/step=0.2 ms' --set '/simulation/end_time=20 ms' --set "
                "'/uncertainty={\"parameters\": {\"rod_diameter\": {\"deviation\": \"0.1 mm\"}}, "
                "\"samples\": 100000}'");
  expect_interrupted();
  const int samples = result().at("samples");
  EXPECT_GE(samples, 64);
  EXPECT_LT(samples, 100000);
  EXPECT_EQ(samples % 64, 0);
  EXPECT_GT(result().at("responses").at("rod_bow").at("sampled").at("deviation"), 0.0);
}

/// The derivatives are not verified then; what is known before them is told.
TEST_F(Interrupted, CheckTellsTheDesign) {
  run_until("[ -s err ]", "check " + file_ + "--json");
  const auto document = read_json(folder_.path() / "out");
  EXPECT_EQ(document.at("status"), "interrupted");
  EXPECT_TRUE(document.at("responses").at("rod_bow").contains("value"));
}

/// The best of what was evaluated: the lightest within the limits, else the one nearest to them.
TEST_F(Interrupted, OptimizationKeepsItsBestDesignNotItsLast) {
  run_until("[ $(cat run/history.csv 2>/dev/null | wc -l) -ge 5 ]",
            "optimize " + file_ + "--backend nlopt-mma -o run");
  const CsvRows history = rows("history.csv");
  std::size_t best = 1;
  for (std::size_t row = 2; row < history.size(); ++row) {
    const bool is_within = cell(history, row, "max_violation") <= 1e-4;
    const bool best_is_within = cell(history, best, "max_violation") <= 1e-4;
    const char* decides = is_within && best_is_within ? "objective" : "max_violation";
    if (cell(history, row, decides) < cell(history, best, decides)) best = row;
  }
  for (const char* name : {"crank_diameter", "rod_diameter"}) {
    EXPECT_EQ(result().at("variables").at(name).at("value"),
              cell(history, best, std::string("variable:") + name));
  }
}

/// The answer is there before what is simulated for its report.
TEST_F(Interrupted, OptimizationKeepsItsVerdictAfterItsSearch) {
  run_until("[ -s run/result.json ]",
            "optimize " + file_ +
                "-o run --set /optimizer/max_iterations=1 --set '/simulation/step=20 us'");
  EXPECT_NE(result().at("status"), "interrupted");
  EXPECT_THAT(result().at("interrupted").get<std::string>(), HasSubstr("its result stands"));
  EXPECT_FALSE(result().contains("monitors"));
  EXPECT_THAT(unwrapped(text("out")), HasSubstr("its result stands"));
}

/// A coarse stage has errors that a fine one has not: the best is that of the last one.
TEST_F(Interrupted, OptimizationInStagesKeepsTheBestOfItsLastSetting) {
  run_until(
      "[ $(awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i == \"time_step\") c = i} "
      "NR > 1 {if (!($c in s)) n++; s[$c] = 1} END {print n + 0}' run/history.csv "
      "2>/dev/null || echo 0) -ge 2 ]",
      "optimize " + file_ + "--accuracy 0.1% -o run");
  const CsvRows history = rows("history.csv");
  const double step = cell(history, history.size() - 1, "time_step");
  ASSERT_NE(cell(history, 1, "time_step"), step);
  const auto best = result().at("variables").at("rod_diameter").at("value");
  bool is_of_last_setting = false;
  for (std::size_t row = 1; row < history.size(); ++row) {
    if (cell(history, row, "time_step") != step) continue;
    is_of_last_setting = is_of_last_setting || best == cell(history, row, "variable:rod_diameter");
  }
  EXPECT_TRUE(is_of_last_setting);
  EXPECT_FALSE(result().contains("stages"));
  EXPECT_FALSE(result().contains("setting"));
}

/// Nothing is known of a motion that has not ended; no folder stays.
TEST_F(Interrupted, SimulationLeavesNothing) {
  run_until("[ -d run ]", "simulate " + file_ + "-o run --set '/simulation/step=1 us'");
  EXPECT_THAT(text("err"), HasSubstr("pleuel: interrupted"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "run"));
}

}  // namespace
}  // namespace pleuel::test::interruption_test
