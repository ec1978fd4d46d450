#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "tests/cli/page_text.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::optimize_test {
namespace {

std::vector<std::string> quick_optimization(const std::vector<std::string>& more) {
  return joined(joined({"optimize", problem("slider_crank_round")}, quick()), more);
}

using Optimize = InProgramFolder;

TEST_F(Optimize, GivesADocumentWithTheDocumentedKeys) {
  const nlohmann::json document = exits(0, folder_.run(quick_optimization({"--json"}))).document();
  for (const char* key :
       {"status", "message", "backend", "objective", "variables", "constraints", "kkt_residual",
        "max_violation", "evaluations", "gradient_evaluations", "iterations", "seconds"}) {
    EXPECT_TRUE(document.contains(key)) << key;
  }
  EXPECT_EQ(document.at("status"), "verified");
  EXPECT_EQ(document.at("objective").at("unit"), "kg");
  EXPECT_LT(document.at("objective").at("value"), document.at("objective").at("start"));
  for (const auto& [name, constraint] : document.at("constraints").items()) {
    // The limits hold to the tolerance of the verdict.
    EXPECT_LE(constraint.at("value"), constraint.at("limit").get<double>() * (1 + 1e-4)) << name;
    EXPECT_TRUE(constraint.contains("multiplier")) << name;
  }
  for (const auto& [name, variable] : document.at("variables").items()) {
    EXPECT_EQ(variable.at("unit"), "m") << name;
    EXPECT_GE(variable.at("value"), variable.at("lower")) << name;
    EXPECT_LE(variable.at("value"), variable.at("upper")) << name;
  }
}

/// A screen of 80 columns and 40 lines has the whole answer; --verbose has the audit, too.
TEST_F(Optimize, FitsAScreen) {
  const std::vector<std::string> words = {"optimize", problem("slider_crank"), "--set",
                                          "/simulation/step=0.2 ms"};
  ::setenv("COLUMNS", "80", 1);
  const ProgramRun run = folder_.run(joined(words, {"-o", "one"}));
  ::unsetenv("COLUMNS");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(run.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto is_first = [](char c) { return (c & 0xC0) != 0x80; };  // of a UTF-8 character
    EXPECT_LE(std::count_if(line.begin(), line.end(), is_first), 80) << line;
  }
  EXPECT_LE(count, 40);
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("\nVERIFIED: every limit holds; "), Not(HasSubstr("Audit: "))));
  const ProgramRun verbose = folder_.run(joined(words, {"--verbose", "-o", "two"}));
  EXPECT_THAT(verbose.out, AllOf(HasSubstr("\nAudit: a local optimum: "),
                                 HasSubstr("at +1 % limit"), HasSubstr("\nDrive bearing: ")));
}

/// Whatever makes the gradients, the optimum is the same: within the tolerance of the optimizer.
TEST_F(Optimize, MayUseAnyGradients) {
  const auto optimum = [&](const std::vector<std::string>& more) {
    return exits(0, folder_.run(quick_optimization(joined({"--json"}, more)))).document();
  };
  const nlohmann::json chosen = optimum({});
  EXPECT_EQ(chosen.at("gradients").at("method"), "direct");
  for (const std::string method : {"adjoint", "central-difference"}) {
    const nlohmann::json document = optimum({"--method", method});
    EXPECT_EQ(document.at("gradients").at("method"), method);
    EXPECT_EQ(document.at("gradients").at("reason"), "asked for");
    const double expected = chosen.at("objective").at("value");
    EXPECT_NEAR(document.at("objective").at("value"), expected, 1e-5 * expected) << method;
  }
  EXPECT_EQ(
      optimum({"--set", R"(/sensitivity={"method": "adjoint"})"}).at("gradients").at("method"),
      "adjoint");
}

/// The words of the line of a table that begins with this name.
std::vector<std::string> table_row(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    if (words.size() > 1 && words.front() == name) return words;
  }
  ADD_FAILURE() << "no line of " << name << " in\n" << text;
  return std::vector<std::string>(16, "nan");
}

