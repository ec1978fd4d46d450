#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/response/linearized_expression.hpp"
#include "core/scene/problem_reader.hpp"
#include "core/trust/checks.hpp"
#include "optimization/design/design_solve.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/problems/loaded_crank.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/test.hpp"

/// Responses of joints, springs, motors and sections in closed form.

/// A slider-crank whose points are formulas of the lengths of crank and rod: its stroke is twice the
/// crank, whatever the rod.

namespace pleuel::test::read_responses_test {
namespace {

using Json = nlohmann::ordered_json;

struct Simulated : AtStart {
  using AtStart::AtStart;
  Eigen::RowVectorXd gradient(const char* name) {
    return direct_gradients(*analysis).row(response_index(problem, name));
  }
};

/// A block that is driven along x by v t, on a spring from the ground at −l₀.
TEST(SpringResponse, IsThatOfTheSpringLaw) {
  Simulated block(R"({
    "scene": {
      "bodies": {"block": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.1, 0.1, 0.1, 0, 0, 0]}},
      "joints": {"guide": {"type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0], "axis": [1, 0, 0],
                           "drive": {"type": "constant-speed", "speed": "= speed"}}},
      "loads": {"spring": {"type": "spring", "bodies": ["ground", "block"],
                           "at": [["-200 mm", 0, 0], [0, 0, 0]], "stiffness": "= stiffness",
                           "damping": "7 N s/m", "free_length": "150 mm"}}},
    "simulation": {"end_time": "0.1 s", "step": "1 ms"},
    "variables": {"speed": {"start": "0.5 m/s", "lower": "0.1 m/s", "upper": "1 m/s"},
                  "stiffness": {"start": "300 N/m", "lower": "1 N/m", "upper": "1 N/mm"}},
    "responses": {
      "length": {"type": "spring-length", "load": "spring", "over_time": "final"},
      "force": {"type": "spring-force", "load": "spring", "over_time": "final"},
      "loss": {"type": "damper-power", "load": "spring", "over_time": "mean"},
      "aslant": {"type": "velocity", "body": "block", "direction": [3, 0, -4], "over_time": "mean"},
      "travel": {"type": "joint-position", "joint": "guide", "over_time": "final"},
      "speed": {"type": "joint-velocity", "joint": "guide", "over_time": "mean"}}})");
  EXPECT_NEAR(block.value("length"), 0.25, 1e-10);               // 200 mm + v t
  EXPECT_NEAR(block.value("force"), 300 * 0.1 + 7 * 0.5, 1e-7);  // k (l − l₀) + c v
  EXPECT_NEAR(block.value("travel"), 0.05, 1e-10);
  EXPECT_NEAR(block.value("speed"), 0.5, 1e-9);
  EXPECT_NEAR(block.value("loss"), 7 * 0.25, 1e-8);  // c v²
  EXPECT_NEAR(block.value("aslant"), 0.3, 1e-9);     // 3/5 of v
  const Eigen::RowVectorXd by = block.gradient("force");
  EXPECT_NEAR(by(0), 300 * 0.1 + 7, 1e-6);  // k t + c
  EXPECT_NEAR(by(1), 0.1, 1e-9);            // l − l₀
}

