#include <fstream>
#include <map>

#include "tests/cli/program.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::invariants_test {
namespace {

using Invariants = InProgramFolder;

TEST_F(Invariants, OfOneBodyAreOneFile) {
  const ProgramRun run = folder_.run(
      {"invariants", problem("slider_crank"), "--body", "rod", "-o", "rod.json", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json written = run.document().at("bodies");
  ASSERT_EQ(written.size(), 1U);
  EXPECT_EQ(written[0].at("file"), "rod.json");
  EXPECT_EQ(written[0].at("variables"), nlohmann::json({"rod_width", "rod_height"}));
  const auto file = read_json(folder_.path() / "rod.json");
  EXPECT_EQ(file.at("format"), "pleuel-invariants");
  EXPECT_EQ(file.at("coordinates").size(), written[0].at("coordinates").get<std::size_t>());
  // ρ L w h with 7850 kg/m³, 180 mm, 20 mm, 30 mm.
  EXPECT_NEAR(file.at("invariants").at("mass"), 7850 * 0.18 * 0.02 * 0.03, 1e-14);
  EXPECT_NEAR(file.at("derivatives").at("rod_width").at("invariants").at("mass"),
              7850 * 0.18 * 0.03, 1e-12);
}

TEST_F(Invariants, OfAllElasticBodiesAreARunFolder) {
  const ProgramRun run = folder_.run({"invariants", problem("slider_crank")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name :
       {"bodies/crank.json", "bodies/rod.json", "run_card.json", "result.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "runs" / "slider_crank-invariants" / name))
        << name;
  }
}

/// The whole way: written, read in place of the beam, and differentiated.
TEST_F(Invariants, TakeThePlaceOfTheBeam) {
  const auto run = [&](std::vector<std::string> words) {
    ProgramRun result = folder_.run_quick(std::move(words));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  };
  run({"invariants", problem("slider_crank"), "--body", "rod", "-o", "rod.json"});
  auto document = read_json(problem("slider_crank"));
  document["scene"]["bodies"]["rod"] = {{"type", "invariants"},
                                        {"file", "rod.json"},
                                        {"from", {"120 mm", 0, 0}},
                                        {"to", {"300 mm", 0, 0}}};
  document["responses"]["rod_bow"]["at"] = "rod_bow";
  std::ofstream(folder_.path() / "imported.json") << document;
  const auto beam = run({"gradient", problem("slider_crank"), "--json"}).document();
  const auto body = run({"gradient", "imported.json", "--json"}).document();
  const auto value = [](const nlohmann::json& of, const char* name) -> double {
    return of.at("responses").at(name).at("value");
  };
  for (const char* name : {"rod_stress", "rod_bow", "torque_rms"}) {
    EXPECT_NEAR(value(body, name) / value(beam, name), 1.0, 1e-9) << name;
  }
  // Effects of bodies of files are told, but cannot be left out.
  document["scene"]["bodies"]["rod"]["other_designs"] = "linear";
  std::ofstream(folder_.path() / "linear.json") << document;
  EXPECT_THAT(run({"check", "linear.json"}).out, HasSubstr("rod_bow"));
  const ProgramRun moved =
      folder_.run_quick({"gradient", "imported.json", "--method", "central-difference"});
  EXPECT_EQ(moved.exit_code, 2);
  EXPECT_THAT(moved.err, HasSubstr("imported.json: /scene/bodies/rod/file is known at the design"));
}

/// A rod of a file has its pin where the file says, at every design.
TEST_F(Invariants, HoldPointsAtTheirPlaces) {
  ASSERT_EQ(folder_.run({"invariants", problem("slider_crank"), "--body", "rod", "-o", "rod.json"})
                .exit_code,
            0);
  auto document = read_json(problem("slider_crank"));
  nlohmann::json& scene = document["scene"];
  const nlohmann::json reach = {{{"variable", "reach"}}, 0, 0};
  document["variables"]["reach"] = {{"start", "300 mm"}, {"lower", "290 mm"}, {"upper", "310 mm"}};
  document["responses"]["rod_bow"]["at"] = "rod_bow";
  scene["bodies"]["rod"] = {
      {"type", "invariants"}, {"file", "rod.json"}, {"from", {"120 mm", 0, 0}}, {"to", reach}};
  scene["bodies"]["slider"]["at"] = scene["joints"]["slider_pin"]["at"] = reach;
  scene["joints"]["guide"]["at"] = reach;
  std::ofstream(folder_.path() / "moved.json") << document;
  const ProgramRun run = folder_.run({"check", "moved.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("/scene/joints/slider_pin/at must be at a place of the body \"rod\""));
  EXPECT_THAT(run.err, HasSubstr("with the variable \"reach\" at its lower bound"));
}

/// A body that gets thicker and thinner, as solids do by Poisson's effect: the rod of another program with inertia
/// of displacements across the plane. In space its motion is the same, to round-off of many more equations.
TEST_F(Invariants, ThatGetThickerMoveInAPlane) {
  const std::string docs = source_folder() + "/docs/invariants";
  const std::string made = (folder_.path() / "rod.json").string();
  ASSERT_EQ(
      std::system(("python3 '" + docs + "/planar_rod.py' '" + made + "' --elements 2").c_str()), 0);
  auto body = read_json(made);
  body.erase("derivatives");
  body.erase("design");
  auto& of = body.at("invariants");
  of["moment_zz"] = of.at("moment_yy");
  std::map<std::pair<int, int>, double> mass;
  for (const char* part : {"moment_xx", "moment_yy", "moment_zz"}) {
    for (const auto& entry : of.at(part)) mass[{entry[0], entry[1]}] += entry[2].get<double>();
  }
  of["mass_matrix"] = nlohmann::json::array();
  for (const auto& [place, value] : mass) {
    of["mass_matrix"].push_back({place.first, place.second, value});
  }
  std::ofstream(made) << body;
  auto document = read_json(docs + "/slider_crank.json");
  document["responses"]["rod_bow"]["at"] = "node 1";
  document["variables"].erase("rod_height");
  std::ofstream(folder_.path() / "crank.json") << document;
  const auto values = [&](const std::string& motion) {
    const ProgramRun run =
        folder_.run_quick({"simulate", "crank.json", "--json", "--no-report", "--no-checks",
                           "--overwrite", "--set", "/effects/spatial_motion=" + motion});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.document();
  };
  const auto plane = values("auto"), space = values("on");
  EXPECT_LT(plane.at("coordinates"), space.at("coordinates"));
  for (const auto& response : space.at("responses").items()) {
    const double expected = response.value().at("value");
    EXPECT_NEAR(plane.at("responses").at(response.key()).at("value"), expected,
                1e-8 * std::abs(expected))
        << response.key();
  }
}

/// A factor on all inertia, a density, changes bow and stress of a rod that bends by its own inertia as much as the inverse
/// of one on its stiffness does.
TEST_F(Invariants, HaveGradientsOfTheirOwn) {
  const std::string docs = source_folder() + "/docs/invariants";
  const std::string made = (folder_.path() / "rod.json").string();
  ASSERT_EQ(
      std::system(("python3 '" + docs + "/planar_rod.py' '" + made + "' --elements 2").c_str()), 0);
  auto document = read_json(docs + "/slider_crank.json");
  document["responses"]["rod_bow"]["at"] = "node 1";
  for (const char* side : {"width", "height"}) {
    document["scene"]["bodies"]["crank"]["section"][side] = "25 mm";
  }
  document.erase("variables");
  std::ofstream(folder_.path() / "crank.json") << document;
  const auto run = [&](const std::string& body) {
    return folder_.run_quick(
        {"gradient", "crank.json", "--json", "--no-checks", "--by-invariants", body});
  };
  const ProgramRun found = run("rod");
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const nlohmann::json bow = found.document().at("by_invariants").at("responses").at("rod_bow");
  EXPECT_EQ(bow.at("unit"), "m");
  const auto body = read_json(made);
  double of_stiffness = 0.0;
  const auto gradient = bow.at("invariants").at("stiffness");
  for (const nlohmann::json& entry : body.at("invariants").at("stiffness")) {
    for (const nlohmann::json& slope : gradient) {
      if (slope[0] == entry[0] && slope[1] == entry[1]) {
        of_stiffness += entry[2].get<double>() * slope[2].get<double>();
      }
    }
  }
  const double value = found.document().at("responses").at("rod_bow").at("value");
  EXPECT_NEAR(of_stiffness / value, -1.0, 0.05) << "a slow vibration would be -1";
  EXPECT_THAT(run("crank").err, HasSubstr("is no body of the type \"invariants\""));
  EXPECT_THAT(run("rood").err, HasSubstr("has no body \"rood\""));
}

TEST_F(Invariants, RefuseWhatHasNone) {
  const auto complaint = [&](const std::vector<std::string>& words) {
    const ProgramRun run = folder_.run(joined({"invariants", problem("slider_crank")}, words));
    EXPECT_EQ(run.exit_code, 2);
    return run.err;
  };
  EXPECT_THAT(complaint({"--body", "slider"}), HasSubstr("\"slider\" is rigid"));
  EXPECT_THAT(complaint({"--body", "rood"}), HasSubstr("there is no body \"rood\""));
  EXPECT_THAT(complaint({"-o", "all.json"}), HasSubstr("2 bodies are elastic"));
  EXPECT_THAT(complaint({"--set", "/effects={\"elasticity\": \"off\"}"}),
              HasSubstr("no body is elastic"));
}

}  // namespace
}  // namespace pleuel::test::invariants_test
