#include <filesystem>

#include "core/base/error.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/scene/shown_unit.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/files.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::problem_files_test {
namespace {

using std::numbers::pi;

ProblemFile read_file(const std::string& name) {
  return read_problem(std::filesystem::path(source_folder()) / "problems" / name).complete();
}

const BeamBody& beam_of(const ProblemFile& problem, std::size_t body) {
  return std::get<BeamBody>(problem.scene.bodies[body].shape);
}

double start_mass(const ProblemFile& problem) {
  double mass = 0.0;
  Design<double> start;
  for (const DesignVariable& variable : problem.variables) start.push_back(variable.start);
  for (const Segment& segment : beam_of(problem, 0).segments) {
    const auto& circle = std::get<CircleSection>(segment.section);
    const double diameter = resolve(circle.diameter, start);
    mass += 0.25 * pi * diameter * diameter * 0.12 * 7850.0 * segment.elements / 8.0;
  }
  return mass;
}

// The numbers are those of the issue that asks for these problems.
class SliderCrank : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Files, SliderCrank,
                         testing::Values("slider_crank.json", "slider_crank_round.json",
                                         "slider_crank_tapered.json"),
                         named_by_value());

TEST_P(SliderCrank, HasTheCommonMechanism) {
  const ProblemFile problem = read_file(GetParam());
  const Scene& scene = problem.scene;
  ASSERT_EQ(scene.bodies.size(), 3U);
  ASSERT_EQ(scene.joints.size(), 4U);
  EXPECT_EQ(scene.materials[0].young.constant, 2.1e11);
  EXPECT_EQ(scene.materials[0].poisson.constant, 0.3);
  EXPECT_EQ(scene.materials[0].density.constant, 7850.0);
  EXPECT_EQ(beam_of(problem, 0).to[0].constant, 0.12);
  EXPECT_EQ(beam_of(problem, 1).from[0].constant, 0.12);
  EXPECT_EQ(beam_of(problem, 1).to[0].constant, 0.3);
  EXPECT_EQ(beam_of(problem, 0).frame, ReferenceCondition::tangent);
  EXPECT_EQ(beam_of(problem, 1).frame, ReferenceCondition::chord);
  for (std::size_t i : {0U, 1U}) {
    EXPECT_EQ(beam_of(problem, i).damping.stiffness.constant, 1e-5);
    EXPECT_EQ(beam_of(problem, i).damping.mass.constant, 0.0);
  }
  EXPECT_EQ(std::get<PointMass>(scene.bodies[2].shape).mass.constant, 0.2826);
  for (const Number& component : scene.gravity) EXPECT_EQ(component.constant, 0.0);
}

TEST_P(SliderCrank, IsDrivenFromRestToSpeed) {
  const ProblemFile problem = read_file(GetParam());
  const Joint& bearing = problem.scene.joints[0];
  EXPECT_EQ(bearing.name, "bearing");
  EXPECT_THAT(bearing.bodies, ElementsAre("ground", "crank"));
  const auto& drive = std::get<RampToSpeedDrive>(bearing.drive->motion);
  EXPECT_EQ(drive.speed.constant, 200.0);
  EXPECT_EQ(drive.ramp.constant, 0.05);
}

TEST_P(SliderCrank, IsSimulatedForTwoRevolutionsAfterTheRamp) {
  const ProblemFile problem = read_file(GetParam());
  EXPECT_EQ(problem.simulation.end_time, 0.05 + 4.0 * pi / 200.0);
  EXPECT_EQ(problem.simulation.step, 2.5e-5);
  EXPECT_EQ(problem.simulation.spectral_radius, 0.8);
  EXPECT_EQ(problem.sensitivity.method, GradientMethod::automatic);
  EXPECT_EQ(problem.sensitivity.difference_step, 1e-5);
  EXPECT_EQ(problem.sensitivity.invariants.derivatives, InvariantDerivatives::exact);
  EXPECT_EQ(problem.sensitivity.memory, 4e9);
  EXPECT_EQ(problem.effects.geometric_stiffening, EffectChoice::on);
  EXPECT_EQ(problem.effects.spatial_motion, EffectChoice::automatic);
}

TEST_P(SliderCrank, IsLimitedInStressAndDeflection) {
  const ProblemFile problem = read_file(GetParam());
  for (const ConstraintSettings& constraint : problem.constraints) {
    if (constraint.name.find("strength") != std::string::npos) {
      EXPECT_EQ(constraint.upper, 2e8);
    } else if (constraint.response == "rod_bow") {
      EXPECT_EQ(constraint.upper, 2e-4);
    } else if (constraint.response == "crank_tip") {
      EXPECT_EQ(constraint.upper, 5e-4);
    } else {
      EXPECT_FALSE(constraint.linear.empty()) << constraint.name;
    }
  }
  EXPECT_EQ(problem.objective->response, "crank_and_rod");
  EXPECT_THAT(bodies_of(problem.responses[0]), ElementsAre("crank", "rod"));
  for (const DesignVariable& variable : problem.variables) {
    EXPECT_EQ(variable.lower, 0.004);
    EXPECT_EQ(variable.upper, 0.06);
    EXPECT_EQ(variable.unit, "mm");
  }
}

