#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>

#include "tests/cli/program.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

/// Bodies that a program makes for each design, as users meet them: the rod of docs/invariants/planar_rod.py.

namespace pleuel::test::body_files_test {
namespace {

using Invariants = InProgramFolder;

TEST_F(Invariants, OfOneBodyAreOneFile) {
  const nlohmann::json written =
      exits(0, folder_.run({"invariants", problem("slider_crank"), "--body", "rod", "-o",
                            "rod.json", "--json"}))
          .document()
          .at("bodies");
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
  const ProgramRun run = exits(0, folder_.run({"invariants", problem("slider_crank")}));
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
      exits(2, folder_.run_quick({"gradient", "imported.json", "--method", "central-difference"}));
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
  const ProgramRun run = exits(2, folder_.run({"check", "moved.json"}));
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
    const ProgramRun run = exits(
        0, folder_.run_quick({"simulate", "crank.json", "--json", "--no-report", "--no-checks",
                              "--overwrite", "--set", "/effects/spatial_motion=" + motion}));
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
  const ProgramRun found = exits(0, run("rod"));
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
    return exits(2, folder_.run(joined({"invariants", problem("slider_crank")}, words))).err;
  };
  EXPECT_THAT(complaint({"--body", "slider"}), HasSubstr("\"slider\" is rigid"));
  EXPECT_THAT(complaint({"--body", "rood"}), HasSubstr("there is no body \"rood\""));
  EXPECT_THAT(complaint({"-o", "all.json"}), HasSubstr("2 bodies are elastic"));
  EXPECT_THAT(complaint({"--set", "/effects={\"elasticity\": \"off\"}"}),
              HasSubstr("no body is elastic"));
}

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::string planar_rod = "python3 '" + source_folder() + "/docs/invariants/planar_rod.py'";

class GeneratedBody : public ComparedRuns {
 protected:
  /// The slider-crank of the documentation with a rod that counts how often it is made.
  GeneratedBody() {
    document_ = Json::parse(read_file(source_folder() + "/docs/invariants/slider_crank.json"));
    Json& rod = document_["scene"]["bodies"]["rod"];
    rod.erase("file");
    rod.erase("other_designs");
    rod["generator"] = {{"command", counted(planar_rod + " - --elements 4")},
                        {"variables", {{"rod_height", "m"}}},
                        {"derivatives", "given"}};
    document_["responses"]["rod_bow"]["at"] = "node 2";
  }

  static Json counted(const std::string& command) {
    return {"sh", "-c", "echo call >>calls; " + command};
  }

  void set_command(const std::string& command) {
    document_["scene"]["bodies"]["rod"]["generator"]["command"] = counted(command);
  }

  std::string line(const std::string& command, const std::string& options = "") const {
    std::ofstream(folder_.path() / "rod.json") << document_.dump();
    return command + " rod.json" + quick_line() + " --allow-programs " + options;
  }

  ProgramRun run(const std::string& command, const std::string& options = "") const {
    return run_line(folder_.path(), line(command, options));
  }

  int calls() const {
    const std::string text = read_file(folder_.path() / "calls");
    return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  }

  Json document_;
};

TEST_F(GeneratedBody, IsMadeWithPermissionOnly) {
  line("check");
  EXPECT_THAT(unwrapped(exits(2, run_line(folder_.path(), "check rod.json")).err),
              AllOf(HasSubstr("rod.json: /scene/bodies/rod/generator"), HasSubstr("planar_rod.py"),
                    HasSubstr("--allow-programs")));
  EXPECT_FALSE(fs::exists(folder_.path() / "calls"));
}

/// The same body as from a file: the same simulation.
TEST_F(GeneratedBody, IsThatOfAFile) {
  const Json made = run("simulate", "--json --no-report").document();
  const std::string file = (folder_.path() / "body.json").string();
  const std::string command = planar_rod + " '" + file + "' --elements 4";
  ASSERT_EQ(std::system(command.c_str()), 0);
  document_["scene"]["bodies"]["rod"].erase("generator");
  document_["scene"]["bodies"]["rod"]["file"] = "body.json";
  const Json read = run("simulate", "--json --no-report --overwrite").document();
  EXPECT_EQ(made.at("responses"), read.at("responses"));
  EXPECT_EQ(calls(), 1);
}

/// Derivatives that are given are central differences of 1e-4: 1e-7; forward differences of 1e-4 of K ~ h³
/// are off by 1e-4 of their second derivative.
TEST_F(GeneratedBody, GradientsGoThroughIt) {
  const auto gradients = [&](const std::string& options) {
    return run("gradient", "--json " + options).document().at("responses");
  };
  const Json given = gradients(""), by_calls = gradients("--method central-difference");
  document_["scene"]["bodies"]["rod"]["generator"]["derivatives"] = "differences";
  const Json forward = gradients("");
  for (const auto& one : given.items()) {
    const std::string name = one.key();
    const auto slope = [&](const Json& of) -> double {
      return of.at(name).at("gradients").front().at("rod_height");
    };
    const double exact = slope(given);
    const double largest = std::max(1e-12, std::abs(exact));
    EXPECT_NEAR(slope(by_calls), exact, 1e-3 * largest) << name;
    EXPECT_NEAR(slope(forward), exact, 2e-3 * largest) << name;
  }
}

TEST_F(GeneratedBody, FailuresAreToldWithDesignAndReason) {
  const std::vector<std::pair<std::string, std::string>> failures = {
      {"echo no mesh >&2; exit 3", "exit code 3; it wrote to standard error: no mesh"},
      {"echo hello", "it must write a body file and nothing else"},
      {"sleep 30", "limit of 0.2 s"}};
  document_["scene"]["bodies"]["rod"]["generator"]["time_limit"] = "0.2 s";
  for (const auto& [command, expected] : failures) {
    set_command(command);
    EXPECT_THAT(unwrapped(exits(2, run("simulate", "--no-report")).err),
                AllOf(HasSubstr("rod.json: /scene/bodies/rod/generator"),
                      HasSubstr("rod_height = 0.03 m"), HasSubstr(expected)));
  }
}

/// At another design a failure is that of the simulation.
TEST_F(GeneratedBody, FailsAtADesignAsASimulation) {
  set_command(planar_rod + " - --elements $((5 - $(wc -l <calls)))");
  std::ofstream(folder_.path() / "design.json")
      << R"({"crank_width": 0.02, "crank_height": 0.03, "rod_height": 0.02})";
  EXPECT_THAT(unwrapped(exits(3, run("simulate", "--no-report --design design.json")).err),
              AllOf(HasSubstr("rod_height = 0.02 m"),
                    HasSubstr("9 coordinates where it had 12 at the start")));
}

/// The lightest slider-crank by its three heights and widths.
class GeneratedOptimum : public GeneratedBody {
 protected:
  GeneratedOptimum() {
    document_["objective"] = {{"minimize", "crank_and_rod"}};
    document_["constraints"] = {
        {"crank_strength", {{"response", "crank_stress"}, {"upper", "200 MPa"}}},
        {"rod_stiffness", {{"response", "rod_bow"}, {"upper", "0.2 mm"}}},
        {"crank_stiffness", {{"response", "crank_tip"}, {"upper", "0.5 mm"}}},
        {"crank_proportion",
         {{"linear", {{"crank_height", 1}, {"crank_width", -2}}}, {"upper", 0}}}};
  }

