#include <sstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

/// Every command that shows numbers shows what speaks against them.
namespace pleuel::test::warnings_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Rubber at 30 rad/s: bends by far more than linear elasticity describes.
const std::vector<std::string> too_soft = {problem("hard/soft_rod"), "--set",
                                           "/scene/joints/bearing/drive/speed=30 rad/s", "--set",
                                           "/simulation/end_time=0.6 s"};

std::vector<std::string> words(const std::string& command, const std::vector<std::string>& more) {
  return joined(joined({command}, too_soft), more);
}

void expect_warned(const std::string& command, const std::vector<std::string>& more) {
  const TemporaryFolder folder;
  const std::vector<std::string> line = joined(words(command, more), {"-o", "run"});
  const bool has_folder = command != "check" && command != "gradient";
  const ProgramRun run = run_program(folder.path(), has_folder ? line : words(command, more));
  EXPECT_THAT(unwrapped(run.out),
              AllOf(HasSubstr("Warning: "), HasSubstr("too far for linear elasticity")))
      << command << run.err;
}

TEST(Warnings, OfADesignThatBendsTooFarAreShownByEveryCommandWithNumbers) {
  expect_warned("simulate", {});
  expect_warned("check", {});
  expect_warned("gradient", {});
  expect_warned("stability", {});
  expect_warned("uncertainty", {"--set", R"(/uncertainty={"parameters": {"rod_diameter":
                                             {"deviation": "0.1 mm"}}})"});
  expect_warned("accuracy", {"--set", R"(/accuracy={"steps": ["1 ms"], "elements": [2]})"});
}

/// A limit of 150 where 150 MPa are meant: told with the first design, before the search.
TEST(Warnings, OfALimitWithoutItsUnitComeBeforeTheSearch) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(),
      {"optimize", problem("slider_crank_round"), "-o", "run", "--no-report", "--set",
       "/constraints/crank_strength/upper=150 Pa", "--set", "/optimizer/max_iterations=1", "--set",
       "/simulation/step=0.5 ms", "--set", "/simulation/end_time=20 ms", "--set",
       "/scene/joints/bearing/drive/ramp=20 ms"});
  const std::string text = unwrapped(run.err);
  EXPECT_THAT(text, HasSubstr("Warning: at the start the limit of \"crank_strength\" is 150 Pa"));
  EXPECT_THAT(text, HasSubstr("Is a unit missing"));
}

/// A sentence that is true of many runs is said once, with all of them behind it.
TEST(Warnings, ThatManyRunsShareNameAllOfThem) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), {"stability", problem("hard/dead_centres"), "-o", "run", "--set",
                      "/scene/gravity=[0, -981, 0]", "--set", "/simulation/end_time=4 ms"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto document = nlohmann::json::parse(read_file(folder.path() / "run/result.json"));
  std::string all;
  for (const auto& formulation : document.at("formulations")) {
    all += (all.empty() ? "(" : ", ") + ("dead_centres, " + formulation.get<std::string>());
  }
  const std::string text = unwrapped(run.out), warning = "Warning: /scene/gravity is 981 m/s²";
  EXPECT_EQ(document.at("formulations").size(), 7u);
  EXPECT_THAT(text, HasSubstr(warning));
  EXPECT_EQ(text.find(warning), text.rfind(warning)) << "said more than once";
  EXPECT_THAT(text.substr(text.find(warning)), HasSubstr(all + ")"));
}

/// The sentence is in the documents, too.
TEST(Warnings, AreAListOfEveryDocument) {
  const TemporaryFolder folder;
  for (const std::string command : {"simulate", "gradient", "check"}) {
    const ProgramRun run = run_program(folder.path(), words(command, {"--json"}));
    EXPECT_FALSE(run.document().at("warnings").empty()) << command;
    // With shear, which would change the deflections of such members by more than 1 %; those of a
    // crank of 12 mm are too large. Steps that resolve the peak of the rod's bow.
    const ProgramRun sound =
        run_program(folder.path(),
                    joined(joined({command, problem("slider_crank_round"), "--json"}, quick()),
                           {"--set", "/variables/rod_diameter/start=11 mm", "--set",
                            "/variables/crank_diameter/start=15 mm", "--set",
                            "/simulation/step=0.05 ms", "--set", "/scene/bodies/crank/shear=true",
                            "--set", "/scene/bodies/rod/shear=true"}));
    EXPECT_EQ(sound.document().at("warnings").dump(), "[]") << command;
  }
}

/// The numbers are the same however closely they are looked at; without checks there are no bars, and a
/// warning says so.
TEST(Warnings, AreLookedForAsCloselyAsIsAskedFor) {
  const TemporaryFolder folder;
  const auto simulated = [&](const std::vector<std::string>& more) {
    return run_program(
               folder.path(),
               joined(joined({"simulate", problem("slider_crank_round"), "--json"}, quick()),
                      joined({"--set", "/simulation/step=0.1 ms"}, more)))
        .document();
  };
  const auto none = simulated({"--no-checks"}), usual = simulated({}),
             all = simulated({"--all-checks"});
  ASSERT_EQ(none.at("warnings").size(), 1u);
  EXPECT_THAT(none.at("warnings").at(0).get<std::string>(), HasSubstr("not looked for"));
  for (const auto& [name, response] : usual.at("responses").items()) {
    EXPECT_EQ(response.at("value"), none.at("responses").at(name).at("value")) << name;
    EXPECT_EQ(response.at("value"), all.at("responses").at(name).at("value")) << name;
    EXPECT_FALSE(none.at("responses").at(name).contains("error")) << name;
  }
  const ProgramRun both = run_program(
      folder.path(), {"simulate", problem("slider_crank_round"), "--no-checks", "--all-checks"});
  EXPECT_EQ(both.exit_code, 2);
}

/// The words of a report stay within a hundred columns; only what a shell is to read is not broken.
TEST(Warnings, FitIntoAHundredColumns) {
  const TemporaryFolder folder;
  const std::string text = run_program(folder.path(), words("simulate", {})).out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;
}

}  // namespace
}  // namespace pleuel::test::warnings_test
