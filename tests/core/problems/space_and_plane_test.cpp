#include <map>

#include <nlohmann/json.hpp>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "core/scene/response_kind.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/test.hpp"

/// Forces that are spread along a stretch, beside closed forms of beams.

namespace pleuel::test::space_and_plane_test {
namespace {

using Json = nlohmann::json;

/// A soft beam of aluminium that is swung about z bends by up to 0.2 rad and carries a stiffer arm,
/// which stands across it, by the joint "wrist". A case adds to it, or replaces the wrist.
Json swung_arm() {
  return Json::parse(R"({
    "scene": {
      "materials": {"light": {"young": 70e9, "poisson": 0.3, "density": 2700}},
      "bodies": {
        "boom": {"type": "beam", "from": [0, 0, 0], "to": [0.48, 0.36, 0], "material": "light",
                 "section": {"type": "rectangle", "width": 0.012, "height": 0.006},
                 "elements": 3, "frame": "chord", "damping": {"stiffness": 1e-4}},
        "arm": {"type": "beam", "from": [0.48, 0.36, 0], "to": [0.4, 0.6, 0], "material": "light",
                "section": {"type": "rectangle", "width": 0.02, "height": 0.016}, "elements": 2,
                "damping": {"stiffness": 1e-4}}},
      "joints": {
        "shoulder": {"type": "revolute", "bodies": ["ground", "boom"], "at": [0, 0, 0],
                     "drive": {"type": "harmonic", "amplitude": 0.12, "frequency": 30}},
        "wrist": {"type": "revolute", "bodies": ["boom", "arm"], "at": [0.48, 0.36, 0]}
      }
    },
    "simulation": {"end_time": 0.12, "step": 1e-3, "newton_tolerance": 1e-13},
    "responses": {
      "torque": {"type": "drive-torque", "joint": "shoulder", "over_time": "max-abs"},
      "boom stress": {"type": "stress", "body": "boom", "over_time": "max"},
      "arm stress": {"type": "stress", "body": "arm", "over_time": "max"},
      "x": {"type": "position", "body": "arm", "at": 1, "direction": "x", "over_time": "max"},
      "y": {"type": "position", "body": "arm", "at": 1, "direction": "y", "over_time": "max"},
      "force": {"type": "reaction-force", "joint": "wrist", "direction": "magnitude", "over_time": "max"},
      "moment": {"type": "reaction-moment", "joint": "shoulder", "direction": "z", "over_time": "max-abs"}
    }
  })");
}

ProblemFile problem_of(Json document, const char* spatial_motion) {
  document["effects"]["spatial_motion"] = spatial_motion;
  return problem_from(document.dump());
}

/// The largest rotation of a node of the boom against its frame [rad].
double largest_rotation(const Analysis& analysis) {
  const BodyModel& boom = analysis.model.body("boom");
  double largest = 0.0;
  for (int step = 0; step <= analysis.trajectory.steps(); ++step) {
    const State state = analysis.trajectory.state_at(step);
    const Eigen::VectorXd d = stacked_displacements(boom, state);
    for (Eigen::Index i = 0; i < d.size(); i += 6) {
      largest = std::max(largest, d.segment<3>(i + 3).norm());
    }
  }
  return largest;
}

/// Of each instant, as one number: stress of space has more channels.
Eigen::VectorXd largest_of(const Eigen::MatrixXd& history) {
  return history.cwiseAbs().colwise().maxCoeff();
}

/// Compares whole histories. Round-off: 1e-9 of the largest of each kind.
void expect_same_histories(const ProblemFile& problem, const Analysis& expected,
                           const Analysis& found) {
  std::map<std::string_view, double> scales;
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    double& scale = scales[kind_of(problem.responses[i].what).word];
    scale = std::max(scale, largest_of(expected.histories[i]).maxCoeff());
  }
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    const double scale = scales[kind_of(problem.responses[i].what).word];
    const Eigen::VectorXd difference =
        largest_of(expected.histories[i]) - largest_of(found.histories[i]);
    EXPECT_LE(difference.lpNorm<Eigen::Infinity>(), 1e-9 * scale) << problem.responses[i].name;
  }
}

