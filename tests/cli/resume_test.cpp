#include <random>

#include <sys/stat.h>

#include "record/run_database.hpp"
#include "tests/cli/program.hpp"

namespace pleuel::test::resume_test {
namespace {

// Runs that are killed go on as if nothing had happened, and answers do not depend on how many
// processes find them.

namespace fs = std::filesystem;

using Resumed = ComparedRuns;

const std::string samples =
    "uncertainty $crank $quick --jobs 2 --set '/uncertainty={\"samples\": 40, "
    "\"parameters\": {\"rod_diameter\": {\"deviation\": \"0.1 mm\"}}}'";

struct Command {
  std::string line, table;
  int exit_code = 0, kills = 6;
};

/// Between the objective and a limit, and between two responses, with points in the gaps, and of
/// sizes from lists: searches with other objectives, which must not take each other's evaluations
/// from the record.
const std::vector<Command> fronts = {
    {"pareto $crank $quick --set /pareto/points=4", "pareto.csv"},
    // 4: the stiffest rod is too stubby to be verified.
    {"pareto $crank $quick --set "
     R"('/pareto={"responses": ["crank_and_rod", "rod_bow"], "points": 4}')",
     "pareto.csv", 4},
    {"pareto $crank $quick --gap 40%", "pareto.csv"},
    {"pareto $crank $quick "
     R"(--set '/variables/crank_diameter={"choices": ["24 mm", "26 mm", "28 mm"]}' )"
     R"(--set '/variables/rod_diameter={"choices": ["12 mm", "15 mm", "18 mm"]}')",
     "pareto.csv"}};

TEST_F(Resumed, CommandsEndAsIfTheyHadNotBeenKilled) {
  std::vector<Command> commands = {{"optimize $crank $quick --starts 3 --jobs 2", "history.csv"},
                                   {samples, "uncertainty.csv"}};
  for (const Command& front : fronts) {
    commands.push_back(front);
    commands.back().line += " --jobs 2";
  }
  for (int i = 0; i < 4; ++i) commands.push_back({"optimize $crank $quick", "history.csv", 0, 3});
  unsigned seed = 0;
  for (const auto& [line, table, exit_code, kills] : commands) {
    SCOPED_TRACE(line);
    const std::string whole = fmt::format("whole{}", ++seed),
                      killed = fmt::format("killed{}", seed);
    run(line + " -o " + whole, exit_code);
    kill_and_end(line, killed, kills, seed, exit_code);
    expect_same(killed, whole, table);
    if (line != samples) continue;
    EXPECT_EQ(count_evaluations(folder_ / whole), 40);
  }
}

/// Times are measured: only those of parts that were kept come back. Values and errors are the
/// same.
TEST_F(Resumed, AccuracyStudyEndsAsIfItHadNotBeenKilled) {
  const std::string line =
      "accuracy $crank $quick --set '/accuracy/steps=[4e-4, 2e-4]' "
      "--set '/accuracy/elements=[2, 4]'";
  run(line + " -o whole");
  kill_and_end(line, "killed", 6, 5);
  const json whole = result("whole"), killed = result("killed");
  EXPECT_EQ(at(killed, "reference/values"), at(whole, "reference/values"));
  EXPECT_EQ(at(killed, "reference/errors"), at(whole, "reference/errors"));
  ASSERT_EQ(killed.at("runs").size(), 4u);
  for (const std::string path : {"runs/0/", "runs/1/", "runs/2/", "runs/3/"}) {
    EXPECT_EQ(at(killed, path + "errors"), at(whole, path + "errors"));
    EXPECT_EQ(at(killed, path + "gradient_errors"), at(whole, path + "gradient_errors"));
  }
}

/// All parts are known then, with their times.
TEST_F(Resumed, RunThatHadEndedEvaluatesAndMeasuresNothing) {
  const std::string study =
      "accuracy $crank $quick --set '/accuracy/steps=[4e-4]' --set '/accuracy/elements=[2]' "
      "-o study";
  run(study);
  const std::string before = folder_.text("study/result.json");
  EXPECT_THAT(run(study + " --resume").out,
              HasSubstr("parts of the study were known from study/run.sqlite"));
  EXPECT_EQ(folder_.text("study/result.json"), before);
  const std::string search = "optimize $crank $quick -o run";
  run(search);
  const int evaluations = count_evaluations(folder_ / "run");
  EXPECT_THAT(run(search + " --resume").out,
              HasSubstr("evaluations were known from run/run.sqlite"));
  EXPECT_EQ(count_evaluations(folder_ / "run"), evaluations);
}

TEST_F(Resumed, InterruptedRunSaysHow) {
  const ProgramRun ended =
      run("optimize $crank --starts 4 --jobs 2 >out & p=$!; " +
          wait_until("[ $(cat runs/*/history.csv 2>/dev/null | wc -l) -ge 4 ]") +
          "c=$(cat /proc/$p/task/$p/children); kill -TERM $p; wait $p; echo $?; "
          "for q in $c; do [ ! -e /proc/$q ] || echo left $q; done");
  EXPECT_EQ(ended.out, "4\n");  // and no process is left
  EXPECT_THAT(unwrapped(folder_.text("out")),
              AllOf(HasSubstr("To go on from there: "),
                    HasSubstr("--jobs 2 -o runs/slider_crank_round-optimize --resume")));
}

/// An optimization that has ended, in the folder "run".
class Ended : public Resumed {
 protected:
  Ended() { run(line_); }

