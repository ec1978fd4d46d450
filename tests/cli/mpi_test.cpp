#include "tests/cli/compared_runs.hpp"
#include "tests/support/test.hpp"

/// Runs under mpirun come to the same digits as others.
namespace pleuel::test::mpi_test {
namespace {

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
    const ProgramRun run = folder_.run_line(words + " --jobs 1 -o alone");
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
};

TEST_F(Mpi, DoesNotChangeTheAnswerOfSeveralStarts) {
  const std::string words = quick_run("optimize") + " --no-report --starts 4";
  run_alone(words);
  for (const int ranks : {2, 3, 4}) {
    const ProgramRun run = run_ranks(ranks, fmt::format("{} -o with{}", words, ranks));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr(fmt::format("{} ranks on 1 machine, ", ranks)));
    expect_same(fmt::format("with{}", ranks), "alone", "history.csv");
  }
}

TEST_F(Mpi, DoesNotChangeTheFront) {
  const std::string words = quick_run("pareto") + " --no-report --set /pareto/points=4";
  run_alone(words);
  for (const int ranks : {2, 3}) {
    const ProgramRun run = run_ranks(ranks, fmt::format("{} -o with{}", words, ranks));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    expect_same(fmt::format("with{}", ranks), "alone", "pareto.csv");
  }
}

TEST_F(Mpi, DoesNotChangeWhatComesIntoTheGapsOfAFront) {
  const std::string words = quick_run("pareto") + " --no-report --set /pareto/points=3 --gap 25%";
  run_alone(words);
  const ProgramRun run = run_ranks(2, words + " -o with2");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_same("with2", "alone", "pareto.csv");
}

TEST_F(Mpi, DoesNotChangeSamples) {
  const std::string words = quick_run("uncertainty") + samples + " --no-report";
  run_alone(words);
  for (const int ranks : {2, 3}) {
    const ProgramRun run = run_ranks(ranks, fmt::format("{} -o with{}", words, ranks));
    EXPECT_EQ(run.exit_code, 0) << run.err;
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
  const ProgramRun again = run_ranks(3, words + " -o run --resume");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("evaluations were known from run/run.sqlite"));
  expect_same("run", "alone", "history.csv");
}

TEST_F(Mpi, BadInputEndsAllRanks) {
  const ProgramRun run = run_ranks(3, "optimize none.json");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("none.json"));
}

/// Nothing of MPI is needed to say so.
TEST(WithoutMpi, MpirunIsAnsweredByAMessage) {
  const ProgramFolder folder;
  const ProgramRun run =
      folder.run_line("--version >/dev/null; cp " PLEUEL_PROGRAM
                      " .; OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0 ./pleuel backends");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(unwrapped(run.err), AllOf(HasSubstr("mpirun started 2 of these"),
                                        HasSubstr("libopenmpi-dev"), HasSubstr("--jobs")));
  const ProgramRun alone = folder.run_line(
      "--version >/dev/null; OMPI_COMM_WORLD_SIZE=1 "
      "OMPI_COMM_WORLD_RANK=0 ./pleuel backends");
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
}

}  // namespace
}  // namespace pleuel::test::mpi_test