void expect_space_as_plane(const Json& document) {
  const auto [planar, x, plane] = AtStart(problem_of(document, "auto"));
  const auto space = analyze(problem_of(document, "on"), start_design(planar));
  ASSERT_LT(plane->model.mechanism.system->coordinates(),
            space->model.mechanism.system->coordinates());
  EXPECT_GE(largest_rotation(*plane), 0.1) << "the case is to bend";
  EXPECT_LE(largest_rotation(*plane), 0.35) << "but not to fold";
  expect_same_histories(planar, *plane, *space);
}

struct Case {
  std::string name;
  std::string patch;  ///< of the document, a JSON merge patch
};
std::ostream& operator<<(std::ostream& stream, const Case& c) {
  return stream << c.name;
}

class SpaceAndPlane : public testing::TestWithParam<Case> {};

TEST_P(SpaceAndPlane, AgreeOnAnElasticallyRotatedNode) {
  Json document = swung_arm();
  document.merge_patch(Json::parse(GetParam().patch));
  expect_space_as_plane(document);
}

std::string wrist(const std::string& keys) {
  return R"({"scene": {"joints": {"wrist": )" + keys + "}}}";
}

/// A load of the wrist on top of one of its kinds.
std::string loaded_wrist(const std::string& keys, const std::string& load) {
  return R"({"scene": {"joints": {"wrist": )" + keys + R"(}, "loads": {"wrist spring": )" + load +
         "}}}";
}
std::string loaded(const std::string& load) {
  return R"({"scene": {"loads": {"load": )" + load + "}}}";
}

const std::string slide_spring =
    R"({"type": "joint", "joint": "wrist", "coordinate": "displacement", "stiffness": 2000, "damping": 3})";
const std::string hinge_spring =
    R"({"type": "joint", "joint": "wrist", "coordinate": "angle", "stiffness": 20,
        "damping": 0.1, "rest": 0.05,
        "motor": {"type": "harmonic", "amplitude": 2, "frequency": 50}})";