/// A number of a table, with five digits (prices: three), against the document.
void expect_number_shown(const std::string& word, double value, double digits = 1e-4) {
  EXPECT_NEAR(std::stod(word), value, digits * std::abs(value)) << word;
}

/// The document in SI, the tables in mm and MPa.
TEST_F(Optimize, ShowsTheNumbersOfItsDocumentInUnitsOfTheUser) {
  const ProgramRun run = exits(0, folder_.run(quick_optimization({"-o", "run", "--verbose"})));
  const auto document = folder_.result("run");
  EXPECT_THAT(run.out, HasSubstr("VERIFIED"));
  for (const auto& [name, variable] : document.at("variables").items()) {
    const auto row = table_row(run.out, name);  // name, start, optimum, lower, upper, unit
    expect_number_shown(row.at(1), 1e3 * variable.at("start").get<double>());
    expect_number_shown(row.at(2), 1e3 * variable.at("value").get<double>());
    expect_number_shown(row.at(3), 1e3 * variable.at("lower").get<double>());
    expect_number_shown(row.at(4), 1e3 * variable.at("upper").get<double>());
    EXPECT_EQ(row.at(5), "mm");
  }
  const double objective = document.at("objective").at("value");
  int priced = 0;
  for (const auto& [name, constraint] : document.at("constraints").items()) {
    // name, value, ≤, limit, unit, used, %, multiplier, sign and percent, %
    const auto row = table_row(run.out, name);
    const bool is_stress = constraint.at("unit") == "Pa";
    const double unit = is_stress ? 1e6 : 1e-3;
    const double value = constraint.at("value"), limit = constraint.at("limit");
    const double price = constraint.at("multiplier");
    expect_number_shown(row.at(1), value / unit);
    EXPECT_EQ(row.at(2), "≤");
    expect_number_shown(row.at(3), limit / unit);
    EXPECT_EQ(row.at(4), is_stress ? "MPa" : "mm");
    EXPECT_NEAR(std::stod(row.at(5)), 100.0 * value / limit, 0.05 + 1e-9);
    if (price == 0.0) {
      EXPECT_EQ(row.at(7), "0") << name;
      EXPECT_EQ(row.at(8), "–") << name;
      continue;
    }
    ++priced;
    expect_number_shown(row.at(7), price * unit, 5e-3);
    // More room for stress or deflection saves mass: the sign is minus.
    EXPECT_THAT(row.at(8), StartsWith("−"));
    EXPECT_NEAR(std::stod(row.at(8).substr(std::string("−").size())), price * limit / objective,
                0.0051)
        << "percent of the objective at one more percent of the limit";
  }
  EXPECT_GT(priced, 0);
}

/// Iterations are those of the backend, designs of the audit are none.
TEST_F(Optimize, TellsStepsFromTheAuditInItsHistory) {
  const ProgramRun run = folder_.run(quick_optimization({"-o", "run"}));
  const auto rows = read_csv(folder_.path() / "run/history.csv");
  const auto& titles = rows.front();
  const auto column = [&](const std::string& title) {
    return static_cast<std::size_t>(std::find(titles.begin(), titles.end(), title) -
                                    titles.begin());
  };
  int last = 0, audits = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const int iteration = std::stoi(rows[k].at(column("iteration")));
    const std::string purpose = rows[k].at(column("purpose"));
    if (purpose == "audit") {
      ++audits;
      EXPECT_EQ(iteration, last) << k;
    }
    last = iteration;
  }
  EXPECT_GE(audits, 6);
  EXPECT_THAT(run.out, HasSubstr("audit"));
  EXPECT_THAT(run.out, Not(HasSubstr(fmt::format("\n  {:>9}  ", last + 1))));
}

TEST_F(Optimize, StartsInItsTablesWhereTheRunBegan) {
  std::ofstream(folder_.path() / "design.json")
      << R"({"variables": {"crank_diameter": {"value": 0.025}, "rod_diameter": {"value": 0.020}}})";
  const ProgramRun run = folder_.run(quick_optimization(
      {"-o", "run", "--design", "design.json", "--set", "/optimizer/max_iterations=1"}));
  const auto document = folder_.result("run");
  EXPECT_EQ(document.at("variables").at("crank_diameter").at("start"), 0.025) << run.err;
  EXPECT_EQ(document.at("variables").at("rod_diameter").at("start"), 0.020);
  expect_number_shown(table_row(run.out, "crank_diameter").at(1), 25.0);
  expect_number_shown(table_row(run.out, "rod_diameter").at(1), 20.0);
}