  const std::string line_ = "optimize $crank $quick -o run";
};

TEST_F(Ended, RunOfAnotherProblemIsRefused) {
  const std::string before = folder_.text("run/result.json");
  EXPECT_THAT(refusal(line_ + " --resume --set /simulation/spectral_radius=0.7"),
              AllOf(HasSubstr("--resume: run holds a run with another problem: "
                              "/simulation/spectral_radius is "),
                    HasSubstr(" there and 0.7 here")));
  refusal(line_ + " --resume --set rod_diameter=15mm");
  EXPECT_THAT(refusal(line_ + " --resume --starts 2"), HasSubstr("/starts is 1 there and 2 here"));
  EXPECT_EQ(folder_.text("run/result.json"), before);
}

TEST_F(Ended, RunWithoutItsRecordIsKept) {
  const std::string before = folder_.text("run/result.json");
  folder_.write("run/run.sqlite", std::string(9000, 'x'));
  EXPECT_THAT(refusal(line_ + " --resume"), HasSubstr("--resume: run/run.sqlite: "));
  run("--version; rm run/run.sqlite*");
  EXPECT_THAT(refusal(line_ + " --resume"), HasSubstr("there is nothing to resume"));
  EXPECT_EQ(folder_.text("run/result.json"), before);
}

/// A record that cannot be written ends no run; the exit code tells.
TEST_F(Ended, RecordThatCannotBeWrittenIsNamed) {
  fs::remove(folder_ / "run/run.sqlite");
  fs::create_directories(folder_ / "run/run.sqlite/not_a_file");
  const ProgramRun again = run(line_ + " --overwrite", 1);
  EXPECT_THAT(again.out, HasSubstr("VERIFIED"));
  EXPECT_THAT(again.err, HasSubstr("run.sqlite"));
}

/// What a file says is part of the problem.
TEST_F(Resumed, RunWithAnotherCatalogueIsRefused) {
  const std::string line = "optimize $crank $quick -o run --set /scene/catalogue=" +
                           (folder_ / "sections.json").string();
  const auto write = [&](const std::string& diameter) {
    folder_.write("sections.json",
                  R"({"sections": {"round": {"type": "circle", "diameter": )" + diameter + "}}}");
  };
  write("0.01");
  run(line);
  run(line + " --resume");
  write("0.02");
  EXPECT_THAT(refusal(line + " --resume"), HasSubstr("another file that the problem names"));
}

/// Problems whose keys stand in another order are told as such.
TEST_F(Resumed, RunWithKeysInAnotherOrderIsRefusedWithThatReason) {
  auto document = nlohmann::ordered_json::parse(read_file(problem("slider_crank_round")));
  folder_.write("problem.json", document);
  const std::string line = "optimize problem.json $quick -o run";
  run(line);
  const auto variables = document.at("variables");
  document["variables"] = nlohmann::ordered_json::object();
  for (const char* name : {"rod_diameter", "crank_diameter"}) {
    document["variables"][name] = variables.at(name);
  }
  ASSERT_NE(document.at("variables").dump(), variables.dump());
  folder_.write("problem.json", document);
  EXPECT_THAT(refusal(line + " --resume"),
              HasSubstr("the keys of /variables stand in another order"));
}

TEST_F(Resumed, NothingBeginsAnew) {
  EXPECT_THAT(run("optimize $crank $quick -o run --resume").err,
              HasSubstr("run has no run.sqlite: there is nothing to resume"));
  refusal("optimize $crank $quick -o run --resume --overwrite");
}

using Jobs = ComparedRuns;

TEST_F(Jobs, DoNotChangeTheAnswer) {
  std::vector<Command> commands = fronts;
  commands.push_back({"optimize $crank $quick --starts 3", "history.csv"});
  for (const Command& command : commands) {
    SCOPED_TRACE(command.line);
    for (const int jobs : {1, 2, 3}) {
      const ProgramRun ended =
          run(fmt::format("{} --jobs {} -o with{} --overwrite", command.line, jobs, jobs),
              command.exit_code);
      if (command.table != "pareto.csv") continue;
      EXPECT_THAT(ended.out, HasSubstr(" points verified"));
    }
    for (const char* name : {"with1", "with2", "with3"}) expect_same(name, "with1", command.table);
    for (const char* name : {"with1", "with2", "with3"}) fs::remove_all(folder_ / name);
  }
}

/// The search that is killed is tried once more, and is heard once.
TEST_F(Jobs, MayLoseAProcess) {
  const std::string line = "optimize $crank $quick --starts 3 --jobs 2 -o ";
  run(line + "whole");
  EXPECT_EQ(run(line + "hurt >out & p=$!; " +
                wait_until("[ $(cat hurt/history.csv 2>/dev/null | wc -l) -ge 3 ]") +
                "kill -9 $(cut -d' ' -f1 /proc/$p/task/$p/children) && echo killed; "
                "wait $p; echo $?")
                .out,
            "killed\n0\n");
  expect_same("hurt", "whole", "history.csv");
}

TEST_F(Jobs, AreTakenFromTheEnvironment) {
  EXPECT_THAT(refusal("--version; PLEUEL_JOBS=none $pleuel uncertainty $crank"),
              HasSubstr("PLEUEL_JOBS must be a whole number from 1 to 1024, got \"none\""));
}

// What goes wrong around a run must not cost its result, nor that of another one.

const std::string optimization = "optimize $crank $quick -o run";

class LostResult : public InProgramFolder {
 protected:
  /// No file may be longer than so many blocks of the shell; what it says is in `out`.
  std::string run_limited(const std::string& blocks, const std::string& line) const {
    // The shell that sets the limit writes no files itself; its streams are pipes.
    const std::string out = run("--version >/dev/null; (ulimit -f " + blocks + "; $pleuel " + line +
                                " 2>&1; echo $?) | cat")
                                .out;
    EXPECT_THAT(out, EndsWith("\n1\n"));
    return out;
  }
  /// What stands in a document, if it is whole.
  json value(const std::string& file, const std::string& key) const {
    return json::parse(folder_.text(file), nullptr, /*allow_exceptions=*/false).value(key, json());
  }
};

/// 8 kB a file hold the result but not the trajectories, as a disk that fills up.
TEST_F(LostResult, OfAFullDiskIsNotTheVerdict) {
  EXPECT_THAT(
      run_limited("16", optimization),
      AllOf(HasSubstr("VERIFIED: "), HasSubstr("run/trajectory-start.csv cannot be written: "),
            HasSubstr("run/trajectory-optimum.csv")));
  EXPECT_EQ(value("run/result.json", "status"), "verified");
  // What is there is whole lines.
  EXPECT_THAT(folder_.text("run/trajectory-start.csv"), EndsWith("\n"));
}

TEST_F(LostResult, OfADiskWithoutAnyRoomIsTheFilesOnly) {
  EXPECT_THAT(run_limited("0", optimization),
              AllOf(HasSubstr("VERIFIED: "), HasSubstr("run/result.json cannot be written: ")));
}

/// 250 kB hold the record of the first evaluations, but not of all.
TEST_F(LostResult, OfADiskThatFillsUpEndsTheRunAndTheRecordGoesOn) {
  const std::string line = "optimize $crank $quick --no-report -o ";
  run(line + "whole");
  EXPECT_THAT(run_limited("500", line + "run"),
              AllOf(HasSubstr("INTERRUPTED: "), HasSubstr("the best design among them"),
                    ContainsRegex("rod_diameter +[0-9.]+ +[0-9.]+"),
                    HasSubstr("run/run.sqlite cannot be written: "), HasSubstr("the run stops"),
                    HasSubstr("--resume")));
  EXPECT_THAT(run(line + "run --resume").out,
              ContainsRegex("[1-9][0-9]* of [0-9]+ evaluations were known"));
  EXPECT_EQ(result("run").at("objective"), result("whole").at("objective"));
  EXPECT_EQ(result("run").at("variables"), result("whole").at("variables"));
}

TEST_F(LostResult, OfClosedStreamsIsWhatTheyWouldHaveShown) {
  EXPECT_EQ(run(optimization + " >&- 2>&- <&-; echo $?").out, "0\n");
  const CsvRows history = folder_.csv("run/history.csv");
  for (const auto& row : history) EXPECT_GE(row.size() + 1, history.front().size());
  EXPECT_EQ(history.size() - 1, value("run/result.json", "evaluations"));
}

TEST_F(LostResult, OfAFullStandardErrorIsNothingElse) {
  EXPECT_THAT(run("stability $crank $quick -o run 2>/dev/full; echo $?").out,
              StartsWith("  case  "));
  EXPECT_EQ(run("simulate nothing.json 2>/dev/full; echo $?").out, "2\n");
}

TEST_F(LostResult, OfAPipeThatNobodyReadsOrAFullStandardOutputIsNotTheRun) {
  run(optimization + " | true");
  EXPECT_EQ(value("run/run_card.json", "finished"), true);
  const ProgramRun full = run(optimization + " --overwrite >/dev/full; echo $?");
  EXPECT_EQ(full.out, "1\n");
  EXPECT_THAT(full.err, HasSubstr("standard output cannot be written"));
  EXPECT_EQ(value("run/run_card.json", "finished"), true);
  EXPECT_EQ(run("backends --json >/dev/full; echo $?").out, "1\n");
}

/// A pipe without a writer would be waited for.
TEST_F(LostResult, OfAPipeInPlaceOfAFileIsRefused) {
  ASSERT_EQ(mkfifo((folder_ / "pipe.json").c_str(), 0600), 0);
  for (const char* line :
       {"simulate pipe.json", "simulate $crank --design pipe.json", "simulate $crank -o pipe.json",
        "invariants $crank --body rod -o pipe.json"}) {
    EXPECT_THAT(refusal(line), HasSubstr("pipe.json: is "));
  }
}

/// The one is interrupted as soon as the other one has been refused.
TEST_F(LostResult, OfTwoRunsInOneFolderIsNone) {
  const ProgramRun ended =
      run("optimize $crank -o run >/dev/null & p=$!; " + wait_until("[ -f run/history.csv ]") +
          "$pleuel optimize $crank -o run --overwrite; echo $?; "
          "kill -TERM $p; wait $p; echo $?");
  EXPECT_EQ(ended.out, "2\n4\n");
  EXPECT_THAT(ended.err, HasSubstr("run: another run is at work"));
  EXPECT_EQ(value("run/result.json", "status"), "interrupted");
}

TEST_F(LostResult, OfABodyThatIsCalledResultIsNot) {
  for (const std::string name : {"result", "run_card", "../up", "="}) {
    SCOPED_TRACE(name);
    std::string text = read_problem("slider_crank").dump();
    for (std::size_t at = 0; (at = text.find("\"rod\"", at)) != std::string::npos;) {
      text.replace(at, 5, json(name).dump());
    }
    folder_.write("renamed.json", text);
    run("invariants renamed.json -o run --overwrite");
    EXPECT_EQ(value("run/run_card.json", "finished"), true);
    const json bodies = value("run/result.json", "bodies");
    ASSERT_EQ(bodies.size(), 2u);
    for (const json& body : bodies) {
      const std::string file = body.at("file");
      EXPECT_EQ(fs::path(file).parent_path(), "run/bodies");
      EXPECT_EQ(value(file, "format"), "pleuel-invariants");
    }
  }
}

/// Neither a result nor its draft goes where a link points.
TEST_F(LostResult, OfAnotherFileIsNotBehindALink) {
  run(optimization);
  folder_.write("precious", "mine\n");
  for (const std::string name : {"run/result.json", "run/history.csv", "run/run_card.json.draft"}) {
    fs::remove(folder_ / name);
    fs::create_symlink(folder_ / "precious", folder_ / name);
  }
  run(optimization + " --overwrite");
  EXPECT_EQ(folder_.text("precious"), "mine\n");
}

TEST_F(LostResult, OfAFileOfInvariantsIsReplacedOnlyIfAskedFor) {
  const std::string line = "invariants $problems/slider_crank.json --body rod -o rod.json";
  run(line);
  EXPECT_THAT(refusal(line), AllOf(HasSubstr("-o rod.json: "), HasSubstr("--overwrite")));
  run(line + " --overwrite");
}

// Records that are damaged, or of another build, give no other numbers.

class DamagedRecord : public ComparedRuns {
 protected:
  DamagedRecord() {
    run(line_ + "whole");
    fs::copy(folder_ / "whole", folder_ / "run", fs::copy_options::recursive);
  }