/// A wheel with the moment of inertia I under a motor m: ω = m t/I, φ = m t²/(2 I), P = m ω.
TEST(MotorResponse, IsTorqueTimesAngularVelocity) {
  Simulated wheel(R"({
    "scene": {
      "bodies": {"wheel": {"type": "rigid", "at": [0, 0, 0], "mass": 3, "inertia": [0.2, 0.2, 0.4, 0, 0, 0]}},
      "joints": {"axle": {"type": "revolute", "bodies": ["ground", "wheel"], "at": [0, 0, 0], "axis": [0, 0, -1]}},
      "loads": {"motor": {"type": "joint", "joint": "axle", "motor": {"variable": "torque"}}}
    },
    "simulation": {"end_time": "2 s", "step": "10 ms"},
    "variables": {"torque": {"start": "8 N m", "lower": "1 N m", "upper": "9 N m"}},
    "responses": {
      "angle": {"type": "joint-position", "joint": "axle", "over_time": "final"},
      "rate": {"type": "joint-velocity", "joint": "axle", "over_time": "final"},
      "spin": {"type": "angular-velocity", "body": "wheel", "direction": "z", "over_time": "final"},
      "size": {"type": "angular-velocity", "body": "wheel", "direction": "magnitude", "over_time": "final"},
      "turn": {"type": "angle", "body": "wheel", "direction": "z", "over_time": "final"},
      "gain": {"type": "joint-acceleration", "joint": "axle", "over_time": "max"},
      "growth": {"type": "angular-acceleration", "body": "wheel", "direction": "z", "over_time": "mean"},
      "aslant": {"type": "angular-velocity", "body": "wheel", "direction": [0, 3, 4], "over_time": "final"},
      "power": {"type": "motor-power", "load": "motor", "over_time": "final"}
    }})");
  EXPECT_NEAR(wheel.value("turn"), -40.0, 1e-8);    // counted, about +z
  EXPECT_NEAR(wheel.value("growth"), -20.0, 1e-8);  // 8/0.4
  EXPECT_NEAR(wheel.value("gain"), 20.0, 1e-8);     // about the axis −z
  EXPECT_NEAR(wheel.value("aslant"), -32.0, 1e-8);  // 4/5 of the one about z
  EXPECT_NEAR(wheel.value("rate"), 40.0, 1e-8);     // 8 · 2/0.4
  EXPECT_NEAR(wheel.value("angle"), 40.0, 1e-8);    // 8 · 4/0.8: more than six turns
  EXPECT_NEAR(wheel.value("spin"), -40.0, 1e-8);    // about the axis −z
  EXPECT_NEAR(wheel.value("size"), 40.0, 1e-8);
  EXPECT_NEAR(wheel.value("power"), 320.0, 1e-6);
  EXPECT_NEAR(wheel.gradient("power")(0), 80.0, 1e-5);  // 2 m t/I
}

/// A cantilever of 1 m under forces at its tip, in equilibrium.
constexpr const char* cantilever = R"({
    "scene": {
      "bodies": {
        "bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                "section": {"type": "rectangle", "width": "30 mm", "height": "= height"}, "elements": 4},
        "stub": {"type": "beam", "from": [0, 0, 1], "to": [1, 0, 1], "material": "steel",
                 "section": {"type": "rectangle", "width": "30 mm", "height": "40 mm"}, "elements": 2}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]},
                 "other": {"type": "fixed", "bodies": ["ground", "stub"], "at": [0, 0, 1]}},
      "loads": {
        "down": {"type": "force", "body": "bar", "at": [1, 0, 0], "direction": [0, -1, 0], "value": "= force"},
        "aside": {"type": "force", "body": "bar", "at": [1, 0, 0], "direction": [0, 0, 1], "value": "30 N"},
        "pull": {"type": "force", "body": "bar", "at": [1, 0, 0], "direction": [1, 0, 0], "value": "500 N"},
        "twist": {"type": "torque", "body": "bar", "at": [1, 0, 0], "direction": [1, 0, 0], "value": "0.9 N m"},
        "small": {"type": "force", "body": "stub", "at": [1, 0, 1], "direction": [0, -1, 0], "value": "10 N"}}
    },
    "effects": {"geometric_stiffening": "off"},
    "simulation": {"end_time": "1 ms", "step": "0.1 ms", "initial_state": "quasi-static"},
    "variables": {"height": {"start": "40 mm", "lower": "20 mm", "upper": "60 mm"},
                  "force": {"start": "40 N", "lower": "1 N", "upper": "60 N"}},
    "responses": {
      "N": {"type": "section-force", "body": "bar", "at": 0.3, "part": "axial", "over_time": "mean"},
      "Mz": {"type": "section-force", "body": "bar", "at": 0.25, "part": "moment-z", "over_time": "max-abs"},
      "My": {"type": "section-force", "body": "bar", "at": 0.6, "part": "moment-y", "over_time": "max-abs"},
      "Vy": {"type": "section-force", "body": "bar", "at": 0.3, "part": "shear-y", "over_time": "mean"},
      "Vz": {"type": "section-force", "body": "bar", "at": 0.3, "part": "shear-z", "over_time": "mean"},
      "T": {"type": "section-force", "body": "bar", "at": 0.6, "part": "torque", "over_time": "mean"},
      "y": {"type": "deflection", "body": "bar", "at": 1, "over_time": "max-abs"},
      "z": {"type": "deflection", "body": "bar", "at": 1, "direction": "z", "over_time": "max-abs"},
      "x": {"type": "deflection", "body": "bar", "at": 1, "direction": "x", "over_time": "max-abs"},
      "resultant": {"type": "deflection", "body": "bar", "at": 1, "direction": "resultant", "over_time": "max"},
      "bar": {"type": "stress", "body": "bar", "over_time": "max"},
      "stub": {"type": "stress", "body": "stub", "over_time": "max"},
      "both": {"type": "stress", "bodies": ["stub", "bar"], "over_time": "max"}
    }})";

