#include <algorithm>
#include <array>
#include <sstream>

#include "tests/cli/page_text.hpp"
#include "tests/cli/program.hpp"

namespace pleuel::test::check_test {
namespace {

using Check = InProgramFolder;

TEST_F(Check, FindsTheDerivativesOfEveryResponseRight) {
  const json checked = document("check $crank $quick");
  ASSERT_EQ(checked.at("responses").size(), 8u);  // those of the file
  for (const auto& [name, response] : checked.at("responses").items()) {
    const json& derivatives = response.at("derivatives");
    EXPECT_EQ(derivatives.at("verdict"), "agrees") << name;
    EXPECT_LT(derivatives.at("adjoint_error"), 1e-10) << name;  // both exact: round-off
    ASSERT_EQ(derivatives.at("directions").size(), 1u);
    EXPECT_LE(number(derivatives, "directions/0/error"), 1e-6) << name;
    EXPECT_GE(at(derivatives, "directions/0/curve").size(), 4u);
  }
  EXPECT_EQ(at(checked, "directions/0").size(), 2u);    // both variables together
  for (const json& warning : checked.at("warnings")) {  // of the model alone
    EXPECT_THAT(warning.get<std::string>(), HasSubstr("stubby: shear"));
  }
}

TEST_F(Check, WarnsOfNoiseAboveTheTolerance) {
  const std::string strict = "check $crank $quick --set /optimizer/tolerance=1e-13";
  EXPECT_THAT(run(strict).out, HasSubstr("Set /optimizer/tolerance to"));
  EXPECT_THAT(document(strict + " --jobs 2").at("warnings").dump(),
              HasSubstr("Set /optimizer/tolerance to"));
}

TEST_F(Check, NamesTheToleranceWhereDerivativesOnlySeemWrong) {
  const std::string out = run("check $problems/four_bar.json --set '/simulation/step=1 ms' "
                              "--set '/simulation/end_time=30 ms' "
                              "--set /simulation/newton_tolerance=1e-3")
                              .out;
  EXPECT_THAT(out,
              AllOf(Not(HasSubstr("DIFFERS")), HasSubstr("/simulation/newton_tolerance is 0.001")));
}

TEST_F(Check, CountsTheFreedomsThatAreLeft) {
  const auto rigid_motion = [&](const std::string& name) {
    return document("check $problems/hard/" + name + ".json --set '/simulation/end_time=4 ms'")
        .at("rigid_motion");
  };
  EXPECT_EQ(rigid_motion("dead_centres").at("free"), 1);
  const json driven = rigid_motion("impossible_designs");
  EXPECT_EQ(driven.at("free"), 0);
  EXPECT_EQ(driven.at("drives"), 1);
}

TEST_F(Check, GivesAReasonForEveryEffect) {
  const json effects = document("check $crank $quick").at("effects");
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
    const auto effect = std::ranges::find_if(effects, [&](const json& one) {
      return one.at("name") == expected.name && one.value("body", "") == expected.body;
    });
    ASSERT_NE(effect, effects.end()) << expected.name;
    EXPECT_EQ(effect->at("built"), expected.is_built) << *effect;
    EXPECT_EQ(effect->at("decision"), expected.decision) << *effect;
    EXPECT_THAT(effect->at("reason").get<std::string>(), HasSubstr(expected.reason));
  }
}

TEST_F(Check, WarnsOfAnUnstableSchemeAndNeedsNoVariables) {
  const std::string check =
      "check $problems/slider_crank_exudyn.json --set '/simulation/end_time=10 ms' ";
  EXPECT_THAT(run(check).out, HasSubstr("a valid problem"));
  const std::string without_damping = check + "--set /simulation/spectral_radius=1";
  EXPECT_THAT(run(without_damping).err, HasSubstr("unstable"));
  EXPECT_THAT(run(without_damping + " --set /simulation/formulation=stabilized-index-2").err,
              Not(HasSubstr("unstable")));
}

// Every command that shows numbers shows what speaks against them.

/// Rubber at 30 rad/s: bends by far more than linear elasticity describes.
const std::string too_soft =
    " $problems/hard/soft_rod.json --set '/scene/joints/bearing/drive/speed=30 rad/s' "
    "--set '/simulation/end_time=0.6 s' ";

using Warnings = InProgramFolder;

TEST_F(Warnings, OfADesignThatBendsTooFarAreShownByEveryCommandWithNumbers) {
  for (const auto& [command, options] :
       {std::pair{"simulate", ""},
        {"check", ""},
        {"gradient", ""},
        {"stability", ""},
        {"uncertainty",
         R"(--set '/uncertainty={"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}}')"},
        {"accuracy", R"(--set '/accuracy={"steps": ["1 ms"], "elements": [2]}')"}}) {
    EXPECT_THAT(unwrapped(run(command + too_soft + options).out),
                AllOf(HasSubstr("Warning: "), HasSubstr("too far for linear elasticity")))
        << command;
  }
}

