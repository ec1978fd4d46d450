#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/cli/readback.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::run_folder_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

ProgramRun simulate_into(const ProgramFolder& folder, const std::string& name) {
  return folder.run_quick({"simulate", problem("slider_crank_round"), "-o", name});
}

using RunFolder = InProgramFolder;

TEST_F(RunFolder, OfAnOptimizationHoldsItsEvidence) {
  const ProgramRun run = folder_.run_quick({"optimize", problem("slider_crank_round"), "--json"});
  const fs::path run_folder = folder_.path() / "runs/slider_crank_round-optimize";
  ASSERT_TRUE(fs::exists(run_folder)) << run.err;
  EXPECT_THAT(
      files(run_folder),
      UnorderedElementsAre("history.csv", "result.json", "run_card.json", "trajectory-start.csv",
                           "trajectory-optimum.csv", "run.sqlite", "report.html"));
  EXPECT_EQ(read_file(run_folder / "result.json"), run.out);
  const auto history = read_csv(run_folder / "history.csv");
  EXPECT_EQ(history.size(), 1 + run.document().at("evaluations").get<std::size_t>());
}

TEST_F(RunFolder, CardTellsInputAndVersions) {
  ASSERT_EQ(simulate_into(folder_, "one").exit_code, 0);
  const auto card = read_json(folder_.path() / "one/run_card.json");
  EXPECT_EQ(card.at("finished"), true);
  EXPECT_EQ(card.at("problem").at("simulation").at("step"), "0.2 ms");  // the override
  EXPECT_FALSE(card.at("versions").at("eigen").get<std::string>().empty());
  EXPECT_GT(card.at("seconds").at("total"), 0.0);
}

/// A run that was killed while it wrote its first file leaves a draft, which is nobody else's.
TEST_F(RunFolder, MayHoldADraftOfItsCard) {
  fs::create_directory(folder_.path() / "one");
  std::ofstream(folder_.path() / "one/run_card.json.123.draft") << "{";
  const ProgramRun run = exits(0, simulate_into(folder_, "one"));
  std::ofstream(folder_.path() / "other.draft") << "{";
  EXPECT_EQ(simulate_into(folder_, ".").exit_code, 2);
}

TEST_F(RunFolder, HashTellsInputsApart) {
  simulate_into(folder_, "one");
  simulate_into(folder_, "same");
  folder_.run_quick({"simulate", problem("slider_crank_round"), "-o", "other", "--set",
                     "/simulation/spectral_radius=0.7"});
  const auto hash = [&](const std::string& name) {
    return read_json(folder_.path() / name / "run_card.json").at("input").at("hash");
  };
  EXPECT_EQ(hash("one"), hash("same"));
  EXPECT_NE(hash("one"), hash("other"));
}

TEST_F(RunFolder, ResultSaysHowWellConstraintsAndEnergyAreKept) {
  const ProgramRun run = simulate_into(folder_, "one");
  EXPECT_THAT(run.out, HasSubstr("Energy is balanced to "));
  const auto monitors = folder_.result("one").at("monitors");
  EXPECT_LE(monitors.at("position_drift"), 1e-10);  // Newton's tolerance
  EXPECT_GT(monitors.at("velocity_drift"), 0.0);
  EXPECT_LE(monitors.at("energy_error"), 1e-2);  // steps of 0.2 ms, eight times those of the file
}

/// Rubber at 30 rad/s: numbers come out, and mean nothing.
TEST_F(RunFolder, ResultSaysWhereLinearElasticityIsLeft) {
  const ProgramRun run = folder_.run({"simulate", problem("hard/soft_rod"), "-o", "soft", "--set",
                                      "/scene/joints/bearing/drive/speed=30 rad/s"});
  EXPECT_THAT(unwrapped(run.out), HasSubstr("too far for linear elasticity"));
  EXPECT_THAT(simulate_into(folder_, "one").out, Not(HasSubstr("linear elasticity")));
}

TEST_F(RunFolder, TrajectoryHasALineAnInstantAndAColumnAResponse) {
  ASSERT_EQ(simulate_into(folder_, "one").exit_code, 0);
  const auto rows = read_csv(folder_.path() / "one/trajectory.csv");
  ASSERT_EQ(rows.size(), 1u + 101u);  // 20 ms in steps of 0.2 ms, and the start
  EXPECT_EQ(rows.front().front(), "time");
  EXPECT_EQ(rows.front().size(), 1u + 2 * 7u);  // all responses of the file but the mass, and bands
  EXPECT_NEAR(std::stod(rows.back().front()), 0.02, 1e-15);
}

