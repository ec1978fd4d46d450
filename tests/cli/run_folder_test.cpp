#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

namespace pleuel::test::run_folder_test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<std::string> files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

ProgramRun simulate_into(const TemporaryFolder& folder, const std::string& name) {
  return run_program(folder.path(),
                     joined({"simulate", problem("slider_crank_round"), "-o", name}, quick()));
}

TEST(RunFolder, OfAnOptimizationHoldsItsEvidence) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), joined({"optimize", problem("slider_crank_round"), "--json"}, quick()));
  const fs::path run_folder = folder.path() / "runs/slider_crank_round-optimize";
  ASSERT_TRUE(fs::exists(run_folder)) << run.err;
  EXPECT_THAT(files(run_folder),
              ::testing::UnorderedElementsAre("history.csv", "result.json", "run_card.json",
                                              "trajectory-start.csv", "trajectory-optimum.csv",
                                              "run.sqlite", "report.html"));
  EXPECT_EQ(read_file(run_folder / "result.json"), run.out);
  const auto history = read_csv(run_folder / "history.csv");
  EXPECT_EQ(history.size(), 1 + run.document().at("evaluations").get<std::size_t>());
}

TEST(RunFolder, CardTellsInputAndVersions) {
  const TemporaryFolder folder;
  ASSERT_EQ(simulate_into(folder, "one").exit_code, 0);
  const auto card = nlohmann::json::parse(read_file(folder.path() / "one/run_card.json"));
  EXPECT_EQ(card.at("finished"), true);
  EXPECT_EQ(card.at("problem").at("simulation").at("step"), "0.2 ms");  // the override
  EXPECT_FALSE(card.at("versions").at("eigen").get<std::string>().empty());
  EXPECT_GT(card.at("seconds").at("total"), 0.0);
}

/// A run that was killed while it wrote its first file leaves a draft, which is nobody else's.
TEST(RunFolder, MayHoldADraftOfItsCard) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "one");
  std::ofstream(folder.path() / "one/run_card.json.123.draft") << "{";
  const ProgramRun run = simulate_into(folder, "one");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::ofstream(folder.path() / "other.draft") << "{";
  EXPECT_EQ(simulate_into(folder, ".").exit_code, 2);
}

TEST(RunFolder, HashTellsInputsApart) {
  const TemporaryFolder folder;
  simulate_into(folder, "one");
  simulate_into(folder, "same");
  run_program(folder.path(), joined({"simulate", problem("slider_crank_round"), "-o", "other",
                                     "--set", "/simulation/spectral_radius=0.7"},
                                    quick()));
  const auto hash = [&](const std::string& name) {
    return nlohmann::json::parse(read_file(folder.path() / name / "run_card.json"))
        .at("input")
        .at("hash");
  };
  EXPECT_EQ(hash("one"), hash("same"));
  EXPECT_NE(hash("one"), hash("other"));
}

TEST(RunFolder, ResultSaysHowWellConstraintsAndEnergyAreKept) {
  const TemporaryFolder folder;
  const ProgramRun run = simulate_into(folder, "one");
  EXPECT_THAT(run.out, HasSubstr("Energy is balanced to "));
  const auto monitors =
      nlohmann::json::parse(read_file(folder.path() / "one/result.json")).at("monitors");
  EXPECT_LE(monitors.at("position_drift"), 1e-10);  // Newton's tolerance
  EXPECT_GT(monitors.at("velocity_drift"), 0.0);
  EXPECT_LE(monitors.at("energy_error"), 1e-2);  // steps of 0.2 ms, eight times those of the file
}

/// Rubber at 30 rad/s: numbers come out, and mean nothing.
TEST(RunFolder, ResultSaysWhereLinearElasticityIsLeft) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"simulate", problem("hard/soft_rod"), "-o", "soft", "--set",
                                  "/scene/joints/bearing/drive/speed=30 rad/s"});
  EXPECT_THAT(unwrapped(run.out), HasSubstr("too far for linear elasticity"));
  EXPECT_THAT(simulate_into(folder, "one").out, ::testing::Not(HasSubstr("linear elasticity")));
}

TEST(RunFolder, TrajectoryHasALineAnInstantAndAColumnAResponse) {
  const TemporaryFolder folder;
  ASSERT_EQ(simulate_into(folder, "one").exit_code, 0);
  const auto rows = read_csv(folder.path() / "one/trajectory.csv");
  ASSERT_EQ(rows.size(), 1u + 101u);  // 20 ms in steps of 0.2 ms, and the start
  EXPECT_EQ(rows.front().front(), "time");
  EXPECT_EQ(rows.front().size(), 1u + 2 * 7u);  // all responses of the file but the mass, and bands
  EXPECT_NEAR(std::stod(rows.back().front()), 0.02, 1e-15);
}

TEST(RunFolder, OfAnOlderRunIsReplacedOnlyIfAskedFor) {
  const TemporaryFolder folder;
  ASSERT_EQ(simulate_into(folder, "one").exit_code, 0);
  std::ofstream(folder.path() / "one/history.csv") << "old\n";
  const ProgramRun refused = simulate_into(folder, "one");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, ::testing::AllOf(HasSubstr("-o one: "), HasSubstr("--overwrite")));
  EXPECT_TRUE(fs::exists(folder.path() / "one/history.csv"));
  ASSERT_EQ(
      run_program(
          folder.path(),
          joined({"simulate", problem("slider_crank_round"), "-o", "one", "--overwrite"}, quick()))
          .exit_code,
      0);
  EXPECT_FALSE(fs::exists(folder.path() / "one/history.csv"));
}