TEST_F(Optimize, CannotVerifyWhatNoDesignCanKeep) {
  const nlohmann::json document =
      exits(4, folder_.run(quick_optimization({"--json", "--set",
                                               "/constraints/rod_stiffness/upper=1e-9 mm", "--set",
                                               "/optimizer/max_iterations=10"})))
          .document();
  EXPECT_EQ(document.at("status"), "infeasible");
  const std::string message = document.at("message");
  EXPECT_THAT(message, HasSubstr("rod_stiffness ≤ 1e-09 mm cannot be kept"));
  EXPECT_THAT(message, HasSubstr("One change would do: rod_stiffness ≤ 0.00"));
  EXPECT_TRUE(document.at("least_violation").at("proven"));
  EXPECT_THAT(message, Not(HasSubstr("between")));
  for (const auto& [name, constraint] : document.at("constraints").items()) {
    EXPECT_FALSE(constraint.contains("multiplier")) << name << ": a price where none can be";
  }
  const auto rows = read_csv(folder_.path() / "runs/slider_crank_round-optimize/history.csv");
  const auto column = std::find(rows.front().begin(), rows.front().end(), "max_violation");
  double least = document.at("max_violation");
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const std::string& cell = rows[k].at(std::size_t(column - rows.front().begin()));
    if (!cell.empty()) least = std::min(least, std::stod(cell));
  }
  EXPECT_NEAR(document.at("max_violation"), least, 1e-12 * least);
}

TEST_F(Optimize, WithoutTimeToFinishItIsNotVerified) {
  const ProgramRun run =
      exits(4, folder_.run(quick_optimization({"--set", "/optimizer/max_iterations=2"})));
  EXPECT_THAT(run.out, HasSubstr("NOT VERIFIED"));
}

/// Coarser steps have room, half of them do not.
TEST_F(Optimize, NamesTheRunThatWouldTellItsErrors) {
  const ProgramRun run = exits(
      4, folder_.run({"optimize", problem("slider_crank_round"), "--set", "/simulation/step=0.4 ms",
                      "--set", R"(/sensitivity={"memory": "60 kB"})", "--no-report"}));
  EXPECT_THAT(unwrapped(run.out),
              AllOf(HasSubstr("A run that would tell failed: /sensitivity/memory is too little"),
                    Not(HasSubstr("nan"))));
}

TEST_F(Optimize, AStartThatCannotBeSimulatedIsASimulationFailure) {
  EXPECT_EQ(exits(3, folder_.run(quick_optimization(
                         {"--json", "--set", "/simulation/max_newton_iterations=1"})))
                .document()
                .at("status"),
            "failed");
}

/// Rubber at 30 rad/s bends too far for linear elasticity, wherever one iteration leads.
TEST_F(Optimize, SaysWhereLinearElasticityIsLeft) {
  const ProgramRun run = folder_.run({"optimize", problem("hard/soft_rod"), "--set",
                                      "/scene/joints/bearing/drive/speed=30 rad/s", "--set",
                                      R"(/objective={"minimize": "rod_bow"})", "--set",
                                      R"(/optimizer={"max_iterations": 1})"});
  EXPECT_THAT(unwrapped(run.out), HasSubstr("too far for linear elasticity"));
  const auto result = read_json(folder_.path() / "runs/soft_rod-optimize/result.json");
  EXPECT_GT(result.at("monitors").at("elastic_rotation"), 0.2);
  EXPECT_THAT(folder_.run(quick_optimization({})).out, Not(HasSubstr("linear elasticity")));
}

TEST_F(Optimize, BackendOfTheCommandLineWinsOverThatOfTheFile) {
  const ProgramRun run = folder_.run(quick_optimization({"--json", "--backend", "ipopt"}));
  EXPECT_EQ(run.document().at("backend"), "ipopt");
  EXPECT_EQ(run.document().at("status"), "verified");
}

