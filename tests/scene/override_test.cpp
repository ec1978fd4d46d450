#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::override_test {
namespace {

ProblemFile read_with(const std::vector<std::string>& overrides) {
  return read_problem_text(good_text(), "good.json", overrides).complete();
}

std::string complaint_with(const std::string& assignment) {
  return thrown<InputError>([&] { read_with({assignment}); });
}

TEST(Override, ReplacesAValue) {
  EXPECT_EQ(read_with({"/simulation/step=2e-4"}).simulation.step, 2e-4);
}

TEST(Override, TakesATextWithUnitWithoutQuotes) {
  EXPECT_DOUBLE_EQ(read_with({"/simulation/step=0.2 ms"}).simulation.step, 2e-4);
  EXPECT_DOUBLE_EQ(read_with({"/simulation/step=\"0.2 ms\""}).simulation.step, 2e-4);
}

TEST(Override, TakesTheStartOfAVariableByItsName) {
  const ProblemFile problem = read_with({"width=21 mm"});
  EXPECT_EQ(problem.variables.front().name, "width");
  EXPECT_DOUBLE_EQ(problem.variables.front().start, 0.021);
  EXPECT_DOUBLE_EQ(read_with({"width = 22 mm"}).variables.front().start, 0.022);
  EXPECT_DOUBLE_EQ(read_with({"/simulation/step = 0.2 ms"}).simulation.step, 2e-4);
  EXPECT_EQ(complaint_with("widht=21 mm"),
            "good.json: --set widht=21 mm: must begin with a JSON pointer such as "
            "/simulation/step, or with the name of a design variable; did you mean \"width\"?");
}

TEST(Override, TakesAWholeObject) {
  const ProblemFile problem =
      read_with({R"(/scene/bodies/slider/mass={"variable": "load", "factor": 3})"});
  EXPECT_EQ(std::get<PointMass>(problem.scene.bodies[2].shape).mass.factor, 3.0);
}

TEST(Override, ReachesIntoAList) {
  const ProblemFile problem = read_with({"/scene/bodies/rod/segments/1/elements=7"});
  EXPECT_EQ(std::get<BeamBody>(problem.scene.bodies[1].shape).segments[1].elements, 7);
}

TEST(Override, AddsAKeyToAnObjectThatIsThere) {
  EXPECT_EQ(read_with({"/responses/stress/from=0.02"}).responses[1].from, 0.02);
}

TEST(Override, BeginsABlockThatTheFileLeavesOut) {
  EXPECT_EQ(read_with({"/sensitivity/method=adjoint"}).sensitivity.method, GradientMethod::adjoint);
  EXPECT_EQ(complaint_with("/sensitivity/metod=adjoint"),
            "good.json: /sensitivity has the unknown key \"metod\"; did you mean \"method\"?");
}

TEST(Override, BeginsABlockOfTheSceneThatTheFileLeavesOut) {
  ASSERT_TRUE(read_with({}).scene.loads.empty());
  const ProblemFile problem =
      read_with({R"(/scene/loads/push={"type": "force", "body": "slider", "at": [0.3, 0, 0],
           "direction": [1, 0, 0], "value": "1 N"})"});
  EXPECT_EQ(problem.scene.loads.size(), 1u);
}

TEST(Override, IsAppliedInOrder) {
  EXPECT_EQ(read_with({"/optimizer/backend=a", "/optimizer/backend=b=c"}).optimizer.backend, "b=c");
}

TEST(Override, ReachesKeysWithSlashesAndTildes) {
  Json document = good_json();
  document["responses"]["a/b~c"] = document["responses"]["stress"];
  const ProblemFile problem =
      read_problem_text(document.dump(), "good.json", {"/responses/a~1b~0c/over_time=rms"})
          .complete();
  EXPECT_EQ(problem.responses.back().over_time, OverTime::rms);
}

TEST(Override, IsCheckedLikeTheFile) {
  EXPECT_EQ(complaint_with("/simulation/step=-1"),
            "good.json: /simulation/step must be positive [s], got -1");
  EXPECT_EQ(complaint_with("/simulation/stepp=1"),
            "good.json: /simulation has the unknown key \"stepp\"; did you mean \"step\"?");
  EXPECT_EQ(complaint_with("/simulation/step=1e400"),
            "good.json: /simulation/step must be a time [s], got \"1e400\": it is out of the range "
            "of numbers");
}

TEST(BadOverride, SaysWhatIsWrongWithIt) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", ": has no \"=\"; write /json/pointer=value"},
      {"/simulation/step", "/simulation/step: has no \"=\"; write /json/pointer=value"},
      {"=3", "=3: must begin with a JSON pointer such as /simulation/step"},
      {"simulation/step=1",
       "simulation/step=1: must begin with a JSON pointer such as "
       "/simulation/step"},
      {"/a~2=1", "/a~2=1: has a \"~\" that is neither ~0 (~) nor ~1 (/)"},
      {"/a~=1", "/a~=1: has a \"~\" that is neither ~0 (~) nor ~1 (/)"},
      {"/simulaton/step=1",
       "/simulaton/step=1: the problem has no key \"simulaton\"; did you mean "
       "\"simulation\"?"},
      {"/scene/bodies/shaft/elements=1",
       "/scene/bodies/shaft/elements=1: /scene/bodies has no key \"shaft\"; known are \"crank\", "
       "\"rod\", \"slider\" and \"wheel\""},
      {"/simulation/step/unit=1", "/simulation/step/unit=1: /simulation/step has no members"},
      {"/accuracy/elements/2=1",
       "/accuracy/elements/2=1: /accuracy/elements is a list of 2 values, "
       "counted from 0, and has no \"2\""},
      {"/accuracy/elements/-=1",
       "/accuracy/elements/-=1: /accuracy/elements is a list of 2 "
       "values, counted from 0, and has no \"-\""},
      {"/accuracy/elements/-1=1",
       "/accuracy/elements/-1=1: /accuracy/elements is a list of 2 "
       "values, counted from 0, and has no \"-1\""}};
  for (const auto& [assignment, message] : cases) {
    EXPECT_EQ(complaint_with(assignment), "good.json: --set " + message);
  }
}

