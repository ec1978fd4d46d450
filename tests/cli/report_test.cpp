#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

/// report.html: the data that the program puts into the page.
namespace pleuel::test::report_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

/// What stands between the tags of a page.
json data_of(const fs::path& page) {
  const std::string text = read_file(page);
  const std::string opening = R"(id="pleuel-data">)";
  const std::size_t begin = text.find(opening) + opening.size();
  return json::parse(text.substr(begin, text.find("</script>", begin) - begin));
}

/// Numbers of a packed document, RFC 4648 and IEEE 754.
std::vector<float> unpacked(const json& packed) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int count = 0;
  for (const char letter : packed.at("f32").get<std::string>()) {
    if (letter == '=') break;
    group = (group << 6) | static_cast<std::uint32_t>(letters.find(letter));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((group >> count) & 255u);
  }
  std::vector<float> numbers(bytes.size() / 4);
  std::memcpy(numbers.data(), bytes.data(), 4 * numbers.size());
  return numbers;
}

const json& named(const json& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(),
                                  [&](const json& one) { return one.at("name") == name; });
  if (found == list.end()) throw std::runtime_error("nothing is called " + name);
  return *found;
}

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
  EXPECT_EQ(data.at("result"), json::parse(read_file(folder() / "one/result.json")));
  EXPECT_EQ(data.at("card").at("command"), "optimize");
  EXPECT_EQ(data.at("files").at("history.csv"), read_file(folder() / "one/history.csv"));
  EXPECT_THAT(read_file(folder() / "one/report.html"), HasSubstr("after the data"));
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
  const json torque =
      json::parse(read_file(folder() / "one/result.json")).at("responses").at("torque_peak");
  const std::string begin = "Drive bearing: torque ", arrow = " → ";
  const std::size_t at = run_.out.find(begin);
  ASSERT_NE(at, std::string::npos) << run_.out;
  const std::size_t between = run_.out.find(arrow, at);
  const double before = std::stod(run_.out.substr(at + begin.size()));
  const double after = std::stod(run_.out.substr(between + arrow.size()));
  EXPECT_NEAR(before, torque.at("start").get<double>(), 2e-3 * before);
  EXPECT_NEAR(after, torque.at("value").get<double>(), 2e-3 * after);
}

