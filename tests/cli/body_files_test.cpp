#include <cstdlib>
#include <map>

#include "tests/cli/program.hpp"

/// Bodies that a program makes for each design, as users meet them: the rod of docs/invariants/planar_rod.py.

namespace pleuel::test::body_files_test {
namespace {

const std::string docs = source_folder() + "/docs/invariants";
const std::string planar_rod = "python3 '" + docs + "/planar_rod.py'";

class Invariants : public InProgramFolder {
 protected:
  void write_rod() const {
    run("invariants $problems/slider_crank.json --body rod -o rod.json --overwrite");
  }
  /// Of two elements, by the other program.
  json make_rod() const {
    const std::string command = planar_rod + " '" + (folder_ / "rod.json").string();
    EXPECT_EQ(std::system((command + "' --elements 2").c_str()), 0);
    return folder_.read("rod.json");
  }
};

TEST_F(Invariants, OfOneBodyAreOneFile) {
  const json written =
      document("invariants $problems/slider_crank.json --body rod -o rod.json").at("bodies");
  ASSERT_EQ(written.size(), 1U);
  EXPECT_EQ(written[0].at("file"), "rod.json");
  EXPECT_EQ(written[0].at("variables"), json({"rod_width", "rod_height"}));
  const json file = folder_.read("rod.json");
  EXPECT_EQ(file.at("format"), "pleuel-invariants");
  EXPECT_EQ(file.at("coordinates").size(), written[0].at("coordinates").get<std::size_t>());
  // ρ L w h with 7850 kg/m³, 180 mm, 20 mm, 30 mm.
  EXPECT_NEAR(number(file, "invariants/mass"), 7850 * 0.18 * 0.02 * 0.03, 1e-14);
  EXPECT_NEAR(number(file, "derivatives/rod_width/invariants/mass"), 7850 * 0.18 * 0.03, 1e-12);
}

TEST_F(Invariants, OfAllElasticBodiesAreARunFolder) {
  run("invariants $problems/slider_crank.json");
  for (const char* name :
       {"bodies/crank.json", "bodies/rod.json", "run_card.json", "result.json"}) {
    EXPECT_TRUE(folder_.has(std::string("runs/slider_crank-invariants/") + name)) << name;
  }
}

/// The whole way: written, read in place of the beam, and differentiated.
TEST_F(Invariants, TakeThePlaceOfTheBeam) {
  write_rod();
  json problem = read_problem("slider_crank");
  json& rod = problem["scene"]["bodies"]["rod"];
  rod = {{"type", "invariants"},
         {"file", "rod.json"},
         {"from", {"120 mm", 0, 0}},
         {"to", {"300 mm", 0, 0}}};
  problem["responses"]["rod_bow"]["at"] = "rod_bow";
  folder_.write("imported.json", problem);
  const json beam = document("gradient $problems/slider_crank.json $quick");
  const json body = document("gradient imported.json $quick");
  for (const std::string name : {"rod_stress", "rod_bow", "torque_rms"}) {
    const std::string value = "responses/" + name + "/value";
    EXPECT_NEAR(number(body, value) / number(beam, value), 1.0, 1e-9) << name;
  }
  // Effects of bodies of files are told, but cannot be left out.
  rod["other_designs"] = "linear";
  folder_.write("linear.json", problem);
  EXPECT_THAT(run("check linear.json $quick").out, HasSubstr("rod_bow"));
  EXPECT_THAT(refusal("gradient imported.json --method central-difference $quick"),
              HasSubstr("imported.json: /scene/bodies/rod/file is known at the design"));
}

/// A rod of a file has its pin where the file says, at every design.
TEST_F(Invariants, HoldPointsAtTheirPlaces) {
  write_rod();
  json problem = read_problem("slider_crank");
  json& scene = problem["scene"];
  const json reach = {{{"variable", "reach"}}, 0, 0};
  problem["variables"]["reach"] = {{"start", "300 mm"}, {"lower", "290 mm"}, {"upper", "310 mm"}};
  problem["responses"]["rod_bow"]["at"] = "rod_bow";
  scene["bodies"]["rod"] = {
      {"type", "invariants"}, {"file", "rod.json"}, {"from", {"120 mm", 0, 0}}, {"to", reach}};
  scene["bodies"]["slider"]["at"] = scene["joints"]["slider_pin"]["at"] = reach;
  scene["joints"]["guide"]["at"] = reach;
  folder_.write("moved.json", problem);
  EXPECT_THAT(refusal("check moved.json"),
              AllOf(HasSubstr("/scene/joints/slider_pin/at must be at a place of the body \"rod\""),
                    HasSubstr("with the variable \"reach\" at its lower bound")));
}

/// A body that gets thicker and thinner, as solids do by Poisson's effect: the rod of another program with inertia
/// of displacements across the plane. In space its motion is the same, to round-off of many more equations.
TEST_F(Invariants, ThatGetThickerMoveInAPlane) {
  json body = make_rod();
  body.erase("derivatives");
  body.erase("design");
  json& of = body.at("invariants");
  of["moment_zz"] = of.at("moment_yy");
  std::map<std::pair<int, int>, double> mass;
  for (const char* part : {"moment_xx", "moment_yy", "moment_zz"}) {
    for (const auto& entry : of.at(part)) mass[{entry[0], entry[1]}] += entry[2].get<double>();
  }
  of["mass_matrix"] = json::array();
  for (const auto& [place, value] : mass) {
    of["mass_matrix"].push_back({place.first, place.second, value});
  }
  folder_.write("rod.json", body);
  json problem = read_json(docs + "/slider_crank.json");
  problem["responses"]["rod_bow"]["at"] = "node 1";
  problem["variables"].erase("rod_height");
  folder_.write("crank.json", problem);
  const auto values = [&](const std::string& motion) {
    return document(
        "simulate crank.json --no-report --no-checks --overwrite $quick "
        "--set /effects/spatial_motion=" +
        motion);
  };
  const json plane = values("auto"), space = values("on");
  EXPECT_LT(plane.at("coordinates"), space.at("coordinates"));
  for (const auto& [name, response] : space.at("responses").items()) {
    const double expected = response.at("value");
    EXPECT_NEAR(number(plane, "responses/" + name + "/value"), expected, 1e-8 * std::abs(expected))
        << name;
  }
}

/// A factor on all inertia, a density, changes bow and stress of a rod that bends by its own inertia as much as the inverse
/// of one on its stiffness does.
TEST_F(Invariants, HaveGradientsOfTheirOwn) {
  const json body = make_rod();
  json problem = read_json(docs + "/slider_crank.json");
  problem["responses"]["rod_bow"]["at"] = "node 1";
  for (const char* side : {"width", "height"}) {
    problem["scene"]["bodies"]["crank"]["section"][side] = "25 mm";
  }
  problem.erase("variables");
  folder_.write("crank.json", problem);
  const std::string line = "gradient crank.json --no-checks $quick --by-invariants ";
  const json found = document(line + "rod");
  const json bow = at(found, "by_invariants/responses/rod_bow");
  EXPECT_EQ(bow.at("unit"), "m");
  double of_stiffness = 0.0;
  for (const json& entry : at(body, "invariants/stiffness")) {
    for (const json& slope : at(bow, "invariants/stiffness")) {
      if (slope[0] != entry[0] || slope[1] != entry[1]) continue;
      of_stiffness += entry[2].get<double>() * slope[2].get<double>();
    }
  }
  EXPECT_NEAR(of_stiffness / number(found, "responses/rod_bow/value"), -1.0, 0.05)
      << "a slow vibration would be -1";
  EXPECT_THAT(refusal(line + "crank"), HasSubstr("is no body of the type \"invariants\""));
  EXPECT_THAT(refusal(line + "rood"), HasSubstr("has no body \"rood\""));
}

TEST_F(Invariants, RefuseWhatHasNone) {
  for (const auto& [options, expected] :
       {std::pair{"--body slider", "\"slider\" is rigid"},
        {"--body rood", "there is no body \"rood\""},
        {"-o all.json", "2 bodies are elastic"},
        {"--set '/effects={\"elasticity\": \"off\"}'", "no body is elastic"}}) {
    EXPECT_THAT(refusal(std::string("invariants $problems/slider_crank.json ") + options),
                HasSubstr(expected));
  }
}

namespace fs = std::filesystem;

class GeneratedBody : public ComparedRuns {
 protected:
  /// The slider-crank of the documentation with a rod that counts how often it is made.
  GeneratedBody() {
    document_ = read_json(docs + "/slider_crank.json");
    json& rod = document_["scene"]["bodies"]["rod"];
    rod.erase("file");
    rod.erase("other_designs");
    rod["generator"] = {{"variables", {{"rod_height", "m"}}}, {"derivatives", "given"}};
    set_command(planar_rod + " - --elements 4");
    document_["responses"]["rod_bow"]["at"] = "node 2";
  }

