#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/linear/modes.hpp"
#include "core/response/analysis.hpp"
#include "core/response/body_frequency.hpp"
#include "core/response/effect_measurement.hpp"
#include "core/start/initial_state.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

/// Natural frequencies and buckling of members that move in a plane: what is out of it counts.

namespace pleuel::test::natural_frequency_test {
namespace {

using namespace response_samples;

constexpr double length = 0.8, width = 0.003, height = 0.002, young = 2.1e11, density = 7850.0;

/// (βL)² of a cantilever: cos βL cosh βL = −1.
constexpr double cantilever_numbers[] = {3.516015268500151, 22.034491564666766, 61.697214407543};

double cantilever_frequency(int mode, double thickness) {
  const double r2 = thickness * thickness / 12.0;  // I/A
  return cantilever_numbers[mode] / (length * length) * std::sqrt(young * r2 / density);
}

Scene cantilever() {
  Scene scene = swinging_beam(length, RectangleSection{width, height}, 10);
  scene.gravity = {0.0, 0.0, 0.0};
  scene.joints[0].drive = PolynomialFunction{{0.0}};
  return scene;
}

/// Cubic elements of length ℓ are too stiff by (βℓ)⁴/1440 (Rayleigh's quotient); rotary inertia
/// takes less than 1e-5 here, (βr)².
TEST(Frequency, OfACantileverIsTheTabulatedOne) {
  const Model model = build_model(cantilever(), {}, {}, {});
  for (int mode = 0; mode < 3; ++mode) {
    const double found = body_frequency(model.body("beam"), {mode}, 0).value;
    const double stiffer = std::pow(cantilever_numbers[mode] / 100.0, 2) / 1440;
    EXPECT_NEAR(found / cantilever_frequency(mode, height), 1.0 + stiffer, 1e-5 + 0.1 * stiffer);
  }
}

/// In space it bends about both axes; the thinner way first.
TEST(Frequency, OfACantileverInSpaceComesInTwoSeries) {
  const Model model = build_model(cantilever(), in_motion(EffectChoice::on), {}, {});
  const BodyModel& beam = model.body("beam");
  EXPECT_NEAR(body_frequency(beam, {0}, 0).value / cantilever_frequency(0, height), 1.0, 5e-5);
  EXPECT_NEAR(body_frequency(beam, {1}, 0).value / cantilever_frequency(0, width), 1.0, 5e-5);
}

/// A drive that stands still clamps the root. 1e-9: eigenvalues of matrices whose frequencies span
/// five orders.
TEST(Frequency, OfAClampedMechanismIsThatOfItsBody) {
  for (EffectChoice spatial : {EffectChoice::off, EffectChoice::on}) {
    Model model = build_model(cantilever(), in_motion(spatial), {}, {});
    const Eigen::VectorXd found =
        frequencies_of(linearize(model.mechanism, initial_state(model.mechanism).state));
    ASSERT_GE(found.size(), 4);
    for (int mode = 0; mode < 4; ++mode) {
      EXPECT_NEAR(found(mode) / body_frequency(model.body("beam"), {mode}, 0).value, 1.0, 1e-8);
    }
  }
}

/// Free to turn, the beam has no frequency for that (gravity is off), and those of a pinned and
/// free beam: tan βL = tanh βL, βL = 3.92660231204792.
TEST(Frequency, OfAMechanismLeavesOutFreeMotions) {
  Scene scene = cantilever();
  scene.joints[0].drive.reset();
  Model model = build_model(scene, {}, {}, {});
  const Eigen::VectorXd found =
      frequencies_of(linearize(model.mechanism, initial_state(model.mechanism).state));
  const double expected =
      std::pow(3.92660231204792 / length, 2) * std::sqrt(young * height * height / 12.0 / density);
  EXPECT_NEAR(found(0) / expected, 1.0, 5e-5);
}

/// Local y is along the height, z along the width: each axis has its own series.
TEST(Frequency, AlongAnAxisIsThatOfBendingInIt) {
  const Model model = build_model(cantilever(), in_motion(EffectChoice::on), {}, {});
  const BodyModel& beam = model.body("beam");
  for (int mode = 0; mode < 3; ++mode) {
    const double stiffer = std::pow(cantilever_numbers[mode] / 100.0, 2) / 1440;
    const double along_y = body_frequency(beam, {mode, {{0, 1, 0}}}, 0).value;
    const double along_z = body_frequency(beam, {mode, {{0, 0, 1}}}, 0).value;
    EXPECT_NEAR(along_y / cantilever_frequency(mode, height), 1.0 + stiffer, 3e-5 + 0.1 * stiffer);
    EXPECT_NEAR(along_z / cantilever_frequency(mode, width), 1.0 + stiffer, 3e-5 + 0.1 * stiffer);
  }
  // ω = π/2 √(E/ρ)/L of a rod that is clamped at one end; ten elements: (π/20)²/24 = 1e-3 too high.
  const double along_x = body_frequency(beam, {0, {{1, 0, 0}}}, 0).value;
  EXPECT_NEAR(along_x * 2.0 * length / std::numbers::pi / std::sqrt(young / density), 1.0, 1.1e-3);
}

TEST(Frequency, ThatIsNotAlongAnAxisIsAnErrorThatSaysSo) {
  const Model model = build_model(cantilever(), in_motion(EffectChoice::off), {}, {});
  // How many there are changes with the design.
  EXPECT_EQ(thrown<SimulationError>([&] {
              body_frequency(model.body("beam"), {0, {{0, 0, 1}}}, 0);
            }),
            "the body \"beam\" has 0 natural frequencies along z (modes with more than half of "
            "their kinetic energy in it), not 1");
}

/// Without elasticity, as the price of that effect is measured.
TEST(Frequency, OfABodyThatIsRigidIsAnErrorThatSaysSo) {
  EffectSettings effects{.elasticity = EffectChoice::off};
  const Model model = build_model(cantilever(), effects, {}, {});
  EXPECT_THROW(body_frequency(model.body("beam"), ModeChoice{0}, 0), InputError);
  EXPECT_THROW(body_frequency(model.body("beam"), ModeChoice{0, {{0, 1, 0}}}, 0), SimulationError);
}

Scene hanging_body() {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  RigidBody body{.at = {0.0, -0.4, 0.0}, .mass = 0.7, .inertia = {0.01, 0.02, 0.03, 0.0, 0.0, 0.0}};
  scene.bodies = {{"bob", body}};
  Joint joint;
  joint.name = "bearing";
  joint.bodies = {ground_name, "bob"};
  scene.joints = {joint};
  return scene;
}

/// ω² = m g L/(I + m L²): the stiffness is the bearing's multipliers'.
TEST(Frequency, OfAPhysicalPendulumIsThatOfItsWeight) {
  for (EffectChoice spatial : {EffectChoice::off, EffectChoice::on}) {
    Model model = build_model(hanging_body(), in_motion(spatial), {}, {});
    const Eigen::VectorXd found =
        frequencies_of(linearize(model.mechanism, initial_state(model.mechanism).state));
    ASSERT_EQ(found.size(), 1);
    EXPECT_NEAR(found(0), std::sqrt(0.7 * 9.81 * 0.4 / (0.03 + 0.7 * 0.16)), 1e-10);
  }
}

/// Euler's equations of a body of revolution that spins freely at Ω about z: its axis goes round in
/// space with Ω I_z/I_x (and the axis of rotation in the body with Ω |I_z − I_x|/I_x).
TEST(Frequency, OfAFreeTopIsThatOfItsGyroscopicForces) {
  Scene scene;
  RigidBody body;
  body.mass = 1.0;
  body.inertia = {0.02, 0.02, 0.03, 0.0, 0.0, 0.0};
  Body top{"top", body};
  top.angular_velocity = {0.0, 0.0, 50.0};
  scene.bodies = {top};
  Model model = build_model(scene, in_motion(EffectChoice::on), {}, {});
  const Eigen::VectorXd found =
      frequencies_of(linearize(model.mechanism, initial_state(model.mechanism).state));
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found(0), 50.0 * 1.5, 1e-9);
}

TEST(Frequency, ThatDoesNotExistIsAnErrorThatSaysHowManyThereAre) {
  ProblemFile problem;
  problem.scene = hanging_body();
  problem.simulation.end_time = 1e-3;
  problem.simulation.step = 1e-3;
  problem.responses = {{"fifth", ModeResponse{.mode = {.number = 4}}}};
  EXPECT_EQ(thrown<InputError>([&] { analyze(problem, {}); }),
            "the response \"fifth\" cannot be computed: the mechanism has 1 natural "
            "frequency, not 5");
}

class BodyFrequencies : public testing::TestWithParam<int> {};

/// The three lowest frequencies of each body.
Eigen::VectorXd low_frequencies(const Model& model) {
  std::vector<double> all;
  for (const BodyModel& body : model.bodies) {
    for (int mode = 0; mode < std::min(3, body.elastic_size()); ++mode) {
      all.push_back(body_frequency(body, {mode}, model.mechanism.system->variables()).value);
    }
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Eigen::MatrixXd low_derivatives(const Model& model) {
  const int variables = model.mechanism.system->variables();
  Eigen::MatrixXd all(low_frequencies(model).size(), variables);
  Eigen::Index row = 0;
  for (const BodyModel& body : model.bodies) {
    for (int mode = 0; mode < std::min(3, body.elastic_size()); ++mode) {
      all.row(row++) = body_frequency(body, {mode}, variables).derivatives.transpose();
    }
  }
  return all;
}

/// Against differences of neighbouring models, of fourth order with relative steps of 1e-3: 1e-9.
TEST_P(BodyFrequencies, HaveTheDerivativesOfDifferences) {
  const SampleScene sample = all_samples()[GetParam()];
  const Model model = sample.build();
  const Eigen::VectorXd at = low_frequencies(model);
  const Eigen::MatrixXd derivatives = low_derivatives(model);
  for (std::size_t k = 0; k < sample.design.size(); ++k) {
    const double size = std::abs(sample.design[k]);
    const auto moved = [&](double s) {
      Design<double> x = sample.design;
      x[k] += s * size;
      return low_frequencies(sample.build_at(x));
    };
    const Eigen::VectorXd found = derivative_at_zero(moved, 2e-3);
    const Eigen::VectorXd expected = size * derivatives.col(k);
    EXPECT_LE((found - expected).cwiseQuotient(at).lpNorm<Eigen::Infinity>(), 1e-7)
        << sample.variables[k];
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, BodyFrequencies, testing::Range(0, sample_count), sample_name);

// Frequencies of mechanisms whose motion begins with undeformed members under loads: those about
// the equilibrium.

constexpr double column_young = 2.1e11, column_length = 1.0, column_height = 0.01,
                 column_width = 0.04;

/// A column on two pins that its ends leave free to turn, pressed by P.
ProblemFile column(double P) {
  return read_scene(fmt::format(R"j({{
    "scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
        "section": {{"type": "rectangle", "width": 0.04, "height": 0.01}}, "elements": 8, "frame": "chord"}}}},
      "joints": {{
        "a": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
        "c": {{"type": "point-on-line", "bodies": ["ground", "b"], "at": [1, 0, 0], "axis": [1, 0, 0]}}}},
      "loads": {{"P": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [-1, 0, 0],
                        "value": {{"variable": "P"}}}}}}}},
    "simulation": {{"end_time": 1e-4, "step": 1e-4}},
    "variables": {{"P": {{"start": {}, "lower": 0, "upper": 1e5}}}},
    "responses": {{"f": {{"type": "frequency"}}}}}})j",
                                P));
}

