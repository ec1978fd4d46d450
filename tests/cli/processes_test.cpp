#include "tests/cli/program.hpp"

/// Long commands end in good order when they are asked to, with what they know by then.

/// Runs under mpirun come to the same digits as others.

namespace pleuel::test::processes_test {
namespace {

class Interrupted : public InProgramFolder {
 protected:
  /// Asks a command to end as soon as a test of the shell holds. What it says is in "out" and "err".
  void run_until(const std::string& reached, const std::string& line,
                 const std::string& signal = "TERM") const {
    EXPECT_EQ(run(line + " >out 2>err & p=$!; " + wait_until(reached) + "kill -" + signal +
                  " $p; wait $p; echo $?")
                  .out,
              "4\n");
  }
  void expect_interrupted() const { EXPECT_EQ(result().at("status"), "interrupted"); }
  CsvRows rows(const std::string& file) const { return folder_.csv("run/" + file); }
};

TEST_F(Interrupted, ParetoKeepsItsPoints) {
  run_until("[ -s run/pareto.csv ]",
            "pareto $crank -o run --set '/simulation/end_time=60 ms' --set /pareto/points=200 "
            "--set '/simulation/step=0.1 ms'");
  expect_interrupted();
  ASSERT_GE(rows("pareto.csv").size(), 2u);
  EXPECT_EQ(result().at("points").size(), rows("pareto.csv").size() - 1);
  EXPECT_THAT(folder_.text("out"), HasSubstr("INTERRUPTED: "));
}

TEST_F(Interrupted, AccuracyKeepsItsRunsAndRecommendsNone) {
  run_until("[ -s run/accuracy.csv ]",
            "accuracy $crank -o run --set "
            R"('/accuracy={"steps": ["50 us", "51 us", "52 us"], "elements": [2, 4, 6]}')");
  expect_interrupted();
  EXPECT_EQ(result().at("runs").size() + 2, rows("accuracy.csv").size());
  EXPECT_TRUE(result().at("recommended").is_null());
}

TEST_F(Interrupted, StabilityKeepsItsRuns) {
  run_until("[ -s run/stability.csv ]", "stability $crank -o run", "HUP");
  expect_interrupted();
  EXPECT_EQ(result().at("runs").size() + 1, rows("stability.csv").size());
}

/// What was simulated is kept where the checks of it, which take as long, are not awaited.
TEST_F(Interrupted, SimulateKeepsWhatItHasSimulated) {
  run_until("[ -s err ]", "simulate $crank -o run --set '/simulation/step=4 us'");
  expect_interrupted();
  EXPECT_FALSE(result().at("responses").empty());
  EXPECT_GE(rows("trajectory.csv").size(), 1000u);
  EXPECT_THAT(folder_.text("out"), HasSubstr("interrupted while the numbers were checked"));
}

/// Samples are told after each batch of 64.
TEST_F(Interrupted, UncertaintyKeepsItsSamples) {
  run_until("grep -q '^  64 of' err",
            "uncertainty $crank -o run --set '/simulation/step=0.2 ms' "
            "--set '/simulation/end_time=20 ms' --set '/uncertainty={\"samples\": 100000, "
            "\"parameters\": {\"rod_diameter\": {\"deviation\": \"0.1 mm\"}}}'");
  expect_interrupted();
  const int samples = result().at("samples");
  EXPECT_GE(samples, 64);
  EXPECT_LT(samples, 100000);
  EXPECT_EQ(samples % 64, 0);
  EXPECT_GT(number(result(), "responses/rod_bow/sampled/deviation"), 0.0);
}

/// The derivatives are not verified then; what is known before them is told.
TEST_F(Interrupted, CheckTellsTheDesign) {
  run_until("[ -s err ]", "check $crank --json");
  EXPECT_EQ(folder_.read("out").at("status"), "interrupted");
  EXPECT_TRUE(at(folder_.read("out"), "responses/rod_bow").contains("value"));
}

/// The best of what was evaluated: the lightest within the limits, else the one nearest to them.
TEST_F(Interrupted, OptimizationKeepsItsBestDesignNotItsLastToGoOnFrom) {
  run_until("[ $(cat run/history.csv 2>/dev/null | wc -l) -ge 5 ]",
            "optimize $crank --backend nlopt-mma -o run");
  expect_interrupted();
  EXPECT_EQ(folder_.read("run/run_card.json").at("finished"), true);
  EXPECT_THAT(folder_.text("out"),
              AllOf(HasSubstr("To go on from there: "), HasSubstr("-o run --resume")));
  const std::vector<double> objective = numbers(rows("history.csv"), "objective"),
                            violation = numbers(rows("history.csv"), "max_violation");
  std::size_t best = 0;
  for (std::size_t row = 1; row < objective.size(); ++row) {
    const bool are_within = violation[row] <= 1e-4 && violation[best] <= 1e-4;
    const std::vector<double>& decides = are_within ? objective : violation;
    if (decides[row] < decides[best]) best = row;
  }
  const json variables = result().at("variables");
  ASSERT_EQ(variables.size(), 2u);
  run("optimize $crank $quick -o two --design run/result.json --set /optimizer/max_iterations=1",
      4);
  for (const auto& [name, variable] : variables.items()) {
    EXPECT_EQ(variable.at("value"), numbers(rows("history.csv"), "variable:" + name)[best]);
    EXPECT_EQ(variable.at("value"),
              numbers(folder_.csv("two/history.csv"), "variable:" + name).front());
  }
}

/// The answer is there before what is simulated for its report.
TEST_F(Interrupted, OptimizationKeepsItsVerdictAfterItsSearch) {
  run_until("[ -s run/result.json ]",
            "optimize $crank -o run --set /optimizer/max_iterations=1 "
            "--set '/simulation/step=20 us'");
  EXPECT_NE(result().at("status"), "interrupted");
  EXPECT_THAT(result().at("interrupted").get<std::string>(), HasSubstr("its result stands"));
  EXPECT_FALSE(result().contains("monitors"));
  EXPECT_THAT(unwrapped(folder_.text("out")), HasSubstr("its result stands"));
}

/// A coarse stage has errors that a fine one has not: the best is that of the last one.
TEST_F(Interrupted, OptimizationInStagesKeepsTheBestOfItsLastSetting) {
  run_until(
      "[ $(awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) if ($i == \"time_step\") c = i} "
      "NR > 1 {if (!($c in s)) n++; s[$c] = 1} END {print n + 0}' run/history.csv "
      "2>/dev/null || echo 0) -ge 2 ]",
      "optimize $crank --accuracy 0.1% -o run");
  const std::vector<double> steps = numbers(rows("history.csv"), "time_step"),
                            rods = numbers(rows("history.csv"), "variable:rod_diameter");
  ASSERT_NE(steps.front(), steps.back());
  const double best = number(result(), "variables/rod_diameter/value");
  bool is_of_last_setting = false;
  for (std::size_t row = 0; row < steps.size(); ++row) {
    is_of_last_setting |= steps[row] == steps.back() && rods[row] == best;
  }
  EXPECT_TRUE(is_of_last_setting);
  EXPECT_FALSE(result().contains("stages"));
  EXPECT_FALSE(result().contains("setting"));
}

/// Nothing is known of a motion that has not ended; no folder stays.
TEST_F(Interrupted, SimulationLeavesNothing) {
  run_until("[ -d run ]", "simulate $crank -o run --set '/simulation/step=1 us'");
  EXPECT_THAT(folder_.text("err"), HasSubstr("pleuel: interrupted"));
  EXPECT_FALSE(folder_.has("run"));
}

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
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 {} --oversubscribe -n {} "
        "$pleuel ",
        PLEUEL_MPIRUN, ranks);
#else
    return fmt::format("{}", ranks);
#endif
  }

  ProgramRun run_ranks(int ranks, const std::string& line, int exit_code = 0) const {
    return run("--version >/dev/null; " + mpirun(ranks) + line, exit_code);
  }

  /// While two ranks are at work.
  /// @param what  of the shell: $p is mpirun, $e the program of rank 1, $w its worker
  ProgramRun run_meanwhile(const std::string& line, const std::string& what) const {
    return run("--version >/dev/null; " + mpirun(2) + line + " >out 2>err & p=$!; " +
               workers_of_rank_1 + what);
  }

  /// As one process and its worker does it.
  void run_alone(const std::string& line) const {
    run(line + " --jobs 1 -o alone");
  }
};