INSTANTIATE_TEST_SUITE_P(
    Joints, SpaceAndPlane,
    testing::Values(
        Case{"Revolute", "{}"}, Case{"RevoluteAgainst", wrist(R"({"axis": [0, 0, -1]})")},
        Case{"RevoluteWithSpringAndMotor", loaded_wrist("{}", hinge_spring)},
        Case{
            "RevoluteDriven",
            wrist(
                R"({"axis": [0, 0, -1], "drive": {"type": "harmonic", "amplitude": 0.3, "frequency": 40}})")},
        Case{"Fixed", wrist(R"({"type": "fixed"})")},
        Case{"PrismaticOnASpring",
             loaded_wrist(R"({"type": "prismatic", "axis": [0.28, 0.96, 0]})", slide_spring)},
        Case{"PrismaticDriven", wrist(R"({"type": "prismatic", "axis": [0.28, 0.96, 0],
                       "drive": {"type": "harmonic", "amplitude": 0.02, "frequency": 40}})")},
        Case{"Spherical", wrist(R"({"type": "spherical"})")},
        Case{"UniversalNormal",
             wrist(R"({"type": "universal", "axis": [0, 0, 1], "second_axis": [1, 0, 0]})")},
        Case{"UniversalInPlane",
             wrist(R"({"type": "universal", "axis": [0.6, 0.8, 0], "second_axis": [0, 0, 1]})")},
        Case{"PlanarAcross",
             loaded_wrist(R"({"type": "planar", "axis": [0.8, 0.6, 0]})",
                          R"({"type": "spring", "bodies": ["boom", "arm"], "stiffness": 2000,
                              "at": [[0.48, 0.36, 0], [0.4, 0.6, 0]]})")},
        Case{"CylindricalNormal", wrist(R"({"type": "cylindrical", "axis": [0, 0, 1]})")},
        Case{"CylindricalInPlane",
             loaded_wrist(R"({"type": "cylindrical", "axis": [0.28, 0.96, 0]})", slide_spring)},
        Case{"PointOnLineDriven", wrist(R"({"type": "point-on-line", "axis": [0.28, 0.96, 0],
                       "drive": {"type": "harmonic", "amplitude": 0.02, "frequency": 40}})")}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Loads, SpaceAndPlane,
    testing::Values(
        Case{"FollowerForce", loaded(R"({"type": "force", "body": "boom", "at": [0.48, 0.36, 0],
                                         "direction": [-0.6, 0.8, 0], "follows": true,
                                         "value": {"type": "harmonic", "amplitude": 8, "frequency": 30}})")},
        Case{"Torque", loaded(R"({"type": "torque", "body": "boom", "at": [0.48, 0.36, 0],
                                  "direction": [0, 0, -1],
                                  "value": {"type": "harmonic", "amplitude": 1.5, "frequency": 40}})")},
        Case{"FollowerTorque", loaded(R"({"type": "torque", "body": "boom", "at": [0.32, 0.24, 0],
                                          "direction": [0, 0, 1], "follows": true, "value": 1.5})")}),
    [](const auto& test) { return test.param.name; });

std::string boom(const std::string& keys) {
  return R"({"scene": {"bodies": {"boom": )" + keys + R"(}, "joints": {"wrist":
             {"type": "prismatic", "axis": [0.28, 0.96, 0]}}, "loads": {"wrist spring": )" +
         slide_spring + "}}}";
}

INSTANTIATE_TEST_SUITE_P(
    Frames, SpaceAndPlane,
    testing::Values(
        Case{"Tangent", boom(R"({"frame": "tangent"})")},
        Case{"TangentEnd", boom(R"({"frame": "tangent-end"})")},
        Case{"MeanAxis", boom(R"({"frame": "mean-axis"})")},
        Case{"Modes", boom(R"({"reduction": {"modes": 2}})")},
        Case{"ModesOnTheMeanAxis", boom(R"({"frame": "mean-axis", "reduction": {"modes": 1}})")},
        Case{"ModesOnATangent", boom(R"({"frame": "tangent", "reduction": {"modes": 3}})")}),
    [](const auto& test) { return test.param.name; });

std::string formulated(const std::string& name) {
  Json patch = Json::parse(boom("{}"));
  patch["simulation"]["formulation"] = name;
  return patch.dump();
}

INSTANTIATE_TEST_SUITE_P(Formulations, SpaceAndPlane,
                         testing::Values(Case{"StabilizedIndex2", formulated("stabilized-index-2")},
                                         Case{"Index1", formulated("index-1")}),
                         [](const auto& test) { return test.param.name; });

/// Of round beams, whose local axes stand across the plane of motion, so that the boom bends about
/// both of them, in parts of a frame each.
Json skew_arm(int parts) {
  Json document = swung_arm();
  Json& scene = document["scene"];
  Json part = scene["bodies"]["boom"];
  scene["bodies"].erase("boom");
  part["section"] = {{"type", "circle"}, {"diameter", 0.008}};
  part["reference"] = {0.3, 0.1, 1.0};
  part["elements"] = 8 / parts;
  if (parts > 1) part["frame"] = "tangent";
  const auto at = [&](int i) -> Json { return {0.48 * i / parts, 0.36 * i / parts, 0.0}; };
  const auto name = [&](int i) -> std::string {
    return i == parts - 1 ? "boom" : "boom" + std::to_string(i);
  };
  for (int i = 0; i < parts; ++i) {
    part["from"] = at(i);
    part["to"] = at(i + 1);
    scene["bodies"][name(i)] = part;
    if (i == 0) continue;
    scene["joints"]["cut" + std::to_string(i)] = {
        {"type", "fixed"}, {"bodies", {name(i - 1), name(i)}}, {"at", at(i)}};
  }
  scene["joints"]["shoulder"]["bodies"][1] = name(0);
  scene["joints"]["shoulder"]["drive"]["amplitude"] = 0.1;
  scene["joints"]["wrist"]["type"] = "prismatic";
  scene["joints"]["wrist"]["axis"] = {0.28, 0.96, 0.0};
  scene["loads"]["wrist spring"] = Json::parse(slide_spring);
  document["responses"].erase("boom stress");  // searched for from local y on
  return document;
}

/// The rotation vector of a node has two components then, and the plane only one.
TEST(ElasticRotation, AboutASkewLocalAxisIsThatOfThePlane) {
  const Json skew = skew_arm(1);
  Json straight = skew;
  straight["scene"]["bodies"]["boom"].erase("reference");
  const auto [planar, x, expected] = AtStart(problem_of(straight, "auto"));
  const auto [spatial, start, found] = AtStart(problem_of(skew, "on"));
  EXPECT_GE(largest_rotation(*expected), 0.1);
  expect_same_histories(planar, *expected, *found);
}

/// Parts turn by an eighth of what the whole beam turns by against one frame, and of what is of
/// second order in that a 64th is left. With directions turned by I + ψ̃ the reaction was 3 % off.
TEST(ElasticRotation, AboutASkewLocalAxisIsThatOfManyFramesInOne) {
  const auto values_with = [](int parts) {
    const ProblemFile problem = problem_of(skew_arm(parts), "on");
    return values_of(*analyze(problem, start_design(problem)));
  };
  const Eigen::VectorXd expected = values_with(8), found = values_with(1);
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(found(i) / expected(i), 1.0, 3e-3) << i;
  }
}