TEST(SectionForce, IsThatOfStatics) {
  Simulated bar(cantilever);
  // The torque at the turned tip has a share across the beam: 0.9 N m · 8e-4 rad/2.
  EXPECT_NEAR(bar.value("N"), 500.0, 5e-3);
  EXPECT_NEAR(bar.value("Mz"), 40.0 * 0.75, 1e-3);
  EXPECT_NEAR(bar.value("My"), 30.0 * 0.4, 1e-3);
  EXPECT_NEAR(bar.value("T"), 0.9, 1e-5);
  EXPECT_NEAR(bar.value("Vy"), -40.0, 1e-2);  // of the part behind on the part before
  EXPECT_NEAR(bar.value("Vz"), 30.0, 1e-2);
  const Eigen::RowVectorXd by = bar.gradient("Mz");
  EXPECT_NEAR(by(0), 0.0, 0.1);  // a moment of statics does not depend on the height
  EXPECT_NEAR(by(1), 0.75, 1e-4);
}

/// Of a cantilever under its weight, ρ A g (L − x) at every place, though each element has one
/// derivative of its curvature: the rest is what the load does within it.
TEST(ShearForce, CarriesTheWeightBehindIt) {
  Simulated bar(R"({
    "scene": {"gravity": [0, -9.81, 3],
      "materials": {"steel": {"young": "210 GPa", "poisson": 0.3, "density": "= density"}},
      "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                 "section": {"type": "rectangle", "width": "30 mm", "height": "40 mm"}, "elements": 2}},
      "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}}
    },
    "effects": {"geometric_stiffening": "off"},
    "simulation": {"end_time": "1 ms", "step": "0.1 ms", "initial_state": "quasi-static"},
    "variables": {"density": {"start": "8000 kg/m^3", "lower": "1 kg/m^3", "upper": "9000 kg/m^3"}},
    "responses": {
      "y": {"type": "section-force", "body": "bar", "at": 0.3, "part": "shear-y", "over_time": "mean"},
      "z": {"type": "section-force", "body": "bar", "at": 0.3, "part": "shear-z", "over_time": "mean"},
      "node": {"type": "section-force", "body": "bar", "at": 0.5, "part": "shear-y", "over_time": "mean"},
      "wall": {"type": "section-force", "body": "bar", "at": 0, "part": "shear-y", "over_time": "mean"}
    }})");
  const double weight = 8000 * 0.03 * 0.04 * 9.81;
  EXPECT_NEAR(bar.value("y"), -0.7 * weight, 1e-3);
  EXPECT_NEAR(bar.value("z"), 0.7 * weight * 3 / 9.81, 1e-3);
  EXPECT_NEAR(bar.value("node"), -0.5 * weight, 1e-3);
  EXPECT_NEAR(bar.value("wall"), -weight, 1e-3);
  EXPECT_NEAR(bar.gradient("y")(0), -0.7 * weight / 8000, 1e-6);
}

