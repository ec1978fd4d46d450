#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "tests/cli/page_text.hpp"
#include "tests/cli/program.hpp"
#include "tests/cli/readback.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::check_test {
namespace {

using Check = InProgramFolder;

TEST_F(Check, FindsTheDerivativesOfEveryResponseRight) {
  const nlohmann::json document =
      exits(0, folder_.run_quick({"check", problem("slider_crank_round"), "--json"})).document();
  ASSERT_EQ(document.at("responses").size(), 8u);  // those of the file
  for (const auto& [name, response] : document.at("responses").items()) {
    const auto& derivatives = response.at("derivatives");
    EXPECT_EQ(derivatives.at("verdict"), "agrees") << name;
    EXPECT_LT(derivatives.at("adjoint_error"), 1e-10) << name;  // both exact: round-off
    ASSERT_EQ(derivatives.at("directions").size(), 1u);
    EXPECT_LE(derivatives.at("directions").at(0).at("error"), 1e-6) << name;
    EXPECT_GE(derivatives.at("directions").at(0).at("curve").size(), 4u);
  }
  EXPECT_EQ(document.at("directions").at(0).size(), 2u);           // both variables together
  for (const nlohmann::json& warning : document.at("warnings")) {  // of the model alone
    EXPECT_THAT(warning.get<std::string>(), HasSubstr("stubby: shear"));
  }
}

TEST_F(Check, WarnsOfNoiseAboveTheTolerance) {
  const std::vector<std::string> strict =
      joined(joined({"check", problem("slider_crank_round")}, quick()),
             {"--set", "/optimizer/tolerance=1e-13"});
  EXPECT_THAT(folder_.run(strict).out, HasSubstr("Set /optimizer/tolerance to"));
  const ProgramRun run = folder_.run(joined(strict, {"--json", "--jobs", "2"}));
  EXPECT_THAT(run.document().at("warnings").dump(), HasSubstr("Set /optimizer/tolerance to"));
}

TEST_F(Check, NamesTheToleranceWhereDerivativesOnlySeemWrong) {
  const ProgramRun run = exits(
      0, folder_.run({"check", problem("four_bar"), "--set", "/simulation/step=1 ms", "--set",
                      "/simulation/end_time=30 ms", "--set", "/simulation/newton_tolerance=1e-3"}));
  EXPECT_THAT(run.out, Not(HasSubstr("DIFFERS")));
  EXPECT_THAT(run.out, HasSubstr("/simulation/newton_tolerance is 0.001"));
}

TEST_F(Check, RefusesAnUnknownOptimizer) {
  const ProgramRun run = folder_.run(
      {"check", problem("slider_crank_round"), "--set", R"(/optimizer/backend="slsqp")"});
  EXPECT_THAT(exits(2, run).err, HasSubstr("/optimizer/backend"));
}

TEST_F(Check, CountsTheFreedomsThatAreLeft) {
  const auto rigid_motion = [&](const std::string& name) {
    return folder_.run({"check", problem(name), "--json", "--set", "/simulation/end_time=4 ms"})
        .document()
        .at("rigid_motion");
  };
  EXPECT_EQ(rigid_motion("hard/dead_centres").at("free"), 1);
  const auto driven = rigid_motion("hard/impossible_designs");
  EXPECT_EQ(driven.at("free"), 0);
  EXPECT_EQ(driven.at("drives"), 1);
}

TEST_F(Check, GivesAReasonForEveryEffect) {
  const ProgramRun run = folder_.run_quick({"check", problem("slider_crank_round"), "--json"});
  const nlohmann::json document = run.document();
  const auto effect_of = [&](const std::string& name, const std::string& body) {
    for (const auto& effect : document.at("effects")) {
      if (effect.at("name") == name && effect.value("body", "") == body) return effect;
    }
    return nlohmann::json{{"built", "missing"}, {"decision", ""}, {"reason", name}};
  };
  struct Expected {
    const char *name, *body;
    bool is_built;
    const char *decision, *reason;
  };
  // The file: all in the plane z = 0, stiffening "on", damping given, no gravity, no loads, no
  // tolerance.
  for (const Expected& expected :
       {Expected{"geometric_stiffening", "rod", true, "forced", "asked for"},
        Expected{"elasticity", "crank", true, "exact", "no tolerance"},
        Expected{"torsional_elasticity", "rod", false, "exact", "in a plane"},
        Expected{"damping", "", true, "exact", "given"},
        Expected{"gravity", "", false, "exact", "none is given"},
        Expected{"loads", "", false, "exact", "none are given"},
        Expected{"spatial_motion", "", false, "exact", "plane with normal (0, 0, 1)"}}) {
    const nlohmann::json effect = effect_of(expected.name, expected.body);
    EXPECT_EQ(effect.at("built"), expected.is_built) << effect;
    EXPECT_EQ(effect.at("decision"), expected.decision) << effect;
    EXPECT_THAT(effect.at("reason").get<std::string>(), HasSubstr(expected.reason));
  }
}

TEST_F(Check, WarnsOfAnUnstableScheme) {
  const std::vector<std::string> check = {"check", problem("slider_crank_exudyn"),
                                          "--set", "/simulation/end_time=10 ms",
                                          "--set", "/simulation/spectral_radius=1"};
  EXPECT_THAT(folder_.run(check).err, HasSubstr("unstable"));
  EXPECT_THAT(
      exits(0, folder_.run(joined(check, {"--set", "/simulation/formulation=stabilized-index-2"})))
          .err,
      Not(HasSubstr("unstable")));
}

TEST_F(Check, NeedsNoVariables) {
  EXPECT_THAT(exits(0, folder_.run({"check", problem("slider_crank_exudyn"), "--set",
                                    "/simulation/end_time=10 ms"}))
                  .out,
              HasSubstr("a valid problem"));
}

// Every command that shows numbers shows what speaks against them.

/// Rubber at 30 rad/s: bends by far more than linear elasticity describes.
const std::vector<std::string> too_soft = {problem("hard/soft_rod"), "--set",
                                           "/scene/joints/bearing/drive/speed=30 rad/s", "--set",
                                           "/simulation/end_time=0.6 s"};

std::vector<std::string> words(const std::string& command, const std::vector<std::string>& more) {
  return joined(joined({command}, too_soft), more);
}

void expect_warned(const std::string& command, const std::vector<std::string>& more) {
  const ProgramFolder folder;
  const std::vector<std::string> line = joined(words(command, more), {"-o", "run"});
  const bool has_folder = command != "check" && command != "gradient";
  const ProgramRun run = folder.run(has_folder ? line : words(command, more));
  EXPECT_THAT(unwrapped(run.out),
              AllOf(HasSubstr("Warning: "), HasSubstr("too far for linear elasticity")))
      << command << run.err;
}

using Warnings = InProgramFolder;

TEST_F(Warnings, OfADesignThatBendsTooFarAreShownByEveryCommandWithNumbers) {
  expect_warned("simulate", {});
  expect_warned("check", {});
  expect_warned("gradient", {});
  expect_warned("stability", {});
  expect_warned("uncertainty", {"--set", R"(/uncertainty={"parameters": {"rod_diameter":
                                             {"deviation": "0.1 mm"}}})"});
  expect_warned("accuracy", {"--set", R"(/accuracy={"steps": ["1 ms"], "elements": [2]})"});
}