TEST_F(Mpi, ChangesNoAnswer) {
  struct Case {
    std::string line, table;
    std::vector<int> ranks;
  };
  const std::string front = "pareto $crank $quick --no-report --set /pareto/points=";
  for (const auto& [line, table, all_ranks] :
       {Case{"optimize $crank $quick --no-report --starts 4", "history.csv", {2, 3, 4}},
        Case{front + "4", "pareto.csv", {2, 3}}, Case{front + "3 --gap 25%", "pareto.csv", {2}},
        Case{"uncertainty $crank $quick --no-report --set '/uncertainty={\"samples\": 40, "
             "\"parameters\": {\"rod_diameter\": {\"deviation\": \"0.1 mm\"}}}'",
             "uncertainty.csv",
             {2, 3}}}) {
    SCOPED_TRACE(line);
    run_alone(line + " --overwrite");
    for (const int ranks : all_ranks) {
      const ProgramRun together = run_ranks(ranks, line + " -o together --overwrite");
      EXPECT_THAT(together.err, HasSubstr(fmt::format("{} ranks on 1 machine, ", ranks)));
      expect_same("together", "alone", table);
    }
    std::filesystem::remove_all(folder_ / "alone");
    std::filesystem::remove_all(folder_ / "together");
  }
}

TEST_F(Mpi, MayLoseAWorkerOrTheProgramOfARank) {
  const std::string line = "optimize $crank $quick --no-report --starts 4";
  run_alone(line);
  for (const std::string lost : {"$w", "$e"}) {
    SCOPED_TRACE(lost);
    const ProgramRun hurt =
        run_meanwhile(line + " -o hurt", "kill -9 " + lost + " && echo killed; wait $p; echo $?");
    EXPECT_EQ(hurt.out, "killed\n0\n") << hurt.err << folder_.text("err");
    expect_same("hurt", "alone", "history.csv");
    std::filesystem::remove_all(folder_ / "hurt");
  }
}