TEST(Deflection, HasAResultantAndAnAxialPart) {
  Simulated bar(cantilever);
  EXPECT_NEAR(bar.value("resultant"), std::hypot(bar.value("y"), bar.value("z")),
              1e-9 * bar.value("resultant"));
  EXPECT_NEAR(bar.value("x"), 500.0 / (210e9 * 0.03 * 0.04), 1e-10);  // F L/(E A)
  const Eigen::RowVectorXd by = bar.gradient("resultant"), y = bar.gradient("y"),
                           z = bar.gradient("z");
  const Eigen::RowVectorXd expected =
      (bar.value("y") * y + bar.value("z") * z) / bar.value("resultant");
  EXPECT_LT((by - expected).norm(), 1e-6 * expected.norm());
}

TEST(Stress, OfSeveralBodiesIsTheLargestOfThem) {
  Simulated bars(cantilever);
  EXPECT_GT(bars.value("bar"), bars.value("stub"));
  EXPECT_EQ(bars.value("both"), bars.value("bar"));
  EXPECT_LT((bars.gradient("both") - bars.gradient("bar")).norm(),
            1e-12 * bars.gradient("bar").norm());
}

/// What the reader says of the cantilever with another response.
std::string complaint(const char* response) {
  Json document = Json::parse(cantilever);
  document["responses"] = {{"asked", Json::parse(response)}};
  return thrown<InputError>([&] { read_problem_text(document.dump(), "test.json").complete(); });
}

TEST(ReadResponse, OfAnythingElseIsRefusedWithItsPlace) {
  const auto expect = [](const char* response, const std::string& place, const char* says) {
    const std::string said = complaint(response);
    EXPECT_EQ(said.find("test.json: /responses/asked/" + place), 0U) << said;
    EXPECT_NE(said.find(says), std::string::npos) << said;
  };
  expect(R"({"type": "motor-power", "load": "pull", "over_time": "max"})", "load",
         "\"pull\" has none");
  expect(R"({"type": "damper-power", "load": "pull", "over_time": "max"})", "load", "\"damping\"");
  expect(R"({"type": "angle", "body": "bar", "direction": "magnitude", "over_time": "max"})",
         "direction", "\"x\", \"y\" or \"z\"");
  expect(R"({"type": "spring-force", "load": "pull", "over_time": "max"})", "load", "\"spring\"");
  expect(R"({"type": "spring-length", "load": "pul", "over_time": "max"})", "load",
         "did you mean \"pull\"?");
  expect(R"({"type": "joint-position", "joint": "wall", "over_time": "max"})", "joint",
         "\"fixed\"");
  expect(
      R"({"type": "section-force", "body": "bar", "at": 0.5, "part": "bend", "over_time": "max"})",
      "part", "\"moment-z\"");
  expect(R"({"type": "stress", "bodies": ["bar", "bar"], "over_time": "max"})", "bodies/1",
         "a second time");
  expect(R"({"type": "deflection", "body": "bar", "at": 1, "against": "chord", "direction": "x",
             "over_time": "max"})",
         "direction", "\"resultant\"");
}

