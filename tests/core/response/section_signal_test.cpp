#include <stdexcept>
#include <tuple>

#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "core/section/rectangle_section.hpp"
#include "core/trust/round_off.hpp"
#include "tests/core/response/response_samples.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/test.hpp"

/// Section forces on both sides of a load.

namespace pleuel::test::section_signal_test {
namespace {

using namespace response_samples;

constexpr double length = 0.8, width = 0.02, height = 0.03, density = 7850, young = 2.1e11;
constexpr double strength = 4e8;

Model beam_model(const Section& section, int elements, EffectChoice spatial) {
  Scene scene = swinging_beam(length, section, elements);
  scene.gravity = {0.0, 0.0, 0.0};
  scene.materials[0].strength = strength;
  EffectSettings effects = in_motion(spatial);
  effects.geometric_stiffening = EffectChoice::off;
  return build_model(scene, effects, {}, {});
}

Eigen::VectorXd stresses(const Model& model, const State& state, StressPart part,
                         std::optional<double> station = {}) {
  const StressResponse stress{{.bodies = {"beam"}, .station = station}, part};
  const auto responses = make_responses({{"stress", stress}}, model);
  return observed(*responses.front().history()->signal, state);
}

/// Uniform pull ε, bending v = κx²/2 and w = μx²/2, twist: exact in one element, whatever frame
/// and number of elements.
struct Strain {
  double pull = 0.0, bend_y = 0.0, bend_z = 0.0, twist = 0.0;  ///< ε, κ, μ, θ' [1/m]
};

State strained(const Model& model, const Strain& strain) {
  State state = model.mechanism.guess;
  const BodyModel& body = model.body("beam");
  for (int node = 0; node < body.beam.node_count(); ++node) {
    const double x = body.beam.node_position(node);
    const double values[] = {strain.pull * x,  strain.bend_y * x * x / 2, strain.bend_z * x * x / 2,
                             strain.twist * x, -strain.bend_z * x,        strain.bend_y * x};
    for (int i = 0; i < 6; ++i) {
      const int index = body.coordinate(node, i);
      if (index >= 0) state.q(index) = values[i];
    }
  }
  return state;
}

/// σ = E(ε − κy): at the upper edge (y = h/2) bending of κ > 0 presses. 1e-9: round-off of
/// displacements that nearly cancel in curvature.
TEST(StressPart, IsSigned) {
  const Model model = beam_model(RectangleSection{width, height}, 3, EffectChoice::off);
  const State state = strained(model, {.pull = 2e-4, .bend_y = 0.04});
  const double axial = young * 2e-4, bending = young * 0.04 * height / 2;
  const auto expect = [&](StressPart part, double least, double largest) {
    const Eigen::VectorXd found = stresses(model, state, part);
    EXPECT_NEAR(found.minCoeff(), least, 1e-9 * bending);
    EXPECT_NEAR(found.maxCoeff(), largest, 1e-9 * bending);
  };
  expect(StressPart::axial, axial, axial);
  expect(StressPart::bending, -bending, bending);
  expect(StressPart::normal, axial - bending, axial + bending);
  expect(StressPart::shear, 0.0, 0.0);
  const Eigen::VectorXd von_mises = stresses(model, state, StressPart::von_mises);
  EXPECT_NEAR(von_mises.maxCoeff(), axial + bending, 1e-9 * bending);
  EXPECT_NEAR(stresses(model, state, StressPart::utilization).maxCoeff(),
              von_mises.maxCoeff() / strength, 1e-12);
}

/// On a round outline bending about both axes adds as vectors, E √(κ² + μ²) r; shear is G θ' r.
TEST(StressPart, OfARoundSectionIsThatOfItsWorstPoint) {
  const double radius = 0.012;
  const Model model = beam_model(CircleSection{2 * radius}, 2, EffectChoice::on);
  const State state =
      strained(model, {.pull = -1e-4, .bend_y = 0.03, .bend_z = -0.04, .twist = -0.05});
  const double axial = -young * 1e-4, bending = young * 0.05 * radius;
  const double shear = young / 2.6 * 0.05 * radius;
  const Eigen::VectorXd normal = stresses(model, state, StressPart::normal);
  EXPECT_NEAR(normal.maxCoeff(), axial + bending, 1e-9 * bending);
  EXPECT_NEAR(normal.minCoeff(), axial - bending, 1e-9 * bending);
  EXPECT_NEAR(stresses(model, state, StressPart::bending).maxCoeff(), bending, 1e-9 * bending);
  EXPECT_NEAR(stresses(model, state, StressPart::shear).minCoeff(), -shear, 1e-9 * bending);
  EXPECT_NEAR(stresses(model, state, StressPart::von_mises).maxCoeff(),
              std::hypot(bending - axial, std::sqrt(3.0) * shear), 1e-9 * bending);
}

/// A cantilever with a force at its tip: M = F (L − x), EI v = F (L x²/2 − x³/6).
TEST(StressPart, AtOnePlaceIsThatOfItsSection) {
  const Model model = beam_model(RectangleSection{width, height}, 4, EffectChoice::off);
  const BodyModel& body = model.body("beam");
  const double force = 100.0, stiffness = young * width * std::pow(height, 3) / 12;
  State state = model.mechanism.guess;
  for (int node = 1; node < body.beam.node_count(); ++node) {
    const double x = body.beam.node_position(node);
    state.q(body.coordinate(node, 1)) = force * (length * x * x / 2 - x * x * x / 6) / stiffness;
    state.q(body.coordinate(node, 5)) = force * (length * x - x * x / 2) / stiffness;
  }
  for (double station : {0.0, 0.25, 0.4, 0.9}) {
    const double moment = force * (length - station * length);
    const Eigen::VectorXd found = stresses(model, state, StressPart::normal, station);
    EXPECT_EQ(found.size(), 2);  // upper and lower edge
    EXPECT_NEAR(found.maxCoeff(), moment * 6 / (width * height * height), 1e-3) << station;
  }
  EXPECT_NEAR(stresses(model, state, StressPart::normal, 1.0).maxCoeff(), 0.0, 1e-2);
}

double buckling(const Model& model, const State& state) {
  const auto responses = make_responses({{"buckling", BucklingResponse{"beam"}}}, model);
  return observed(*responses.front().history()->signal, state).maxCoeff();
}

double euler_load(double thickness, double across) {
  const double inertia = across * std::pow(thickness, 3) / 12;
  return std::numbers::pi * std::numbers::pi * young * inertia / (length * length);
}

/// Shortened by ε: N = −EAε; it bends the easier way, whether the motion has it or not.
TEST(Buckling, IsThePressOverTheEulerLoad) {
  const double press = young * width * height * 1e-4;
  const Model planar = beam_model(RectangleSection{width, height}, 2, EffectChoice::off);
  EXPECT_NEAR(buckling(planar, strained(planar, {.pull = -1e-4})),
              press / euler_load(std::min(height, width), std::max(height, width)), 1e-12);
  const Model spatial = beam_model(RectangleSection{width, height}, 2, EffectChoice::on);
  EXPECT_NEAR(buckling(spatial, strained(spatial, {.pull = -1e-4})),
              press / euler_load(std::min(height, width), std::max(height, width)), 1e-12);
  EXPECT_LT(buckling(planar, strained(planar, {.pull = 1e-4})), 0.0) << "pull does no harm";
}

/// A tapered member counts with its weakest section over its whole length, about whichever axis
/// that is: three segments pressed by the same force, the weakest in the middle, and turned.
TEST(Buckling, OfATaperedMemberIsThatOfItsWeakestSection) {
  for (const bool is_turned : {false, true}) {
    const auto rectangle = [&](double across, double thick) {
      return is_turned ? RectangleSection{thick, across} : RectangleSection{across, thick};
    };
    Scene scene = swinging_beam(length, RectangleSection{0.03, 0.03}, 2);
    scene.gravity = {0.0, 0.0, 0.0};
    std::get<BeamBody>(scene.bodies[0].shape).segments = {{rectangle(0.05, 0.03), 2, {}},
                                                          {rectangle(0.04, 0.012), 2, {}},
                                                          {rectangle(0.02, 0.016), 2, {}}};
    EffectSettings effects{.geometric_stiffening = EffectChoice::off};
    const Model model = build_model(scene, effects, {}, {});
    // I: 50·30³, 40·12³ = 69120, 20·16³ = 81920 by twelve; over the other side 16·20³ = 128000.
    const double least = 40 * std::pow(12.0, 3) / 12 * 1e-12;
    const double euler = std::numbers::pi * std::numbers::pi * young * least / (length * length);
    const double press = 500.0;
    State state = model.mechanism.guess;
    const BodyModel& body = model.body("beam");
    double shift = 0.0;
    for (int node = 0; node < body.beam.node_count(); ++node) {
      const int index = body.coordinate(node, 0);
      if (index >= 0) state.q(index) = shift;
      if (node + 1 == body.beam.node_count()) break;
      const auto& element = body.beam.elements[node];
      shift -= press * element.length / (element.young * element.section.area);
    }
    EXPECT_NEAR(buckling(model, state) * euler / press, 1.0, 1e-9) << is_turned;
  }
}

/// A bar that is pushed along its axis with acceleration a: its root carries ρAL a.
TEST(Buckling, OfAPushedBarIsThatOfItsInertia) {
  for (int elements : {1, 3}) {
    Model model = beam_model(RectangleSection{width, height}, elements, EffectChoice::off);
    const BodyModel& body = model.body("beam");
    State state = model.mechanism.guess;
    const double push = 200.0;
    state.a(0) = push;
    // Elastic equilibrium under the inertia load: linear without stiffening.
    const int first = body.elastic_offset(), n = body.elastic_size();
    Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(n, n);
    for (const auto& term : model.mechanism.system->terms()) {
      if (term->name().starts_with("joint")) continue;
      force += residual_of(*term, state, ConstraintLevel::position).segment(first, n);
      tangent +=
          tangent_of(*term, state, {.q = 1.0}, ConstraintLevel::position).block(first, first, n, n);
    }
    state.q.segment(first, n) -= solve_dense(tangent, force);
    const double press = density * width * height * length * push;
    EXPECT_NEAR(buckling(model, state) *
                    euler_load(std::min(height, width), std::max(height, width)) / press,
                1.0, 1e-9);
  }
}

void expect_error(const Model& model, const AnyResponse& load, const std::string& message) {
  EXPECT_EQ(thrown<InputError>([&] { make_responses({{"load", load}}, model); }), message);
}

TEST(SectionForces, OfARigidBodyAreNotKnown) {
  const Scene scene = swinging_beam(length, RectangleSection{width, height}, 2);
  EffectSettings without_elasticity, without_axial;
  without_elasticity.elasticity = EffectChoice::off;
  without_axial.axial_elasticity = EffectChoice::off;
  const Model rigid = build_model(scene, without_elasticity, {}, {});
  const BucklingResponse buckling{"beam"};
  expect_error(rigid, buckling, "the response \"load\" cannot be computed: \"beam\" is rigid");
  const Model stiff = build_model(scene, without_axial, {}, {});
  expect_error(stiff, buckling,
               "the response \"load\" cannot be computed: \"beam\" has no axial elasticity");
  expect_error(
      stiff, StressResponse{{{"beam"}}, StressPart::utilization},
      "the response \"load\" cannot be computed: the material of \"beam\" has no strength");
}

/// A force towards +y, or +z, presses the fibres on that side: σ = −F L y/I_z, −F L z/I_y.
TEST(StressOfOnePoint, HasTheSignOfItsSide) {
  const auto stress_at = [](const std::string& point, const std::string& direction) {
    const ProblemFile problem = problem_from(R"({"scene": {"gravity": [0, 0, 0],
            "bodies": {"beam": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
              "material": "steel", "elements": 2, "section": {"type": "general", "area": 1e-4,
                "inertia_y": 2e-9, "inertia_z": 1e-9, "torsion": 1e-9, "points": [)" +
                                             point + R"(]}}},
            "joints": {"wall": {"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}},
            "loads": {"push": {"type": "force", "body": "beam", "at": [1, 0, 0], "value": 1, "direction": )" +
                                             direction + R"(}}},
          "effects": {"geometric_stiffening": "off"},
          "simulation": {"end_time": 2e-4, "step": 1e-4, "initial_state": "quasi-static"},
          "responses": {"s": {"type": "stress", "part": "normal", "body": "beam", "at": 0,
                              "over_time": "final"}}})");
    return analyze(problem, start_design(problem))->reductions[0].value;
  };
  const std::string y = "[0, 1, 0]", z = "[0, 0, 1]";
  for (const double side : {-1.0, 1.0}) {
    const std::string lever = side > 0.0 ? "0.01" : "-0.01";
    EXPECT_NEAR(stress_at(R"({"z": 0, "shear": 0, "y": )" + lever + "}", y), -side * 1e7, 1e3);
    EXPECT_NEAR(stress_at(R"({"y": 0, "shear": 0, "z": )" + lever + "}", z), -side * 5e6, 1e3);
  }
}

/// A light beam on two supports with a force F upwards at 0.4 of its length: the shear force of the
/// part behind a section on the part before it is +0.6 F before the load and −0.4 F behind it; the
/// moment there is 0.24 F L, and nothing at the pins.
ProblemFile supported_beam(const std::string& responses, int frames = 1, double force = 100.0) {
  return problem_from(fmt::format(R"j({{"scene": {{"gravity": [0, 0, 0],
    "materials": {{"light": {{"young": "200 GPa", "poisson": 0.3, "density": 1}}}},
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": 5,
      "material": "light", "frames": {},
      "section": {{"type": "rectangle", "width": {{"variable": "width"}}, "height": "20 mm"}}}}}},
    "joints": {{"pin": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
               "roller": {{"type": "point-on-line", "bodies": ["ground", "bar"], "at": [1, 0, 0],
                          "axis": [1, 0, 0]}}}},
    "loads": {{"push": {{"type": "force", "body": "bar", "at": [0.4, 0, 0],
                         "direction": [0, 1, 0], "value": {}}}}}}},
  "effects": {{"geometric_stiffening": "off"}},
  "simulation": {{"end_time": "10 ms", "step": "1 ms", "initial_state": "quasi-static"}},
  "variables": {{"width": {{"start": "20 mm", "lower": "10 mm", "upper": "40 mm"}}}},
  "objective": {{"minimize": "m"}},
  "responses": {{"m": {{"type": "mass"}}, {}}}}})j",
                                  frames, force, responses));
}