TEST_P(SliderCrank, HasBothStudies) {
  const ProblemFile problem = read_file(GetParam());
  EXPECT_EQ(problem.pareto->constraint, "rod_stiffness");
  EXPECT_EQ(problem.pareto->from, 1e-4);
  EXPECT_EQ(problem.pareto->to, 4e-4);
  EXPECT_EQ(problem.pareto->points, 7);
  EXPECT_THAT(problem.accuracy.steps, ElementsAre(2e-4, 1e-4, 5e-5, 2.5e-5));
}

TEST(RectangularSliderCrank, HasFourVariablesAndProportions) {
  const ProblemFile problem = read_file("slider_crank.json");
  ASSERT_EQ(problem.variables.size(), 4U);
  EXPECT_EQ(problem.variables[0].start, 0.02);  // crank width
  EXPECT_EQ(problem.variables[3].start, 0.03);  // rod height
  const auto& rod = std::get<RectangleSection>(beam_of(problem, 1).segments[0].section);
  EXPECT_EQ(rod.width.variable, 2);
  EXPECT_EQ(rod.height.variable, 3);
  EXPECT_EQ(beam_of(problem, 1).segments[0].elements, 6);
  const std::vector<std::pair<int, double>> proportion = {{3, 1.0}, {2, -2.0}};
  EXPECT_EQ(problem.constraints.size(), 6U);
  EXPECT_EQ(problem.constraints[5].linear, proportion);
  EXPECT_EQ(problem.constraints[5].upper, 0.0);
}

TEST(RoundSliderCrank, HasTwoVariables) {
  const ProblemFile problem = read_file("slider_crank_round.json");
  EXPECT_EQ(problem.variables.size(), 2U);
  EXPECT_EQ(problem.constraints.size(), 4U);
  EXPECT_EQ(std::get<CircleSection>(beam_of(problem, 1).segments[0].section).diameter.variable, 1);
}

TEST(TaperedSliderCrank, HasAVariableAndAStressLimitForEachSegment) {
  const ProblemFile problem = read_file("slider_crank_tapered.json");
  EXPECT_EQ(problem.variables.size(), 8U);
  EXPECT_EQ(problem.constraints.size(), 10U);
  for (int i = 0; i < 8; ++i) {
    const std::size_t body = i < 4 ? 0 : 1;
    const Segment& segment = beam_of(problem, body).segments[i % 4];
    EXPECT_EQ(segment.elements, 2);
    EXPECT_EQ(std::get<CircleSection>(segment.section).diameter.variable, i);
    const auto& stress = std::get<StressResponse>(problem.responses[1 + i].what);
    EXPECT_EQ(stress.where.bodies[0], body == 0 ? "crank" : "rod");
    EXPECT_EQ(stress.where.segment, i % 4);
    EXPECT_EQ(problem.constraints[i].response, problem.responses[1 + i].name);
  }
}

TEST(TaperedSliderCrank, HasSegmentsThatFillTheMembers) {
  // Four segments of equal diameter weigh what one bar does: π/4 · (30 mm)² · 120 mm · 7850 kg/m³.
  EXPECT_NEAR(start_mass(read_file("slider_crank_tapered.json")), 0.66587, 1e-5);
}

TEST(ExudynSliderCrank, HasTheDataOfTheReference) {
  const ProblemFile problem = read_file("slider_crank_exudyn.json");
  EXPECT_TRUE(problem.variables.empty());
  EXPECT_FALSE(problem.objective.has_value());
  EXPECT_EQ(beam_of(problem, 0).to[0].constant, 0.15);
  EXPECT_EQ(beam_of(problem, 1).to[0].constant, 0.45);
  EXPECT_EQ(std::get<CircleSection>(beam_of(problem, 0).segments[0].section).diameter.constant,
            0.03);
  EXPECT_EQ(std::get<CircleSection>(beam_of(problem, 1).segments[0].section).diameter.constant,
            0.01);
  EXPECT_EQ(beam_of(problem, 0).segments[0].elements, 8);
  EXPECT_EQ(beam_of(problem, 1).damping.stiffness.constant, 0.0);
  EXPECT_EQ(std::get<PointMass>(problem.scene.bodies[2].shape).mass.constant, 0.5);
  const auto& drive = std::get<RampToSpeedDrive>(problem.scene.joints[0].drive->motion);
  EXPECT_EQ(drive.speed.constant, 150.0);
  EXPECT_EQ(problem.simulation.end_time, 0.15);
  EXPECT_EQ(problem.simulation.step, 5e-5);
  EXPECT_EQ(problem.simulation.spectral_radius, 0.9);
  EXPECT_EQ(problem.effects.geometric_stiffening, EffectChoice::on);
}

TEST(ExudynSliderCrank, TakesTheOtherRodByAnOverride) {
  const ProblemFile problem =
      read_problem(std::filesystem::path(source_folder()) / "problems/slider_crank_exudyn.json",
                   {"/scene/bodies/rod/section/diameter=30 mm"})
          .complete();
  EXPECT_EQ(std::get<CircleSection>(beam_of(problem, 1).segments[0].section).diameter.constant,
            0.03);
}

