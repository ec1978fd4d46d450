#include <fstream>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

/// Designs that an optimization leaves, run again with --design.
namespace pleuel::test::design_test {
namespace {

namespace fs = std::filesystem;

/// The words of a command behind the name of the program.
std::string without_program(const std::string& command) {
  EXPECT_THAT(command, StartsWith(PLEUEL_PROGRAM));  // as it was called
  return command.substr(command.find(' ') + 1);
}

class FailedDesign : public testing::Test {
 protected:
  ProgramRun optimize(const std::string& start, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"optimize", problem("hard/impossible_designs"),
                                      "-o",       "run",
                                      "--set",    "/variables/crank_length/start=" + start};
    words.insert(words.end(), more.begin(), more.end());
    return folder_.run(words);
  }
  nlohmann::json dossier() const { return read_json(folder_.path() / "run/failed_design.json"); }

  const ProgramFolder folder_;
};

TEST_F(FailedDesign, OfAStartIsKeptWithTheCommandThatMeetsTheSameFailure) {
  // No crank of these lengths can turn: the search has nowhere to go.
  const ProgramRun run =
      exits(3, optimize("120 mm", {"--set", "/variables/crank_length/lower=115 mm"}));
  EXPECT_GE(dossier().at("variables").at("crank_length").at("value"), 0.115);
  EXPECT_EQ(dossier().at("variables").at("crank_length").at("unit"), "m");
  const std::string command = dossier().at("command");
  EXPECT_THAT(run.out, HasSubstr("run/failed_design.json"));
  EXPECT_THAT(run.out, HasSubstr(command));
  const ProgramRun again = exits(3, folder_.run_line(without_program(command)));
  EXPECT_EQ(again.err, "pleuel: " + dossier().at("failure").get<std::string>() + "\n");
}

TEST_F(FailedDesign, OfAStartIsLeftForADesignThatCanBeSimulated) {
  exits(0, optimize("120 mm"));
  const nlohmann::json result = folder_.result("run");
  EXPECT_THAT(result.at("message").get<std::string>(), HasSubstr("the start cannot be evaluated"));
  EXPECT_LT(result.at("variables").at("crank_length").at("start"), 0.12);
}

/// The last failure of a search that found its optimum all the same.
TEST_F(FailedDesign, OfASearchIsTheLastOneOfItsHistory) {
  const ProgramRun run = exits(0, optimize("30 mm"));
  const auto history = read_csv(folder_.path() / "run/history.csv");
  int failures = 0;
  std::vector<std::string> last;
  for (const auto& row : history) {
    const bool is_failure = row != history.front() && !row.back().empty();
    failures += is_failure ? 1 : 0;
    if (is_failure) last = row;
  }
  ASSERT_GT(failures, 0);
  EXPECT_EQ(dossier().at("evaluation"), std::stoi(last.front()));
  const nlohmann::json result = folder_.result("run");
  EXPECT_EQ(result.at("failed_evaluations"), failures);
  const ProgramRun again =
      folder_.run_line(without_program(dossier().at("command").get<std::string>()));
  EXPECT_EQ(again.err, "pleuel: " + dossier().at("failure").get<std::string>() + "\n");
}

TEST_F(FailedDesign, IsNotThereWhereNoneFailed) {
  EXPECT_EQ(optimize("90 mm").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "run/failed_design.json"));
}

/// Responses and gradients at the optimum, from its result.
TEST_F(FailedDesign, OrAnyOtherOfAResultIsSimulatedExactly) {
  ASSERT_EQ(optimize("90 mm").exit_code, 0);
  const nlohmann::json optimum = folder_.result("run");
  for (const char* command : {"simulate", "gradient", "check"}) {
    const ProgramRun run = exits(0, folder_.run({command, problem("hard/impossible_designs"),
                                                 "--set", "/variables/crank_length/start=90 mm",
                                                 "--design", "run/result.json", "--json"}));
    for (const auto& [name, response] : optimum.at("responses").items()) {
      EXPECT_EQ(run.document().at("responses").at(name).at("value"), response.at("value"))
          << command << " " << name;
    }
  }
}

using DesignOfARun = InProgramFolder;