  json& generator() { return document_["scene"]["bodies"]["rod"]["generator"]; }
  void set_command(const std::string& command) {
    generator()["command"] = {"sh", "-c", "echo call >>calls; " + command};
  }

  std::string line(const std::string& command, const std::string& options = "") const {
    folder_.write("rod.json", document_);
    return command + " rod.json $quick --allow-programs --no-report " + options;
  }

  auto calls() const { return std::ranges::count(folder_.text("calls"), '\n'); }

  json document_;
};

TEST_F(GeneratedBody, IsMadeWithPermissionOnly) {
  line("check");
  EXPECT_THAT(refusal("check rod.json"),
              AllOf(HasSubstr("rod.json: /scene/bodies/rod/generator"), HasSubstr("planar_rod.py"),
                    HasSubstr("--allow-programs")));
  EXPECT_FALSE(folder_.has("calls"));
}

/// The same body as from a file: the same simulation.
TEST_F(GeneratedBody, IsThatOfAFile) {
  const json made = document(line("simulate"));
  const std::string file = (folder_ / "body.json").string();
  ASSERT_EQ(std::system((planar_rod + " '" + file + "' --elements 4").c_str()), 0);
  document_["scene"]["bodies"]["rod"].erase("generator");
  document_["scene"]["bodies"]["rod"]["file"] = "body.json";
  EXPECT_EQ(made.at("responses"), document(line("simulate", "--overwrite")).at("responses"));
  EXPECT_EQ(calls(), 1);
}

/// Derivatives that are given are central differences of 1e-4: 1e-7; forward differences of 1e-4 of K ~ h³
/// are off by 1e-4 of their second derivative.
TEST_F(GeneratedBody, GradientsGoThroughIt) {
  const auto gradients = [&](const std::string& options) {
    return document(line("gradient", options)).at("responses");
  };
  const json given = gradients(""), by_calls = gradients("--method central-difference");
  generator()["derivatives"] = "differences";
  const json forward = gradients("");
  for (const auto& [name, response] : given.items()) {
    const auto slope = [&, name = name](const json& of) -> double {
      return of.at(name).at("gradients").front().at("rod_height");
    };
    const double exact = slope(given), size = std::max(1e-12, std::abs(exact));
    EXPECT_NEAR(slope(by_calls), exact, 1e-3 * size) << name;
    EXPECT_NEAR(slope(forward), exact, 2e-3 * size) << name;
  }
}

TEST_F(GeneratedBody, FailuresAreToldWithDesignAndReason) {
  generator()["time_limit"] = "0.2 s";
  for (const auto& [command, expected] :
       {std::pair{"echo no mesh >&2; exit 3", "exit code 3; it wrote to standard error: no mesh"},
        {"echo hello", "it must write a body file and nothing else"},
        {"sleep 30", "limit of 0.2 s"}}) {
    set_command(command);
    EXPECT_THAT(refusal(line("simulate")),
                AllOf(HasSubstr("rod.json: /scene/bodies/rod/generator"),
                      HasSubstr("rod_height = 0.03 m"), HasSubstr(expected)));
  }
}

/// At another design a failure is that of the simulation.
TEST_F(GeneratedBody, FailsAtADesignAsASimulation) {
  set_command(planar_rod + " - --elements $((5 - $(wc -l <calls)))");
  folder_.write("design.json",
                R"({"crank_width": 0.02, "crank_height": 0.03, "rod_height": 0.02})");
  EXPECT_THAT(unwrapped(run(line("simulate", "--design design.json"), 3).err),
              AllOf(HasSubstr("rod_height = 0.02 m"),
                    HasSubstr("9 coordinates where it had 12 at the start")));
}

/// The lightest slider-crank by its three heights and widths.
class GeneratedOptimum : public GeneratedBody {
 protected:
  GeneratedOptimum() {
    document_["objective"] = {{"minimize", "crank_and_rod"}};
    document_["constraints"] = json::parse(R"({
        "crank_strength": {"response": "crank_stress", "upper": "200 MPa"},
        "rod_stiffness": {"response": "rod_bow", "upper": "0.2 mm"},
        "crank_stiffness": {"response": "crank_tip", "upper": "0.5 mm"},
        "crank_proportion": {"linear": {"crank_height": 1, "crank_width": -2}, "upper": 0}})");
  }
};

/// With Pleuel's own beam, the same body to round-off, that is there for every design.
TEST_F(GeneratedOptimum, IsThatOfABodyThatIsAlwaysThere) {
  const json made = document(line("optimize"));
  EXPECT_LE(calls(), 8);
  document_["scene"]["bodies"]["rod"] = json::parse(R"({
      "type": "beam", "from": ["120 mm", 0, 0], "to": ["300 mm", 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": "20 mm", "height": {"variable": "rod_height"}},
      "elements": 4, "frame": "chord", "damping": {"stiffness": "1e-5 s"}})");
  document_["responses"]["rod_bow"]["at"] = 0.5;
  const double expected = number(document(line("optimize", "--overwrite")), "objective/value");
  EXPECT_NEAR(number(made, "objective/value"), expected, 1e-4 * expected);
}

TEST_F(GeneratedOptimum, KilledFiveTimesItMakesNoBodyTwice) {
  run(line("optimize", "-o whole"));
  const auto whole = calls();
  fs::remove_all(folder_ / "runs");
  fs::remove(folder_ / "calls");
  constexpr int kills = 5;
  kill_and_end(line("optimize"), "killed", kills, 1);
  expect_same("killed", "whole", "history.csv");
  EXPECT_LE(calls(), whole + kills);  // a call that was killed itself is made again
}

/// A search keeps to where bodies can be made, and its answer is a design that they were made for.
TEST_F(GeneratedOptimum, WhereNoBodyCanBeMadeIsNotVerified) {
  set_command(
      "x=$(cat); h=$(echo \"$x\" | sed 's/.*rod_height\":\\([0-9.e-]*\\).*/\\1/'); "
      "awk \"BEGIN{exit !($h < 0.02)}\" && { echo too thin >&2; exit 1; }; echo \"$x\" | " +
      planar_rod + " - --elements 4");
  EXPECT_THAT(unwrapped(run(line("optimize"), 4).out),
              AllOf(HasSubstr("too thin: the next step is shorter"),
                    HasSubstr("the last design that bodies were made for is judged")));
}

/// The block of problems/conrod, which CalculiX assembles: two calls for a design of one variable, as derivatives
/// are differences.
TEST_F(Invariants, OfASolidRodAreAskedForByFewCallsOfTheFiniteElementProgram) {
  if (std::system("command -v ccx >/dev/null") != 0) GTEST_SKIP() << "ccx is not installed";
  ::setenv("PLEUEL", PLEUEL_PROGRAM, 1);  // that the generator reduces with
  const json optimum = document(
      "optimize $problems/conrod/block.json --allow-programs --no-report"
      R"( --set '/variables={"height": {"start": "30 mm", "lower": "6 mm", "upper": "60 mm"}}')"
      R"( --set '/scene/bodies/rod/generator/variables={"height": "m"}')"
      R"( --set '/constraints={"stiffness": {"response": "rod_bow", "upper": "0.2 mm"}}')");
  EXPECT_EQ(optimum.at("status"), "verified");
  const fs::directory_iterator bodies(folder_ / "runs/bodies");
  EXPECT_LE(std::distance(begin(bodies), end(bodies)), 12);
}

}  // namespace
}  // namespace pleuel::test::body_files_test