/// Neither the overrides nor the folder of the file are in its name.
TEST(RunFolder, WithoutANameIsAnotherOneEachTime) {
  const TemporaryFolder folder;
  const std::vector<std::string> words =
      joined({"simulate", problem("slider_crank_round")}, quick());
  for (const std::string name : {"", "-2", "-3"}) {
    const ProgramRun run = run_program(folder.path(), words);
    EXPECT_THAT(run.out, HasSubstr("Written to runs/slider_crank_round-simulate" + name + ":"));
    EXPECT_TRUE(
        fs::exists(folder.path() / ("runs/slider_crank_round-simulate" + name) / "result.json"));
  }
}

TEST(RunFolder, OfASimulationThatFailsIsNotLeftBehind) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), joined({"simulate", problem("slider_crank_round"), "--set",
                                         "/simulation/max_newton_iterations=1"},
                                        quick()));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// Errors that are found while reading, at the first evaluation, and by the backend.
TEST(RunFolder, OfAnOlderRunOutlivesBadInput) {
  const TemporaryFolder folder;
  const std::vector<std::string> good =
      joined({"optimize", problem("slider_crank_round"), "-o", "one", "--overwrite"}, quick());
  ASSERT_EQ(run_program(folder.path(), good).exit_code, 0);
  const std::vector<std::string> before = files(folder.path() / "one");
  const std::string result = read_file(folder.path() / "one/result.json");
  for (
      const std::string bad :
      {"/simulation/step=-1 s", "/responses/crank_stress/from=19.99 ms",
       R"(/constraints/crank_strength={"response": "crank_stress", "lower": 1e8, "upper": 1e8})"}) {
    const ProgramRun run = run_program(folder.path(), joined(good, {"--set", bad}));
    EXPECT_EQ(run.exit_code, 2) << bad << run.err;
    EXPECT_THAT(files(folder.path() / "one"), ::testing::UnorderedElementsAreArray(before)) << bad;
    EXPECT_EQ(read_file(folder.path() / "one/result.json"), result) << bad;
  }
}

TEST(RunFolder, OfAnotherCommandIsNotTouched) {
  const TemporaryFolder folder;
  ASSERT_EQ(simulate_into(folder, "one").exit_code, 0);
  const ProgramRun run = run_program(
      folder.path(), joined({"optimize", problem("slider_crank_round"), "-o", "one"}, quick()));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("-o one: holds a run of `pleuel simulate`"));
  EXPECT_TRUE(fs::exists(folder.path() / "one/trajectory.csv"));
}

TEST(Optimize, ThatIsInterruptedKeepsItsBestDesignToGoOnFrom) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  const std::string line = fmt::format(
      "optimize {0} -o {1}/one >{1}/log & p=$!; i=0; "
      "while [ ! -f {1}/one/history.csv ] && [ $i -lt 3000 ]; "
      "do sleep 0.01; i=$((i + 1)); done; kill -TERM $p; wait $p; echo $?",
      problem("slider_crank_round"), path);
  EXPECT_EQ(run_line(folder.path(), line).out, "4\n");
  const fs::path result = folder.path() / "one/result.json";
  const auto document = nlohmann::json::parse(read_file(result));
  EXPECT_EQ(document.at("status"), "interrupted");
  EXPECT_EQ(nlohmann::json::parse(read_file(folder.path() / "one/run_card.json")).at("finished"),
            true);
  EXPECT_THAT(read_file(folder.path() / "log"),
              AllOf(HasSubstr("To go on from there: "), HasSubstr("/one --resume")));
  const ProgramRun next = run_program(
      folder.path(), joined({"optimize", problem("slider_crank_round"), "-o", "two", "--design",
                             "one/result.json", "--set", "/optimizer/max_iterations=1"},
                            quick()));
  const auto history = read_csv(folder.path() / "two/history.csv");
  ASSERT_EQ(document.at("variables").size(), 2u);
  for (const auto& [name, variable] : document.at("variables").items()) {
    const auto column =
        std::find(history.front().begin(), history.front().end(), "variable:" + name);
    ASSERT_NE(column, history.front().end());
    EXPECT_EQ(std::stod(history.at(1).at(std::size_t(column - history.front().begin()))),
              variable.at("value").get<double>());
  }
}

TEST(Simulate, WarnsOfStepsThatAreTooLong) {
  const TemporaryFolder folder;
  const auto warnings = [&](const std::string& step) {
    return run_program(folder.path(), {"simulate", problem("four_bar"), "--json", "--set",
                                       "/simulation/step=" + step})
        .document()
        .at("warnings")
        .dump();
  };
  EXPECT_THAT(warnings("20 ms"), HasSubstr("energy is balanced to"));
  EXPECT_EQ(warnings("0.5 ms"), "[]");
}

TEST(Simulate, SaysThatAssemblyMovesTheMechanism) {
  const TemporaryFolder folder;
  EXPECT_THAT(run_program(folder.path(), {"simulate", problem("hard/inconsistent_start")}).out,
              HasSubstr("from where the file places it"));
  EXPECT_THAT(simulate_into(folder, "one").out,
              ::testing::Not(HasSubstr("from where the file places it")));
}

TEST(Output, ThatCannotBeWrittenIsAnError) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_line(folder.path(), "backends --json >/dev/full; echo $?").out, "1\n");
}

TEST(RunFolder, WithOtherPeoplesFilesIsNotTouched) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "thesis");
  std::ofstream(folder.path() / "thesis/result.json") << "precious\n";
  const ProgramRun run = simulate_into(folder, "thesis");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("thesis"));
  EXPECT_EQ(read_file(folder.path() / "thesis/result.json"), "precious\n");
}

}  // namespace
}  // namespace pleuel::test::run_folder_test
