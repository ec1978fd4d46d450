#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

/// Long commands end in good order when they are asked to, with what they know by then.

/// Runs under mpirun come to the same digits as others.

namespace pleuel::test::processes_test {
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

/// What the file of a problem asks for where samples are drawn.
constexpr const char* samples =
    R"( --set '/uncertainty={"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}, )"
    R"("samples": 40}')";

/// Children of rank 1: mpirun has started pleuel-mpi twice, each beside its pleuel.
constexpr const char* workers_of_rank_1 =
    "children() { cat /proc/$1/task/$1/children 2>/dev/null; }; "
    "i=0; w=; while [ -z \"$w\" ] && [ $i -lt 3000 ]; do sleep 0.01; i=$((i + 1)); "
    "r=$(children $p | cut -s -d' ' -f2); [ -n \"$r\" ] || continue; "
    "e=$(children $r | cut -d' ' -f1); [ -n \"$e\" ] || continue; "
    "w=$(children $e | cut -d' ' -f1); done; ";

class Mpi : public ComparedRuns {
 protected:
  void SetUp() override {
#ifndef PLEUEL_MPIRUN
    GTEST_SKIP() << "built without MPI (Debian: libopenmpi-dev openmpi-bin)";
#endif
  }

  /// Ranks may be more than processors, and root may start them.
  static std::string mpirun(int ranks) {
#ifdef PLEUEL_MPIRUN
    return fmt::format(
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 {} --oversubscribe -n {} {}",
        PLEUEL_MPIRUN, ranks, PLEUEL_PROGRAM);
#else
    return fmt::format("{}", ranks);
#endif
  }

  ProgramRun run_ranks(int ranks, const std::string& words) const {
    return folder_.run_line("--version >/dev/null; " + mpirun(ranks) + " " + words);
  }

  /// While two ranks are at work.
  /// @param what  of the shell: $p is mpirun, $e the program of rank 1, $w its worker
  ProgramRun run_meanwhile(const std::string& words, std::string_view what) const {
    return folder_.run_line(
        fmt::format("--version >/dev/null; {} {} >out 2>err & p=$!; "
                    "{} {}",
                    mpirun(2), words, workers_of_rank_1, what));
  }

  /// As one process and its worker does it.
  void run_alone(const std::string& words) const {
    const ProgramRun run = exits(0, folder_.run_line(words + " --jobs 1 -o alone"));
  }
};

TEST_F(Mpi, DoesNotChangeTheAnswerOfSeveralStarts) {
  const std::string words = quick_run("optimize") + " --no-report --starts 4";
  run_alone(words);
  for (const int ranks : {2, 3, 4}) {
    const ProgramRun run = exits(0, run_ranks(ranks, fmt::format("{} -o with{}", words, ranks)));
    EXPECT_THAT(run.err, HasSubstr(fmt::format("{} ranks on 1 machine, ", ranks)));
    expect_same(fmt::format("with{}", ranks), "alone", "history.csv");
  }
}

TEST_F(Mpi, DoesNotChangeTheFront) {
  const std::string words = quick_run("pareto") + " --no-report --set /pareto/points=4";
  run_alone(words);
  for (const int ranks : {2, 3}) {
    const ProgramRun run = exits(0, run_ranks(ranks, fmt::format("{} -o with{}", words, ranks)));
    expect_same(fmt::format("with{}", ranks), "alone", "pareto.csv");
  }
}

TEST_F(Mpi, DoesNotChangeWhatComesIntoTheGapsOfAFront) {
  const std::string words = quick_run("pareto") + " --no-report --set /pareto/points=3 --gap 25%";
  run_alone(words);
  const ProgramRun run = exits(0, run_ranks(2, words + " -o with2"));
  expect_same("with2", "alone", "pareto.csv");
}

TEST_F(Mpi, DoesNotChangeSamples) {
  const std::string words = quick_run("uncertainty") + samples + " --no-report";
  run_alone(words);
  for (const int ranks : {2, 3}) {
    const ProgramRun run = exits(0, run_ranks(ranks, fmt::format("{} -o with{}", words, ranks)));
    expect_same(fmt::format("with{}", ranks), "alone", "uncertainty.csv");
  }
}

TEST_F(Mpi, MayLoseAWorkerOrTheProgramOfARank) {
  const std::string words = quick_run("optimize") + " --no-report --starts 4";
  run_alone(words);
  for (const char* lost : {"$w", "$e"}) {
    SCOPED_TRACE(lost);
    const ProgramRun run = run_meanwhile(
        words + " -o hurt", fmt::format("kill -9 {} && echo killed; wait $p; echo $?", lost));
    EXPECT_EQ(run.out, "killed\n0\n") << run.err << read_file(folder_.path() / "err");
    expect_same("hurt", "alone", "history.csv");
    std::filesystem::remove_all(folder_.path() / "hurt");
  }
}

/// What was interrupted goes on to the same end, with or without ranks.
TEST_F(Mpi, EndsInGoodOrderAndGoesOn) {
  const std::string words = quick_run("optimize") + " --no-report --starts 8";
  const ProgramRun run = run_meanwhile(
      words + " -o run",
      "i=0; while [ $(cat run/history.csv 2>/dev/null | wc -l) -lt 4 ] && [ $i -lt 3000 ]; do "
      "sleep 0.01; i=$((i + 1)); done; kill -USR1 $p; wait $p; echo $?; "
      "for q in $w $e; do [ ! -e /proc/$q ] || echo left $q; done");
  EXPECT_EQ(run.out, "4\n");  // and no process is left
  EXPECT_THAT(unwrapped(read_file(folder_.path() / "out")), HasSubstr("To go on from there: "));
  run_alone(words);
  const ProgramRun again = exits(0, run_ranks(3, words + " -o run --resume"));
  EXPECT_THAT(again.out, HasSubstr("evaluations were known from run/run.sqlite"));
  expect_same("run", "alone", "history.csv");
}

TEST_F(Mpi, BadInputEndsAllRanks) {
  EXPECT_THAT(exits(2, run_ranks(3, "optimize none.json")).err, HasSubstr("none.json"));
}

/// Nothing of MPI is needed to say so.
TEST(WithoutMpi, MpirunIsAnsweredByAMessage) {
  const ProgramFolder folder;
  const ProgramRun run = exits(
      2, folder.run_line("--version >/dev/null; cp " PLEUEL_PROGRAM
                         " .; OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0 ./pleuel backends"));
  EXPECT_THAT(unwrapped(run.err), AllOf(HasSubstr("mpirun started 2 of these"),
                                        HasSubstr("libopenmpi-dev"), HasSubstr("--jobs")));
  const ProgramRun alone = exits(0, folder.run_line("--version >/dev/null; OMPI_COMM_WORLD_SIZE=1 "
                                                    "OMPI_COMM_WORLD_RANK=0 ./pleuel backends"));
}

}  // namespace
}  // namespace pleuel::test::processes_test