// report.html of an optimization: the data that the program puts into the page.

namespace fs = std::filesystem;
using nlohmann::json;

class OptimizationReport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    run_ = run_program(
        folder_->path(),
        joined({"optimize", problem("slider_crank_round"), "--verbose", "-o", "one"}, quick()));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static fs::path folder() { return folder_->path(); }

  static std::unique_ptr<TemporaryFolder> folder_;
  static ProgramRun run_;
};

std::unique_ptr<TemporaryFolder> OptimizationReport::folder_;

ProgramRun OptimizationReport::run_;

TEST_F(OptimizationReport, IsWrittenBesideTheResultAndSaidSo) {
  EXPECT_THAT(run_.out, HasSubstr("Report: one/report.html"));
  const json data = data_of(folder() / "one/report.html");
  EXPECT_EQ(data.at("result"), read_json(folder() / "one/result.json"));
  EXPECT_EQ(data.at("card").at("command"), "optimize");
  EXPECT_EQ(data.at("files").at("history.csv"), read_file(folder() / "one/history.csv"));
  EXPECT_THAT(read_file(folder() / "one/report.html"), HasSubstr("after the data"));
}

TEST_F(OptimizationReport, ResultBeginsWithItsVersion) {
  EXPECT_THAT(read_file(folder() / "one/result.json"), StartsWith("{\n  \"version\": 1,\n"));
}

/// To the seven digits of what is drawn.
TEST_F(OptimizationReport, ShowsHistoriesWithThePeaksOfTheResult) {
  const json data = data_of(folder() / "one/report.html");
  const json& optimum = named(data.at("picture").at("designs"), "optimum");
  int peaks = 0;
  for (const json& response : optimum.at("responses")) {
    const std::string name = response.at("name");
    const double value = data.at("result").at("responses").at(name).at("value");
    EXPECT_EQ(response.at("value"), value) << name;
    if (data.at("picture").at("responses").at(name).at("over_time") != "max") continue;
    if (!response.contains("history")) continue;
    const std::vector<float> curve = unpacked(response.at("history"));
    const std::size_t rows = response.at("history").at("rows");
    ASSERT_EQ(rows, 3u) << "time, value, and the band of a verified optimum";
    float highest = curve[1];
    for (std::size_t i = 1; i < curve.size(); i += rows) highest = std::max(highest, curve[i]);
    // The peak lies between steps, on a parabola through three of them.
    EXPECT_NEAR(highest, value, 2e-3 * std::abs(value)) << name;
    ++peaks;
  }
  EXPECT_GT(peaks, 0);
}

/// The slider's end position by the response against the place that is drawn.
TEST_F(OptimizationReport, ShowsThePlacesOfTheTrajectory) {
  const json data = data_of(folder() / "one/report.html");
  const json& bodies = data.at("picture").at("scene").at("bodies");
  const auto slider = static_cast<std::size_t>(
      std::find_if(bodies.begin(), bodies.end(),
                   [](const json& b) { return b.at("name") == "slider"; }) -
      bodies.begin());
  for (const json& design : data.at("picture").at("designs")) {
    const std::vector<float> places =
        unpacked(design.at("motion").at("bodies")[slider].at("positions"));
    const json& end = named(design.at("responses"), "slider_end");
    EXPECT_NEAR(places[places.size() - 3], end.at("value").get<double>(), 1e-6);
    EXPECT_NEAR(places[places.size() - 2], 0.0, 1e-6) << "the guide holds it on the x axis";
  }
}

/// The drive's torque is a response, too: its peak between steps, on a parabola.
TEST_F(OptimizationReport, SummarySaysWhatTheDriveNeeds) {
  const json torque = read_json(folder() / "one/result.json").at("responses").at("torque_peak");
  const std::string begin = "Drive bearing: torque ", arrow = " → ";
  const std::size_t at = run_.out.find(begin);
  ASSERT_NE(at, std::string::npos) << run_.out;
  const std::size_t between = run_.out.find(arrow, at);
  const double before = std::stod(run_.out.substr(at + begin.size()));
  const double after = std::stod(run_.out.substr(between + arrow.size()));
  EXPECT_NEAR(before, torque.at("start").get<double>(), 2e-3 * before);
  EXPECT_NEAR(after, torque.at("value").get<double>(), 2e-3 * after);
}

