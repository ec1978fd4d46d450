#include <cstdlib>
#include <memory>
#include <sstream>

#include "tests/cli/page_text.hpp"
#include "tests/cli/program.hpp"

namespace pleuel::test::optimize_test {
namespace {

namespace fs = std::filesystem;

using Optimize = InProgramFolder;

TEST_F(Optimize, GivesADocumentWithTheDocumentedKeys) {
  const json found = document("optimize $crank $quick");
  for (const char* key :
       {"status", "message", "backend", "objective", "variables", "constraints", "kkt_residual",
        "max_violation", "evaluations", "gradient_evaluations", "iterations", "seconds"}) {
    EXPECT_TRUE(found.contains(key)) << key;
  }
  EXPECT_EQ(found.at("status"), "verified");
  EXPECT_EQ(at(found, "objective/unit"), "kg");
  EXPECT_LT(at(found, "objective/value"), at(found, "objective/start"));
  for (const auto& [name, constraint] : found.at("constraints").items()) {
    // The limits hold to the tolerance of the verdict.
    EXPECT_LE(number(constraint, "value"), number(constraint, "limit") * (1 + 1e-4)) << name;
    EXPECT_TRUE(constraint.contains("multiplier")) << name;
  }
  for (const auto& [name, variable] : found.at("variables").items()) {
    EXPECT_EQ(variable.at("unit"), "m") << name;
    EXPECT_GE(variable.at("value"), variable.at("lower")) << name;
    EXPECT_LE(variable.at("value"), variable.at("upper")) << name;
  }
}

/// A screen of 80 columns and 40 lines has the whole answer; --verbose has the audit, too.
TEST_F(Optimize, FitsAScreen) {
  const std::string line = "optimize $problems/slider_crank.json --set '/simulation/step=0.2 ms'";
  ::setenv("COLUMNS", "80", 1);
  const std::string out = run(line + " -o one").out;
  ::unsetenv("COLUMNS");
  std::istringstream lines(out);
  int count = 0;
  for (std::string one; std::getline(lines, one); ++count) {
    const auto is_first = [](char c) { return (c & 0xC0) != 0x80; };  // of a UTF-8 character
    EXPECT_LE(std::ranges::count_if(one, is_first), 80) << one;
  }
  EXPECT_LE(count, 40);
  EXPECT_THAT(out, AllOf(HasSubstr("\nVERIFIED: every limit holds; "), Not(HasSubstr("Audit: "))));
  EXPECT_THAT(run(line + " --verbose -o two").out,
              AllOf(HasSubstr("\nAudit: a local optimum: "), HasSubstr("at +1 % limit"),
                    HasSubstr("\nDrive bearing: ")));
}

/// Whatever makes the gradients, the optimum is the same: within the tolerance of the optimizer.
TEST_F(Optimize, MayUseAnyGradients) {
  const json chosen = document("optimize $crank $quick");
  EXPECT_EQ(at(chosen, "gradients/method"), "direct");
  const double expected = number(chosen, "objective/value");
  for (const std::string method : {"adjoint", "central-difference"}) {
    const json found = document("optimize $crank $quick --method " + method);
    EXPECT_EQ(at(found, "gradients/method"), method);
    EXPECT_EQ(at(found, "gradients/reason"), "asked for");
    EXPECT_NEAR(number(found, "objective/value"), expected, 1e-5 * expected) << method;
  }
  const json of_file =
      document(R"(optimize $crank $quick --set '/sensitivity={"method": "adjoint"}')");
  EXPECT_EQ(at(of_file, "gradients/method"), "adjoint");
}

/// Iterations are those of the backend, designs of the audit are none.
TEST_F(Optimize, TellsStepsFromTheAuditInItsHistory) {
  const std::string out = run("optimize $crank $quick -o run").out;
  const CsvRows history = folder_.csv("run/history.csv");
  const std::vector<double> iterations = numbers(history, "iteration");
  const std::vector<std::string> purposes = column(history, "purpose");
  int last = 0, audits = 0;
  for (std::size_t k = 0; k < iterations.size(); ++k) {
    if (purposes[k] == "audit") {
      ++audits;
      EXPECT_EQ(iterations[k], last) << k;
    }
    last = static_cast<int>(iterations[k]);
  }
  EXPECT_GE(audits, 6);
  EXPECT_THAT(out, AllOf(HasSubstr("audit"), Not(HasSubstr(fmt::format("\n  {:>9}  ", last + 1)))));
}

TEST_F(Optimize, StartsInItsTablesWhereTheRunBegan) {
  folder_.write("design.json", R"({"crank_diameter": "25 mm", "rod_diameter": "20 mm"})");
  const std::string out = run("optimize $crank $quick -o run --design design.json "
                              "--set /optimizer/max_iterations=1",
                              4)
                              .out;
  EXPECT_EQ(number(result(), "variables/crank_diameter/start"), 0.025);
  EXPECT_EQ(number(result(), "variables/rod_diameter/start"), 0.020);
  EXPECT_THAT(out, ContainsRegex("\n +crank_diameter +25\\.000 "));
  EXPECT_THAT(out, ContainsRegex("\n +rod_diameter +20\\.000 "));
}

TEST_F(Optimize, CannotVerifyWhatNoDesignCanKeep) {
  const json found = document(
      "optimize $crank $quick -o run --set /optimizer/max_iterations=10 "
      "--set '/constraints/rod_stiffness/upper=1e-9 mm'",
      4);
  EXPECT_EQ(found.at("status"), "infeasible");
  EXPECT_THAT(
      found.at("message").get<std::string>(),
      AllOf(HasSubstr("rod_stiffness ≤ 1e-09 mm cannot be kept"),
            HasSubstr("One change would do: rod_stiffness ≤ 0.00"), Not(HasSubstr("between"))));
  EXPECT_TRUE(at(found, "least_violation/proven"));
  for (const auto& [name, constraint] : found.at("constraints").items()) {
    EXPECT_FALSE(constraint.contains("multiplier")) << name << ": a price where none can be";
  }
  const double violation = number(found, "max_violation");
  double least = violation;
  for (const double one : numbers(folder_.csv("run/history.csv"), "max_violation")) {
    if (!std::isnan(one)) least = std::min(least, one);
  }
  EXPECT_NEAR(violation, least, 1e-12 * least);
}

/// Coarser steps have room, half of them do not.
TEST_F(Optimize, NamesTheRunThatWouldTellItsErrors) {
  EXPECT_THAT(unwrapped(run(R"(optimize $crank --no-report --set '/simulation/step=0.4 ms' )"
                            R"(--set '/sensitivity={"memory": "60 kB"}')",
                            4)
                            .out),
              AllOf(HasSubstr("A run that would tell failed: /sensitivity/memory is too little"),
                    Not(HasSubstr("nan"))));
}

TEST_F(Optimize, AStartThatCannotBeSimulatedIsASimulationFailure) {
  EXPECT_EQ(
      document("optimize $crank $quick --set /simulation/max_newton_iterations=1", 3).at("status"),
      "failed");
}

/// Rubber at 30 rad/s bends too far for linear elasticity, wherever one iteration leads.
TEST_F(Optimize, SaysWhereLinearElasticityIsLeft) {
  const ProgramRun soft = run_line(folder_.path(),
                                   "optimize $problems/hard/soft_rod.json -o run "
                                   "--set '/scene/joints/bearing/drive/speed=30 rad/s' "
                                   R"(--set '/objective={"minimize": "rod_bow"}' )"
                                   R"(--set '/optimizer={"max_iterations": 1}')");
  EXPECT_THAT(unwrapped(soft.out), HasSubstr("too far for linear elasticity"));
  EXPECT_GT(number(result(), "monitors/elastic_rotation"), 0.2);
  EXPECT_THAT(run("optimize $crank $quick").out, Not(HasSubstr("linear elasticity")));
}

TEST_F(Optimize, BackendOfTheCommandLineWinsOverThatOfTheFile) {
  const json found = document("optimize $crank $quick --backend ipopt");
  EXPECT_EQ(found.at("backend"), "ipopt");
  EXPECT_EQ(found.at("status"), "verified");
}

// report.html of an optimization: the data that the program puts into the page.

class OptimizationReport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ProgramFolder>();
    out_ = folder_->run("optimize $crank $quick --verbose -o one").out;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static const ProgramFolder& folder() { return *folder_; }
  static json data(const std::string& run = "one") {
    return data_of(folder() / (run + "/report.html"));
  }
  static json optimum() { return named(at(data(), "picture/designs"), "optimum"); }