TEST(GoodProblem, KeepsWhatItSaysInTheOrderOfTheFile) {
  const ProblemFile problem = read(good_json());
  EXPECT_EQ(problem.name, "good");
  EXPECT_EQ(problem.scene.gravity[1].constant, -9.81);
  EXPECT_EQ(problem.scene.materials[1].name, "alloy");
  EXPECT_DOUBLE_EQ(problem.scene.materials[1].poisson.constant, 0.33);
  EXPECT_DOUBLE_EQ(problem.scene.materials[1].density.constant, 2700.0);
  EXPECT_EQ(problem.scene.bodies[3].name, "wheel");
  EXPECT_EQ(std::get<RigidBody>(problem.scene.bodies[3].shape).inertia[2].constant, 0.2);
  EXPECT_EQ(beam_of(problem, 0).damping.mass.constant, 2.0);
  EXPECT_EQ(beam_of(problem, 1).reference->at(2), 1.0);
  EXPECT_EQ(beam_of(problem, 1).segments[1].fraction, 0.75);
  EXPECT_EQ(problem.scene.joints[1].type, JointType::fixed);
  EXPECT_EQ(problem.scene.joints[4].type, JointType::point_on_line);
  EXPECT_THAT(problem.scene.joints[4].axis, ElementsAre(1.0, 0.0, 0.0));
  const auto& drive = std::get<RampToSpeedDrive>(problem.scene.joints[0].drive->motion);
  EXPECT_NEAR(drive.speed.constant, 157.07963267948966, 1e-12);  // 1500 · 2π/60
  EXPECT_EQ(problem.simulation.newton_tolerance, 1e-10);
  EXPECT_EQ(problem.simulation.max_newton_iterations, 12);
  EXPECT_EQ(problem.sensitivity.method, GradientMethod::central_difference);
  EXPECT_EQ(problem.sensitivity.difference_step, 1e-4);
  EXPECT_EQ(problem.sensitivity.invariants.derivatives, InvariantDerivatives::central);
  EXPECT_EQ(problem.sensitivity.invariants.step, 1e-5);
  EXPECT_EQ(problem.sensitivity.memory, 512e6);
  EXPECT_EQ(problem.optimizer.backend, "ipopt");
  EXPECT_EQ(problem.optimizer.max_iterations, 50);
  EXPECT_THAT(problem.accuracy.elements, ElementsAre(2, 4));
}

TEST(GoodProblem, HasItsResponses) {
  const std::vector<ResponseSettings> responses = read(good_json()).responses;
  EXPECT_EQ(std::get<StressResponse>(responses[1].what).where.segment, 1);
  EXPECT_EQ(std::get<DeflectionResponse>(responses[2].what).direction, 2);  // local z
  EXPECT_EQ(place_along(responses[2]), 0.5);
  EXPECT_EQ(std::get<PointMotionResponse>(responses[3].what).component.direction, 0);  // global x
  EXPECT_EQ(responses[3].over_time, OverTime::final);
  EXPECT_EQ(joint_of(responses[4]), "bearing");
  EXPECT_EQ(quantity_of(responses[0]).unit, "kg");
  EXPECT_EQ(quantity_of(responses[1]).unit, "Pa");
  EXPECT_EQ(quantity_of(responses[2]).unit, "m");
  EXPECT_EQ(quantity_of(responses[4]).unit, "N m s");
}

TEST(GoodProblem, MayAskForAGapOfTheFront) {
  EXPECT_EQ(read(good_json()).pareto->gap, 0.0);
  const ProblemFile with_points = read(edited("/pareto/gap", R"("5 %")"));
  EXPECT_DOUBLE_EQ(with_points.pareto->gap, 0.05);
  EXPECT_EQ(with_points.pareto->points, 5);
  EXPECT_EQ(with_points.pareto->most_points, 100);
  const ProblemFile without = read(edited("/pareto", R"({"constraint": "stiffness",
    "from": "0.1 mm", "to": "0.4 mm", "gap": 0.1, "most_points": 12})"));
  EXPECT_EQ(without.pareto->points, 3);
  EXPECT_EQ(without.pareto->most_points, 12);
}

TEST(GoodProblem, MayOmitWhatHasADefault) {
  Json document = good_json();
  for (const char* key : {"$schema", "name", "description", "effects", "objective", "constraints",
                          "sensitivity", "optimizer", "pareto", "accuracy", "responses"}) {
    document.erase(key);
  }
  document["scene"].erase("gravity");
  document["simulation"] = Json::parse(R"({"end_time": 1, "step": 0.1})");
  const ProblemFile problem = read(document);
  EXPECT_EQ(problem.simulation.spectral_radius, 0.8);
  EXPECT_EQ(problem.optimizer.backend, "nlopt-slsqp");
  EXPECT_EQ(problem.effects.geometric_stiffening, EffectChoice::automatic);
  EXPECT_FALSE(problem.pareto.has_value());
}

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
}  // namespace pleuel::test::problem_files_test