using Report = InProgramFolder;

/// Peaks of each case's own history, as in the result.
TEST_F(Report, OfLoadCasesHasThePicturesOfAll) {
  const ProgramRun run = exits(0, folder_.run({"optimize", problem("two_loads"), "-o", "run"}));
  const fs::path page = folder_.path() / "run/report.html";
  const json data = data_of(page);
  const json& picture = data.at("picture");
  EXPECT_EQ(picture.at("case"), data.at("result").at("cases").at("shown"));
  std::vector<json> pictures = {picture};
  for (const json& other : picture.at("other_cases")) pictures.push_back(other);
  ASSERT_EQ(pictures.size(), 2u);
  for (const json& one : pictures) {
    const std::string name = one.at("case");
    const json& optimum = named(one.at("designs"), "optimum");
    const json& stress = named(optimum.at("responses"), "rod_stress");
    EXPECT_EQ(stress.at("value"),
              data.at("result").at("responses").at("rod_stress [" + name + "]").at("value"));
    EXPECT_GT(unpacked(stress.at("history")).size(), 300u) << name;
    EXPECT_TRUE(optimum.contains("motion")) << name;
  }
  EXPECT_FALSE(pictures[1].at("limits").contains("rod_strength")) << "it is one of \"heavy\"";
  EXPECT_EQ(picture.at("units").at("responses").at("rod_bow [fast]").at("name"), "mm");
  EXPECT_EQ(picture.at("units").at("limits").at("rod_strength [heavy]").at("name"), "MPa");
  fs::remove(page);
  const ProgramRun again = exits(0, folder_.run({"report", "run"}));
  EXPECT_EQ(data_of(page).at("picture"), picture);
}

/// The command makes from the card what the run made from its own numbers.
TEST_F(OptimizationReport, CanBeMadeLater) {
  const fs::path page = folder() / "one/report.html";
  const json before = data_of(page).at("picture");
  fs::remove(page);
  const ProgramRun run = exits(0, run_program(folder(), {"report", "one"}));
  EXPECT_EQ(data_of(page).at("picture"), before);
}

/// An optimization may end with effects that it left out where it began.
TEST_F(Report, IsOfTheEffectsThatTheResultNames) {
  const fs::path page = folder_.path() / "one/report.html",
                 result = folder_.path() / "one/result.json";
  folder_.run_quick({"optimize", problem("slider_crank_round"), "-o", "one", "--set",
                     "/effects/tolerance=0.03", "--set", "/effects/geometric_stiffening=auto"});
  const json drawn = data_of(page).at("picture");
  folder_.run({"report", "one"});
  EXPECT_TRUE(data_of(page).at("picture") == drawn);
  json document = read_json(result);
  int turned = 0;
  for (json& effect : document.at("effects")) {
    if (effect.at("name") != "geometric_stiffening") continue;
    effect["built"] = !effect["built"].get<bool>();
    ++turned;
  }
  EXPECT_EQ(turned, 2);
  std::ofstream(result) << document.dump();
  const ProgramRun run = exits(0, folder_.run({"report", "one"}));
  EXPECT_FALSE(data_of(page).at("picture") == drawn);
}