/// An optimum with steps and elements that were chosen for an accuracy: the commands that look at
/// it see its numbers, whatever the file has.
TEST_F(DesignOfARun, IsSimulatedWithTheSettingOfTheRun) {
  const std::string file = problem("hard/impossible_designs");
  const auto run = [&](const std::vector<std::string>& words) {
    return exits(0, folder_.run(joined(words, {"--json"})));
  };
  const nlohmann::json optimum =
      run({"optimize", file, "-o", "run", "--accuracy", "5%"}).document();
  const int steps =
      static_cast<int>(std::lround(0.4 / optimum.at("setting").at("step").get<double>()));
  ASSERT_NE(steps, 400);  // those of the file
  const char* note = "steps and elements that this optimum was found with";
  for (const char* command : {"simulate", "check"}) {
    const ProgramRun looked = run({command, file, "--design", "run"});
    EXPECT_THAT(looked.err, HasSubstr(note));
    for (const auto& [name, response] : optimum.at("responses").items()) {
      EXPECT_EQ(looked.document().at("responses").at(name).at("value"), response.at("value"))
          << name;
    }
  }
  const ProgramRun others =  // where the limits need not be kept
      folder_.run(
          {"simulate", file, "--design", "run", "--json", "--set", "/simulation/step=1 ms"});
  EXPECT_EQ(others.document().at("steps"), 400);
  // Of a file without the key "effects", whose tolerance is part of the setting.
  run({"new", "four-bar", "starter.json"});
  run({"optimize", "starter.json", "-o", "starter", "--accuracy", "1%"});
  EXPECT_THAT(run({"simulate", "starter.json", "--design", "starter"}).err,
              HasSubstr("/effects/tolerance="));
  const ProgramRun anew =  // which may find that it breaks a limit by a little
      folder_.run({"simulate", file, "--design", "run", "--accuracy", "2%"});
  EXPECT_THAT(anew.err, Not(HasSubstr(note)));
}

/// Each load case with its own setting, which stands above what the case says of the step; and the
/// command line above that.
TEST_F(DesignOfARun, IsSimulatedWithTheSettingOfEachLoadCase) {
  const auto run = [&](const std::vector<std::string>& words) {
    return exits(0, folder_.run(joined(words, {"--json"})));
  };
  nlohmann::json problem_of_cases = read_json(problem("two_loads"));
  problem_of_cases["cases"]["heavy"]["/simulation/step"] = "2 ms";
  std::ofstream(folder_.path() / "two.json") << problem_of_cases;
  const nlohmann::json optimum =
      run({"optimize", "two.json", "-o", "run", "--accuracy", "1%"}).document();
  const nlohmann::json looked =
      run({"simulate", "two.json", "--design", "run"}).document().at("cases");
  for (const char* name : {"fast", "heavy"}) {
    const double step = optimum.at("setting").at("cases").at(name).at("step").get<double>();
    const double end = std::string(name) == "heavy" ? 0.2 : 0.1;
    EXPECT_EQ(looked.at(name).at("steps"), std::lround(end / step)) << name;
  }
  const ProgramRun alone = run({"simulate", "two.json", "--design", "run", "--case", "heavy"});
  EXPECT_EQ(alone.document().at("steps"), looked.at("heavy").at("steps"));
  const ProgramRun others =  // coarser steps may break a limit by a little
      folder_.run({"simulate", "two.json", "--design", "run", "--case", "heavy", "--set",
                   "/cases/heavy/~1simulation~1step=1 ms", "--json"});
  EXPECT_EQ(others.document().at("steps"), 200);
  EXPECT_THAT(others.err, Not(HasSubstr("/simulation/step")));
  // Of one case alone.
  const nlohmann::json heavy =
      run({"optimize", "two.json", "--case", "heavy", "-o", "heavy", "--accuracy", "1%"})
          .document();
  const ProgramRun seen = run({"simulate", "two.json", "--case", "heavy", "--design", "heavy"});
  EXPECT_EQ(seen.document().at("steps"),
            std::lround(0.2 / heavy.at("setting").at("step").get<double>()));
}