TEST_F(RunFolder, OfAnOlderRunIsReplacedOnlyIfAskedFor) {
  ASSERT_EQ(simulate_into(folder_, "one").exit_code, 0);
  std::ofstream(folder_.path() / "one/history.csv") << "old\n";
  const ProgramRun refused = exits(2, simulate_into(folder_, "one"));
  EXPECT_THAT(refused.err, AllOf(HasSubstr("-o one: "), HasSubstr("--overwrite")));
  EXPECT_TRUE(fs::exists(folder_.path() / "one/history.csv"));
  ASSERT_EQ(
      folder_.run_quick({"simulate", problem("slider_crank_round"), "-o", "one", "--overwrite"})
          .exit_code,
      0);
  EXPECT_FALSE(fs::exists(folder_.path() / "one/history.csv"));
}

/// Neither the overrides nor the folder of the file are in its name.
TEST_F(RunFolder, WithoutANameIsAnotherOneEachTime) {
  const std::vector<std::string> words =
      joined({"simulate", problem("slider_crank_round")}, quick());
  for (const std::string name : {"", "-2", "-3"}) {
    const ProgramRun run = folder_.run(words);
    EXPECT_THAT(run.out, HasSubstr("Written to runs/slider_crank_round-simulate" + name + ":"));
    EXPECT_TRUE(
        fs::exists(folder_.path() / ("runs/slider_crank_round-simulate" + name) / "result.json"));
  }
}