/// The influence of the variables is that of the gradients in the result; of the mass in closed
/// form: m = ρ π/4 Σ L d², so that d ln m / d ln d₁ = 2 L₁ d₁² / Σ L d².
TEST_F(OptimizationReport, ShowsWhatEachVariableChanges) {
  const json data = data_of(folder() / "one/report.html");
  const json& result = data.at("result");
  const json& optimum = named(data.at("picture").at("designs"), "optimum");
  const double crank = result.at("variables").at("crank_diameter").at("value");
  const double rod = result.at("variables").at("rod_diameter").at("value");
  const json& mass = named(optimum.at("responses"), "crank_and_rod");
  EXPECT_EQ(mass.at("gradients"), result.at("responses").at("crank_and_rod").at("gradients"));
  const double found = mass.at("gradients").at("crank_diameter").get<double>() * crank /
                       mass.at("value").get<double>();
  const double expected = 2 * 0.12 * crank * crank / (0.12 * crank * crank + 0.18 * rod * rod);
  EXPECT_NEAR(found, expected, 1e-9);
  const json& stress = named(optimum.at("responses"), "crank_stress");
  EXPECT_EQ(stress.at("slopes").size(), 2u) << "a curve a variable";
  EXPECT_GE(stress.at("peak_share").get<double>(), 0.0);
  EXPECT_LE(stress.at("peak_share").get<double>(), 1.0);
}

/// A run folder with a file of another content.
ProgramRun report_with(const fs::path& folder, const std::string& file, const std::string& text) {
  fs::remove_all(folder / "copy");
  fs::copy(folder / "one", folder / "copy");
  fs::remove(folder / "copy/report.html");
  std::ofstream(folder / ("copy/" + file)) << text;
  return run_program(folder, {"report", "copy"});
}

TEST_F(OptimizationReport, OfADamagedResultIsRefused) {
  for (const char* text : {"{}", R"({"status": "verified", "objective": 3})", "", "[1", "null"}) {
    const ProgramRun run = report_with(folder(), "result.json", text);
    EXPECT_EQ(run.exit_code, 2) << text;
    EXPECT_THAT(run.err, HasSubstr("copy/result.json: is")) << text;
    EXPECT_FALSE(fs::exists(folder() / "copy/report.html")) << text;
  }
  json result = read_json(folder() / "one/result.json");
  result["variables"]["rod_diameter"]["value"] = "wide";
  EXPECT_THAT(report_with(folder(), "result.json", result.dump()).err,
              HasSubstr("is damaged: the variable \"rod_diameter\" has no value"));
}

TEST_F(OptimizationReport, OfADamagedTrajectorySaysWhatIsMissing) {
  const std::string whole = read_file(folder() / "one/trajectory-optimum.csv");
  const std::size_t within_a_line = whole.find('\n', 3000) + 10;
  EXPECT_THAT(unwrapped(exits(0, report_with(folder(), "trajectory-optimum.csv",
                                             whole.substr(0, within_a_line)))
                            .out),
              HasSubstr("Note: histories have no error bands: "
                        "copy/trajectory-optimum.csv: is damaged: line "));
  const std::size_t cut = whole.find('\n', whole.size() / 2) + 1;
  EXPECT_THAT(unwrapped(report_with(folder(), "trajectory-optimum.csv", whole.substr(0, cut)).out),
              HasSubstr("instants, the simulation has"));
}

TEST_F(OptimizationReport, NamesFilesThatAreTooLargeForAPage) {
  EXPECT_EQ(data_of(folder() / "one/report.html").at("left_out"), json::array());
  const ProgramRun run =
      exits(0, report_with(folder(), "history.csv", std::string(3'100'000, '\n')));
  const json data = data_of(folder() / "copy/report.html");
  EXPECT_EQ(data.at("left_out"), json::array({"history.csv"}));
  EXPECT_FALSE(data.at("files").contains("history.csv"));
}

TEST_F(OptimizationReport, IsNotPromisedWhereItCannotBeWritten) {
  fs::remove_all(folder() / "blocked");
  fs::copy(folder() / "one", folder() / "blocked");
  fs::remove(folder() / "blocked/report.html");
  fs::create_directory(folder() / "blocked/report.html");
  const ProgramRun run = exits(1, run_program(folder(), {"report", "blocked"}));
  EXPECT_THAT(run.out, Not(HasSubstr("Report:")));
  EXPECT_THAT(run.err, HasSubstr("blocked/report.html cannot be written"));
}

// report.html: pages of any run, and where there is none.