/// A limit of 150 where 150 MPa are meant: told with the first design, before the search.
TEST_F(Warnings, OfALimitWithoutItsUnitComeBeforeTheSearch) {
  const std::string said =
      run("optimize $crank -o run --no-report $quick "
          "--set '/constraints/crank_strength/upper=150 Pa' --set /optimizer/max_iterations=1 "
          "--set '/simulation/step=0.5 ms'",
          4)
          .err;
  EXPECT_THAT(unwrapped(said),
              AllOf(HasSubstr("Warning: at the start the limit of \"crank_strength\" is 150 Pa"),
                    HasSubstr("Is a unit missing")));
}

/// A sentence that is true of many runs is said once, with all of them behind it.
TEST_F(Warnings, ThatManyRunsShareNameAllOfThem) {
  const std::string text =
      unwrapped(run("stability $problems/hard/dead_centres.json -o run "
                    "--set '/scene/gravity=[0, -981, 0]' --set '/simulation/end_time=4 ms'")
                    .out);
  const json formulations = result().at("formulations");
  std::string all;
  for (const std::string formulation : formulations) {
    all += (all.empty() ? "(dead_centres, " : ", dead_centres, ") + formulation;
  }
  const std::string warning = "Warning: /scene/gravity is 981 m/s²";
  EXPECT_EQ(formulations.size(), 7u);
  ASSERT_THAT(text, HasSubstr(warning));
  EXPECT_EQ(text.find(warning), text.rfind(warning)) << "said more than once";
  EXPECT_THAT(text.substr(text.find(warning)), HasSubstr(all + ")"));
}

/// The sentence is in the documents, too.
TEST_F(Warnings, AreAListOfEveryDocument) {
  for (const std::string command : {"simulate", "gradient", "check"}) {
    EXPECT_FALSE(document(command + too_soft).at("warnings").empty()) << command;
    // With shear, which would change the deflections of such members by more than 1 %; those of a
    // crank of 12 mm are too large. Steps that resolve the peak of the rod's bow.
    const json sound =
        document(command +
                 " $crank $quick --set '/variables/rod_diameter/start=11 mm' "
                 "--set '/variables/crank_diameter/start=15 mm' --set '/simulation/step=0.05 ms' "
                 "--set /scene/bodies/crank/shear=true --set /scene/bodies/rod/shear=true");
    EXPECT_EQ(sound.at("warnings").dump(), "[]") << command;
  }
}

/// The numbers are the same however closely they are looked at; without checks there are no bars, and a
/// warning says so.
TEST_F(Warnings, AreLookedForAsCloselyAsIsAskedFor) {
  const std::string simulate = "simulate $crank $quick --set '/simulation/step=0.1 ms' ";
  const json none = document(simulate + "--no-checks"), usual = document(simulate),
             all = document(simulate + "--all-checks");
  ASSERT_EQ(none.at("warnings").size(), 1u);
  EXPECT_THAT(at(none, "warnings/0").get<std::string>(), HasSubstr("not looked for"));
  for (const auto& [name, response] : usual.at("responses").items()) {
    EXPECT_EQ(response.at("value"), at(none, "responses/" + name + "/value")) << name;
    EXPECT_EQ(response.at("value"), at(all, "responses/" + name + "/value")) << name;
    EXPECT_FALSE(at(none, "responses/" + name).contains("error")) << name;
  }
  refusal("simulate $crank --no-checks --all-checks");
}