/// ω = ω₀ √(1 − P/P_E) with Euler's load, beyond it −γ = −ω₀ √(P/P_E − 1); its slope −ω₀²/(2 ω P_E).
TEST(FrequencyUnderALoad, IsThatOfThePressedColumnThoughItStartsUndeformed) {
  const double bending = column_young * column_width * std::pow(column_height, 3) / 12;
  const double euler = bending * std::pow(std::numbers::pi / column_length, 2);
  const double free = std::pow(std::numbers::pi / column_length, 2) *
                      std::sqrt(bending / (7850 * column_width * column_height));
  for (const double share : {0.5, 0.95, 1.5}) {
    const auto [problem, x, analysis] = AtStart(column(share * euler));
    const double expected = std::copysign(std::sqrt(std::abs(1 - share)), 1 - share) * free;
    EXPECT_NEAR(values_of(*analysis)(0), expected, 2e-3 * std::abs(expected)) << share;
    const double slope = -free * free / (2 * std::abs(expected) * euler);
    EXPECT_NEAR(direct_gradients(*analysis)(0, 0), slope, 4e-3 * std::abs(slope)) << share;
  }
}

/// A lever that a motor turns against a stop, with an arm welded to it.
ProblemFile lever(int elements, double torque) {
  return read_scene(fmt::format(R"j({{
    "scene": {{
      "bodies": {{
        "arm": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "steel", "elements": {0},
          "section": {{"type": "rectangle", "width": 0.03, "height": 0.015}}}},
        "lever": {{"type": "beam", "from": [0, 0, 0], "to": [0, 0.075, 0], "material": "steel", "elements": {0},
          "section": {{"type": "rectangle", "width": 0.02, "height": 0.008}}}},
        "blade": {{"type": "point-mass", "at": [0.5, 0, 0], "mass": 0.3}}}},
      "joints": {{
        "pivot": {{"type": "revolute", "bodies": ["ground", "lever"], "at": [0, 0, 0]}},
        "weld": {{"type": "fixed", "bodies": ["lever", "arm"], "at": [0, 0, 0]}},
        "tip": {{"type": "spherical", "bodies": ["arm", "blade"], "at": [0.5, 0, 0]}},
        "stop": {{"type": "point-on-line", "bodies": ["ground", "lever"], "at": [0, 0.075, 0],
                  "axis": [0, 1, 0]}}}},
      "loads": {{"T": {{"type": "joint", "joint": "pivot", "motor": {1}}}}}}},
    "simulation": {{"end_time": 1e-4, "step": 1e-4}},
    "responses": {{"f": {{"type": "frequency", "direction": "y"}}}}}})j",
                                elements, torque));
}