/// Design variables of both bodies, of the place of the joint, and of its load.
TEST(ElasticRotation, HasTheGradientsOfDifferencesAndOfBothMethods) {
  Json document = skew_arm(1);
  Json& scene = document["scene"];
  scene["bodies"]["boom"]["section"]["diameter"] = {{"variable", "diameter"}};
  scene["bodies"]["boom"]["to"][2] = {{"variable", "height"}};
  scene["bodies"]["arm"]["from"][2] = {{"variable", "height"}};
  scene["joints"]["wrist"]["at"][2] = {{"variable", "height"}};
  scene["loads"]["wrist spring"]["stiffness"] = {{"variable", "stiffness"}};
  scene["loads"]["couple"] = Json::parse(R"({"type": "torque", "body": "boom",
      "at": [0.48, 0.36, 0], "direction": [0.6, 0.48, 0.64], "follows": true, "value": 0.3})");
  scene["loads"]["couple"]["at"][2] = {{"variable", "height"}};
  document["variables"] = {{"diameter", {{"start", 0.008}, {"lower", 0.004}, {"upper", 0.02}}},
                           {"height", {{"start", 0.05}, {"lower", 0.0}, {"upper", 0.2}}},
                           {"stiffness", {{"start", 2000.0}, {"lower", 100.0}, {"upper", 1e4}}}};
  // Maxima over time have kinks.
  for (Json& response : document["responses"]) response["over_time"] = "final";
  const auto [problem, x, analysis] = AtStart(problem_of(document, "auto"));
  EXPECT_GE(largest_rotation(*analysis), 0.1);
  const Eigen::MatrixXd direct = gradients(problem, x, *analysis, GradientMethod::direct);
  const Eigen::MatrixXd adjoint = gradients(problem, x, *analysis, GradientMethod::adjoint);
  const Eigen::VectorXd values = values_of(*analysis);
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const Eigen::VectorXd differences = derivative_at_zero(
        [&, &problem = problem, &x = x](double s) {
          Eigen::VectorXd moved = x;
          moved(j) *= 1.0 + s;
          return values_of(*analyze(problem, moved));
        },
        1e-3);
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const double scale = std::max(std::abs(values(i)), std::abs(x(j) * direct(i, j)));
      EXPECT_NEAR(adjoint(i, j) * x(j), direct(i, j) * x(j), 1e-9 * scale) << i << ", " << j;
      // The differences' own error at this step.
      EXPECT_NEAR(direct(i, j) * x(j), differences(i), 1e-6 * scale) << i << ", " << j;
    }
  }
}

/// In space for good: the wrist is inclined, has a spring and a motor, and a torque follows the tip
/// of the boom. What is asked does not depend on the global axes.
Json inclined_wrist() {
  Json document = swung_arm();
  Json& scene = document["scene"];
  for (Json& body : scene["bodies"]) {
    body["reference"] = {0.0, 0.0, 1.0};
    body.erase("damping");
  }
  scene["joints"]["wrist"]["axis"] = {0.36, 0.48, 0.8};
  scene["joints"]["shoulder"]["axis"] = {0.0, 0.0, 1.0};
  scene["joints"]["shoulder"]["drive"]["amplitude"] = 0.16;
  scene["loads"]["wrist spring"] = Json::parse(hinge_spring);
  scene["loads"]["couple"] = Json::parse(R"({"type": "torque", "body": "boom",
      "at": [0.48, 0.36, 0], "direction": [0.6, 0.48, 0.64], "follows": true, "value": 0.3})");
  document["responses"].erase("x");
  document["responses"].erase("y");
  document["responses"]["moment"]["direction"] = "magnitude";
  return document;
}