  fs::path file() const { return folder_ / "run/run.sqlite"; }

  const std::string line_ = "optimize $crank $quick --no-report -o ";
};

/// With checksums that are right: the evaluations that the verdict rests on are made again.
TEST_F(DamagedRecord, OfOtherNumbersIsNotVerified) {
  std::vector<NumberedEvaluation> all;
  RunDatabase(file()).read_evaluations([&](const NumberedEvaluation& one) { all.push_back(one); });
  Database(file()).execute("DELETE FROM evaluations");
  for (NumberedEvaluation& one : all) {
    one.stored.evaluation.objective *= 0.9;
    RunDatabase(file()).keep(one.key, one.stored);
  }
  EXPECT_THAT(refusal(line_ + "run --resume"),
              AllOf(HasSubstr("run/run.sqlite: row "),
                    HasSubstr("of the table evaluations is not what this program computes"),
                    HasSubstr("--overwrite begins anew")));
}

TEST_F(DamagedRecord, OfAnotherBuildOrWithoutWhatIsSaidOfTheRunIsRefused) {
  RunDatabase(file()).describe("program", R"("fnv1a64:0")");
  EXPECT_THAT(refusal(line_ + "run --resume"),
              AllOf(HasSubstr("run holds a run with another build of Pleuel"),
                    HasSubstr("--overwrite begins anew")));
  Database(file()).execute("DELETE FROM run");
  EXPECT_THAT(refusal(line_ + "run --resume"),
              HasSubstr("run/run.sqlite: the table run has no row command"));
}

TEST_F(DamagedRecord, WithChangedNumbersIsNotExported) {
  Database(file()).execute("UPDATE evaluations SET constraints = zeroblob(7) WHERE id = 2");
  EXPECT_THAT(refusal("export run"), HasSubstr("run/run.sqlite: row 2 of the table evaluations"));
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
    folder_.write("run/run.sqlite", damaged);
    const ProgramRun resumed = run_line(folder_.path(), line_ + "run --resume");
    if (resumed.exit_code == 0) {
      EXPECT_EQ(timeless_result("run"), timeless_result("whole")) << place;
      continue;
    }
    ++refused;
    EXPECT_EQ(resumed.exit_code, 2) << place << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("run/run.sqlite: ")) << place;
    fs::copy(folder_ / "whole", folder_ / "run",
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  EXPECT_GT(refused, 5);
}

}  // namespace
}  // namespace pleuel::test::resume_test