TEST_F(RunFolder, OfASimulationThatFailsIsNotLeftBehind) {
  const ProgramRun run =
      exits(3, folder_.run_quick({"simulate", problem("slider_crank_round"), "--set",
                                  "/simulation/max_newton_iterations=1"}));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

/// Errors that are found while reading, at the first evaluation, and by the backend.
TEST_F(RunFolder, OfAnOlderRunOutlivesBadInput) {
  const std::vector<std::string> good =
      joined({"optimize", problem("slider_crank_round"), "-o", "one", "--overwrite"}, quick());
  ASSERT_EQ(folder_.run(good).exit_code, 0);
  const std::vector<std::string> before = files(folder_.path() / "one");
  const std::string result = read_file(folder_.path() / "one/result.json");
  for (
      const std::string bad :
      {"/simulation/step=-1 s", "/responses/crank_stress/from=19.99 ms",
       R"(/constraints/crank_strength={"response": "crank_stress", "lower": 1e8, "upper": 1e8})"}) {
    const ProgramRun run = folder_.run(joined(good, {"--set", bad}));
    EXPECT_EQ(run.exit_code, 2) << bad << run.err;
    EXPECT_THAT(files(folder_.path() / "one"), ::testing::UnorderedElementsAreArray(before)) << bad;
    EXPECT_EQ(read_file(folder_.path() / "one/result.json"), result) << bad;
  }
}

TEST_F(RunFolder, OfAnotherCommandIsNotTouched) {
  ASSERT_EQ(simulate_into(folder_, "one").exit_code, 0);
  const ProgramRun run =
      exits(2, folder_.run_quick({"optimize", problem("slider_crank_round"), "-o", "one"}));
  EXPECT_THAT(run.err, HasSubstr("-o one: holds a run of `pleuel simulate`"));
  EXPECT_TRUE(fs::exists(folder_.path() / "one/trajectory.csv"));
}

using Optimize = InProgramFolder;

TEST_F(Optimize, ThatIsInterruptedKeepsItsBestDesignToGoOnFrom) {
  const std::string path = folder_.path().string();
  const std::string line = fmt::format(
      "optimize {0} -o {1}/one >{1}/log & p=$!; i=0; "
      "while [ ! -f {1}/one/history.csv ] && [ $i -lt 3000 ]; "
      "do sleep 0.01; i=$((i + 1)); done; kill -TERM $p; wait $p; echo $?",
      problem("slider_crank_round"), path);
  EXPECT_EQ(folder_.run_line(line).out, "4\n");
  const fs::path result = folder_.path() / "one/result.json";
  const auto document = read_json(result);
  EXPECT_EQ(document.at("status"), "interrupted");
  EXPECT_EQ(read_json(folder_.path() / "one/run_card.json").at("finished"), true);
  EXPECT_THAT(read_file(folder_.path() / "log"),
              AllOf(HasSubstr("To go on from there: "), HasSubstr("/one --resume")));
  const ProgramRun next =
      folder_.run_quick({"optimize", problem("slider_crank_round"), "-o", "two", "--design",
                         "one/result.json", "--set", "/optimizer/max_iterations=1"});
  const auto history = read_csv(folder_.path() / "two/history.csv");
  ASSERT_EQ(document.at("variables").size(), 2u);
  for (const auto& [name, variable] : document.at("variables").items()) {
    const auto column =
        std::find(history.front().begin(), history.front().end(), "variable:" + name);
    ASSERT_NE(column, history.front().end());
    EXPECT_EQ(std::stod(history.at(1).at(std::size_t(column - history.front().begin()))),
              variable.at("value").get<double>());
  }
}

using Simulate = InProgramFolder;

TEST_F(Simulate, WarnsOfStepsThatAreTooLong) {
  const auto warnings = [&](const std::string& step) {
    return folder_
        .run({"simulate", problem("four_bar"), "--json", "--set", "/simulation/step=" + step})
        .document()
        .at("warnings")
        .dump();
  };
  EXPECT_THAT(warnings("20 ms"), HasSubstr("energy is balanced to"));
  EXPECT_EQ(warnings("0.5 ms"), "[]");
}

TEST_F(Simulate, SaysThatAssemblyMovesTheMechanism) {
  EXPECT_THAT(folder_.run({"simulate", problem("hard/inconsistent_start")}).out,
              HasSubstr("from where the file places it"));
  EXPECT_THAT(simulate_into(folder_, "one").out, Not(HasSubstr("from where the file places it")));
}

TEST(Output, ThatCannotBeWrittenIsAnError) {
  const ProgramFolder folder;
  EXPECT_EQ(folder.run_line("backends --json >/dev/full; echo $?").out, "1\n");
}

TEST_F(RunFolder, WithOtherPeoplesFilesIsNotTouched) {
  fs::create_directory(folder_.path() / "thesis");
  std::ofstream(folder_.path() / "thesis/result.json") << "precious\n";
  EXPECT_THAT(exits(2, simulate_into(folder_, "thesis")).err, HasSubstr("thesis"));
  EXPECT_EQ(read_file(folder_.path() / "thesis/result.json"), "precious\n");
}

// What is told of runs that have ended, and of those that have not.

class OlderRuns : public testing::Test {
 protected:
  ProgramRun optimize(const std::string& name, const std::vector<std::string>& more = {}) const {
    return folder_.run(joined(
        joined({"optimize", problem("slider_crank_round"), "-o", "runs/" + name}, quick()), more));
  }
  const ProgramFolder folder_;
};

TEST_F(OlderRuns, AreListedWithTheirStatusAndObjective) {
  ASSERT_EQ(optimize("one").exit_code, 0);
  folder_.run_quick({"simulate", problem("slider_crank_round"), "-o", "runs/two"});
  fs::create_directories(folder_.path() / "runs/foreign");
  EXPECT_THAT(unwrapped(exits(0, folder_.run({"runs"})).out), HasSubstr("one optimize"));
  const nlohmann::json runs = folder_.run({"runs", "runs", "--json"}).document();
  ASSERT_EQ(runs.at("runs").size(), 2u);
  const nlohmann::json result = read_json(folder_.path() / "runs/one/result.json");
  EXPECT_EQ(runs["runs"][0].at("status"), "verified");
  EXPECT_EQ(runs["runs"][0].at("objective").at("value"), result.at("objective").at("value"));
  EXPECT_EQ(runs["runs"][1].at("command"), "simulate");
  EXPECT_FALSE(runs["runs"][1].contains("objective"));
  EXPECT_EQ(folder_.run({"runs", "nowhere"}).exit_code, 2);
}

/// The newest is the last, or they are in the order of their names.
TEST_F(OlderRuns, AreListedByTimeOrByName) {
  EXPECT_THAT(exits(0, folder_.run({"runs"})).out, HasSubstr("No runs yet"));
  for (const char* name : {"b", "a"}) {
    folder_.run_quick({"simulate", problem("slider_crank_round"), "--no-report", "-o",
                       std::string("runs/") + name});
  }
  const auto first = [&](const std::vector<std::string>& words) {
    const auto runs = folder_.run(joined({"runs", "--json"}, words)).document();
    return runs.at("runs").at(0).at("folder").get<std::string>();
  };
  EXPECT_EQ(first({}), "runs/b");
  EXPECT_EQ(first({"--sort", "name"}), "runs/a");
}

TEST_F(OlderRuns, ThatWereKilledAreToldFromThoseAtWork) {
  const ProgramRun run = folder_.run_line(
      fmt::format("optimize {0} -o runs/one >out 2>&1 & p=$!; i=0; "
                  "while [ ! -s runs/one/history.csv ] && [ $i -lt 3000 ]; do sleep 0.01; "
                  "i=$((i + 1)); done; {1} runs --json >at_work; kill -9 $p; wait $p; {1} runs "
                  "--json >killed",
                  problem("slider_crank_round"), PLEUEL_PROGRAM));
  const auto status = [&](const char* file) {
    return read_json(folder_.path() / file).at("runs").at(0).at("status");
  };
  EXPECT_EQ(status("at_work"), "running");
  EXPECT_EQ(status("killed"), "killed");
}

/// The mass goes with the density: its deviation, too.
TEST_F(OlderRuns, AreComparedInTheirDeviations) {
  for (const char* deviation : {"50", "100"}) {
    const ProgramRun run = exits(
        0,
        folder_.run_quick(
            {"uncertainty", problem("slider_crank_round"), "-o", std::string("runs/") + deviation,
             "--set", R"(/scene/materials/steel/density={"variable": "density"})", "--set",
             R"(/variables/density={"start": 7850, "lower": 7850, "upper": 7850})", "--set",
             fmt::format(R"(/uncertainty={{"parameters": {{"density": {{"deviation": {}}}}}}})",
                         deviation)}));
  }
  const nlohmann::json document =
      folder_.run({"compare", "runs/50", "runs/100", "--json"}).document();
  const auto& values = document.at("outcome");
  const auto found = std::find_if(values.begin(), values.end(), [](const auto& value) {
    return value.at("name") == "crank_and_rod" && value.value("of", "") == "deviation";
  });
  ASSERT_NE(found, values.end());
  EXPECT_NEAR(found->at("second").get<double>(), 2.0 * found->at("first").get<double>(), 1e-12);
}

TEST_F(OlderRuns, AreComparedInInputAndOutcome) {
  ASSERT_EQ(optimize("one").exit_code, 0);
  ASSERT_EQ(optimize("two", {"--set", "/simulation/spectral_radius=0.7"}).exit_code, 0);
  const ProgramRun same = folder_.run({"compare", "runs/one", "runs/one"});
  EXPECT_THAT(same.out, HasSubstr("The inputs are the same."));
  const ProgramRun text = folder_.run({"compare", "runs/one", "runs/two"});
  EXPECT_THAT(unwrapped(text.out), HasSubstr("/simulation/spectral_radius"));
  // In the units of the file, to six digits; residuals as they are, without a change of theirs.
  const TextTable table(text.out, "outcome");
  const auto row_of = [&](const std::string& name) {
    std::size_t row = 0;
    while (row < table.rows() && table.text(row, "name") != name) ++row;
    return row;
  };
  const nlohmann::json first = read_json(folder_.path() / "runs/one/result.json");
  const std::size_t rod = row_of("rod_diameter"), residual = row_of("kkt_residual");
  ASSERT_LT(rod, table.rows());
  ASSERT_LT(residual, table.rows());
  EXPECT_EQ(table.text(rod, "unit"), "mm");
  EXPECT_NEAR(table.number(rod, "first"),
              1e3 * first.at("variables").at("rod_diameter").at("value").get<double>(), 1e-3);
  EXPECT_EQ(table.text(residual, "change"), "");
  EXPECT_EQ(text.out.find("+0.0 %"), std::string::npos);
  EXPECT_EQ(text.out.find("−0.0 %"), std::string::npos);
  const nlohmann::json document =
      folder_.run({"compare", "runs/one", "runs/two", "--json"}).document();
  ASSERT_EQ(document.at("input").size(), 1u);
  EXPECT_EQ(document["input"][0].at("place"), "/simulation/spectral_radius");
  EXPECT_EQ(document["input"][0].at("second"), 0.7);
  const auto& values = document.at("outcome");
  const auto found = std::find_if(values.begin(), values.end(), [](const auto& value) {
    return value.at("group") == "variables" && value.at("name") == "rod_diameter";
  });
  ASSERT_NE(found, values.end());
  const nlohmann::json result = read_json(folder_.path() / "runs/two/result.json");
  EXPECT_EQ(found->at("second"), result.at("variables").at("rod_diameter").at("value"));
  EXPECT_EQ(folder_.run({"compare", "runs/one", "runs"}).exit_code, 2);
  EXPECT_EQ(folder_.run({"compare", "runs/one"}).exit_code, 2);
  std::ofstream(folder_.path() / "mine.json") << "mine";
  const ProgramRun refused = folder_.run({"compare", "runs/one", "runs/two", "-o", "mine.json"});
  EXPECT_THAT(exits(2, refused).err, HasSubstr("mine.json: is there already"));
  EXPECT_EQ(read_file(folder_.path() / "mine.json"), "mine");
  std::ofstream(folder_.path() / "runs/two/result.json") << R"({"version": 1})";
  EXPECT_THAT(folder_.run({"compare", "runs/one", "runs/two"}).out,
              HasSubstr("runs/two/result.json: is damaged"));
  EXPECT_THAT(folder_.run({"runs"}).out, HasSubstr("damaged"));
}

/// Numbers in the tables read back as those of the record, which are those of the history.
TEST_F(OlderRuns, AreExportedAsTables) {
  ASSERT_EQ(optimize("one").exit_code, 0);
  const ProgramRun run = exits(0, folder_.run({"export", "runs/one", "--json"}));
  const CsvRows evaluations = read_csv(folder_.path() / "runs/one/evaluations.csv");
  const CsvRows history = read_csv(folder_.path() / "runs/one/history.csv");
  ASSERT_EQ(evaluations.size(), history.size());
  EXPECT_EQ(run.document().at("files").size(), 2u);
  const auto cell = [](const CsvRows& rows, std::size_t row, const std::string& title) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    return rows.at(row).at(found - rows[0].begin());
  };
  for (const char* title : {"objective", "variable:rod_diameter", "constraint:rod_strength"}) {
    ASSERT_NE(std::find(history[0].begin(), history[0].end(), title), history[0].end()) << title;
    EXPECT_EQ(cell(evaluations, 1, title), cell(history, 1, title));
  }
  const CsvRows gradients = read_csv(folder_.path() / "runs/one/evaluation_gradients.csv");
  EXPECT_EQ(gradients[0], (std::vector<std::string>{"evaluation", "of", "variable", "derivative"}));
  EXPECT_EQ(gradients[1][1], "objective");
  const ProgramRun none = exits(2, folder_.run({"export", "runs"}));
}