/// Turns all vectors of a document.
void turn(Json& node, const Eigen::Matrix3d& by) {
  if (node.is_array() && node.size() == 3 && node[0].is_number()) {
    const Eigen::Vector3d turned = by * Eigen::Vector3d(node[0], node[1], node[2]);
    node = {turned(0), turned(1), turned(2)};
  } else if (node.is_structured()) {
    for (Json& child : node) turn(child, by);
  }
}

TEST(ElasticRotation, DoesNotDependOnHowTheSceneStands) {
  const Json here = inclined_wrist();
  Json there = here;
  turn(there["scene"],
       Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.48, -0.6, 0.64)).toRotationMatrix());
  const auto [problem, x, expected] = AtStart(problem_of(here, "auto"));
  EXPECT_GE(largest_rotation(*expected), 0.1);
  const auto found = analyze(problem_of(there, "auto"), start_design(problem));
  expect_same_histories(problem, *expected, *found);
}

/// Joints do no work, springs and torques theirs: what is missing falls with the square of the
/// step.
TEST(ElasticRotation, KeepsTheBalanceOfEnergy) {
  const auto error_with = [](double step) {
    Json document = inclined_wrist();
    document["simulation"]["step"] = step;
    document["simulation"]["spectral_radius"] = 1.0;
    const auto [problem, x, analysis] = AtStart(problem_of(document, "auto"));
    return monitor(analysis->model, analysis->trajectory).energy_error;
  };
  const double coarse = error_with(2e-4), fine = error_with(1e-4);
  EXPECT_LE(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 1.0);
}

constexpr double young = 210e9, length = 0.8, side = 0.02, force = 30.0;
constexpr double bending_stiffness = young * side * side * side * side / 12.0;

/// A cantilever along (3, 4, 0)/5, loaded across from x = 0.3 to the variable `end` of its length, at rest.
constexpr const char* cantilever = R"({
  "variables": {"end": {"start": "0.5 m", "lower": "0.4 m", "upper": "0.7 m"},
                       "long": {"start": "0.8 m", "lower": "0.75 m", "upper": "1 m"}},
  "scene": {
    "materials": {"m": {"young": 210e9, "poisson": 0.3, "density": 7850}},
    "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": ["= 0.6*long", "= 0.8*long", 0],
      "material": "m", "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "elements": 3,
      "damping": {"stiffness": "= 0 s/m * end"}}},
    "joints": {"f": {"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
    "loads": {"wind": {"type": "force", "body": "b", "at": ["= 0.225*long", "= 0.3*long", 0],
      "to": ["= 0.6*end", "= 0.8*end", 0], "direction": [-0.8, 0.6, 0], "value": 30}}},
    "simulation": {"end_time": 1e-3, "step": 1e-3, "initial_state": "quasi-static"},
  "effects": {"geometric_stiffening": "off"},
  "responses": {
    "tip": {"type": "deflection", "body": "b", "at": 1, "direction": "y", "over_time": "final"},
    "reaction": {"type": "reaction-force", "joint": "f", "direction": "magnitude", "over_time": "final"}
  }
})";

ProblemFile problem_of(const std::vector<std::string>& overrides) {
  return problem_from(cantilever, overrides);
}

double value(const ProblemFile& problem, const Eigen::VectorXd& x, std::size_t response) {
  return analyze(problem, x)->reductions[response].value;
}

/// Ends of the stretch that keep their shares of the beam, as several frames need it.
const std::string shares = R"(/scene/loads/wind/to=["= 0.375*long", "= 0.5*long", 0])";

double value(const std::vector<std::string>& overrides, std::size_t response = 0) {
  const ProblemFile problem = problem_of(overrides);
  return value(problem, start_design(problem), response);
}

/// F/(b − a) ∫ x² (3 L − x)/(6 EI) dx over the stretch: the sum of the tip's deflections by point forces
/// (Euler–Bernoulli).
double tip_by_points(double a, double b) {
  const auto integral = [](double x) { return x * x * x * length - x * x * x * x / 4.0; };
  return force / (b - a) * (integral(b) - integral(a)) / (6.0 * bending_stiffness);
}

TEST(SpreadForce, BendsACantileverAsInTheTextbook) {
  EXPECT_NEAR(value({}), tip_by_points(0.3, 0.5), 1e-9 * tip_by_points(0.3, 0.5));
  const std::vector<std::string> whole = {
      "/scene/loads/wind/at=[0, 0, 0]", R"(/scene/loads/wind/to=["= 0.6*long", "= 0.8*long", 0])"};
  const double tip = force * length * length * length / (8.0 * bending_stiffness);
  EXPECT_NEAR(value(whole), tip, 1e-9 * tip);
}