/// What was interrupted goes on to the same end, with or without ranks.
TEST_F(Mpi, EndsInGoodOrderAndGoesOn) {
  const std::string line = "optimize $crank $quick --no-report --starts 8";
  const ProgramRun ended = run_meanwhile(
      line + " -o run",
      wait_until("[ $(cat run/history.csv 2>/dev/null | wc -l) -ge 4 ]") +
          "kill -USR1 $p; wait $p; echo $?; for q in $w $e; do [ ! -e /proc/$q ] || echo left $q; "
          "done");
  EXPECT_EQ(ended.out, "4\n");  // and no process is left
  EXPECT_THAT(unwrapped(folder_.text("out")), HasSubstr("To go on from there: "));
  run_alone(line);
  EXPECT_THAT(run_ranks(3, line + " -o run --resume").out,
              HasSubstr("evaluations were known from run/run.sqlite"));
  expect_same("run", "alone", "history.csv");
}

TEST_F(Mpi, BadInputEndsAllRanks) {
  EXPECT_THAT(run_ranks(3, "optimize none.json", 2).err, HasSubstr("none.json"));
}

/// Nothing of MPI is needed to say so.
using WithoutMpi = InProgramFolder;

TEST_F(WithoutMpi, MpirunIsAnsweredByAMessage) {
  const std::string program = "--version >/dev/null; cp " PLEUEL_PROGRAM " .; ";
  EXPECT_THAT(refusal(program + "OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0 ./pleuel backends"),
              AllOf(HasSubstr("mpirun started 2 of these"), HasSubstr("libopenmpi-dev"),
                    HasSubstr("--jobs")));
  run(program + "OMPI_COMM_WORLD_SIZE=1 OMPI_COMM_WORLD_RANK=0 ./pleuel backends");
}

}  // namespace
}  // namespace pleuel::test::processes_test