  /// A run folder with a file of another content, and what `report` makes of it.
  static ProgramRun report_with(const std::string& file, const std::string& text, int exit_code) {
    fs::remove_all(folder() / "copy");
    fs::copy(folder() / "one", folder() / "copy");
    fs::remove(folder() / "copy/report.html");
    folder().write("copy/" + file, text);
    return folder().run("report copy", exit_code);
  }

  inline static std::unique_ptr<ProgramFolder> folder_;
  inline static std::string out_;
};

TEST_F(OptimizationReport, IsWrittenBesideTheResultAndSaidSo) {
  EXPECT_THAT(out_, HasSubstr("Report: one/report.html"));
  EXPECT_EQ(data().at("result"), folder().result("one"));
  EXPECT_EQ(at(data(), "card/command"), "optimize");
  EXPECT_EQ(at(data(), "files/history.csv"), folder().text("one/history.csv"));
  EXPECT_THAT(folder().text("one/report.html"), HasSubstr("after the data"));
  EXPECT_THAT(folder().text("one/result.json"), StartsWith("{\n  \"version\": 1,\n"));
}

/// To the seven digits of what is drawn.
TEST_F(OptimizationReport, ShowsHistoriesWithThePeaksOfTheResult) {
  const json all = data();
  int peaks = 0;
  const json responses = optimum().at("responses");
  for (const json& response : responses) {
    const std::string name = response.at("name");
    const double value = number(all, "result/responses/" + name + "/value");
    EXPECT_EQ(response.at("value"), value) << name;
    if (at(all, "picture/responses/" + name + "/over_time") != "max") continue;
    if (!response.contains("history")) continue;
    const std::vector<float> curve = unpacked(response.at("history"));
    const std::size_t rows = at(response, "history/rows");
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
  const json picture = data().at("picture");
  const json& bodies = picture.at("scene").at("bodies");
  const auto slider =
      std::ranges::find_if(bodies, [](const json& one) { return one.at("name") == "slider"; }) -
      bodies.begin();
  for (const json& design : picture.at("designs")) {
    const std::vector<float> places =
        unpacked(at(design, fmt::format("motion/bodies/{}/positions", slider)));
    EXPECT_NEAR(places[places.size() - 3],
                number(named(design.at("responses"), "slider_end"), "value"), 1e-6);
    EXPECT_NEAR(places[places.size() - 2], 0.0, 1e-6) << "the guide holds it on the x axis";
  }
}

/// The drive's torque is a response, too: its peak between steps, on a parabola.
TEST_F(OptimizationReport, SummarySaysWhatTheDriveNeeds) {
  const std::string begin = "Drive bearing: torque ", arrow = " → ";
  const std::size_t place = out_.find(begin);
  ASSERT_NE(place, std::string::npos) << out_;
  const double before = std::stod(out_.substr(place + begin.size()));
  const double after = std::stod(out_.substr(out_.find(arrow, place) + arrow.size()));
  const json torque = at(folder().result("one"), "responses/torque_peak");
  EXPECT_NEAR(before, number(torque, "start"), 2e-3 * before);
  EXPECT_NEAR(after, number(torque, "value"), 2e-3 * after);
}

/// The command makes from the card what the run made from its own numbers.
TEST_F(OptimizationReport, CanBeMadeLater) {
  const json before = data().at("picture");
  fs::remove(folder() / "one/report.html");
  folder().run("report one");
  EXPECT_EQ(data().at("picture"), before);
}

/// The influence of the variables is that of the gradients in the result; of the mass in closed
/// form: m = ρ π/4 Σ L d², so that d ln m / d ln d₁ = 2 L₁ d₁² / Σ L d².
TEST_F(OptimizationReport, ShowsWhatEachVariableChanges) {
  const json found = data().at("result");
  const double crank = number(found, "variables/crank_diameter/value");
  const double rod = number(found, "variables/rod_diameter/value");
  const json mass = named(optimum().at("responses"), "crank_and_rod");
  EXPECT_EQ(mass.at("gradients"), at(found, "responses/crank_and_rod/gradients"));
  const double expected = 2 * 0.12 * crank * crank / (0.12 * crank * crank + 0.18 * rod * rod);
  EXPECT_NEAR(number(mass, "gradients/crank_diameter") * crank / number(mass, "value"), expected,
              1e-9);
  const json stress = named(optimum().at("responses"), "crank_stress");
  EXPECT_EQ(stress.at("slopes").size(), 2u) << "a curve a variable";
  EXPECT_GE(number(stress, "peak_share"), 0.0);
  EXPECT_LE(number(stress, "peak_share"), 1.0);
}

TEST_F(OptimizationReport, OfADamagedResultIsRefused) {
  for (const char* text : {"{}", R"({"status": "verified", "objective": 3})", "", "[1", "null"}) {
    EXPECT_THAT(report_with("result.json", text, 2).err, HasSubstr("copy/result.json: is")) << text;
    EXPECT_FALSE(folder().has("copy/report.html")) << text;
  }
  json result = folder().result("one");
  result["variables"]["rod_diameter"]["value"] = "wide";
  EXPECT_THAT(report_with("result.json", result.dump(), 2).err,
              HasSubstr("is damaged: the variable \"rod_diameter\" has no value"));
}

TEST_F(OptimizationReport, OfADamagedTrajectorySaysWhatIsMissing) {
  const std::string whole = folder().text("one/trajectory-optimum.csv");
  const auto report_of_first = [&](std::size_t letters) {
    return unwrapped(report_with("trajectory-optimum.csv", whole.substr(0, letters), 0).out);
  };
  EXPECT_THAT(report_of_first(whole.find('\n', 3000) + 10),
              HasSubstr("Note: histories have no error bands: "
                        "copy/trajectory-optimum.csv: is damaged: line "));
  EXPECT_THAT(report_of_first(whole.find('\n', whole.size() / 2) + 1),
              HasSubstr("instants, the simulation has"));
}

TEST_F(OptimizationReport, NamesFilesThatAreTooLargeForAPage) {
  EXPECT_EQ(data().at("left_out"), json::array());
  report_with("history.csv", std::string(3'100'000, '\n'), 0);
  EXPECT_EQ(data("copy").at("left_out"), json::array({"history.csv"}));
  EXPECT_FALSE(data("copy").at("files").contains("history.csv"));
}

TEST_F(OptimizationReport, IsNotPromisedWhereItCannotBeWritten) {
  fs::copy(folder() / "one", folder() / "blocked");
  fs::remove(folder() / "blocked/report.html");
  fs::create_directory(folder() / "blocked/report.html");
  const ProgramRun blocked = folder().run("report blocked", 1);
  EXPECT_THAT(blocked.out, Not(HasSubstr("Report:")));
  EXPECT_THAT(blocked.err, HasSubstr("blocked/report.html cannot be written"));
}

// report.html: pages of any run, and where there is none.

class PageOfARun : public InProgramFolder {
 protected:
  json picture() const { return data_of(folder_ / "run/report.html").at("picture"); }
};

/// Peaks of each case's own history, as in the result.
TEST_F(PageOfARun, OfLoadCasesHasThePicturesOfAll) {
  run("optimize $problems/two_loads.json -o run");
  const json drawn = picture(), found = result();
  EXPECT_EQ(drawn.at("case"), at(found, "cases/shown"));
  std::vector<json> pictures = {drawn};
  for (const json& other : drawn.at("other_cases")) pictures.push_back(other);
  ASSERT_EQ(pictures.size(), 2u);
  for (const json& one : pictures) {
    const std::string name = one.at("case");
    const json optimum = named(one.at("designs"), "optimum");
    const json stress = named(optimum.at("responses"), "rod_stress");
    EXPECT_EQ(stress.at("value"), at(found, "responses/rod_stress [" + name + "]/value"));
    EXPECT_GT(unpacked(stress.at("history")).size(), 300u) << name;
    EXPECT_TRUE(optimum.contains("motion")) << name;
  }
  EXPECT_FALSE(pictures[1].at("limits").contains("rod_strength")) << "it is one of \"heavy\"";
  EXPECT_EQ(at(drawn, "units/responses/rod_bow [fast]/name"), "mm");
  EXPECT_EQ(at(drawn, "units/limits/rod_strength [heavy]/name"), "MPa");
  fs::remove(folder_ / "run/report.html");
  run("report run");
  EXPECT_EQ(picture(), drawn);
}

/// An optimization may end with effects that it left out where it began.
TEST_F(PageOfARun, IsOfTheEffectsThatTheResultNames) {
  run_line(folder_.path(),
           "optimize $crank $quick -o run --set /effects/tolerance=0.03 "
           "--set /effects/geometric_stiffening=auto");
  const json drawn = picture();
  run("report run");
  EXPECT_TRUE(picture() == drawn);
  json document = result();
  int turned = 0;
  for (json& effect : document.at("effects")) {
    if (effect.at("name") != "geometric_stiffening") continue;
    effect["built"] = !effect["built"].get<bool>();
    ++turned;
  }
  EXPECT_EQ(turned, 2);
  folder_.write("run/result.json", document);
  run("report run");
  EXPECT_FALSE(picture() == drawn);
}

/// Damage is a sum over cycles, an integral has the unit of its history times seconds.
TEST_F(PageOfARun, DrawsLimitsOnlyIntoHistoriesThatTheyAreOf) {
  run("simulate $crank $quick -o run "
      R"(--set '/responses/swept={"type": "deflection", "body": "rod", "at": 0.5, "over_time": "integral"}' )"
      R"(--set '/responses/damage={"type": "fatigue-damage", "body": "rod", "criterion": "goodman"}' )"
      R"(--set '/constraints/swept_limit={"response": "swept", "upper": 1}' )"
      R"(--set '/constraints/life={"response": "damage", "upper": 1e-6}' )"
      R"(--set '/scene/materials/steel/ultimate_strength=600 MPa' )"
      R"(--set '/scene/materials/steel/fatigue_strength=900 MPa' )"
      R"(--set /scene/materials/steel/fatigue_exponent=8)");
  const json responses = picture().at("responses");
  EXPECT_EQ(at(responses, "swept/limits_history"), false);
  EXPECT_EQ(at(responses, "swept/unit/name"), "mm s");
  EXPECT_EQ(at(responses, "swept/history_unit/name"), "mm");
  EXPECT_EQ(at(responses, "damage/limits_history"), false);
  EXPECT_EQ(at(responses, "rod_stress/limits_history"), true);
  run("plot run swept");
  EXPECT_THAT(folder_.text("run/plot-swept.svg"), Not(HasSubstr("class=\"limit\"")));
}

TEST_F(PageOfARun, IsLeftOutIfTheUserSaysSo) {
  EXPECT_THAT(run("simulate $crank $quick -o run --no-report").out, Not(HasSubstr("eport")));
  EXPECT_FALSE(folder_.has("run/report.html"));
}

TEST_F(PageOfARun, WithoutTemplateIsOneSentence) {
  const ProgramRun without =
      run("--version >/dev/null; PLEUEL_REPORT_TEMPLATE=/nowhere $pleuel simulate $crank $quick "
          "-o run");
  EXPECT_FALSE(folder_.has("run/report.html"));
  EXPECT_THAT(unwrapped(without.out), AllOf(HasSubstr("No report.html: its template is not built"),
                                            HasSubstr("report run")));
}

/// A name must not end the script element that holds the data.
TEST_F(PageOfARun, HoldsNamesThatLookLikeTags) {
  const std::string name = "</script><script>alert(1)</script><!--";
  run("simulate $crank $quick -o run --set '/name=" + name + "'");
  EXPECT_EQ(picture().at("name"), name);
  EXPECT_THAT(folder_.text("run/report.html"), Not(HasSubstr("<script>alert")));
}

TEST_F(PageOfARun, OfAnUnknownFolderIsRefused) {
  EXPECT_THAT(refusal("report nothing"), HasSubstr("nothing: there is no such run folder"));
  const std::string said = refusal("simulate $crank -o " + std::string(300, 'a'));
  EXPECT_THAT(said, AllOf(HasSubstr("File name too long"), Not(HasSubstr("fault of the program"))));
  EXPECT_LT(said.size(), 250u);
}

}  // namespace
}  // namespace pleuel::test::optimize_test