/// Peaks of each case's own history, as in the result.
TEST(Report, OfLoadCasesHasThePicturesOfAll) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"optimize", problem("two_loads"), "-o", "run"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const fs::path page = folder.path() / "run/report.html";
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
  const ProgramRun again = run_program(folder.path(), {"report", "run"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(data_of(page).at("picture"), picture);
}

/// Damage is a sum over cycles, an integral has the unit of its history times seconds.
TEST(Report, DrawsLimitsOnlyIntoHistoriesThatTheyAreOf) {
  const TemporaryFolder folder;
  json file = json::parse(read_file(problem("slider_crank_round")));
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
  std::ofstream(folder.path() / "swept.json") << file;
  const ProgramRun run =
      run_program(folder.path(), joined({"simulate", "swept.json", "-o", "one"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json responses = data_of(folder.path() / "one/report.html").at("picture").at("responses");
  EXPECT_EQ(responses.at("swept").at("limits_history"), false);
  EXPECT_EQ(responses.at("swept").at("unit").at("name"), "mm s");
  EXPECT_EQ(responses.at("swept").at("history_unit").at("name"), "mm");
  EXPECT_EQ(responses.at("damage").at("limits_history"), false);
  EXPECT_EQ(responses.at("rod_stress").at("limits_history"), true);
  const ProgramRun drawn = run_program(folder.path(), {"plot", "one", "swept"});
  EXPECT_THAT(read_file(folder.path() / "one/plot-swept.svg"),
              ::testing::Not(HasSubstr("class=\"limit\"")))
      << drawn.out << drawn.err;
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
TEST(Report, IsOfTheEffectsThatTheResultNames) {
  const TemporaryFolder folder;
  const fs::path page = folder.path() / "one/report.html",
                 result = folder.path() / "one/result.json";
  run_program(folder.path(),
              joined({"optimize", problem("slider_crank_round"), "-o", "one", "--set",
                      "/effects/tolerance=0.03", "--set", "/effects/geometric_stiffening=auto"},
                     quick()));
  const json drawn = data_of(page).at("picture");
  run_program(folder.path(), {"report", "one"});
  EXPECT_TRUE(data_of(page).at("picture") == drawn);
  json document = json::parse(read_file(result));
  int turned = 0;
  for (json& effect : document.at("effects")) {
    if (effect.at("name") != "geometric_stiffening") continue;
    effect["built"] = !effect["built"].get<bool>();
    ++turned;
  }
  EXPECT_EQ(turned, 2);
  std::ofstream(result) << document.dump();
  const ProgramRun run = run_program(folder.path(), {"report", "one"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(data_of(page).at("picture") == drawn);
}

std::vector<std::string> simulate(const std::string& name) {
  return joined({"simulate", problem("slider_crank_round"), "-o", name}, quick());
}

TEST(Report, IsLeftOutIfTheUserSaysSo) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), joined(simulate("one"), {"--no-report"}));
  EXPECT_FALSE(fs::exists(folder.path() / "one/report.html"));
  EXPECT_THAT(run.out, ::testing::Not(HasSubstr("eport")));
}

TEST(Report, WithoutTemplateIsOneSentence) {
  const TemporaryFolder folder;
  std::string words;
  for (const std::string& word : simulate("one")) words += "'" + word + "' ";
  const ProgramRun run = run_line(
      folder.path(), words + "; export PLEUEL_REPORT_TEMPLATE=/nowhere; '" PLEUEL_PROGRAM "' " +
                         words + " --overwrite");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(fs::exists(folder.path() / "one/report.html"));
  EXPECT_THAT(unwrapped(run.out), HasSubstr("No report.html: its template is not built"));
  EXPECT_THAT(unwrapped(run.out), HasSubstr("report one"));
}

/// A name must not end the script element that holds the data.
TEST(Report, HoldsNamesThatLookLikeTags) {
  const TemporaryFolder folder;
  const std::string name = "</script><script>alert(1)</script><!--";
  json file = json::parse(read_file(problem("slider_crank_round")));
  file["name"] = name;
  std::ofstream(folder.path() / "tags.json") << file;
  const ProgramRun run =
      run_program(folder.path(), joined({"simulate", "tags.json", "-o", "one"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string page = read_file(folder.path() / "one/report.html");
  EXPECT_EQ(data_of(folder.path() / "one/report.html").at("picture").at("name"), name);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
}

TEST(Report, OfAnUnknownFolderIsRefused) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"report", "nothing"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("nothing/run_card.json: there is no such file"));
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
  json result = json::parse(read_file(folder() / "one/result.json"));
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
  EXPECT_THAT(run.out, ::testing::Not(HasSubstr("Report:")));
  EXPECT_THAT(run.err, HasSubstr("blocked/report.html cannot be written"));
}

TEST(Report, OfTooLongANameIsASentence) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), joined(simulate(std::string(300, 'a')), {}));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("File name too long"));
  EXPECT_THAT(run.err, ::testing::Not(HasSubstr("fault of the program")));
  EXPECT_LT(run.err.size(), 250u);
}

TEST(Show, SaysWhatJointsLeaveFreeAndHowLongItTakes) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"show", problem("four_bar"), "-o", "page.html"});
  EXPECT_THAT(run.out, HasSubstr("1 of 6"));
  EXPECT_THAT(run.out, HasSubstr("drive of the angle"));
  EXPECT_THAT(run.out, HasSubstr("Time: one simulation takes about "));
}