/// Accelerations of members that are let go under a load grow with the mesh; they are none of a
/// vibration. Without the motor they vanish.
TEST(FrequencyUnderALoad, DoesNotDependOnTheMesh) {
  const auto frequency = [](int elements, double torque) {
    const ProblemFile problem = lever(elements, torque);
    return values_of(*analyze(problem, start_design(problem)))(0);
  };
  const double expected = frequency(4, 0.0);
  for (const int elements : {2, 8, 24}) {
    EXPECT_NEAR(frequency(elements, 5.0), expected, 1e-3 * expected) << elements;
  }
}

TEST(FrequencyUnderALoad, IsDoubtedWhereThereIsNoEquilibrium) {
  const auto pushed = [](double force) {
    return read_scene(fmt::format(R"j({{
      "scene": {{
        "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
          "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}, "elements": 4}}}},
        "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
        "loads": {{"P": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [0, 1, 0], "value": {}}}}}}},
      "simulation": {{"end_time": 1e-5, "step": 1e-5}},
      "responses": {{"f": {{"type": "frequency"}}}}}})j",
                                  force));
  };
  const auto findings = [](const ProblemFile& problem) {
    for (const Finding& finding : findings_of(problem)) {
      const bool is_of_equilibrium = finding.text.find("undeformed members") != std::string::npos;
      if (is_of_equilibrium) return finding.is_serious;
    }
    return false;
  };
  EXPECT_FALSE(findings(pushed(10)));
  EXPECT_TRUE(findings(pushed(1e7)));
}