/// A body that has segments now has no number of elements of its own.
TEST_F(DesignOfARun, ThatDoesNotFitTheFileLeavesItsSettingWithANote) {
  const std::string file = problem("hard/impossible_designs");
  folder_.run({"optimize", file, "-o", "run", "--accuracy", "5%"});
  nlohmann::json other = read_json(file);
  for (auto& [name, body] : other["scene"]["bodies"].items()) {
    if (!body.contains("elements")) continue;
    body["segments"] = {{{"section", body["section"]}, {"elements", body["elements"]}}};
    body.erase("section");
    body.erase("elements");
  }
  std::ofstream(folder_.path() / "other.json") << other;
  const ProgramRun run = folder_.run({"simulate", "other.json", "--design", "run", "--json"});
  EXPECT_THAT(run.err, HasSubstr("those of this optimum do not fit"));
  EXPECT_EQ(run.document().at("steps"), 400);  // where the limits need not be kept
}

class WrongDesign : public testing::Test {
 protected:
  void expect_complaint(const std::string& design, const std::string& part) const {
    std::ofstream(folder_.path() / "design.json") << design;
    const ProgramRun run =
        exits(2, folder_.run({"simulate", problem("hard/impossible_designs"), "--design",
                              (folder_.path() / "design.json").string()}));
    EXPECT_EQ(run.err, "pleuel: " + (folder_.path() / "design.json").string() + ": " + part + "\n");
  }

  const ProgramFolder folder_;
};

TEST_F(WrongDesign, IsRefusedWithFileAndPlace) {
  expect_complaint("{}", "the design is missing the key \"crank_length\"");
  expect_complaint(R"({"status": "failed"})", "the design is missing the key \"variables\"");
  expect_complaint(R"({"crank_lenght": "50 mm", "rod_height": "10 mm"})",
                   "the design names the unknown design variable \"crank_lenght\"; did you mean "
                   "\"crank_length\"?");
  expect_complaint(R"({"variables": {"crank_length": {"value": 0.05}}})",
                   "/variables is missing the key \"rod_height\"");
  expect_complaint(
      R"({"variables": {"crank_lenght": {"value": 0.05}, "rod_height": {"value": 0.01}}})",
      "/variables names the unknown design variable \"crank_lenght\"; did you mean "
      "\"crank_length\"?");
  expect_complaint(R"({"variables": {"crank_length": {"start": 0.05}}})",
                   "/variables/crank_length is missing the key \"value\"");
  expect_complaint(R"({"variables": {"crank_length": {"value": "50 kg"}}})",
                   "/variables/crank_length/value must be a length [m], got \"50 kg\": \"kg\" "
                   "measures something else");
  expect_complaint(R"({"variables": {"crank_length": {"value": 50, "unit": "s"}}})",
                   "/variables/crank_length/unit must be a length [m], got \"s\": \"s\" measures "
                   "something else");
  expect_complaint(R"({"variables": {"crank_length": {"value": 0.2}}})",
                   "/variables/crank_length/value must lie within the bounds of 20 to 150 "
                   "mm, got 0.2 in SI units");
}

TEST_F(FailedDesign, MayBeWrittenByHandInAnyUnit) {
  const auto responses = [&](const std::string& design) {
    std::ofstream(folder_.path() / "design.json") << design;
    return folder_
        .run({"simulate", problem("hard/impossible_designs"), "--design", "design.json", "--json"})
        .document()
        .at("responses");
  };
  const nlohmann::json si = responses(
      R"({"variables": {"crank_length": {"value": 0.05}, "rod_height": {"value": 0.02}}})");
  EXPECT_EQ(responses(R"({"variables": {"crank_length": {"value": "50 mm"},
                                        "rod_height": {"value": 2, "unit": "cm"}}})"),
            si);
}

/// Rounded sizes, as a drawing has them: crank_length and rod_height of the file, and a limit.
class RoundedDesign : public testing::Test {
 protected:
  ProgramRun simulate(const std::vector<std::string>& more) const {
    return folder_.run(joined(
        {"simulate", problem("hard/impossible_designs"), "--json", "-o", "run", "--overwrite",
         "--set", R"(/constraints={"length": {"linear": {"crank_length": 1}, "upper": "60 mm"}})"},
        more));
  }
  nlohmann::json values(const ProgramRun& run) const {
    const nlohmann::json variables = run.document().at("variables");
    return {variables.at("crank_length").at("value"), variables.at("rod_height").at("value")};
  }
  std::string design(const std::string& text) const {
    std::ofstream(folder_.path() / "rounded.json") << text;
    return "rounded.json";
  }

