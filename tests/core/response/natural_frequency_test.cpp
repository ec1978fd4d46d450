#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/linear/modes.hpp"
#include "core/response/analysis.hpp"
#include "core/response/body_frequency.hpp"
#include "core/start/initial_state.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/test.hpp"

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
        mechanism_frequencies(model.mechanism, initial_state(model.mechanism).state);
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
      mechanism_frequencies(model.mechanism, initial_state(model.mechanism).state);
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
  try {
    body_frequency(model.body("beam"), {0, {{0, 0, 1}}}, 0);
    FAIL();
  } catch (const SimulationError& error) {  // how many there are changes with the design
    EXPECT_STREQ(
        error.what(),
        "the body \"beam\" has 0 natural frequencies along z (modes with more than half of "
        "their kinetic energy in it), not 1");
  }
}

/// Without elasticity, as the price of that effect is measured.
TEST(Frequency, OfABodyThatIsRigidIsAnErrorThatSaysSo) {
  EffectSettings effects;
  effects.elasticity = EffectChoice::off;
  const Model model = build_model(cantilever(), effects, {}, {});
  EXPECT_THROW(body_frequency(model.body("beam"), ModeChoice{0}, 0), InputError);
  EXPECT_THROW(body_frequency(model.body("beam"), ModeChoice{0, {{0, 1, 0}}}, 0), SimulationError);
}

Scene hanging_body() {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  RigidBody body;
  body.at = {0.0, -0.4, 0.0};
  body.mass = 0.7;
  body.inertia = {0.01, 0.02, 0.03, 0.0, 0.0, 0.0};
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
        mechanism_frequencies(model.mechanism, initial_state(model.mechanism).state);
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
      mechanism_frequencies(model.mechanism, initial_state(model.mechanism).state);
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found(0), 50.0 * 1.5, 1e-9);
}

TEST(Frequency, ThatDoesNotExistIsAnErrorThatSaysHowManyThereAre) {
  ProblemFile problem;
  problem.scene = hanging_body();
  problem.simulation.end_time = 1e-3;
  problem.simulation.step = 1e-3;
  ResponseSettings settings;
  settings.name = "fifth";
  settings.type = ResponseType::frequency;
  settings.mode.number = 4;
  problem.responses = {settings};
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
        "section": {{"type": "rectangle", "width": 0.04, "height": 0.01}}, "elements": 8,
        "frame": "chord"}}}},
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
    const ProblemFile problem = column(share * euler);
    const auto analysis = analyze(problem, start_design(problem));
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
        "loads": {{"P": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [0, 1, 0],
                          "value": {}}}}}}},
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

}  // namespace
}  // namespace pleuel::test::natural_frequency_test