constexpr double poisson = 0.3;
constexpr double breadth = 0.01, depth = 0.03;  // along z, out of the plane, and along y
const double pi = std::numbers::pi;

/// A cantilever in the x–y plane with so many modes asked for.
std::string cantilever(const std::string& section, const std::string& effects, int modes,
                       const std::string& more_of_body = "") {
  std::string responses;
  for (int mode = 1; mode <= modes; ++mode) {
    responses += fmt::format(
        R"("m{0}": {{"type": "frequency", "mode": {0}}},
           "b{0}": {{"type": "frequency", "body": "b", "mode": {0}}}{1})",
        mode, mode < modes ? "," : "");
  }
  return fmt::format(
      R"({{"scene": {{
            "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
            "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "m",
                             "section": {}, "elements": 12{}}}}},
            "joints": {{"c": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0],
                             "drive": {{"type": "polynomial", "coefficients": [0]}}}}}}}},
          "effects": {},
          "simulation": {{"end_time": 1e-3, "step": 1e-3}},
          "responses": {{{}}}}})",
      section, more_of_body, effects, responses);
}

Eigen::VectorXd values(const std::string& text) {
  ProblemFile problem = problem_from(text);
  decide_effects(problem);
  return values_of(*analyze(problem, start_design(problem)));
}