double value_of(const Analysis& analysis, const std::string& name) {
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    if (analysis.responses[i].name == name) return analysis.reductions[i].value;
  }
  throw std::logic_error("no response " + name);
}

double of_shear(const std::string& over_time, const std::string& side = "", int frames = 1) {
  const std::string more = side.empty() ? "" : fmt::format(R"(, "side": "{}")", side);
  const ProblemFile problem =
      supported_beam(fmt::format(R"("s": {{"type": "section-force", "body": "bar", "at": 0.4,
                           "part": "shear-y", "over_time": "{}"{}}})",
                                 over_time, more),
                     frames);
  return value_of(*analyze(problem, start_design(problem)), "s");
}

/// 1e-3 N: vibrations about the equilibrium.
TEST(SectionSides, AreBothInPeaksAndTheLargerMagnitudeElsewhere) {
  EXPECT_NEAR(std::abs(of_shear("max") - of_shear("min")), 100.0, 1e-2);
  EXPECT_NEAR(of_shear("max-abs"), 60.0, 1e-2);
  const double larger = of_shear("max") > 50.0 ? 60.0 : -60.0;
  for (const char* over_time : {"final", "mean"}) {
    EXPECT_NEAR(of_shear(over_time), larger, 1e-2) << over_time;
  }
  EXPECT_NEAR(of_shear("integral"), 0.01 * larger, 1e-4);
}

