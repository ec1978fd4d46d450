#include <fstream>

#include <gmock/gmock.h>

#include "tests/cli/program.hpp"
#include "tests/cli/report_data.hpp"

/// Pages of mechanisms that are not simulated.
namespace pleuel::test::show_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(Show, SaysWhatJointsLeaveFreeAndHowLongItTakes) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"show", problem("four_bar"), "-o", "page.html"});
  EXPECT_THAT(run.out, HasSubstr("1 of 6"));
  EXPECT_THAT(run.out, HasSubstr("drive of the angle"));
  EXPECT_THAT(run.out, HasSubstr("Time: one simulation takes about "));
}

/// Some seven periods in place of one: more than times of the same work ever differ.
TEST(Show, ExpectsTheSearchForAMotionThatRepeatsItself) {
  const TemporaryFolder folder;
  const auto expected = [&](const std::string& start) {
    const ProgramRun run =
        run_program(folder.path(), {"show", problem("running_press"), "-o", start + ".html",
                                    "--json", "--set", "/simulation/initial_state=" + start});
    return run.document().at("seconds").at("simulate").get<double>();
  };
  EXPECT_GT(expected("periodic"), 2.0 * expected("consistent"));
}

/// A link that nothing drives, holds or pulls, on the end of a driven crank.
TEST(Show, DrawsBodiesRedThatNothingMoves) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "loose.json") << R"({
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
  const ProgramRun run =
      run_program(folder.path(), {"show", "loose.json", "-o", "page.html", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.document().at("unheld_bodies"), json({"link"}));
}

TEST(Show, SaysWhatStartsBent) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), {"show", problem("slider_crank_round"), "-o", "bent.html", "--set",
                      R"(/scene/bodies/rod/initial_deflections=[{"at": ["210 mm", 0, 0], )"
                      R"("direction": [0, 1, 0], "displacement": "2 mm"}])"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json bodies = data_of(folder.path() / "bent.html").at("picture").at("scene").at("bodies");
  EXPECT_EQ(named(bodies, "rod").at("starts_bent").at("displacement"), 0.002);
  EXPECT_FALSE(named(bodies, "crank").contains("starts_bent"));
}

TEST(Show, SaysWhichJointsABodySlidesOn) {
  const TemporaryFolder folder;
  run_program(folder.path(), {"show", problem("spatial_slider_crank"), "-o", "page.html"});
  const json joints = data_of(folder.path() / "page.html").at("picture").at("scene").at("joints");
  EXPECT_EQ(named(joints, "guide").at("slides"), "along");
  EXPECT_EQ(named(joints, "guide").at("is_guide"), true);
  EXPECT_FALSE(named(joints, "bearing").contains("slides"));
  EXPECT_EQ(named(joints, "bearing").at("is_guide"), false);
}

TEST(Show, DrawsTheMechanismBeforeAnythingIsSimulated) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"show", problem("four_bar"), "-o", "page.html"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Drawn in page.html"));
  const json picture = data_of(folder.path() / "page.html").at("picture");
  const json& geometry = picture.at("designs")[0].at("geometry");
  EXPECT_EQ(geometry.at("bodies").size(), picture.at("scene").at("bodies").size());
  for (const json& joint : geometry.at("joints")) {
    EXPECT_EQ(joint.at("places").size(), 2u);
    EXPECT_EQ(joint.at("places")[0].at("at"), joint.at("places")[1].at("at"));
  }
}

}  // namespace
}  // namespace pleuel::test::show_test