TEST(SpreadForce, IsTheSameFromItsOtherEnd) {
  EXPECT_NEAR(value({"/scene/loads/wind/at=[0.3, 0.4, 0]", "/scene/loads/wind/to=[0.18, 0.24, 0]"}),
              value({}), 1e-11 * value({}));
}

TEST(SpreadForce, IsTheSameInSpaceReducedAndInSeveralFrames) {
  const double tip = value({});
  EXPECT_NEAR(value({"/effects/spatial_motion=\"on\""}), tip, 1e-8 * tip);
  EXPECT_NEAR(value({"/scene/bodies/b/reduction={\"modes\": 6}"}), tip, 1e-3 * tip);
  // Small displacements: frames turn by 1e-4 and less.
  EXPECT_NEAR(value({shares, "/scene/bodies/b/frames=3", "/scene/loads/wind/value=3e-3"}),
              1e-4 * tip, 1e-9 * tip);
}

/// Against the sum of the reactions: what acts on all frames is the whole force.
TEST(SpreadForce, HasItsWholeValueOnSeveralFrames) {
  for (const char* frames : {"1", "2", "5"}) {
    EXPECT_NEAR(value({shares, "/scene/bodies/b/frames=" + std::string(frames)}, 1), force,
                1e-6 * force);
  }
}

TEST(SpreadForce, ActsInTheMiddleOfARigidBody) {
  const std::vector<std::string> rigid = {
      R"(/scene/bodies/b={"type": "beam", "from": [0, 0, 0], "to": ["= 0.6*long", "= 0.8*long", 0],
         "material": "m", "section": {"type": "rectangle", "width": 0.02, "height": 0.02}, "rigid": true, "elements": 1})",
      R"(/responses/tip={"type": "reaction-moment", "joint": "f", "direction": "z", "over_time": "final"})"};
  EXPECT_NEAR(std::abs(value(rigid)), 0.4 * force, 1e-9 * force);
}

/// Ends of the stretch and of the beam that move with the design.
TEST(SpreadForce, HasExactGradients) {
  for (const std::vector<std::string>& overrides : {std::vector<std::string>{},
                                                    {"/scene/bodies/b/shear=true"},
                                                    {shares, "/scene/bodies/b/frames=2"}}) {
    const auto [problem, x, analysis] = AtStart(problem_of(overrides));
    const auto values = response_values(*analysis);
    for (const ExactMethod method : {ExactMethod::direct, ExactMethod::adjoint}) {
      const Eigen::MatrixXd gradients = sampled_gradients(*analysis, values, method);
      for (Eigen::Index j = 0; j < x.size(); ++j) {
        Eigen::VectorXd more = x, less = x;
        more(j) += 1e-4;
        less(j) -= 1e-4;
        const double difference = (value(problem, more, 0) - value(problem, less, 0)) / 2e-4;
        EXPECT_NEAR(gradients(0, j), difference, 1e-5 * std::abs(difference)) << j;
      }
    }
  }
}

/// The recovery knows forces at nodes only: the moment at the clamp is p l²/12 too small with elements of
/// the length l.
TEST(SpreadForce, MissesItsMomentWithinElements) {
  for (const int elements : {1, 2, 4}) {
    const double moment =
        value({"/scene/loads/wind/at=[0, 0, 0]",
               R"(/scene/loads/wind/to=["= 0.6*long", "= 0.8*long", 0])",
               "/scene/bodies/b/elements=" + std::to_string(elements),
               R"(/responses/tip={"type": "section-force", "body": "b", "part": "moment-z", "at": 0,
                                                    "over_time": "max-abs"})"});
    const double l = length / elements, load = force / length;
    EXPECT_NEAR(moment, 0.5 * force * length - load * l * l / 12.0, 1e-8 * force * length);
  }
}

TEST(SpreadForce, NeedsTwoPoints) {
  EXPECT_THROW(problem_of({"/scene/loads/wind/to=[0.18, 0.24, 0]"}), InputError);
  EXPECT_THROW(problem_of({"/scene/loads/wind/to=[0.18, 0.25, 0]"}), InputError);
}

}  // namespace
}  // namespace pleuel::test::space_and_plane_test