Json slider_crank() {
  return Json::parse(R"json({
    "constants": {"speed": "10 rad/s"},
    "scene": {
      "bodies": {
        "crank": {"type": "beam", "from": [0, 0, 0], "to": ["= crank", 0, 0], "rigid": true,
                  "material": "steel", "section": {"type": "circle", "diameter": "= crank/5"}, "elements": 1},
        "rod": {"type": "beam", "from": ["= crank", 0, 0], "to": ["= crank + rod", 0, 0],
                "rigid": true, "material": "steel",
                "section": {"type": "circle", "diameter": "8 mm"}, "elements": 1},
        "slider": {"type": "point-mass", "at": ["= crank + rod", 0, 0], "mass": "0.2 kg"}
      },
      "joints": {
        "bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                    "drive": {"type": "constant-speed", "speed": "= speed"}},
        "pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": ["= crank", 0, 0]},
        "end": {"type": "revolute", "bodies": ["rod", "slider"], "at": ["= crank + rod", 0, 0]},
        "guide": {"type": "point-on-line", "bodies": ["ground", "slider"],
                  "at": ["= crank + rod", 0, 0], "axis": [1, 0, 0]}}},
    "simulation": {"end_time": "= 7 rad/speed", "step": "5 ms"},
    "variables": {
      "crank": {"start": "40 mm", "lower": "20 mm", "upper": "80 mm"},
      "rod": {"start": "150 mm", "lower": "120 mm", "upper": "200 mm"}
    },
    "responses": {
      "stroke": {"type": "expression", "value": "right - left"},
      "left": {"type": "position", "body": "slider", "direction": "x", "over_time": "min"},
      "right": {"type": "position", "body": "slider", "direction": "x", "over_time": "max"},
      "mass": {"type": "mass"},
      "effort": {"type": "drive-torque", "joint": "bearing", "over_time": "rms"},
      "cost": {"type": "expression",
               "value": "sqrt(effort^2 + (1 N m)^2)*mass/(1 kg)/(stroke + rod) + 3 N*max(0.1, crank/rod)"
}
}
  })json");
}

ProblemFile problem_of(const Json& document) {
  return problem_from(document.dump());
}

double value_of(const ProblemFile& problem, const Analysis& analysis, const char* name) {
  return analysis.reductions[response_index(problem, name)].value;
}

TEST(ExpressionOfResponses, IsTheStrokeOfASliderCrank) {
  const ProblemFile problem = problem_of(slider_crank());
  Eigen::VectorXd x(2);
  for (const double crank : {0.04, 0.055}) {
    x << crank, 0.15;
    const auto analysis = analyze(problem, x);
    // The peak between two steps of 0.05 rad is that of a parabola: 0.05⁴ off.
    EXPECT_NEAR(value_of(problem, *analysis, "stroke"), 2 * crank, 1e-5 * crank);
  }
}

TEST(ExpressionOfResponses, HasTheGradientOfTheStroke) {
  const auto [problem, x, analysis] = AtStart(problem_of(slider_crank()));
  const Eigen::MatrixXd gradients = direct_gradients(*analysis);
  const Eigen::Index stroke = response_index(problem, "stroke");
  EXPECT_NEAR(gradients(stroke, 0), 2.0, 1e-5);
  EXPECT_NEAR(gradients(stroke, 1), 0.0, 1e-5);
}

TEST(ExpressionOfResponses, HasOneGradientByAllMethods) {
  const auto [problem, x, analysis] = AtStart(problem_of(slider_crank()));
  const Eigen::Index cost = response_index(problem, "cost");
  const auto by = [&, &problem = problem, &x = x,
                   &analysis = analysis](GradientMethod method) -> Eigen::RowVectorXd {
    return gradients(problem, x, *analysis, method).row(cost);
  };
  const Eigen::RowVectorXd direct = by(GradientMethod::direct);
  EXPECT_LT((by(GradientMethod::adjoint) - direct).norm(), 1e-10 * direct.norm());
  // Differences with a relative step of 1e-5 have the noise of Newton's method over it.
  EXPECT_LT((by(GradientMethod::central_difference) - direct).norm(), 1e-5 * direct.norm());
}