  std::string words() const { return line("optimize", "--no-report"); }
};

/// With Pleuel's own beam, the same body to round-off, that is there for every design.
TEST_F(GeneratedOptimum, IsThatOfABodyThatIsAlwaysThere) {
  const ProgramRun made = exits(0, run("optimize", "--json --no-report"));
  EXPECT_LE(calls(), 8);
  document_["scene"]["bodies"]["rod"] = {
      {"type", "beam"},
      {"from", {"120 mm", 0, 0}},
      {"to", {"300 mm", 0, 0}},
      {"material", "steel"},
      {"section",
       {{"type", "rectangle"}, {"width", "20 mm"}, {"height", {{"variable", "rod_height"}}}}},
      {"elements", 4},
      {"frame", "chord"},
      {"damping", {{"stiffness", "1e-5 s"}}}};
  document_["responses"]["rod_bow"]["at"] = 0.5;
  const ProgramRun beam = exits(0, run("optimize", "--json --no-report --overwrite"));
  const double expected = beam.document().at("objective").at("value");
  EXPECT_NEAR(made.document().at("objective").at("value"), expected, 1e-4 * expected);
}

TEST_F(GeneratedOptimum, KilledFiveTimesItMakesNoBodyTwice) {
  ASSERT_EQ(run_line(folder_.path(), words() + " -o whole").exit_code, 0);
  const int whole = calls();
  fs::remove_all(folder_.path() / "runs");
  fs::remove(folder_.path() / "calls");
  std::mt19937 random(1);
  constexpr int kills = 5;
  kill_and_end(words(), "killed", kills, random);
  expect_same("killed", "whole", "history.csv");
  EXPECT_LE(calls(), whole + kills);  // a call that was killed itself is made again
}

/// A search keeps to where bodies can be made, and its answer is a design that they were made for.
TEST_F(GeneratedOptimum, WhereNoBodyCanBeMadeIsNotVerified) {
  set_command(
      "x=$(cat); h=$(echo \"$x\" | sed 's/.*rod_height\":\\([0-9.e-]*\\).*/\\1/'); "
      "awk \"BEGIN{exit !($h < 0.02)}\" && { echo too thin >&2; exit 1; }; echo \"$x\" | " +
      planar_rod + " - --elements 4");
  EXPECT_THAT(unwrapped(exits(4, run("optimize", "--no-report")).out),
              AllOf(HasSubstr("too thin: the next step is shorter"),
                    HasSubstr("the last design that bodies were made for is judged")));
}

/// The block of problems/conrod, which CalculiX assembles: two calls for a design of one variable, as derivatives
/// are differences.
TEST(SolidRod, IsVerifiedAfterFewCallsOfTheFiniteElementProgram) {
  if (std::system("command -v ccx >/dev/null") != 0) GTEST_SKIP() << "ccx is not installed";
  const ProgramFolder folder;
  ::setenv("PLEUEL", PLEUEL_PROGRAM, 1);  // that the generator reduces with
  const std::string file = source_folder() + "/problems/conrod/block.json";
  const ProgramRun run = exits(
      0,
      folder.run_line(
          "optimize '" + file +
          "' --allow-programs --no-report --json"
          R"( --set '/variables={"height": {"start": "30 mm", "lower": "6 mm", "upper": "60 mm"}}')"
          R"( --set '/scene/bodies/rod/generator/variables={"height": "m"}')"
          R"( --set '/constraints={"stiffness": {"response": "rod_bow", "upper": "0.2 mm"}}')"));
  EXPECT_EQ(run.document().at("status"), "verified");
  const fs::directory_iterator bodies(folder.path() / "runs" / "bodies");
  EXPECT_LE(std::distance(begin(bodies), end(bodies)), 12);
}

}  // namespace
}  // namespace pleuel::test::body_files_test
