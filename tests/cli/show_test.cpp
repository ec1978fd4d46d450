#include <fstream>
#include <limits>

#include "tests/cli/program.hpp"
#include "tests/cli/readback.hpp"
#include "tests/cli/report_data.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::show_test {
namespace {

// Pages of mechanisms that are not simulated.

using nlohmann::json;

using Show = InProgramFolder;

TEST_F(Show, SaysWhatJointsLeaveFreeAndHowLongItTakes) {
  const ProgramRun run = folder_.run({"show", problem("four_bar"), "-o", "page.html"});
  EXPECT_THAT(run.out, HasSubstr("1 of 6"));
  EXPECT_THAT(run.out, HasSubstr("drive of the angle"));
  EXPECT_THAT(run.out, HasSubstr("Time: one simulation takes about "));
}

/// Some seven periods in place of one: more than the least of some times of the same work ever differ.
TEST_F(Show, ExpectsTheSearchForAMotionThatRepeatsItself) {
  const auto expected = [&](const std::string& start) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
      const ProgramRun run = folder_.run({"show", problem("running_press"), "-o", start + ".html",
                                          "--json", "--set", "/simulation/initial_state=" + start});
      least = std::min(least, run.document().at("seconds").at("simulate").get<double>());
    }
    return least;
  };
  EXPECT_GT(expected("periodic"), 2.0 * expected("consistent"));
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
                 "rigid": true, "elements": 1, "section": {"type": "circle", "diameter": 0.01}}
      },
      "joints": {
        "hub": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                "drive": {"type": "constant-speed", "speed": 5}},
        "pin": {"type": "revolute", "bodies": ["crank", "link"], "at": [0.1, 0, 0]}
      }
    },
    "simulation": {"end_time": 0.1, "step": 1e-3},
    "responses": {"reach": {"type": "position", "body": "link", "at": 1, "direction": "x",
                            "over_time": "final"}}
  })";
  const ProgramRun run = folder_.run({"show", "loose.json", "-o", "page.html", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.document().at("unheld_bodies"), json({"link"}));
}

TEST_F(Show, SaysWhatStartsBent) {
  const ProgramRun run =
      folder_.run({"show", problem("slider_crank_round"), "-o", "bent.html", "--set",
                   R"(/scene/bodies/rod/initial_deflections=[{"at": ["210 mm", 0, 0], )"
                   R"("direction": [0, 1, 0], "displacement": "2 mm"}])"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
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
  const ProgramRun run = folder_.run({"show", problem("four_bar"), "-o", "page.html"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Drawn in page.html"));
  const json picture = data_of(folder_.path() / "page.html").at("picture");
  const json& geometry = picture.at("designs")[0].at("geometry");
  EXPECT_EQ(geometry.at("bodies").size(), picture.at("scene").at("bodies").size());
  for (const json& joint : geometry.at("joints")) {
    EXPECT_EQ(joint.at("places").size(), 2u);
    EXPECT_EQ(joint.at("places")[0].at("at"), joint.at("places")[1].at("at"));
  }
}

// report.html of check and gradient.

using Check = InProgramFolder;

TEST_F(Check, WritesAPageIfAFolderIsNamed) {
  const ProgramRun run = folder_.run_quick({"check", problem("slider_crank_round"), "-o", "one"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json data = data_of(folder_.path() / "one/report.html");
  EXPECT_EQ(data.at("card").at("command"), "check");
  EXPECT_TRUE(data.at("result").at("responses").at("crank_stress").contains("derivatives"));
  EXPECT_FALSE(named(data.at("picture").at("designs"), "start").at("responses").empty());
}

TEST(GradientReport, ComparesAllMethods) {
  const ProgramFolder folder;
  const ProgramRun run =
      folder.run_quick({"gradient", problem("slider_crank_round"), "--compare", "-o", "one"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Effort and accuracy of the methods"));
  const json result = data_of(folder.path() / "one/report.html").at("result");
  // Two exact ones, and two differences with seven steps each.
  EXPECT_EQ(result.at("comparison").size(), 2u + 2u * 7u);
}

// Time and place of peaks.

/// A cantilever of 1 m whose tip is pushed by a bell of force in the middle of 2 s, slowly against
/// its period of 62 ms.
const char* const pushed = R"j({"name": "pushed", "scene": {
    "bodies": {"beam": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": "30 mm", "height": "20 mm"}, "elements": 4,
      "frame": "tangent"}},
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
  const ProgramRun run = folder.run({"simulate", "pushed.json", "-o", "run"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
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
}  // namespace pleuel::test::show_test