const std::string rectangle = R"({"type": "rectangle", "width": 0.01, "height": 0.03})";

/// (βL)² of a cantilever: cos βL cosh βL = −1.
double bending_frequency(double number, double thickness) {
  return number / (length * length) * std::sqrt(young * thickness * thickness / 12.0 / density);
}

/// Twelve cubic elements: some 1e-6; rotary inertia takes ½ (βr)², 1e-3 of the third over the
/// height.
TEST(FrequencyOfAPlanarMechanism, HasTheBendingOutOfThePlane) {
  const Eigen::VectorXd found = values(cantilever(rectangle, "{}", 4));
  const double expected[] = {bending_frequency(3.516015268500151, breadth),
                             bending_frequency(3.516015268500151, depth),
                             bending_frequency(22.034491564666766, breadth),
                             bending_frequency(61.697214413549105, breadth)};
  for (int mode = 0; mode < 4; ++mode) {
    EXPECT_NEAR(found(2 * mode) / expected[mode], 1.0, 2e-3) << mode;
    EXPECT_NEAR(found(2 * mode) / found(2 * mode + 1), 1.0, 1e-7) << "the body's, " << mode;
  }
}

/// (2n − 1) π/2 √(G J/ρ I_p)/L of torsion and √(E/ρ) of stretching, 1e-3 each by twelve linear
/// elements.
TEST(FrequencyOfAPlanarMechanism, HasTorsionAndStretching) {
  // A tube is stiff in bending: its torsion comes early. J = I_p.
  const std::string tube = R"({"type": "tube", "outer_diameter": 0.2, "thickness": 0.002})";
  const Eigen::VectorXd found = values(cantilever(tube, "{}", 6));
  const double twist = pi / 2 / length * std::sqrt(young / (2 * (1 + poisson)) / density);
  const double stretch = pi / 2 / length * std::sqrt(young / density);
  const auto has = [&](double frequency) {
    return (found.array() / frequency - 1.0).abs().minCoeff() < 1e-3;
  };
  EXPECT_TRUE(has(twist)) << found.transpose();
  EXPECT_TRUE(has(stretch)) << found.transpose();
}

/// Whatever takes part in the motion. 1e-7: round-off of eigenvalues over five orders.
TEST(FrequencyOfAMechanism, IsTheSameWhateverEffectsLeaveOutOfTheMotion) {
  const Eigen::VectorXd expected = values(cantilever(rectangle, R"({"spatial_motion": "on"})", 10));
  for (const char* effects :
       {"{}", R"({"spatial_motion": "on", "torsional_elasticity": "off"})",
        R"({"axial_elasticity": "off"})", R"({"tolerance": 0.5})", R"({"tolerance": 1e-6})"}) {
    const Eigen::VectorXd found = values(cantilever(rectangle, effects, 10));
    EXPECT_LE((found.array() / expected.array() - 1.0).abs().maxCoeff(), 1e-7) << effects;
  }
  const Eigen::VectorXd reduced =
      values(cantilever(rectangle, "{}", 10, R"(, "reduction": {"modes": 2})"));
  EXPECT_LE((reduced.array() / expected.array() - 1.0).abs().maxCoeff(), 1e-7);
}

/// A round section bends alike in both planes: each frequency comes twice, and the gradient is that
/// of both. ω ~ d/L² without rotary inertia.
TEST(FrequencyOfAMechanism, OfARoundSectionComesTwiceWithOneGradient) {
  std::string text = cantilever(R"({"type": "circle", "diameter": {"variable": "d"}})",
                                R"({"rotary_inertia": "off"})", 4);
  text.insert(1, R"("variables": {"d": {"start": 0.02, "lower": 0.01, "upper": 0.03}},)");
  const auto [problem, x, analysis] = AtStart(problem_from(text));
  const Eigen::VectorXd found = values_of(*analysis);
  const Eigen::MatrixXd gradient = direct_gradients(*analysis);
  EXPECT_NEAR(found(0) / found(2), 1.0, 1e-7);
  EXPECT_NEAR(found(4) / found(6), 1.0, 1e-7);
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(gradient(i, 0) * 0.02 / found(i), 1.0, 1e-6) << i;
  }
}