/// A limit of 150 where 150 MPa are meant: told with the first design, before the search.
TEST_F(Warnings, OfALimitWithoutItsUnitComeBeforeTheSearch) {
  const ProgramRun run = folder_.run(
      {"optimize", problem("slider_crank_round"), "-o", "run", "--no-report", "--set",
       "/constraints/crank_strength/upper=150 Pa", "--set", "/optimizer/max_iterations=1", "--set",
       "/simulation/step=0.5 ms", "--set", "/simulation/end_time=20 ms", "--set",
       "/scene/joints/bearing/drive/ramp=20 ms"});
  const std::string text = unwrapped(run.err);
  EXPECT_THAT(text, HasSubstr("Warning: at the start the limit of \"crank_strength\" is 150 Pa"));
  EXPECT_THAT(text, HasSubstr("Is a unit missing"));
}

/// A sentence that is true of many runs is said once, with all of them behind it.
TEST_F(Warnings, ThatManyRunsShareNameAllOfThem) {
  const ProgramRun run =
      exits(0, folder_.run({"stability", problem("hard/dead_centres"), "-o", "run", "--set",
                            "/scene/gravity=[0, -981, 0]", "--set", "/simulation/end_time=4 ms"}));
  const auto document = folder_.result("run");
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
TEST_F(Warnings, AreAListOfEveryDocument) {
  for (const std::string command : {"simulate", "gradient", "check"}) {
    const ProgramRun run = folder_.run(words(command, {"--json"}));
    EXPECT_FALSE(run.document().at("warnings").empty()) << command;
    // With shear, which would change the deflections of such members by more than 1 %; those of a
    // crank of 12 mm are too large. Steps that resolve the peak of the rod's bow.
    const ProgramRun sound = folder_.run(joined(
        joined({command, problem("slider_crank_round"), "--json"}, quick()),
        {"--set", "/variables/rod_diameter/start=11 mm", "--set",
         "/variables/crank_diameter/start=15 mm", "--set", "/simulation/step=0.05 ms", "--set",
         "/scene/bodies/crank/shear=true", "--set", "/scene/bodies/rod/shear=true"}));
    EXPECT_EQ(sound.document().at("warnings").dump(), "[]") << command;
  }
}

/// The numbers are the same however closely they are looked at; without checks there are no bars, and a
/// warning says so.
TEST_F(Warnings, AreLookedForAsCloselyAsIsAskedFor) {
  const auto simulated = [&](const std::vector<std::string>& more) {
    return folder_
        .run(joined(joined({"simulate", problem("slider_crank_round"), "--json"}, quick()),
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
  const ProgramRun both = exits(
      2, folder_.run({"simulate", problem("slider_crank_round"), "--no-checks", "--all-checks"}));
}

/// The words of a report stay within a hundred columns; only what a shell is to read is not broken.
TEST_F(Warnings, FitIntoAHundredColumns) {
  const std::string text = folder_.run(words("simulate", {})).out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;
}

// The table of limits.

/// A beam that is to be three times as high as it is wide: 3 w − h ≤ 0.
ProgramRun simulate_with_width(const std::string& width) {
  const ProgramFolder folder;
  std::ofstream(folder.path() / "bar.json") << R"({"scene": {
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 1,
                         "section": {"type": "rectangle", "width": "= w", "height": "= h"}}},
      "joints": {"root": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": 0.001, "step": 0.001},
    "variables": {"w": {"start": "100 mm", "lower": "50 mm", "upper": "500 mm"},
                  "h": {"start": "300 mm", "lower": "50 mm", "upper": "500 mm"}},
    "responses": {"m": {"type": "mass"}},
    "constraints": {"slim": {"linear": {"w": 3, "h": -1}, "upper": 0}}})";
  return folder.run({"simulate", "bar.json", "--json", "--set", "w=" + width});
}

/// In floating point three times 0.1 is more than 0.3, by 5.6e-17.
TEST(LimitOfZeroOnVariables, IsKeptWhereItsTermsCancel) {
  for (const auto& [width, is_kept] :
       {std::pair("100 mm", true), std::pair("99.99 mm", true), std::pair("100.0001 mm", false)}) {
    const ProgramRun run = simulate_with_width(width);
    EXPECT_EQ(run.exit_code, is_kept ? 0 : 4) << run.err;
    const nlohmann::json limit = run.document().at("constraints").at("slim");
    EXPECT_EQ(limit.at("kept"), is_kept) << width;
    if (std::string(width) == "100 mm") {
      EXPECT_EQ(limit.at("value"), 0.0);
    }
  }
}

// Pages of mechanisms that are not simulated.

using nlohmann::json;

using Show = InProgramFolder;

TEST_F(Show, SaysWhatJointsLeaveFreeAndHowLongItTakes) {
  const ProgramRun run = folder_.run({"show", problem("four_bar"), "-o", "page.html"});
  EXPECT_THAT(run.out, HasSubstr("1 of 6"));
  EXPECT_THAT(run.out, HasSubstr("drive of the angle"));
  EXPECT_THAT(run.out, HasSubstr("Time: one simulation takes about "));
}

/// Some seven periods in place of one: more than the medians of some times of the same work ever differ,
/// which are taken in turns.
TEST_F(Show, ExpectsTheSearchForAMotionThatRepeatsItself) {
  const auto expected = [&](const std::string& start) {
    const ProgramRun run =
        folder_.run({"show", problem("running_press"), "-o", start + ".html", "--overwrite",
                     "--json", "--set", "/simulation/initial_state=" + start});
    return run.document().at("seconds").at("simulate").get<double>();
  };
  std::array<double, 5> periodic{}, consistent{};
  for (std::size_t i = 0; i < periodic.size(); ++i) {
    periodic[i] = expected("periodic");
    consistent[i] = expected("consistent");
  }
  std::ranges::sort(periodic);
  std::ranges::sort(consistent);
  EXPECT_GT(periodic[2], 2.0 * consistent[2]);
}

/// A link that nothing drives, holds or pulls, on the end of a driven crank.
TEST_F(Show, DrawsBodiesRedThatNothingMoves) {
  std::ofstream(folder_.path() / "loose.json") << R"({
    "scene": {
      "materials": {"steel": {"young": 2.1e11, "poisson": 0.3, "density": 7850}},
      "bodies": {
        "crank": {"type": "beam", "from": [0, 0, 0], "to": [0.1, 0, 0], "material": "steel",
                  "rigid": true, "elements": 1, "section": {"type": "circle", "diameter": 0.01}},
        "link": {"type": "beam", "from": [0.1, 0, 0], "to": [0.3, 0, 0], "material": "steel",
                 "rigid": true, "elements": 1, "section": {"type": "circle", "diameter": 0.01}}},
      "joints": {
        "hub": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                "drive": {"type": "constant-speed", "speed": 5}},
        "pin": {"type": "revolute", "bodies": ["crank", "link"], "at": [0.1, 0, 0]}
      }
    },
    "simulation": {"end_time": 0.1, "step": 1e-3},
    "responses": {"reach": {"type": "position", "body": "link", "at": 1, "direction": "x", "over_time": "final"}}
  })";
  const ProgramRun run = exits(0, folder_.run({"show", "loose.json", "-o", "page.html", "--json"}));
  EXPECT_EQ(run.document().at("unheld_bodies"), json({"link"}));
}