const BeamBody& beam(const ProblemFile& problem, std::size_t body) {
  return std::get<BeamBody>(problem.scene.bodies[body].shape);
}

TEST(Binding, RefersToTheVariableByItsPlaceInTheFile) {
  const ProblemFile problem = read(good_json());
  const auto& crank = std::get<RectangleSection>(beam(problem, 0).segments[0].section);
  const auto& rod = std::get<TubeSection>(beam(problem, 1).segments[0].section);
  EXPECT_EQ(problem.variables[0].name, "width");
  EXPECT_EQ(problem.variables[1].name, "diameter");
  EXPECT_EQ(crank.width.variable, 0);
  EXPECT_EQ(rod.outer_diameter.variable, 1);
  EXPECT_EQ(std::get<PointMass>(problem.scene.bodies[2].shape).mass.variable, 2);
}

TEST(Binding, HasTheFactorOneUnlessItIsGiven) {
  const ProblemFile problem = read(good_json());
  const auto& crank = std::get<RectangleSection>(beam(problem, 0).segments[0].section);
  EXPECT_EQ(crank.width.factor, 1.0);
  EXPECT_EQ(crank.height.factor, 2.0);
  EXPECT_EQ(resolve(crank.height, Design<double>{0.02, 0.0, 0.0}), 0.04);
}

TEST(Binding, LeavesOtherNumbersFixed) {
  const ProblemFile problem = read(good_json());
  const auto& rod = std::get<TubeSection>(beam(problem, 1).segments[0].section);
  EXPECT_FALSE(rod.thickness.is_bound());
  EXPECT_EQ(rod.thickness.constant, 0.002);
}