/// ω ~ b/L² for bending over the width, out of the plane: nothing moves there, and the gradient is
/// exact.
TEST(FrequencyOfAPlanarMechanism, HasTheGradientOfTheModeOutOfThePlane) {
  std::string text = cantilever(
      R"({"type": "rectangle", "width": {"variable": "b"}, "height": {"variable": "h"}})",
      R"({"rotary_inertia": "off"})", 1);
  text.insert(1, R"("variables": {"b": {"start": 0.01, "lower": 0.005, "upper": 0.03},
                                  "h": {"start": 0.03, "lower": 0.005, "upper": 0.05}},)");
  const auto [problem, x, analysis] = AtStart(problem_from(text));
  const Eigen::MatrixXd gradient = direct_gradients(*analysis);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const double value = values_of(*analysis)(i);
    EXPECT_NEAR(gradient(i, 0) * 0.01 / value, 1.0, 1e-6);
    EXPECT_NEAR(gradient(i, 1) * 0.03 / value, 0.0, 1e-6);
  }
}

/// The six lowest of a four-bar of elastic members, in its plane and out of it, at rest and
/// stressed: differences of fourth order of whole analyses, 1e-7 of each frequency. The same with
/// members that leave something out of the motion.
TEST(FrequencyOfAMechanism, HasTheGradientOfDifferences) {
  for (const char* start : {"consistent", "quasi-static"}) {
    for (const char* effects : {"{}", R"({"axial_elasticity": "off"})"}) {
      std::vector<std::string> overrides = {
          "/simulation/end_time=0.2 ms",
          "/constraints={}",
          std::string("/effects=") + effects,
          std::string("/simulation/initial_state=") + start,
          "/objective/minimize=f1",
          R"(/scene/bodies/coupler/section/width={"variable": "width"})",
          R"(/variables/width={"start": "8 mm", "lower": "4 mm", "upper": "12 mm"})"};
      std::string responses = "/responses={";
      for (int mode = 1; mode <= 6; ++mode) {
        responses += fmt::format(R"({}"f{}": {{"type": "frequency", "mode": {}}})",
                                 mode > 1 ? ", " : "", mode, mode);
      }
      overrides.push_back(responses + "}");
      ProblemFile problem = sample_problem("four_bar", overrides);
      problem.simulation.newton_tolerance = 1e-13;
      const auto [x, analysis] = started(problem);
      const Eigen::VectorXd found = values_of(*analysis);
      ASSERT_EQ(found.size(), 6);
      for (Eigen::Index i = 1; i < 6; ++i) EXPECT_GT(found(i), 1.001 * found(i - 1));
      const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
      const Eigen::MatrixXd wide = central_differences(problem, x, 4e-3) * x.asDiagonal();
      const Eigen::MatrixXd narrow = central_differences(problem, x, 2e-3) * x.asDiagonal();
      const Eigen::MatrixXd error = (4.0 * narrow - wide) / 3.0 - direct;
      for (Eigen::Index i = 0; i < 6; ++i) {
        EXPECT_LE(error.row(i).lpNorm<Eigen::Infinity>(), 1e-7 * found(i))
            << "mode " << i + 1 << ", " << start << ", " << effects;
        EXPECT_GT(direct.row(i).lpNorm<Eigen::Infinity>(), 1e-2 * found(i));
      }
    }
  }
}