TEST_F(Show, SaysWhatStartsBent) {
  const ProgramRun run =
      exits(0, folder_.run({"show", problem("slider_crank_round"), "-o", "bent.html", "--set",
                            R"(/scene/bodies/rod/initial_deflections=[{"at": ["210 mm", 0, 0], )"
                            R"("direction": [0, 1, 0], "displacement": "2 mm"}])"}));
  const json bodies = data_of(folder_.path() / "bent.html").at("picture").at("scene").at("bodies");
  EXPECT_EQ(named(bodies, "rod").at("starts_bent").at("displacement"), 0.002);
  EXPECT_FALSE(named(bodies, "crank").contains("starts_bent"));
}

TEST_F(Show, SaysWhichJointsABodySlidesOn) {
  folder_.run({"show", problem("spatial_slider_crank"), "-o", "page.html"});
  const json joints = data_of(folder_.path() / "page.html").at("picture").at("scene").at("joints");
  EXPECT_EQ(named(joints, "guide").at("slides"), "along");
  EXPECT_EQ(named(joints, "guide").at("is_guide"), true);
  EXPECT_FALSE(named(joints, "bearing").contains("slides"));
  EXPECT_EQ(named(joints, "bearing").at("is_guide"), false);
}

TEST_F(Show, DrawsTheMechanismBeforeAnythingIsSimulated) {
  const ProgramRun run = exits(0, folder_.run({"show", problem("four_bar"), "-o", "page.html"}));
  EXPECT_THAT(run.out, HasSubstr("Drawn in page.html"));
  const std::vector<std::string> again = {"show", problem("four_bar"), "-o", "page.html"};
  EXPECT_THAT(exits(2, folder_.run(again)).err, HasSubstr("page.html: is there already"));
  exits(0, folder_.run(joined(again, {"--overwrite"})));
  const json picture = data_of(folder_.path() / "page.html").at("picture");
  const json& geometry = picture.at("designs")[0].at("geometry");
  EXPECT_EQ(geometry.at("bodies").size(), picture.at("scene").at("bodies").size());
  for (const json& joint : geometry.at("joints")) {
    EXPECT_EQ(joint.at("places").size(), 2u);
    EXPECT_EQ(joint.at("places")[0].at("at"), joint.at("places")[1].at("at"));
  }
}

