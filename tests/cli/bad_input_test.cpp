#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"

namespace pleuel::test::bad_input_test {
namespace {

using ::testing::AllOf;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Exit code 2, one line that begins with the program's name, nothing on standard output.
void expect_complaint(const std::vector<std::string>& words, const std::string& part) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), words);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: "), HasSubstr(part)));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1);
  EXPECT_THAT(run.out, Eq(""));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "bad input must leave no run folder";
}

TEST(BadInput, MissingFileIsNamed) {
  expect_complaint({"simulate", "nothing.json"}, "nothing.json: there is no such file");
}

TEST(BadInput, WrongValueIsNamedByItsPointer) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--set", "/simulation/step=-1 s"},
                   "/simulation/step");
}

/// Commands that simulate, and those that only look at instants.
TEST(BadInput, StepsThatNoMachineHoldsAreRefusedBeforeAnyLoop) {
  for (const char* command : {"show", "simulate", "optimize"}) {
    expect_complaint(
        {command, problem("slider_crank_round"), "--set", "/simulation/step=1.2e-10 s"},
        "but the machine has");
  }
}

TEST(BadInput, LongTextsAreToldByTheirBeginnings) {
  const TemporaryFolder folder;
  const std::string text(1'000'000, 'x');
  for (const auto& [place, value] :
       {std::pair{"name", nlohmann::json(1)}, std::pair{"scene", nlohmann::json(text)},
        std::pair{"objective", nlohmann::json{{"minimize", text}}},
        std::pair{"objective", nlohmann::json{{"minimize", "= " + text}}},
        std::pair{"simulation", nlohmann::json{{text, 1}}}}) {
    nlohmann::json document = nlohmann::json::parse(read_file(problem("slider_crank_round")));
    document[place] = value;
    std::ofstream(folder.path() / "long.json") << document;
    const ProgramRun run = run_program(folder.path(), {"show", "long.json"});
    EXPECT_EQ(run.exit_code, 2) << place;
    EXPECT_THAT(run.err, StartsWith("pleuel: long.json: /")) << place;
    EXPECT_LT(run.err.size(), 5000) << place;
  }
}

TEST(BadInput, SeveralMistakesAreALineEach) {
  const ProgramRun run =
      run_program(TemporaryFolder().path(),
                  {"simulate", problem("slider_crank"), "--set", "/scene/bodies/crank/elements=0",
                   "--set", "/scene/bodies/rod/elements=0", "--set", "/simulation/step=-1 s"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: 3 mistakes:\n"),
                             HasSubstr("\n" + problem("slider_crank") +
                                       ": /scene/bodies/crank/elements must be "),
                             HasSubstr(": /scene/bodies/rod/elements must be "),
                             HasSubstr(": /simulation/step must be ")));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 4);
}

/// 0.1 in place of "0.2 mm" would be 100 mm.
TEST(BadInput, OverrideWithoutTheUnitOfTheFileHasTwoReadings) {
  expect_complaint(
      {"simulate", problem("slider_crank"), "--set", "/constraints/rod_stiffness/upper=0.1"},
      "the file has \"0.2 mm\" there: write \"0.1 mm\", or \"100 mm\" if the number is in SI");
  expect_complaint({"simulate", problem("slider_crank"), "--set", "rod_height=0.012"},
                   "write \"0.012 mm\", or \"12 mm\" if");
  // What is no place of the file is refused as that.
  expect_complaint({"simulate", problem("slider_crank"), "--set", "/scene/a~2=1"}, "neither ~0");
  // A number in place of a number says what it is.
  expect_complaint({"simulate", problem("slider_crank"), "--set", "/scene/bodies/rod/elements=0"},
                   "/scene/bodies/rod/elements must be");
}

TEST(BadInput, OverrideOfNothingIsRefused) {
  expect_complaint({"check", problem("slider_crank_round"), "--set", "/simulation/stp/x=1"}, "stp");
}

TEST(BadInput, UnknownBackendListsThoseThereAre) {
  expect_complaint({"optimize", problem("slider_crank_round"), "--backend", "magic"},
                   "nlopt-mma, nlopt-ccsaq, nlopt-slsqp, ipopt");
}

TEST(BadInput, UnknownMethodListsThoseThereAre) {
  expect_complaint({"gradient", problem("slider_crank_round"), "--method", "guess"},
                   "auto, direct, adjoint, forward-difference, central-difference");
}

TEST(BadInput, DifferenceStepOutOfRangeIsRefused) {
  expect_complaint({"gradient", problem("slider_crank_round"), "--step", "-1"}, "--step must be");
}

TEST(BadInput, UnknownCommandListsThoseThereAre) {
  expect_complaint({"optimise", problem("slider_crank_round")}, "optimize");
}

TEST(BadInput, UnknownOptionIsNamed) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--fast"}, "--fast");
}

TEST(BadInput, MisspeltOptionIsGuessed) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--accurcy", "1%"},
                   "--accurcy; did you mean --accuracy?");
  expect_complaint({"simulate", problem("slider_crank_round"), "--overwrit"},
                   "did you mean --overwrite?");
}

TEST(BadInput, NoCommandAtAllIsBadInput) {
  expect_complaint({}, " --help");
}

TEST(BadInput, OptimizingWithoutVariablesNamesFileAndPointer) {
  expect_complaint({"optimize", problem("slider_crank_exudyn")},
                   "slider_crank_exudyn.json: /variables is missing");
}

TEST(BadInput, StudyWithoutSettingsNamesFileAndPointer) {
  expect_complaint({"uncertainty", problem("slider_crank_exudyn")},
                   "slider_crank_exudyn.json: /uncertainty is missing");
}

TEST(BadInput, WithJsonTheErrorIsADocument) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"check", "nothing.json", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  const nlohmann::json error = run.document().at("error");
  EXPECT_EQ(error.at("exit_code"), 2);
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("nothing.json"));
}

TEST(SimulationFailure, HasItsOwnExitCodeAndSaysWhen) {
  const TemporaryFolder folder;
  // One Newton iteration is too few for any step of a mechanism that moves.
  const ProgramRun run =
      run_program(folder.path(), joined({"simulate", problem("slider_crank_round"), "--set",
                                         "/simulation/max_newton_iterations=1"},
                                        quick()));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: "), HasSubstr("t = ")));
}

TEST(Help, IsNoError) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"--help"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("optimize"));
}

TEST(Help, FitsIntoAHundredColumns) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--help"}, {"optimize", "--help"}, {"gradient", "--help"}}) {
    std::istringstream lines(run_program(folder.path(), words).out);
    for (std::string line; std::getline(lines, line);) {
      const auto is_character = [](char byte) { return (byte & 0xC0) != 0x80; };  // of UTF-8
      EXPECT_LE(std::count_if(line.begin(), line.end(), is_character), 100) << line;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::bad_input_test