/// A rod between two pins, pressed: −N/P_E about the weaker axis, whatever the motion has.
TEST(Buckling, IsAboutTheWeakerAxisAlsoInThePlane) {
  const auto pressed = [](const std::string& effects) {
    return fmt::format(R"({{"scene": {{
        "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
        "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "m",
                         "section": {{"type": "i", "width": 0.02, "height": 0.04,
                                     "flange_thickness": 0.002, "web_thickness": 0.002}},
                         "elements": 4, "frame": "chord"}},
                  "s": {{"type": "point-mass", "at": [0.8, 0, 0], "mass": 0.1}}}},
        "joints": {{"a": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
                  "c": {{"type": "revolute", "bodies": ["b", "s"], "at": [0.8, 0, 0]}},
                  "g": {{"type": "point-on-line", "bodies": ["ground", "s"], "at": [0.8, 0, 0],
                       "axis": [1, 0, 0]}}}},
        "loads": {{"f": {{"type": "force", "body": "s", "at": [0.8, 0, 0], "direction": [-1, 0, 0],
                        "value": 300}}}}}},
        "effects": {},
        "simulation": {{"end_time": 1e-4, "step": 1e-4, "initial_state": "quasi-static"}},
        "responses": {{"n": {{"type": "buckling", "body": "b", "over_time": "max"}}}}}})",
                       effects);
  };
  // Two flanges and a web: I about the web's plane.
  const double inertia = 2 * 0.002 * std::pow(0.02, 3) / 12 + 0.036 * std::pow(0.002, 3) / 12;
  const double euler = pi * pi * young * inertia / (length * length);
  for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
    EXPECT_NEAR(values(pressed(effects))(0) * euler / 300.0, 1.0, 1e-6) << effects;
  }
}

std::string pendulum(const std::string& gravity) {
  return fmt::format(R"({{"scene": {{"gravity": {},
      "bodies": {{"bob": {{"type": "rigid", "at": [0, 0.4, 0], "mass": 0.7, "inertia": [0, 0, 0.03, 0, 0, 0]}}}},
      "joints": {{"j": {{"type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 0]}}}}}},
      "simulation": {{"end_time": 1e-3, "step": 1e-3}},
      "responses": {{"f": {{"type": "frequency"}}}}}})",
                     gravity);
}

/// γ² = m g L/(I + m L²): upside down it falls as exp(γt).
TEST(FrequencyOfAMechanism, OfAnUnstableModeIsNegativeAndMentioned) {
  const double expected = std::sqrt(0.7 * 9.81 * 0.4 / (0.03 + 0.7 * 0.16));
  const std::string text = pendulum("[0, -9.81, 0]");
  EXPECT_NEAR(values(text)(0), -expected, 1e-8);
  EXPECT_NEAR(values(pendulum("[0, 9.81, 0]"))(0), expected, 1e-8);
  const std::vector<Finding> findings = findings_of(read_scene(text));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].text.find("is unstable where it starts"), std::string::npos);
  EXPECT_TRUE(findings[0].is_serious);
  EXPECT_TRUE(
      findings[0].responses.empty());  // it stands there: nothing of the motion is to be trusted
  EXPECT_TRUE(findings_of(read_scene(pendulum("[0, 9.81, 0]"))).empty());
}

/// η = Ω √(ρAL⁴/EI) = 4 lifts the first flap frequency from λ = 3.516 to 5.585 (Wright et al.
/// 1982), which a start of undeformed members does not have.
TEST(FrequencyOfAMechanism, OfARotatingBeamHasItsStressHoweverItStarts) {
  const double radius = std::sqrt(breadth * breadth / 12.0);  // thin out of the plane: flap
  const double unit = 1.0 / (length * length) * std::sqrt(young / density) * radius;
  const auto rotating = [&](const std::string& start, double eta = 4.0) {
    std::string text = cantilever(rectangle, "{}", 1);
    const auto replace = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace(R"({"type": "polynomial", "coefficients": [0]})",
            fmt::format(R"({{"type": "constant-speed", "speed": {:.12g}}})", eta * unit));
    replace(R"("step": 1e-3)", R"("step": 1e-3, "initial_state": ")" + start + "\"");
    return text;
  };
  for (const char* start : {"quasi-static", "consistent"}) {
    EXPECT_NEAR(values(rotating(start))(0) / unit, 5.585001, 5e-3 * 5.585) << start;
  }
}

/// A clamp that is there twice holds as once.
TEST(FrequencyOfAMechanism, IsThatWithoutItsRedundantConstraints) {
  const std::string once = cantilever(rectangle, "{}", 3);
  std::string twice = once;
  const std::string joints = R"("joints": {)";
  twice.insert(twice.find(joints) + joints.size(),
               R"("again": {"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]},)");
  const Eigen::VectorXd expected = values(once), found = values(twice);
  EXPECT_LE((found.array() / expected.array() - 1.0).abs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace pleuel::test::natural_frequency_test
