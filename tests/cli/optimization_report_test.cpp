#include <filesystem>
#include <fstream>
#include <memory>

#include "tests/cli/program.hpp"
#include "tests/cli/report_data.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::optimization_report_test {
namespace {

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
  const ProgramRun run = folder_.run({"optimize", problem("two_loads"), "-o", "run"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
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
  const ProgramRun again = folder_.run({"report", "run"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(data_of(page).at("picture"), picture);
}

/// The command makes from the card what the run made from its own numbers.
TEST_F(OptimizationReport, CanBeMadeLater) {
  const fs::path page = folder() / "one/report.html";
  const json before = data_of(page).at("picture");
  fs::remove(page);
  const ProgramRun run = run_program(folder(), {"report", "one"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
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
  const ProgramRun run = folder_.run({"report", "one"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
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
  const ProgramRun torn =
      report_with(folder(), "trajectory-optimum.csv", whole.substr(0, within_a_line));
  EXPECT_EQ(torn.exit_code, 0) << torn.err;
  EXPECT_THAT(unwrapped(torn.out), HasSubstr("Note: histories have no error bands: "
                                             "copy/trajectory-optimum.csv: is damaged: line "));
  const std::size_t cut = whole.find('\n', whole.size() / 2) + 1;
  EXPECT_THAT(unwrapped(report_with(folder(), "trajectory-optimum.csv", whole.substr(0, cut)).out),
              HasSubstr("instants, the simulation has"));
}

TEST_F(OptimizationReport, NamesFilesThatAreTooLargeForAPage) {
  EXPECT_EQ(data_of(folder() / "one/report.html").at("left_out"), json::array());
  const ProgramRun run = report_with(folder(), "history.csv", std::string(3'100'000, '\n'));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const json data = data_of(folder() / "copy/report.html");
  EXPECT_EQ(data.at("left_out"), json::array({"history.csv"}));
  EXPECT_FALSE(data.at("files").contains("history.csv"));
}

TEST_F(OptimizationReport, IsNotPromisedWhereItCannotBeWritten) {
  fs::remove_all(folder() / "blocked");
  fs::copy(folder() / "one", folder() / "blocked");
  fs::remove(folder() / "blocked/report.html");
  fs::create_directory(folder() / "blocked/report.html");
  const ProgramRun run = run_program(folder(), {"report", "blocked"});
  EXPECT_EQ(run.exit_code, 1);
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
  const ProgramRun run = folder_.run_quick({"simulate", "swept.json", "-o", "one"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
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
      folder_.run_line(words + "; export PLEUEL_REPORT_TEMPLATE=/nowhere; '" PLEUEL_PROGRAM "' " +
                       words + " --overwrite");
  EXPECT_EQ(run.exit_code, 0) << run.err;
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
  const ProgramRun run = folder_.run_quick({"simulate", "tags.json", "-o", "one"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string page = read_file(folder_.path() / "one/report.html");
  EXPECT_EQ(data_of(folder_.path() / "one/report.html").at("picture").at("name"), name);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
}

TEST_F(Report, OfAnUnknownFolderIsRefused) {
  const ProgramRun run = folder_.run({"report", "nothing"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("nothing/run_card.json: there is no such file"));
}

TEST_F(Report, OfTooLongANameIsASentence) {
  const ProgramRun run = folder_.run(joined(simulate(std::string(300, 'a')), {}));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("File name too long"));
  EXPECT_THAT(run.err, Not(HasSubstr("fault of the program")));
  EXPECT_LT(run.err.size(), 250u);
}

}  // namespace
}  // namespace pleuel::test::optimization_report_test