/// Damage is a sum over cycles, an integral has the unit of its history times seconds.
TEST_F(Report, DrawsLimitsOnlyIntoHistoriesThatTheyAreOf) {
  json file = read_json(problem("slider_crank_round"));
  file["responses"]["swept"] = {
      {"type", "deflection"}, {"body", "rod"}, {"at", 0.5}, {"over_time", "integral"}};
  file["constraints"]["swept_limit"] = {{"response", "swept"}, {"upper", 1}};
  json& steel = file["scene"]["materials"]["steel"];
  steel["ultimate_strength"] = "600 MPa";
  steel["fatigue_strength"] = "900 MPa";
  steel["fatigue_exponent"] = 8;
  file["responses"]["damage"] = {
      {"type", "fatigue-damage"}, {"body", "rod"}, {"criterion", "goodman"}};
  file["constraints"]["life"] = {{"response", "damage"}, {"upper", 1e-6}};
  std::ofstream(folder_.path() / "swept.json") << file;
  const ProgramRun run = exits(0, folder_.run_quick({"simulate", "swept.json", "-o", "one"}));
  const json responses = data_of(folder_.path() / "one/report.html").at("picture").at("responses");
  EXPECT_EQ(responses.at("swept").at("limits_history"), false);
  EXPECT_EQ(responses.at("swept").at("unit").at("name"), "mm s");
  EXPECT_EQ(responses.at("swept").at("history_unit").at("name"), "mm");
  EXPECT_EQ(responses.at("damage").at("limits_history"), false);
  EXPECT_EQ(responses.at("rod_stress").at("limits_history"), true);
  const ProgramRun drawn = folder_.run({"plot", "one", "swept"});
  EXPECT_THAT(read_file(folder_.path() / "one/plot-swept.svg"), Not(HasSubstr("class=\"limit\"")))
      << drawn.out << drawn.err;
}

std::vector<std::string> simulate(const std::string& name) {
  return joined({"simulate", problem("slider_crank_round"), "-o", name}, quick());
}

TEST_F(Report, IsLeftOutIfTheUserSaysSo) {
  const ProgramRun run = folder_.run(joined(simulate("one"), {"--no-report"}));
  EXPECT_FALSE(fs::exists(folder_.path() / "one/report.html"));
  EXPECT_THAT(run.out, Not(HasSubstr("eport")));
}

TEST_F(Report, WithoutTemplateIsOneSentence) {
  std::string words;
  for (const std::string& word : simulate("one")) words += "'" + word + "' ";
  const ProgramRun run =
      exits(0, folder_.run_line(words +
                                "; export PLEUEL_REPORT_TEMPLATE=/nowhere; '" PLEUEL_PROGRAM "' " +
                                words + " --overwrite"));
  EXPECT_FALSE(fs::exists(folder_.path() / "one/report.html"));
  EXPECT_THAT(unwrapped(run.out), HasSubstr("No report.html: its template is not built"));
  EXPECT_THAT(unwrapped(run.out), HasSubstr("report one"));
}

/// A name must not end the script element that holds the data.
TEST_F(Report, HoldsNamesThatLookLikeTags) {
  const std::string name = "</script><script>alert(1)</script><!--";
  json file = read_json(problem("slider_crank_round"));
  file["name"] = name;
  std::ofstream(folder_.path() / "tags.json") << file;
  const ProgramRun run = exits(0, folder_.run_quick({"simulate", "tags.json", "-o", "one"}));
  const std::string page = read_file(folder_.path() / "one/report.html");
  EXPECT_EQ(data_of(folder_.path() / "one/report.html").at("picture").at("name"), name);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
}

TEST_F(Report, OfAnUnknownFolderIsRefused) {
  const ProgramRun run = exits(2, folder_.run({"report", "nothing"}));
  EXPECT_THAT(run.err, HasSubstr("nothing: there is no such run folder"));
}

TEST_F(Report, OfTooLongANameIsASentence) {
  const ProgramRun run = exits(2, folder_.run(joined(simulate(std::string(300, 'a')), {})));
  EXPECT_THAT(run.err, HasSubstr("File name too long"));
  EXPECT_THAT(run.err, Not(HasSubstr("fault of the program")));
  EXPECT_LT(run.err.size(), 250u);
}

}  // namespace
}  // namespace pleuel::test::optimize_test