  const ProgramFolder folder_;
};

TEST_F(RoundedDesign, IsAFileOfNamesAndValues) {
  const ProgramRun run =
      simulate({"--design", design(R"({"crank_length": "5.5 cm", "rod_height": 0.02})")});
  EXPECT_EQ(values(run), nlohmann::json({0.055, 0.02}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(values(simulate({"--design", design(R"({"variables": {"crank_length": "5.5 cm",
                                                    "rod_height": {"value": 2, "unit": "cm"}}})")})),
            nlohmann::json({0.055, 0.02}));
}

/// A value on the command line stands above that of the file.
TEST_F(RoundedDesign, IsOnTheCommandLineByTheNamesOfVariables) {
  EXPECT_EQ(values(simulate({"--set", "crank_length=55 mm", "--set", "rod_height=20 mm"})),
            nlohmann::json({0.055, 0.02}));
  const std::string file = design(R"({"crank_length": "50 mm", "rod_height": "20 mm"})");
  EXPECT_EQ(values(simulate({"--design", file, "--set", "crank_length=55 mm"})),
            nlohmann::json({0.055, 0.02}));
}

TEST_F(RoundedDesign, SaysWhichOfItsSizesAreAtABound) {
  const auto reached = [&](const std::string& rest) {
    const nlohmann::json size = simulate(joined({"--set", "crank_length=55 mm"}, {"--set", rest}))
                                    .document()
                                    .at("variables")
                                    .at("crank_length");
    return size.value("at_bound", "none");
  };
  EXPECT_EQ(reached("/variables/crank_length/lower=50 mm"), "none");
  EXPECT_EQ(reached("/variables/crank_length/lower=55 mm"), "lower");
  EXPECT_EQ(reached("/variables/crank_length/upper=55 mm"), "upper");
  EXPECT_EQ(
      reached(R"(/variables/crank_length={"start": "55 mm", "lower": "55 mm", "upper": "55 mm"})"),
      "both");
  // Far bounds are compared with themselves and with the start, 5 cm, not with the range.
  EXPECT_EQ(reached("/variables/crank_length/upper=100 km"), "none");
}

TEST_F(RoundedDesign, ThatBreaksALimitIsNoSuccess) {
  for (const auto& [value, code] : {std::pair{"61 mm", 4}, std::pair{"60 mm", 0}}) {
    const ProgramRun run = simulate({"--set", std::string("crank_length=") + value});
    EXPECT_EQ(run.exit_code, code) << value;
    EXPECT_EQ(run.document().at("constraints").at("length").at("kept"), code == 0);
  }
  // A start is no answer.
  const ProgramRun start = exits(0, simulate({"--set", "/variables/crank_length/start=61 mm"}));
  EXPECT_EQ(start.document().at("constraints").at("length").at("kept"), false);
}

TEST_F(RoundedDesign, IsDrawnInAReportThatIsMadeLater) {
  const std::string file = design(R"({"crank_length": "55 mm", "rod_height": "20 mm"})");
  simulate({"--no-report", "--design", file, "--set", "rod_height=21 mm"});
  const ProgramRun report = exits(0, folder_.run({"report", "run"}));
  EXPECT_THAT(report.out, Not(HasSubstr("Without the mechanism")));
}

/// What it has is no misspelling of what it lacks.
TEST_F(RoundedDesign, SaysWhichVariableIsMissing) {
  const std::string file = design(R"({"crank_length": "55 mm"})");
  EXPECT_THAT(
      exits(2, folder_.run({"simulate", problem("hard/impossible_designs"), "--design", file})).err,
      HasSubstr("is missing the key \"rod_height\"\n"));
}

TEST_F(WrongDesign, ThatIsNotThereIsNamed) {
  EXPECT_THAT(exits(2, folder_.run({"simulate", problem("hard/impossible_designs"), "--design",
                                    "nothing.json"}))
                  .err,
              HasSubstr("nothing.json: there is no such file"));
}

}  // namespace
}  // namespace pleuel::test::design_test