TEST(Variable, IsInSiAndRemembersItsUnit) {
  const ProblemFile problem = read(good_json());
  const DesignVariable& width = problem.variables[0];
  EXPECT_EQ(width.start, 0.02);
  EXPECT_EQ(width.lower, 0.004);
  EXPECT_EQ(width.upper, 0.06);
  EXPECT_EQ(width.unit, "mm");
  EXPECT_EQ(problem.variables[1].unit, "mm");  // the start is a plain number, the upper bound not
  EXPECT_EQ(problem.variables[2].upper, 1.0);
}

TEST(Variable, WithoutUnitIsPlain) {
  Json document = edited("/variables/load", R"({"start": 0.3, "lower": 0.1, "upper": 1})");
  EXPECT_EQ(read(document).variables[2].unit, "");
}

TEST(Variable, OfALinearConstraintAloneMeasuresWhatTheOthersDo) {
  Json document = edited("/variables/slack", R"({"start": "1 mm", "lower": 0, "upper": "2 mm"})");
  document["constraints"]["slender"]["linear"]["slack"] = 1;
  EXPECT_EQ(read(document).variables[3].start, 0.001);
  document["variables"]["slack"]["start"] = "1 kg";
  EXPECT_EQ(complaint(document),
            "bad.json: /variables/slack/start must be a length [m], got \"1 kg\": \"kg\" measures "
            "something else");
}

TEST(Variable, MayMoveAJointWithTheEndsOfItsBeams) {
  Json document =
      edited("/variables/length", R"({"start": "120 mm", "lower": "100 mm", "upper": "140 mm"})");
  const Json bound = Json::parse(R"([{"variable": "length"}, 0, 0])");
  document["scene"]["bodies"]["crank"]["to"] = bound;
  document["scene"]["bodies"]["rod"]["from"] = bound;
  document["scene"]["joints"]["pin"]["at"] = bound;
  EXPECT_EQ(complaint(document), "");
  document["scene"]["joints"]["pin"]["at"] = Json::parse("[0.12, 0, 0]");
  EXPECT_EQ(complaint(document),
            "bad.json: /scene/joints/pin/at must stay at the share 1 of the length of the beam "
            "\"crank\", which is (0.1, 0, 0) [m], got (0.12, 0, 0), with the variable \"length\" "
            "at its lower "
            "bound");
}

TEST(Joint, MayBeAnywhereAlongABeam) {  // the rod goes from 0.12 m to 0.3 m
  for (const char* x : {"0.12", "0.1425", "0.15", "0.2999"}) {
    Json document = edited("/scene/joints/end/at/0", x);
    document["scene"]["joints"]["guide"]["at"][0] = Json::parse(x);
    document["scene"]["bodies"]["slider"]["at"][0] = Json::parse(x);
    EXPECT_EQ(complaint(document), "") << x;
  }
}

TEST(LinearConstraint, HasItsTermsInOrderAndLimitsInSi) {
  const ProblemFile problem = read(good_json());
  const ConstraintSettings& slender = problem.constraints[3];
  EXPECT_EQ(slender.response, "");
  const std::vector<std::pair<int, double>> expected = {{1, 1.0}, {0, -2.0}};
  EXPECT_EQ(slender.linear, expected);
  EXPECT_EQ(slender.upper, 0.001);
  EXPECT_FALSE(slender.lower.has_value());
}

TEST(Fractions, AreRoundedNumbersThatSumToOneExactly) {
  Json document = edited("/scene/bodies/rod/segments/0/length_fraction", "0.3333333");
  document["scene"]["bodies"]["rod"]["segments"][1]["length_fraction"] = 0.6666666;
  const ProblemFile problem = read(document);
  const std::vector<Segment>& segments = beam(problem, 1).segments;
  EXPECT_DOUBLE_EQ(*segments[0].fraction + *segments[1].fraction, 1.0);
  EXPECT_NEAR(*segments[0].fraction, 1.0 / 3.0, 1e-7);
}

}  // namespace
}  // namespace pleuel::test::override_test
