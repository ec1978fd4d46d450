#include <algorithm>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/cli/program.hpp"
#include "tests/cli/text_table.hpp"

/// What is told of runs that have ended, and of those that have not.
namespace pleuel::test::older_runs_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OlderRuns : public testing::Test {
 protected:
  ProgramRun optimize(const std::string& name, const std::vector<std::string>& more = {}) const {
    return run_program(
        folder_.path(),
        joined(joined({"optimize", problem("slider_crank_round"), "-o", "runs/" + name}, quick()),
               more));
  }
  const TemporaryFolder folder_;
};

TEST_F(OlderRuns, AreListedWithTheirStatusAndObjective) {
  ASSERT_EQ(optimize("one").exit_code, 0);
  run_program(folder_.path(),
              joined({"simulate", problem("slider_crank_round"), "-o", "runs/two"}, quick()));
  fs::create_directories(folder_.path() / "runs/foreign");
  const ProgramRun text = run_program(folder_.path(), {"runs"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(unwrapped(text.out), HasSubstr("one optimize"));
  const nlohmann::json runs = run_program(folder_.path(), {"runs", "runs", "--json"}).document();
  ASSERT_EQ(runs.at("runs").size(), 2u);
  const nlohmann::json result =
      nlohmann::json::parse(read_file(folder_.path() / "runs/one/result.json"));
  EXPECT_EQ(runs["runs"][0].at("status"), "verified");
  EXPECT_EQ(runs["runs"][0].at("objective").at("value"), result.at("objective").at("value"));
  EXPECT_EQ(runs["runs"][1].at("command"), "simulate");
  EXPECT_FALSE(runs["runs"][1].contains("objective"));
  EXPECT_EQ(run_program(folder_.path(), {"runs", "nowhere"}).exit_code, 2);
}

/// The newest is the last, or they are in the order of their names.
TEST_F(OlderRuns, AreListedByTimeOrByName) {
  const ProgramRun none = run_program(folder_.path(), {"runs"});
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_THAT(none.out, HasSubstr("No runs yet"));
  for (const char* name : {"b", "a"}) {
    run_program(folder_.path(), joined({"simulate", problem("slider_crank_round"), "--no-report",
                                        "-o", std::string("runs/") + name},
                                       quick()));
  }
  const auto first = [&](const std::vector<std::string>& words) {
    const auto runs = run_program(folder_.path(), joined({"runs", "--json"}, words)).document();
    return runs.at("runs").at(0).at("folder").get<std::string>();
  };
  EXPECT_EQ(first({}), "runs/b");
  EXPECT_EQ(first({"--sort", "name"}), "runs/a");
}

TEST_F(OlderRuns, ThatWereKilledAreToldFromThoseAtWork) {
  const ProgramRun run = run_line(
      folder_.path(),
      fmt::format("optimize {0} -o runs/one >out 2>&1 & p=$!; i=0; "
                  "while [ ! -s runs/one/history.csv ] && [ $i -lt 3000 ]; do sleep 0.01; "
                  "i=$((i + 1)); done; {1} runs --json >at_work; kill -9 $p; wait $p; {1} runs "
                  "--json >killed",
                  problem("slider_crank_round"), PLEUEL_PROGRAM));
  const auto status = [&](const char* file) {
    return nlohmann::json::parse(read_file(folder_.path() / file)).at("runs").at(0).at("status");
  };
  EXPECT_EQ(status("at_work"), "running");
  EXPECT_EQ(status("killed"), "killed");
}

/// The mass goes with the density: its deviation, too.
TEST_F(OlderRuns, AreComparedInTheirDeviations) {
  for (const char* deviation : {"50", "100"}) {
    const ProgramRun run = run_program(
        folder_.path(),
        joined(
            {"uncertainty", problem("slider_crank_round"), "-o", std::string("runs/") + deviation,
             "--set", R"(/scene/materials/steel/density={"variable": "density"})", "--set",
             R"(/variables/density={"start": 7850, "lower": 7850, "upper": 7850})", "--set",
             fmt::format(R"(/uncertainty={{"parameters": {{"density": {{"deviation": {}}}}}}})",
                         deviation)},
            quick()));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  const nlohmann::json document =
      run_program(folder_.path(), {"compare", "runs/50", "runs/100", "--json"}).document();
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
  const ProgramRun same = run_program(folder_.path(), {"compare", "runs/one", "runs/one"});
  EXPECT_THAT(same.out, HasSubstr("The inputs are the same."));
  const ProgramRun text = run_program(folder_.path(), {"compare", "runs/one", "runs/two"});
  EXPECT_THAT(unwrapped(text.out), HasSubstr("/simulation/spectral_radius"));
  // In the units of the file, to six digits; residuals as they are, without a change of theirs.
  const TextTable table(text.out, "outcome");
  const auto row_of = [&](const std::string& name) {
    std::size_t row = 0;
    while (row < table.rows() && table.text(row, "name") != name) ++row;
    return row;
  };
  const nlohmann::json first =
      nlohmann::json::parse(read_file(folder_.path() / "runs/one/result.json"));
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
      run_program(folder_.path(), {"compare", "runs/one", "runs/two", "--json"}).document();
  ASSERT_EQ(document.at("input").size(), 1u);
  EXPECT_EQ(document["input"][0].at("place"), "/simulation/spectral_radius");
  EXPECT_EQ(document["input"][0].at("second"), 0.7);
  const auto& values = document.at("outcome");
  const auto found = std::find_if(values.begin(), values.end(), [](const auto& value) {
    return value.at("group") == "variables" && value.at("name") == "rod_diameter";
  });
  ASSERT_NE(found, values.end());
  const nlohmann::json result =
      nlohmann::json::parse(read_file(folder_.path() / "runs/two/result.json"));
  EXPECT_EQ(found->at("second"), result.at("variables").at("rod_diameter").at("value"));
  EXPECT_EQ(run_program(folder_.path(), {"compare", "runs/one", "runs"}).exit_code, 2);
  EXPECT_EQ(run_program(folder_.path(), {"compare", "runs/one"}).exit_code, 2);
}

/// Numbers in the tables read back as those of the record, which are those of the history.
TEST_F(OlderRuns, AreExportedAsTables) {
  ASSERT_EQ(optimize("one").exit_code, 0);
  const ProgramRun run = run_program(folder_.path(), {"export", "runs/one", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
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
  const ProgramRun none = run_program(folder_.path(), {"export", "runs"});
  EXPECT_EQ(none.exit_code, 2);
}

/// The files are read by ParaView; here their counts have to fit together.
TEST_F(OlderRuns, AreExportedAsMotion) {
  ASSERT_EQ(optimize("one").exit_code, 0);
  const ProgramRun run =
      run_program(folder_.path(), {"export", "runs/one", "--vtk", "-o", "out", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
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
}  // namespace pleuel::test::older_runs_test