/// The words of a report stay within a hundred columns; only what a shell is to read is not broken.
TEST_F(Warnings, FitIntoAHundredColumns) {
  std::istringstream lines(run("simulate" + too_soft).out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << line;
}

/// A beam that is to be three times as high as it is wide: 3 w − h ≤ 0. In floating point three
/// times 0.1 is more than 0.3, by 5.6e-17.
TEST_F(Check, LimitOfZeroOnVariablesIsKeptWhereItsTermsCancel) {
  folder_.write("bar.json", R"({"scene": {
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 1,
                         "section": {"type": "rectangle", "width": "= w", "height": "= h"}}},
      "joints": {"root": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": 0.001, "step": 0.001},
    "variables": {"w": {"start": "100 mm", "lower": "50 mm", "upper": "500 mm"},
                  "h": {"start": "300 mm", "lower": "50 mm", "upper": "500 mm"}},
    "responses": {"m": {"type": "mass"}},
    "constraints": {"slim": {"linear": {"w": 3, "h": -1}, "upper": 0}}})");
  for (const auto& [width, is_kept] :
       {std::pair("100 mm", true), {"99.99 mm", true}, {"100.0001 mm", false}}) {
    const json limit =
        at(document(fmt::format("simulate bar.json --set 'w={}'", width), is_kept ? 0 : 4),
           "constraints/slim");
    EXPECT_EQ(limit.at("kept"), is_kept) << width;
    if (std::string(width) == "100 mm") {
      EXPECT_EQ(limit.at("value"), 0.0);
    }
  }
}

// Pages of mechanisms that are not simulated.

class Show : public InProgramFolder {
 protected:
  json picture() const { return data_of(folder_ / "page.html").at("picture"); }
};

TEST_F(Show, DrawsTheMechanismBeforeAnythingIsSimulated) {
  const std::string line = "show $problems/four_bar.json -o page.html";
  // What joints leave free, and how long it takes.
  EXPECT_THAT(run(line).out, AllOf(HasSubstr("Drawn in page.html"), HasSubstr("1 of 6"),
                                   HasSubstr("drive of the angle"),
                                   HasSubstr("Time: one simulation takes about ")));
  EXPECT_THAT(refusal(line), HasSubstr("page.html: is there already"));
  run(line + " --overwrite");
  const json geometry = at(picture(), "designs/0/geometry");
  EXPECT_EQ(geometry.at("bodies").size(), at(picture(), "scene/bodies").size());
  for (const json& joint : geometry.at("joints")) {
    EXPECT_EQ(joint.at("places").size(), 2u);
    EXPECT_EQ(at(joint, "places/0/at"), at(joint, "places/1/at"));
  }
}

/// Some seven periods in place of one: more than the medians of some times of the same work ever differ,
/// which are taken in turns.
TEST_F(Show, ExpectsTheSearchForAMotionThatRepeatsItself) {
  const auto expected = [&](const std::string& start) {
    return number(document("show $problems/running_press.json -o page.html --overwrite "
                           "--set /simulation/initial_state=" +
                           start),
                  "seconds/simulate");
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
  folder_.write("loose.json", R"({
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
        "pin": {"type": "revolute", "bodies": ["crank", "link"], "at": [0.1, 0, 0]}}},
    "simulation": {"end_time": 0.1, "step": 1e-3},
    "responses": {"reach": {"type": "position", "body": "link", "at": 1, "direction": "x", "over_time": "final"}}
  })");
  EXPECT_EQ(document("show loose.json -o page.html").at("unheld_bodies"), json({"link"}));
}