/// The chain rule by hand, from the gradients of the parts.
TEST(ExpressionOfResponses, FollowsTheChainRuleThroughOtherExpressions) {
  Json document = slider_crank();
  document["responses"]["twice"] = {{"type", "expression"}, {"value", "2*stroke*mass - rod*mass"}};
  const auto [problem, x, analysis] = AtStart(problem_of(document));
  const Eigen::MatrixXd g = direct_gradients(*analysis);
  const auto row = [&, &problem = problem](const char* name) -> Eigen::RowVectorXd {
    return g.row(response_index(problem, name));
  };
  const double mass = value_of(problem, *analysis, "mass"),
               stroke = value_of(problem, *analysis, "stroke");
  Eigen::RowVectorXd expected =
      2 * mass * (row("right") - row("left")) + (2 * stroke - 0.15) * row("mass");
  expected(1) -= mass;  // explicitly by the rod
  EXPECT_LT((row("twice") - expected).norm(), 1e-12 * expected.norm());
}

/// To first order the error of a difference is at most the sum of those of both.
TEST(ExpressionOfResponses, HasAnErrorBarFromItsParts) {
  Json document = slider_crank();
  document["responses"]["sum"] = {{"type", "expression"}, {"value", "3*effort + 2 N*right"}};
  const auto [problem, x, analysis] = AtStart(problem_of(document));
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  const Trust trust = judge_run({problem, x, *analysis, monitors});
  const auto bar = [&, &problem = problem](const char* name) {
    return *trust.errors[response_index(problem, name)];
  };
  EXPECT_TRUE(bar("sum").is_resolved());
  EXPECT_GT(bar("sum").bound(), 0.0);
  EXPECT_LE(bar("sum").bound(), 3 * bar("effort").bound() + 2 * bar("right").bound() + 1e-12);
  EXPECT_GE(bar("sum").bound(), 0.5 * 3 * bar("effort").bound() - 2 * bar("right").bound());
}

TEST(ExpressionOfResponses, WithoutFiniteValueSaysSo) {
  Json document = slider_crank();
  document["responses"]["root"] = {{"type", "expression"}, {"value", "sqrt(left - right)"}};
  const ProblemFile problem = problem_of(document);
  EXPECT_THAT(thrown<SimulationError>([&] { started(problem); }),
              HasSubstr("the response \"root\" has no finite value there: "
                        "\"sqrt(left - right)\", with left = "));
}

TEST(ExpressionOfResponses, WithoutDerivativeSaysSoWhereItIsAsked) {
  Json document = slider_crank();
  document["responses"]["root"] = {{"type", "expression"}, {"value", "sqrt(mass - mass)"}};
  const ProblemFile problem = problem_of(document);
  const auto analysis = analyze(problem, start_design(problem));  // the value is 0
  EXPECT_THROW(direct_gradients(*analysis), SimulationError);
}

/// The longest crank whose stroke is 100 mm.
TEST(Maximize, FindsTheLargestDesignWithinItsLimits) {
  Json document = slider_crank();
  document["objective"] = {{"maximize", "= crank"}};
  document["constraints"]["room"] = {{"response", "stroke"}, {"upper", "100 mm"}};
  const Result result = verified_optimum(problem_of(document));
  EXPECT_NEAR(result.x(0), 0.05, 1e-6);
  EXPECT_NEAR(-result.evaluation.objective, 0.05, 1e-6);
}

TEST(Maximize, IsToMinimizeTheNegative) {
  Json document = slider_crank();
  document["objective"] = {{"maximize", "= cost/(1 N)"}};
  const ProblemFile largest = problem_of(document);
  document["objective"] = {{"minimize", "= -cost/(1 N)"}};
  const ProblemFile smallest = problem_of(document);
  DesignProblem a(largest), b(smallest);
  const Eigen::VectorXd x = start_design(largest);
  const Evaluation of_a = a.evaluate(x, Request::values_and_gradients),
                   of_b = b.evaluate(x, Request::values_and_gradients);
  EXPECT_EQ(of_a.objective, of_b.objective);
  EXPECT_LT((of_a.objective_gradient - of_b.objective_gradient).norm(),
            1e-12 * of_b.objective_gradient.norm());
}

}  // namespace
}  // namespace pleuel::test::read_responses_test
