#include "tests/cli/program.hpp"

/// Designs that an optimization leaves, run again with --design.
namespace pleuel::test::design_test {
namespace {

class DesignOfARun : public InProgramFolder {
 protected:
  std::string optimize(const std::string& start, const std::string& more = "") const {
    return "optimize " + file_ + " -o run --set '/variables/crank_length/start=" + start + "' " +
           more;
  }
  json dossier() const { return folder_.read("run/failed_design.json"); }

  /// The command that meets the failure again, which it says.
  void expect_same_failure() const {
    const std::string command = dossier().at("command");
    EXPECT_THAT(command, StartsWith(PLEUEL_PROGRAM));  // as it was called
    EXPECT_EQ(run(command.substr(command.find(' ') + 1), 3).err,
              "pleuel: " + dossier().at("failure").get<std::string>() + "\n");
  }

  /// Every response of a document has the value that it has in another one.
  static void expect_same_values(const json& found, const json& expected) {
    for (const auto& [name, response] : expected.at("responses").items()) {
      EXPECT_EQ(at(found, "responses/" + name + "/value"), response.at("value")) << name;
    }
  }

  const std::string file_ = "$problems/hard/impossible_designs.json";
};

using FailedDesign = DesignOfARun;

TEST_F(FailedDesign, OfAStartIsKeptWithTheCommandThatMeetsTheSameFailure) {
  // No crank of these lengths can turn: the search has nowhere to go.
  const ProgramRun failed =
      run(optimize("120 mm", "--set '/variables/crank_length/lower=115 mm'"), 3);
  EXPECT_GE(number(dossier(), "variables/crank_length/value"), 0.115);
  EXPECT_EQ(at(dossier(), "variables/crank_length/unit"), "m");
  EXPECT_THAT(failed.out, AllOf(HasSubstr("run/failed_design.json"),
                                HasSubstr(dossier().at("command").get<std::string>())));
  expect_same_failure();
}

TEST_F(FailedDesign, OfAStartIsLeftForADesignThatCanBeSimulated) {
  run(optimize("120 mm"));
  EXPECT_THAT(result().at("message").get<std::string>(),
              HasSubstr("the start cannot be evaluated"));
  EXPECT_LT(number(result(), "variables/crank_length/start"), 0.12);
}

/// The last failure of a search that found its optimum all the same.
TEST_F(FailedDesign, OfASearchIsTheLastOneOfItsHistory) {
  run(optimize("30 mm"));
  const CsvRows history = folder_.csv("run/history.csv");
  int failures = 0;
  std::string last;
  for (std::size_t row = 1; row < history.size(); ++row) {
    if (history[row].back().empty()) continue;
    ++failures;
    last = history[row].front();
  }
  ASSERT_GT(failures, 0);
  EXPECT_EQ(dossier().at("evaluation"), std::stoi(last));
  EXPECT_EQ(result().at("failed_evaluations"), failures);
  expect_same_failure();
}

/// Responses and gradients at the optimum, from its result.
TEST_F(DesignOfARun, IsSimulatedExactly) {
  run(optimize("90 mm"));
  EXPECT_FALSE(folder_.has("run/failed_design.json")) << "none failed";
  for (const std::string command : {"simulate ", "gradient ", "check "}) {
    SCOPED_TRACE(command);
    expect_same_values(document(command + file_ +
                                " --design run/result.json "
                                "--set '/variables/crank_length/start=90 mm'"),
                       result());
  }
}

/// An optimum with steps and elements that were chosen for an accuracy: the commands that look at
/// it see its numbers, whatever the file has.
TEST_F(DesignOfARun, IsSimulatedWithTheSettingOfTheRun) {
  const json optimum = document("optimize " + file_ + " -o run --accuracy 5%");
  ASSERT_NE(std::lround(0.4 / number(optimum, "setting/step")), 400);  // those of the file
  const char* note = "steps and elements that this optimum was found with";
  for (const std::string command : {"simulate ", "check "}) {
    SCOPED_TRACE(command);
    const ProgramRun looked = run(command + file_ + " --design run --json");
    EXPECT_THAT(looked.err, HasSubstr(note));
    expect_same_values(looked.document(), optimum);
  }
  const std::string simulate = "simulate " + file_ + " --design run";
  const ProgramRun others =  // where the limits need not be kept
      run_line(folder_.path(), simulate + " --json --set '/simulation/step=1 ms'");
  EXPECT_EQ(others.document().at("steps"), 400);
  // Of a file without the key "effects", whose tolerance is part of the setting.
  run("new four-bar starter.json");
  run("optimize starter.json -o starter --accuracy 1%");
  EXPECT_THAT(run("simulate starter.json --design starter").err, HasSubstr("/effects/tolerance="));
  const ProgramRun anew =  // which may find that it breaks a limit by a little
      run_line(folder_.path(), simulate + " --accuracy 2%");
  EXPECT_THAT(anew.err, Not(HasSubstr(note)));
}

/// Each load case with its own setting, which stands above what the case says of the step; and the
/// command line above that.
TEST_F(DesignOfARun, IsSimulatedWithTheSettingOfEachLoadCase) {
  json problem_of_cases = read_problem("two_loads");
  problem_of_cases["cases"]["heavy"]["/simulation/step"] = "2 ms";
  folder_.write("two.json", problem_of_cases);
  const json optimum = document("optimize two.json -o run --accuracy 1%");
  const std::string simulate = "simulate two.json --design run";
  const json looked = document(simulate).at("cases");
  for (const auto& [name, end] : {std::pair<std::string, double>{"fast", 0.1}, {"heavy", 0.2}}) {
    EXPECT_EQ(looked.at(name).at("steps"),
              std::lround(end / number(optimum, "setting/cases/" + name + "/step")))
        << name;
  }
  EXPECT_EQ(document(simulate + " --case heavy").at("steps"), at(looked, "heavy/steps"));
  const ProgramRun others =  // coarser steps may break a limit by a little
      run_line(folder_.path(), simulate +
                                   " --case heavy --json "
                                   "--set '/cases/heavy/~1simulation~1step=1 ms'");
  EXPECT_EQ(others.document().at("steps"), 200);
  EXPECT_THAT(others.err, Not(HasSubstr("/simulation/step")));
  // Of one case alone.
  const json heavy = document("optimize two.json --case heavy -o heavy --accuracy 1%");
  EXPECT_EQ(document("simulate two.json --case heavy --design heavy").at("steps"),
            std::lround(0.2 / number(heavy, "setting/step")));
}

/// A body that has segments now has no number of elements of its own.
TEST_F(DesignOfARun, ThatDoesNotFitTheFileLeavesItsSettingWithANote) {
  run("optimize " + file_ + " -o run --accuracy 5%");
  json other = read_problem("hard/impossible_designs");
  for (json& body : other["scene"]["bodies"]) {
    if (!body.contains("elements")) continue;
    body["segments"] = {{{"section", body["section"]}, {"elements", body["elements"]}}};
    body.erase("section");
    body.erase("elements");
  }
  folder_.write("other.json", other);
  const ProgramRun looked =  // where the limits need not be kept
      run_line(folder_.path(), "simulate other.json --design run --json");
  EXPECT_THAT(looked.err, HasSubstr("those of this optimum do not fit"));
  EXPECT_EQ(looked.document().at("steps"), 400);
}

TEST_F(DesignOfARun, IsRefusedWithFileAndPlace) {
  const std::string simulate = "simulate " + file_ + " --design ";
  for (const auto& [design, expected] : std::vector<std::pair<std::string, std::string>>{
           {"{}", "the design is missing the key \"crank_length\""},
           // What it has is no misspelling of what it lacks.
           {R"({"crank_length": "55 mm"})", "the design is missing the key \"rod_height\""},
           {R"({"status": "failed"})", "the design is missing the key \"variables\""},
           {R"({"crank_lenght": "50 mm", "rod_height": "10 mm"})",
            "the design names the unknown design variable \"crank_lenght\"; did you mean "
            "\"crank_length\"?"},
           {R"({"variables": {"crank_length": {"value": 0.05}}})",
            "/variables is missing the key \"rod_height\""},
           {R"({"variables": {"crank_lenght": {"value": 0.05}, "rod_height": {"value": 0.01}}})",
            "/variables names the unknown design variable \"crank_lenght\"; did you mean "
            "\"crank_length\"?"},
           {R"({"variables": {"crank_length": {"start": 0.05}}})",
            "/variables/crank_length is missing the key \"value\""},
           {R"({"variables": {"crank_length": {"value": "50 kg"}}})",
            "/variables/crank_length/value must be a length [m], got \"50 kg\": \"kg\" "
            "measures something else"},
           {R"({"variables": {"crank_length": {"value": 50, "unit": "s"}}})",
            "/variables/crank_length/unit must be a length [m], got \"s\": \"s\" measures "
            "something else"},
           {R"({"variables": {"crank_length": {"value": 0.2}}})",
            "/variables/crank_length/value must lie within the bounds of 20 to 150 mm, got 0.2 in "
            "SI units"}}) {
    folder_.write("design.json", design);
    EXPECT_EQ(run(simulate + "design.json", 2).err, "pleuel: design.json: " + expected + "\n");
  }
  EXPECT_THAT(refusal(simulate + "none.json"), HasSubstr("none.json: there is no such file"));
}

/// Rounded sizes, as a drawing has them: crank_length and rod_height of the file, and a limit.
class RoundedDesign : public DesignOfARun {
 protected:
  std::string simulate(const std::string& more) const {
    return "simulate " + file_ + " -o run --overwrite " + more +
           R"( --set '/constraints={"length": {"linear": {"crank_length": 1}, "upper": "60 mm"}}')";
  }
  json of(const std::string& design, const std::string& more = "") const {
    folder_.write("rounded.json", design);
    return document(simulate("--design rounded.json " + more));
  }
  static json values(const json& run) {
    return {at(run, "variables/crank_length/value"), at(run, "variables/rod_height/value")};
  }
};

TEST_F(RoundedDesign, IsWrittenByHandInAnyUnit) {
  const json sizes({0.055, 0.02});
  const json plain = of(R"({"crank_length": "5.5 cm", "rod_height": 0.02})");
  EXPECT_EQ(values(plain), sizes);
  for (
      const char* design :
      {R"({"variables": {"crank_length": "5.5 cm", "rod_height": {"value": 2, "unit": "cm"}}})",
       R"({"variables": {"crank_length": {"value": 0.055}, "rod_height": {"value": 0.02}}})",
       R"({"variables": {"crank_length": {"value": "55 mm"}, "rod_height": {"value": "2 cm"}}})"}) {
    EXPECT_EQ(values(of(design)), sizes) << design;
    EXPECT_EQ(of(design).at("responses"), plain.at("responses")) << design;
  }
  // On the command line by the names of variables; a value there stands above that of the file.
  EXPECT_EQ(values(document(simulate("--set 'crank_length=55 mm' --set 'rod_height=20 mm'"))),
            sizes);
  EXPECT_EQ(values(of(R"({"crank_length": "50 mm", "rod_height": "20 mm"})",
                      "--set 'crank_length=55 mm'")),
            sizes);
}

TEST_F(RoundedDesign, SaysWhichOfItsSizesAreAtABound) {
  const std::string length = "/variables/crank_length";
  for (const auto& [change, reached] :
       {std::pair{"/lower=50 mm", "none"},
        {"/lower=55 mm", "lower"},
        {"/upper=55 mm", "upper"},
        {R"(={"start": "55 mm", "lower": "55 mm", "upper": "55 mm"})", "both"},
        // Far bounds are compared with themselves and with the start, 5 cm, not with the range.
        {"/upper=100 km", "none"}}) {
    const json size =
        at(document(simulate("--set 'crank_length=55 mm' --set '" + length + change + "'")),
           "variables/crank_length");
    EXPECT_EQ(size.value("at_bound", "none"), reached) << change;
  }
}

TEST_F(RoundedDesign, ThatBreaksALimitIsNoSuccess) {
  for (const auto& [words, code, is_kept] : {std::tuple{"crank_length=61 mm", 4, false},
                                             {"crank_length=60 mm", 0, true},
                                             // A start is no answer.
                                             {"/variables/crank_length/start=61 mm", 0, false}}) {
    const json looked = document(simulate(fmt::format("--set '{}'", words)), code);
    EXPECT_EQ(at(looked, "constraints/length/kept"), is_kept) << words;
  }
}

TEST_F(RoundedDesign, IsDrawnInAReportThatIsMadeLater) {
  of(R"({"crank_length": "55 mm", "rod_height": "20 mm"})", "--no-report --set 'rod_height=21 mm'");
  EXPECT_THAT(run("report run").out, Not(HasSubstr("Without the mechanism")));
}

}  // namespace
}  // namespace pleuel::test::design_test
