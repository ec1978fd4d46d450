#include <iterator>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/cli/readback.hpp"

namespace pleuel::test::run_folder_test {
namespace {

namespace fs = std::filesystem;

class RunFolder : public InProgramFolder {
 protected:
  std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }
};

const std::string simulate = "simulate $crank $quick -o ";

TEST_F(RunFolder, OfAnOptimizationHoldsItsEvidence) {
  const ProgramRun ended = run("optimize $crank $quick --json");
  const std::string folder = "runs/slider_crank_round-optimize";
  EXPECT_THAT(files(folder), UnorderedElementsAre("history.csv", "result.json", "run_card.json",
                                                  "trajectory-start.csv", "trajectory-optimum.csv",
                                                  "run.sqlite", "report.html"));
  EXPECT_EQ(folder_.text(folder + "/result.json"), ended.out);
  EXPECT_EQ(folder_.csv(folder + "/history.csv").size(),
            1 + ended.document().at("evaluations").get<std::size_t>());
}

TEST_F(RunFolder, CardTellsInputsApartAndVersions) {
  for (const std::string name : {"one", "same", "other --set /simulation/spectral_radius=0.7"}) {
    run(simulate + name);
  }
  const json card = folder_.read("one/run_card.json");
  EXPECT_EQ(card.at("finished"), true);
  EXPECT_EQ(at(card, "problem/simulation/step"), "0.2 ms");  // the override
  EXPECT_FALSE(at(card, "versions/eigen").get<std::string>().empty());
  EXPECT_GT(number(card, "seconds/total"), 0.0);
  EXPECT_EQ(at(card, "input/hash"), at(folder_.read("same/run_card.json"), "input/hash"));
  EXPECT_NE(at(card, "input/hash"), at(folder_.read("other/run_card.json"), "input/hash"));
}

/// A run that was killed while it wrote its first file leaves a draft, which is nobody else's.
TEST_F(RunFolder, MayHoldADraftOfItsCard) {
  fs::create_directory(folder_ / "one");
  folder_.write("one/run_card.json.123.draft", "{");
  run(simulate + "one");
  folder_.write("other.draft", "{");
  refusal(simulate + ".");
}

TEST_F(RunFolder, SaysHowWellConstraintsAndEnergyAreKept) {
  EXPECT_THAT(unwrapped(run(simulate + "one").out),
              AllOf(HasSubstr("Energy is balanced to "), Not(HasSubstr("linear elasticity")),
                    Not(HasSubstr("from where the file places it"))));
  const json monitors = result("one").at("monitors");
  EXPECT_LE(monitors.at("position_drift"), 1e-10);  // Newton's tolerance
  EXPECT_GT(monitors.at("velocity_drift"), 0.0);
  EXPECT_LE(monitors.at("energy_error"), 1e-2);  // steps of 0.2 ms, eight times those of the file
  EXPECT_THAT(run("simulate $problems/hard/inconsistent_start.json").out,
              HasSubstr("from where the file places it"));
}

TEST_F(RunFolder, WarnsOfStepsThatAreTooLong) {
  const std::string line = "simulate $problems/four_bar.json --set /simulation/step=";
  EXPECT_THAT(document(line + "20ms").at("warnings").dump(), HasSubstr("energy is balanced to"));
  EXPECT_EQ(document(line + "0.5ms").at("warnings").dump(), "[]");
}

TEST_F(RunFolder, OfAnOlderRunIsReplacedOnlyIfAskedFor) {
  run(simulate + "one");
  folder_.write("one/history.csv", "old\n");
  EXPECT_THAT(refusal(simulate + "one"), AllOf(HasSubstr("-o one: "), HasSubstr("--overwrite")));
  EXPECT_TRUE(folder_.has("one/history.csv"));
  run(simulate + "one --overwrite");
  EXPECT_FALSE(folder_.has("one/history.csv"));
  // Nor is that of another command, or what is none.
  EXPECT_THAT(refusal("optimize $crank $quick -o one"),
              HasSubstr("-o one: holds a run of `pleuel simulate`"));
  EXPECT_TRUE(folder_.has("one/trajectory.csv"));
  fs::create_directory(folder_ / "thesis");
  folder_.write("thesis/result.json", "precious\n");
  EXPECT_THAT(refusal(simulate + "thesis"), HasSubstr("thesis"));
  EXPECT_EQ(folder_.text("thesis/result.json"), "precious\n");
}

/// Neither the overrides nor the folder of the file are in its name.
TEST_F(RunFolder, WithoutANameIsAnotherOneEachTime) {
  for (const std::string name : {"", "-2", "-3"}) {
    EXPECT_THAT(run("simulate $crank $quick").out,
                HasSubstr("Written to runs/slider_crank_round-simulate" + name + ":"));
    EXPECT_TRUE(folder_.has("runs/slider_crank_round-simulate" + name + "/result.json"));
  }
}

/// Errors that are found while reading, at the first evaluation, and by the backend.
TEST_F(RunFolder, OfAnOlderRunOutlivesBadInput) {
  const std::string good = "optimize $crank $quick -o one --overwrite";
  run(good);
  const std::vector<std::string> before = files("one");
  const std::string result = folder_.text("one/result.json");
  for (
      const std::string bad :
      {"/simulation/step=-1 s", "/responses/crank_stress/from=19.99 ms",
       R"(/constraints/crank_strength={"response": "crank_stress", "lower": 1e8, "upper": 1e8})"}) {
    refusal(good + " --set '" + bad + "'");
    EXPECT_THAT(files("one"), ::testing::UnorderedElementsAreArray(before)) << bad;
    EXPECT_EQ(folder_.text("one/result.json"), result) << bad;
  }
}

// What is told of runs that have ended, and of those that have not.

using OlderRuns = InProgramFolder;

const std::string optimize = "optimize $crank $quick -o runs/";

TEST_F(OlderRuns, AreListedWithTheirStatusAndObjectiveByTimeOrByName) {
  EXPECT_THAT(run("runs").out, HasSubstr("No runs yet"));
  run(optimize + "two");
  run("simulate $crank $quick --no-report -o runs/one");
  fs::create_directories(folder_ / "runs/foreign");
  EXPECT_THAT(unwrapped(run("runs").out), HasSubstr("two optimize"));
  const json runs = document("runs runs").at("runs");
  ASSERT_EQ(runs.size(), 2u);  // the newest is the last
  EXPECT_EQ(runs[0].at("folder"), "runs/two");
  EXPECT_EQ(runs[0].at("status"), "verified");
  EXPECT_EQ(at(runs[0], "objective/value"), at(result("runs/two"), "objective/value"));
  EXPECT_EQ(runs[1].at("command"), "simulate");
  EXPECT_FALSE(runs[1].contains("objective"));
  EXPECT_EQ(at(document("runs --sort name"), "runs/0/folder"), "runs/one");
  refusal("runs nowhere");
}

TEST_F(OlderRuns, ThatWereKilledAreToldFromThoseAtWork) {
  run("optimize $crank -o runs/one >out 2>&1 & p=$!; " + wait_until("[ -s runs/one/history.csv ]") +
      "$pleuel runs --json >at_work; kill -9 $p; wait $p; $pleuel runs --json >killed");
  EXPECT_EQ(at(folder_.read("at_work"), "runs/0/status"), "running");
  EXPECT_EQ(at(folder_.read("killed"), "runs/0/status"), "killed");
}

/// The mass goes with the density: its deviation, too.
TEST_F(OlderRuns, AreComparedInTheirDeviations) {
  for (const char* deviation : {"50", "100"}) {
    run(
        fmt::format("uncertainty $crank $quick -o runs/{0} "
                    R"(--set '/scene/materials/steel/density={{"variable": "density"}}' )"
                    R"(--set '/variables/density={{"start": 7850, "lower": 7850, "upper": 7850}}' )"
                    R"(--set '/uncertainty={{"parameters": {{"density": {{"deviation": {0}}}}}}}')",
                    deviation));
  }
  const json values = document("compare runs/50 runs/100").at("outcome");
  const auto found = std::ranges::find_if(values, [](const json& value) {
    return value.at("name") == "crank_and_rod" && value.value("of", "") == "deviation";
  });
  ASSERT_NE(found, values.end());
  EXPECT_NEAR(number(*found, "second"), 2.0 * number(*found, "first"), 1e-12);
}

TEST_F(OlderRuns, AreComparedInInputAndOutcome) {
  run(optimize + "one");
  run(optimize + "two --set /simulation/spectral_radius=0.7");
  EXPECT_THAT(run("compare runs/one runs/one").out, HasSubstr("The inputs are the same."));
  const std::string text = run("compare runs/one runs/two").out;
  EXPECT_THAT(unwrapped(text), HasSubstr("/simulation/spectral_radius"));
  // In the units of the file, to six digits; residuals as they are, without a change of theirs.
  const TextTable table(text, "outcome");
  const auto row_of = [&](const std::string& name) {
    std::size_t row = 0;
    while (row < table.rows() && table.text(row, "name") != name) ++row;
    EXPECT_LT(row, table.rows()) << name;
    return row;
  };
  EXPECT_EQ(table.text(row_of("rod_diameter"), "unit"), "mm");
  EXPECT_NEAR(table.number(row_of("rod_diameter"), "first"),
              1e3 * number(result("runs/one"), "variables/rod_diameter/value"), 1e-3);
  EXPECT_EQ(table.text(row_of("kkt_residual"), "change"), "");
  EXPECT_THAT(text, AllOf(Not(HasSubstr("+0.0 %")), Not(HasSubstr("−0.0 %"))));
  const json compared = document("compare runs/one runs/two");
  ASSERT_EQ(compared.at("input").size(), 1u);
  EXPECT_EQ(at(compared, "input/0/place"), "/simulation/spectral_radius");
  EXPECT_EQ(at(compared, "input/0/second"), 0.7);
  const json& values = compared.at("outcome");
  const auto found = std::ranges::find_if(values, [](const json& value) {
    return value.at("group") == "variables" && value.at("name") == "rod_diameter";
  });
  ASSERT_NE(found, values.end());
  EXPECT_EQ(found->at("second"), at(result("runs/two"), "variables/rod_diameter/value"));
  refusal("compare runs/one runs");
  refusal("compare runs/one");
  folder_.write("mine.json", "mine");
  EXPECT_THAT(refusal("compare runs/one runs/two -o mine.json"),
              HasSubstr("mine.json: is there already"));
  EXPECT_EQ(folder_.text("mine.json"), "mine");
  folder_.write("runs/two/result.json", R"({"version": 1})");
  EXPECT_THAT(run_line(folder_.path(), "compare runs/one runs/two").out,
              HasSubstr("runs/two/result.json: is damaged"));
  EXPECT_THAT(run("runs").out, HasSubstr("damaged"));
}

/// Numbers in the tables read back as those of the record, which are those of the history.
TEST_F(OlderRuns, AreExportedAsTables) {
  run(optimize + "one");
  EXPECT_EQ(document("export runs/one").at("files").size(), 2u);
  const CsvRows evaluations = folder_.csv("runs/one/evaluations.csv");
  const CsvRows history = folder_.csv("runs/one/history.csv");
  ASSERT_EQ(evaluations.size(), history.size());
  for (const char* title : {"objective", "variable:rod_diameter", "constraint:rod_strength"}) {
    EXPECT_EQ(column(evaluations, title).front(), column(history, title).front());
  }
  const CsvRows gradients = folder_.csv("runs/one/evaluation_gradients.csv");
  EXPECT_THAT(gradients[0], ElementsAre("evaluation", "of", "variable", "derivative"));
  EXPECT_EQ(gradients[1][1], "objective");
  refusal("export runs");
}

/// The files are read by ParaView; here their counts have to fit together.
TEST_F(OlderRuns, AreExportedAsMotion) {
  run(optimize + "one");
  EXPECT_EQ(document("export runs/one --vtk -o out").at("files").size(), 4u);
  EXPECT_THAT(folder_.text("out/vtk/optimum.pvd"), HasSubstr("file=\"optimum-0000.vtu\""));
  const std::string grid = folder_.text("out/vtk/optimum-0001.vtu");
  const auto number_after = [&](const std::string& word) {
    return std::stoul(grid.substr(grid.find(word) + word.size()));
  };
  const auto block = [&](const std::string& name) {
    const auto begin = grid.find('\n', grid.find("Name=\"" + name + "\"")) + 1;
    std::istringstream stream(grid.substr(begin, grid.find("</DataArray>", begin) - begin));
    return std::vector<double>(std::istream_iterator<double>(stream), {});
  };
  const auto points = number_after("NumberOfPoints=\""), cells = number_after("NumberOfCells=\"");
  EXPECT_EQ(block("stress").size(), points);
  EXPECT_EQ(block("body").size(), cells);
  ASSERT_EQ(block("offsets").size(), cells);
  const std::vector<double> connectivity = block("connectivity");
  EXPECT_EQ(connectivity.size(), block("offsets").back());
  EXPECT_EQ(std::ranges::max(connectivity), static_cast<double>(points - 1));
}

}  // namespace
}  // namespace pleuel::test::run_folder_test