TEST_F(Show, SaysWhatStartsBent) {
  run(R"(show $crank -o page.html --set '/scene/bodies/rod/initial_deflections=[)"
      R"({"at": ["210 mm", 0, 0], "direction": [0, 1, 0], "displacement": "2 mm"}]')");
  const json bodies = at(picture(), "scene/bodies");
  EXPECT_EQ(number(named(bodies, "rod"), "starts_bent/displacement"), 0.002);
  EXPECT_FALSE(named(bodies, "crank").contains("starts_bent"));
}

TEST_F(Show, SaysWhichJointsABodySlidesOn) {
  run("show $problems/spatial_slider_crank.json -o page.html");
  const json joints = at(picture(), "scene/joints");
  EXPECT_EQ(named(joints, "guide").at("slides"), "along");
  EXPECT_EQ(named(joints, "guide").at("is_guide"), true);
  EXPECT_FALSE(named(joints, "bearing").contains("slides"));
  EXPECT_EQ(named(joints, "bearing").at("is_guide"), false);
}

// report.html of check and gradient.

TEST_F(Check, WritesAPageIfAFolderIsNamed) {
  run("check $crank $quick -o one");
  const json data = data_of(folder_ / "one/report.html");
  EXPECT_EQ(at(data, "card/command"), "check");
  EXPECT_TRUE(at(data, "result/responses/crank_stress").contains("derivatives"));
  EXPECT_FALSE(named(at(data, "picture/designs"), "start").at("responses").empty());
}

TEST_F(Check, OfGradientsIsAComparisonOfAllMethods) {
  EXPECT_THAT(run("gradient $crank $quick --compare -o one").out,
              HasSubstr("Effort and accuracy of the methods"));
  // Two exact ones, and two differences with seven steps each.
  EXPECT_EQ(at(data_of(folder_ / "one/report.html"), "result/comparison").size(), 2u + 2u * 7u);
}

/// A cantilever of 1 m whose tip is pushed by a bell of force in the middle of 2 s, slowly against
/// its period of 62 ms: time and place of peaks.
TEST_F(Check, PeaksAreShownWithTimeAndPlace) {
  folder_.write("pushed.json", R"j({"name": "pushed", "scene": {
    "bodies": {"beam": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": "30 mm", "height": "20 mm"}, "elements": 4, "frame": "tangent"}},
    "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
    "loads": {"push": {"type": "force", "body": "beam", "at": [1, 0, 0], "direction": [0, -1, 0],
      "value": {"type": "expression", "value": "= 20 N*exp(-(4*(t/(1 s) - 1))^2)"}}}},
  "simulation": {"end_time": 2, "step": "2 ms"},
  "responses": {
    "root": {"type": "stress", "body": "beam", "over_time": "max"},
    "quarter": {"type": "deflection", "body": "beam", "at": 0.25, "over_time": "max-abs"},
    "end": {"type": "deflection", "body": "beam", "at": 1, "over_time": "final"}}})j");
  const ProgramRun ended = run("simulate pushed.json -o run");
  const json responses = result().at("responses");
  for (const auto& [name, share] : {std::pair("root", 0.0), std::pair("quarter", 0.25)}) {
    const json& peak = responses.at(name).at("peak");
    EXPECT_NEAR(number(peak, "time"), 1.0, 0.02) << name;
    EXPECT_DOUBLE_EQ(number(peak, "share"), share) << name;
    EXPECT_FALSE(peak.at("place").get<std::string>().empty()) << name;
  }
  EXPECT_FALSE(responses.at("end").contains("peak"));
  EXPECT_THAT(ended.out, AllOf(HasSubstr("peak at"), HasSubstr(" s, 0 of the length\n"),
                               HasSubstr(" s, 0.25 of the length\n")));
  EXPECT_THAT(ended.out + ended.err, Not(HasSubstr("the start decides")));
}

}  // namespace
}  // namespace pleuel::test::check_test
