#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"
#include "tests/cli/report_data.hpp"

/// report.html: pages of any run, and where there is none.
namespace pleuel::test::report_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

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

TEST(Report, OfTooLongANameIsASentence) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), joined(simulate(std::string(300, 'a')), {}));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("File name too long"));
  EXPECT_THAT(run.err, ::testing::Not(HasSubstr("fault of the program")));
  EXPECT_LT(run.err.size(), 250u);
}

}  // namespace
}  // namespace pleuel::test::report_test