/// A link that nothing drives, holds or pulls, on the end of a driven crank.
TEST(Show, DrawsBodiesRedThatNothingMoves) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "loose.json") << R"({
    "scene": {
      "materials": {"steel": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
      "bodies": {
        "crank": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "steel",
                  "rigid": true, "elements": 1, "section": {"type": "circle", "diameter": 0.01}},
        "link": {"type": "beam", "from": [0.1, 0, 0], "to": [0.3, 0, 0], "material": "steel",
                 "rigid": true, "elements": 1, "section": {"type": "circle", "diameter": 0.01}}
      },
      "joints": {
        "hub": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                "drive": {"type": "constant-speed", "speed": 5}},
        "pin": {"type": "revolute", "bodies": ["crank", "link"], "at": [0.1, 0, 0]}
      }
    },
    "simulation": {"end_time": 0.1, "step": 1e-3},
    "responses": {"reach": {"type": "position", "body": "link", "at": 1, "direction": "x",
                            "over_time": "final"}}
  })";
  const ProgramRun run =
      run_program(folder.path(), {"show", "loose.json", "-o", "page.html", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.document().at("unheld_bodies"), json({"link"}));
}

TEST(Check, WritesAPageIfAFolderIsNamed) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), joined({"check", problem("slider_crank_round"), "-o", "one"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json data = data_of(folder.path() / "one/report.html");
  EXPECT_EQ(data.at("card").at("command"), "check");
  EXPECT_TRUE(data.at("result").at("responses").at("crank_stress").contains("derivatives"));
  EXPECT_FALSE(named(data.at("picture").at("designs"), "start").at("responses").empty());
}

TEST(GradientReport, ComparesAllMethods) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(),
      joined({"gradient", problem("slider_crank_round"), "--compare", "-o", "one"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Effort and accuracy of the methods"));
  const json result = data_of(folder.path() / "one/report.html").at("result");
  // Two exact ones, and two differences with seven steps each.
  EXPECT_EQ(result.at("comparison").size(), 2u + 2u * 7u);
}

TEST(Show, SaysWhatStartsBent) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), {"show", problem("slider_crank_round"), "-o", "bent.html", "--set",
                      R"(/scene/bodies/rod/initial_deflections=[{"at": ["210 mm", 0, 0], )"
                      R"("direction": [0, 1, 0], "displacement": "2 mm"}])"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json bodies = data_of(folder.path() / "bent.html").at("picture").at("scene").at("bodies");
  EXPECT_EQ(named(bodies, "rod").at("starts_bent").at("displacement"), 0.002);
  EXPECT_FALSE(named(bodies, "crank").contains("starts_bent"));
}

TEST(Show, SaysWhichJointsABodySlidesOn) {
  const TemporaryFolder folder;
  run_program(folder.path(), {"show", problem("spatial_slider_crank"), "-o", "page.html"});
  const json joints = data_of(folder.path() / "page.html").at("picture").at("scene").at("joints");
  EXPECT_EQ(named(joints, "guide").at("slides"), "along");
  EXPECT_EQ(named(joints, "guide").at("is_guide"), true);
  EXPECT_FALSE(named(joints, "bearing").contains("slides"));
  EXPECT_EQ(named(joints, "bearing").at("is_guide"), false);
}

TEST(Show, DrawsTheMechanismBeforeAnythingIsSimulated) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"show", problem("four_bar"), "-o", "page.html"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Drawn in page.html"));
  const json picture = data_of(folder.path() / "page.html").at("picture");
  const json& geometry = picture.at("designs")[0].at("geometry");
  EXPECT_EQ(geometry.at("bodies").size(), picture.at("scene").at("bodies").size());
  for (const json& joint : geometry.at("joints")) {
    EXPECT_EQ(joint.at("places").size(), 2u);
    EXPECT_EQ(joint.at("places")[0].at("at"), joint.at("places")[1].at("at"));
  }
}

}  // namespace
}  // namespace pleuel::test::report_test