/// The files are read by ParaView; here their counts have to fit together.
TEST_F(OlderRuns, AreExportedAsMotion) {
  ASSERT_EQ(optimize("one").exit_code, 0);
  const ProgramRun run =
      exits(0, folder_.run({"export", "runs/one", "--vtk", "-o", "out", "--json"}));
  EXPECT_EQ(run.document().at("files").size(), 4u);
  const std::string series = read_file(folder_.path() / "out/vtk/optimum.pvd");
  EXPECT_THAT(series, HasSubstr("file=\"optimum-0000.vtu\""));
  const std::string grid = read_file(folder_.path() / "out/vtk/optimum-0001.vtu");
  const auto number_after = [&](const std::string& word) {
    return std::stoi(grid.substr(grid.find(word) + word.size()));
  };
  const auto block = [&](const std::string& name) {
    const auto begin = grid.find('\n', grid.find("Name=\"" + name + "\"")) + 1;
    std::istringstream stream(grid.substr(begin, grid.find("</DataArray>", begin) - begin));
    return std::vector<double>(std::istream_iterator<double>(stream), {});
  };
  const auto points = static_cast<std::size_t>(number_after("NumberOfPoints=\""));
  const auto cells = static_cast<std::size_t>(number_after("NumberOfCells=\""));
  EXPECT_EQ(block("stress").size(), points);
  EXPECT_EQ(block("body").size(), cells);
  ASSERT_EQ(block("offsets").size(), cells);
  const std::vector<double> connectivity = block("connectivity");
  EXPECT_EQ(connectivity.size(), block("offsets").back());
  EXPECT_EQ(*std::max_element(connectivity.begin(), connectivity.end()),
            static_cast<double>(points - 1));
}

}  // namespace
}  // namespace pleuel::test::run_folder_test