/// The same beam in two frames that meet at the load, too.
TEST(SectionSides, CanBeChosen) {
  const double before = of_shear("final", "before"), behind = of_shear("final", "behind");
  EXPECT_NEAR(std::abs(before), 60.0, 1e-2);
  EXPECT_NEAR(behind / before, -40.0 / 60.0, 1e-3);
  for (const char* over_time : {"max", "min", "mean"}) {
    EXPECT_NEAR(of_shear(over_time, "before"), before, 1e-2);
    EXPECT_NEAR(of_shear(over_time, "behind"), behind, 1e-2);
  }
}

/// Judged beside the moment in the middle, 24 N mm. A larger force tilts the supports by its deflection,
/// squared: that is no round-off.
TEST(SectionForces, ThatVanishAreRoundOff) {
  std::string responses;
  for (const auto& [name, place, part] : {std::tuple{"a", 0.0, "moment-z"},
                                          {"b", 1.0, "moment-z"},
                                          {"c", 0.4, "axial"},
                                          {"d", 0.4, "moment-z"},
                                          {"e", 0.9, "shear-y"}}) {
    responses += fmt::format(
        R"({}"{}": {{"type": "section-force", "body": "bar", "at": {}, "part": "{}", "over_time": "max-abs"}})",
        responses.empty() ? "" : ", ", name, place, part);
  }
  responses += R"(, "f": {"type": "stress", "body": "bar", "at": 1, "over_time": "max"},
                    "g": {"type": "stress", "body": "bar", "at": 0.5, "over_time": "max"})";
  const auto [problem, x, analysis] = AtStart(supported_beam(responses, 1, 0.1));
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  EXPECT_EQ(find_round_off(TrustedRun{problem, x, *analysis, monitors}),
            (std::vector<bool>{false, true, true, true, false, false, true, false}));
}

}  // namespace
}  // namespace pleuel::test::section_signal_test
