#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

/// report.html: the data that the program puts into the page.
namespace pleuel::test {
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
    run_ = run_program(folder_->path(),
                       joined({"optimize", problem("slider_crank_round"), "-o", "one"}, quick()));
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

/// The command makes from the card what the run made from its own numbers.
TEST_F(OptimizationReport, CanBeMadeLater) {
  const fs::path page = folder() / "one/report.html";
  const json before = data_of(page).at("picture");
  fs::remove(page);
  const ProgramRun run = run_program(folder(), {"report", "one"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(data_of(page).at("picture"), before);
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
}  // namespace pleuel::test