// report.html of check and gradient.

TEST_F(Check, WritesAPageIfAFolderIsNamed) {
  const ProgramRun run =
      exits(0, folder_.run_quick({"check", problem("slider_crank_round"), "-o", "one"}));
  const json data = data_of(folder_.path() / "one/report.html");
  EXPECT_EQ(data.at("card").at("command"), "check");
  EXPECT_TRUE(data.at("result").at("responses").at("crank_stress").contains("derivatives"));
  EXPECT_FALSE(named(data.at("picture").at("designs"), "start").at("responses").empty());
}

TEST(GradientReport, ComparesAllMethods) {
  const ProgramFolder folder;
  EXPECT_THAT(exits(0, folder.run_quick(
                           {"gradient", problem("slider_crank_round"), "--compare", "-o", "one"}))
                  .out,
              HasSubstr("Effort and accuracy of the methods"));
  const json result = data_of(folder.path() / "one/report.html").at("result");
  // Two exact ones, and two differences with seven steps each.
  EXPECT_EQ(result.at("comparison").size(), 2u + 2u * 7u);
}

// Time and place of peaks.

/// A cantilever of 1 m whose tip is pushed by a bell of force in the middle of 2 s, slowly against
/// its period of 62 ms.
const char* const pushed = R"j({"name": "pushed", "scene": {
    "bodies": {"beam": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": "30 mm", "height": "20 mm"}, "elements": 4, "frame": "tangent"}},
    "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
    "loads": {"push": {"type": "force", "body": "beam", "at": [1, 0, 0], "direction": [0, -1, 0],
      "value": {"type": "expression", "value": "= 20 N*exp(-(4*(t/(1 s) - 1))^2)"}}}},
  "simulation": {"end_time": 2, "step": "2 ms"},
  "responses": {
    "root": {"type": "stress", "body": "beam", "over_time": "max"},
    "quarter": {"type": "deflection", "body": "beam", "at": 0.25, "over_time": "max-abs"},
    "end": {"type": "deflection", "body": "beam", "at": 1, "over_time": "final"}}})j";

TEST(Peaks, AreShownWithTimeAndPlace) {
  const ProgramFolder folder;
  std::ofstream(folder.path() / "pushed.json") << pushed;
  const ProgramRun run = exits(0, folder.run({"simulate", "pushed.json", "-o", "run"}));
  const json responses = folder.result("run").at("responses");
  for (const auto& [name, share] : {std::pair("root", 0.0), std::pair("quarter", 0.25)}) {
    const json& peak = responses.at(name).at("peak");
    EXPECT_NEAR(peak.at("time").get<double>(), 1.0, 0.02) << name;
    EXPECT_DOUBLE_EQ(peak.at("share").get<double>(), share) << name;
    EXPECT_FALSE(peak.at("place").get<std::string>().empty()) << name;
  }
  EXPECT_FALSE(responses.at("end").contains("peak"));
  EXPECT_THAT(run.out, HasSubstr("peak at"));
  EXPECT_THAT(run.out, HasSubstr(" s, 0 of the length\n"));
  EXPECT_THAT(run.out, HasSubstr(" s, 0.25 of the length\n"));
  EXPECT_THAT(run.out + run.err, Not(HasSubstr("the start decides")));
}

}  // namespace
}  // namespace pleuel::test::check_test
