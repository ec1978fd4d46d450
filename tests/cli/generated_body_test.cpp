#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/cli/compared_runs.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/source_folder.hpp"
#include "tests/support/test.hpp"

/// Bodies that a program makes for each design, as users meet them: the rod of docs/invariants/planar_rod.py.
namespace pleuel::test::generated_body_test {
namespace {

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
  const ProgramRun refused = run_line(folder_.path(), "check rod.json");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(unwrapped(refused.err),
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
    const ProgramRun failed = run("simulate", "--no-report");
    EXPECT_EQ(failed.exit_code, 2);
    EXPECT_THAT(unwrapped(failed.err),
                AllOf(HasSubstr("rod.json: /scene/bodies/rod/generator"),
                      HasSubstr("rod_height = 0.03 m"), HasSubstr(expected)));
  }
}

/// At another design a failure is that of the simulation.
TEST_F(GeneratedBody, FailsAtADesignAsASimulation) {
  set_command(planar_rod + " - --elements $((5 - $(wc -l <calls)))");
  std::ofstream(folder_.path() / "design.json")
      << R"({"crank_width": 0.02, "crank_height": 0.03, "rod_height": 0.02})";
  const ProgramRun failed = run("simulate", "--no-report --design design.json");
  EXPECT_EQ(failed.exit_code, 3) << failed.err;
  EXPECT_THAT(unwrapped(failed.err),
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
  const ProgramRun made = run("optimize", "--json --no-report");
  ASSERT_EQ(made.exit_code, 0) << made.err;
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
  const ProgramRun beam = run("optimize", "--json --no-report --overwrite");
  ASSERT_EQ(beam.exit_code, 0) << beam.err;
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
  const ProgramRun failed = run("optimize", "--no-report");
  EXPECT_EQ(failed.exit_code, 4);
  EXPECT_THAT(unwrapped(failed.out),
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
  const ProgramRun run = folder.run_line(
      "optimize '" + file +
      "' --allow-programs --no-report --json"
      R"( --set '/variables={"height": {"start": "30 mm", "lower": "6 mm", "upper": "60 mm"}}')"
      R"( --set '/scene/bodies/rod/generator/variables={"height": "m"}')"
      R"( --set '/constraints={"stiffness": {"response": "rod_bow", "upper": "0.2 mm"}}')");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.document().at("status"), "verified");
  const fs::directory_iterator bodies(folder.path() / "runs" / "bodies");
  EXPECT_LE(std::distance(begin(bodies), end(bodies)), 12);
}

}  // namespace
}  // namespace pleuel::test::generated_body_test
