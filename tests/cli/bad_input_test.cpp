#include <fstream>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::bad_input_test {
namespace {
using ::testing::Eq;

/// Exit code 2, one line that begins with the program's name, nothing on standard output.
void expect_complaint(const std::vector<std::string>& words, const std::string& part) {
  const ProgramFolder folder;
  const ProgramRun run = folder.run(words);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: "), HasSubstr(part)));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1);
  EXPECT_THAT(run.out, Eq(""));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "bad input must leave no run folder";
}

using BadInput = InProgramFolder;

TEST_F(BadInput, MissingFileIsNamed) {
  expect_complaint({"simulate", "nothing.json"}, "nothing.json: there is no such file");
}

TEST_F(BadInput, WrongValueIsNamedByItsPointer) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--set", "/simulation/step=-1 s"},
                   "/simulation/step");
}

/// Commands that simulate, and those that only look at instants.
TEST_F(BadInput, StepsThatNoMachineHoldsAreRefusedBeforeAnyLoop) {
  for (const char* command : {"show", "simulate", "optimize"}) {
    expect_complaint(
        {command, problem("slider_crank_round"), "--set", "/simulation/step=1.2e-10 s"},
        "but the machine has");
  }
}

TEST_F(BadInput, LongTextsAreToldByTheirBeginnings) {
  const std::string text(1'000'000, 'x');
  for (const auto& [place, value] :
       {std::pair{"name", nlohmann::json(1)}, std::pair{"scene", nlohmann::json(text)},
        std::pair{"objective", nlohmann::json{{"minimize", text}}},
        std::pair{"objective", nlohmann::json{{"minimize", "= " + text}}},
        std::pair{"simulation", nlohmann::json{{text, 1}}}}) {
    nlohmann::json document = read_json(problem("slider_crank_round"));
    document[place] = value;
    std::ofstream(folder_.path() / "long.json") << document;
    const ProgramRun run = folder_.run({"show", "long.json"});
    EXPECT_EQ(run.exit_code, 2) << place;
    EXPECT_THAT(run.err, StartsWith("pleuel: long.json: /")) << place;
    EXPECT_LT(run.err.size(), 5000) << place;
  }
}

TEST_F(BadInput, SeveralMistakesAreALineEach) {
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
TEST_F(BadInput, OverrideWithoutTheUnitOfTheFileHasTwoReadings) {
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

TEST_F(BadInput, OverrideOfNothingIsRefused) {
  expect_complaint({"check", problem("slider_crank_round"), "--set", "/simulation/stp/x=1"}, "stp");
}

TEST_F(BadInput, UnknownBackendListsThoseThereAre) {
  expect_complaint({"optimize", problem("slider_crank_round"), "--backend", "magic"},
                   "nlopt-mma, nlopt-ccsaq, nlopt-slsqp, ipopt");
}

TEST_F(BadInput, UnknownMethodListsThoseThereAre) {
  expect_complaint({"gradient", problem("slider_crank_round"), "--method", "guess"},
                   "auto, direct, adjoint, forward-difference, central-difference");
}

TEST_F(BadInput, DifferenceStepOutOfRangeIsRefused) {
  expect_complaint({"gradient", problem("slider_crank_round"), "--step", "-1"}, "--step must be");
}

TEST_F(BadInput, UnknownCommandListsThoseThereAre) {
  expect_complaint({"optimise", problem("slider_crank_round")}, "optimize");
}

TEST_F(BadInput, UnknownOptionIsNamed) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--fast"}, "--fast");
}

TEST_F(BadInput, MisspeltOptionIsGuessed) {
  expect_complaint({"simulate", problem("slider_crank_round"), "--accurcy", "1%"},
                   "--accurcy; did you mean --accuracy?");
  expect_complaint({"simulate", problem("slider_crank_round"), "--overwrit"},
                   "did you mean --overwrite?");
}

TEST_F(BadInput, NoCommandAtAllIsBadInput) {
  expect_complaint({}, " --help");
}

TEST_F(BadInput, OptimizingWithoutVariablesNamesFileAndPointer) {
  expect_complaint({"optimize", problem("slider_crank_exudyn")},
                   "slider_crank_exudyn.json: /variables is missing");
}

TEST_F(BadInput, StudyWithoutSettingsNamesFileAndPointer) {
  expect_complaint({"uncertainty", problem("slider_crank_exudyn")},
                   "slider_crank_exudyn.json: /uncertainty is missing");
}

TEST_F(BadInput, WithJsonTheErrorIsADocument) {
  const ProgramRun run = folder_.run({"check", "nothing.json", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  const nlohmann::json error = run.document().at("error");
  EXPECT_EQ(error.at("exit_code"), 2);
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("nothing.json"));
}

TEST(SimulationFailure, HasItsOwnExitCodeAndSaysWhen) {
  const ProgramFolder folder;
  // One Newton iteration is too few for any step of a mechanism that moves.
  const ProgramRun run = folder.run_quick(
      {"simulate", problem("slider_crank_round"), "--set", "/simulation/max_newton_iterations=1"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, AllOf(StartsWith("pleuel: "), HasSubstr("t = ")));
}

using Help = InProgramFolder;

TEST_F(Help, IsNoError) {
  const ProgramRun run = folder_.run({"--help"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("optimize"));
}

TEST_F(Help, FitsIntoAHundredColumns) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--help"}, {"optimize", "--help"}, {"gradient", "--help"}}) {
    std::istringstream lines(folder_.run(words).out);
    for (std::string line; std::getline(lines, line);) {
      const auto is_character = [](char byte) { return (byte & 0xC0) != 0x80; };  // of UTF-8
      EXPECT_LE(std::count_if(line.begin(), line.end(), is_character), 100) << line;
    }
  }
}

}  // namespace
}  // namespace pleuel::test::bad_input_test
