#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::frequency_sensitivity_test {
namespace {

// Frequencies of modes along an axis, where those of two modes coincide.

/// A square cantilever that is fixed to the ground, turned by 30° about its axis z = global z: local y
/// stays in the global plane x y. Both planes of bending have one frequency.
ProblemFile square_cantilever(const std::string& joints = "", const std::string& bodies = "") {
  return problem_from(
      fmt::format(R"j({{"scene": {{"bodies": {{"mast": {{"type": "beam", "from": [0, 0, 0],
    "to": [0.4330127018922193, 0.25, 0], "material": "steel", "elements": 4,
    "section": {{"type": "rectangle", "width": "= w", "height": "= h"}}}}{}}},
    "joints": {{"root": {{"type": "fixed", "bodies": ["ground", "mast"], "at": [0, 0, 0]}}{}}}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "resolution_check": false}},
  "variables": {{"w": {{"start": "16 mm", "lower": "5 mm", "upper": "60 mm"}},
                "h": {{"start": "16 mm", "lower": "5 mm", "upper": "60 mm"}}}},
  "responses": {{
    "body_y": {{"type": "frequency", "body": "mast", "direction": "y"}},
    "body_z": {{"type": "frequency", "body": "mast", "direction": "z"}},
    "second_z": {{"type": "frequency", "body": "mast", "direction": "z", "mode": 2}},
    "across": {{"type": "frequency", "direction": "z"}},
    "second_across": {{"type": "frequency", "direction": "z", "mode": 2}},
    "in_plane": {{"type": "frequency", "direction": "y"}},
    "first": {{"type": "frequency"}}}}}})j",
                  bodies, joints));
}

/// ω is proportional to the thickness in the direction of bending, but for rotary inertia, (βr)² = 3e-4
/// for the first mode and 7 times that for the second: its derivative by that thickness is ω/h, and
/// by the other one zero. The mean of both is what modes in the order of frequencies have.
TEST(FrequencyDirection, HasTheGradientOfItsPlaneWherePlanesCoincide) {
  const auto [problem, x, analysis] = AtStart(square_cantilever());
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd gradients = direct_gradients(*analysis) * x.asDiagonal();
  for (int i = 0; i < 7; ++i) {
    const bool is_second = i == 2 || i == 4;
    EXPECT_NEAR(values(i) / values(is_second ? 2 : 0), 1.0, 1e-7) << problem.responses[i].name;
    const bool is_of_width = i >= 1 && i <= 4;
    const double of_width = i == 6 ? 0.5 : is_of_width ? 1.0 : 0.0;
    const double allowed = is_second ? 1e-2 : 1e-3;
    EXPECT_NEAR(gradients(i, 0) / values(i), of_width, allowed) << problem.responses[i].name;
    EXPECT_NEAR(gradients(i, 1) / values(i), 1.0 - of_width, allowed) << problem.responses[i].name;
  }
}

/// Along vectors, as of a beam whose section stands obliquely: those of its own axes.
TEST(FrequencyDirection, MayBeAVector) {
  ProblemFile problem = square_cantilever();
  for (ResponseSettings& response : problem.responses) {
    if (response.name != "in_plane") continue;
    std::get<ModeResponse>(response.what).mode.axis = {{-0.5, 0.8660254037844386, 0.0}};
  }
  problem.variables[0].start = 0.012;  // so that planes do not coincide
  const Eigen::VectorXd x = start_design(problem);
  const Eigen::VectorXd values = values_of(*analyze(problem, x));
  EXPECT_NEAR(values(5) / values(0), 1.0, 1e-7);
}

/// They are smooth there: central differences of designs on both sides have one limit. 1e-6: what
/// differences of fourth order with steps of 1e-3 leave of frequencies that are exact to 1e-12.
TEST(FrequencyDirection, IsSmoothWherePlanesCoincide) {
  const auto [problem, x, analysis] = AtStart(square_cantilever());
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
  const Eigen::MatrixXd wide = central_differences(problem, x, 2e-3) * x.asDiagonal();
  const Eigen::MatrixXd narrow = central_differences(problem, x, 1e-3) * x.asDiagonal();
  const Eigen::MatrixXd error = (4.0 * narrow - wide) / 3.0 - direct;
  for (int i = 0; i < 6; ++i) {
    EXPECT_LE(error.row(i).lpNorm<Eigen::Infinity>(), 1e-6 * values(i))
        << problem.responses[i].name;
  }
}

/// Of two masts without a joint between them, whose frequencies all coincide in fours.
TEST(FrequencyDirection, IsFoundAmongFourModesThatCoincide) {
  const auto [problem, x, analysis] = AtStart(square_cantilever(
      R"j(, "second_root": {"type": "fixed", "bodies": ["ground", "other"], "at": [1, 0, 0]})j",
      R"j(, "other": {"type": "beam", "from": [1, 0, 0], "to": [1.4330127018922193, 0.25, 0],
    "material": "steel", "elements": 4, "section": {"type": "rectangle", "width": "= w", "height": "= h"}})j"));
  const Eigen::VectorXd values = values_of(*analysis);
  const Eigen::MatrixXd gradients = direct_gradients(*analysis) * x.asDiagonal();
  const int across = 3, second_across = 4, in_plane = 5;
  EXPECT_NEAR(values(second_across) / values(across), 1.0, 1e-7);
  EXPECT_NEAR(gradients(across, 0) / values(across), 1.0, 1e-3);
  EXPECT_NEAR(gradients(second_across, 0) / values(across), 1.0, 1e-3);
  EXPECT_NEAR(gradients(in_plane, 1) / values(in_plane), 1.0, 1e-3);
}

// Damping ratios and growth rates of small vibrations.

struct Found {
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;  ///< a row each response
};

Found found_of(const std::string& text, const Eigen::VectorXd* x = nullptr) {
  const ProblemFile problem = problem_from(text, {});
  const auto analysis = analyze(problem, x != nullptr ? *x : start_design(problem));
  return {values_of(*analysis), direct_gradients(*analysis)};
}

/// A mass on a spring and a damper, m = 2 kg, k = 800 N/m: ω = 20 rad/s.
/// @param more  responses
Found oscillator(double damping, const std::string& more = "") {
  return found_of(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "bodies": {{"m": {{"type": "point-mass", "at": [1, 0, 0], "mass": {{"variable": "m"}}}}}},
      "joints": {{"rail": {{"type": "point-on-line", "bodies": ["ground", "m"], "at": [1, 0, 0],
                           "axis": [1, 0, 0]}}}},
      "loads": {{"s": {{"type": "spring", "bodies": ["ground", "m"], "at": [[0, 0, 0], [1, 0, 0]],
                       "stiffness": {{"variable": "k"}}, "damping": {{"variable": "c"}}}}}}}},
    "simulation": {{"end_time": 0.01, "step": 0.01}},
    "variables": {{"m": {{"start": 2, "lower": 1, "upper": 9}},
                   "k": {{"start": 800, "lower": 1, "upper": 9999}},
                   "c": {{"start": {}, "lower": 0, "upper": 999}}}},
    "responses": {{"zeta": {{"type": "damping-ratio"}}, "rate": {{"type": "growth-rate"}}{}}}}})",
                              damping, more));
}

const std::string first_mode = R"(, "first": {"type": "damping-ratio", "mode": 1})";

/// ζ = c/(2√(km)), and the motion decays as exp(−c t/(2m)).
TEST(DampedMode, OfAMassOnASpringIsTheClosedForm) {
  const double m = 2.0, k = 800.0, c = 8.0, zeta = c / (2.0 * std::sqrt(k * m));
  const Found found = oscillator(c, first_mode);
  EXPECT_NEAR(found.values(0), zeta, 1e-9);
  EXPECT_NEAR(found.values(2), zeta, 1e-9);
  EXPECT_NEAR(found.values(1), -c / (2.0 * m), 1e-8);
  const Eigen::RowVector3d of_ratio(-zeta / (2.0 * m), -zeta / (2.0 * k), zeta / c);
  const Eigen::RowVector3d of_rate(c / (2.0 * m * m), 0.0, -1.0 / (2.0 * m));
  EXPECT_LT((found.gradients.row(0) - of_ratio).norm(), 1e-7);
  EXPECT_LT((found.gradients.row(1) - of_rate).norm(), 1e-6);
}

/// Beyond c = 2√(km) = 80 N s/m nothing vibrates: s = −(c ∓ √(c² − 4 k m))/(2m), −Re s/|s| = 1.
TEST(DampedMode, WithoutVibrationHasARateAndTheRatioOne) {
  const Found found = oscillator(100.0);
  EXPECT_EQ(found.values(0), 1.0);
  EXPECT_LT(found.gradients.row(0).norm(), 1e-12);
  EXPECT_NEAR(found.values(1), -(100.0 - std::sqrt(3600.0)) / 4.0, 1e-8);
  EXPECT_THAT(thrown<SimulationError>([] { oscillator(100.0, first_mode); }),
              HasSubstr("the response \"first\" cannot be computed"));
}

/// A wheel on a soft spring with a motor that feeds it, c = −1 N m s/rad, and a short steel rod on it. The rod's
/// damping goes with its stiffness and makes rates of 1e8 1/s and more, the finer the mesh; the wheel grows
/// as exp(−c t/(2J)) all the same, ζ = c/(2√(kJ)), as the rod hardly bends.
TEST(DampedMode, OfAWheelIsFoundBesideAStiffRodWithDamping) {
  constexpr double d = 0.01, area = std::numbers::pi * d * d / 4.0, length = 0.1;
  const double mass = 7850.0 * area * length;
  const double inertia = 10.0 + mass * (0.45 * 0.45 + length * length / 12.0 + d * d / 16.0);
  for (const int elements : {1, 10, 20}) {
    const Found found = found_of(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
        "bodies": {{"wheel": {{"type": "rigid", "at": [0, 0, 0], "mass": 50, "inertia": [5, 5, 10, 0, 0, 0]}},
          "rod": {{"type": "beam", "from": [0.4, 0, 0], "to": [0.5, 0, 0], "elements": {},
            "material": "steel",
            "section": {{"type": "circle", "diameter": {{"variable": "d"}}}}, "damping": {{"stiffness": 1e-4}}}}}},
        "joints": {{"a": {{"type": "revolute", "bodies": ["ground", "wheel"], "at": [0, 0, 0], "axis": [0, 0, 1]}},
                    "f": {{"type": "fixed", "bodies": ["wheel", "rod"], "at": [0.4, 0, 0]}}}},
        "loads": {{"s": {{"type": "joint", "joint": "a", "stiffness": 10,
                          "motor": {{"type": "expression", "value": "= 1 N m s/rad*speed"}}}}}}}},
      "simulation": {{"end_time": 0.01, "step": 0.01}},
      "variables": {{"d": {{"start": 0.01, "lower": 0.005, "upper": 0.02}}}},
      "responses": {{"zeta": {{"type": "damping-ratio"}}, "rate": {{"type": "growth-rate"}}}}}})",
                                             elements));
    const double rate = 0.5 / inertia, zeta = -0.5 / std::sqrt(10.0 * inertia);
    EXPECT_NEAR(found.values(0), zeta, 1e-6 * std::abs(zeta)) << elements;
    EXPECT_NEAR(found.values(1), rate, 1e-6 * rate) << elements;
  }
}

/// A cantilever whose damping goes with its stiffness, C = β K: ζ = β ω/2 of each mode, and the first
/// decays most slowly, with β ω²/2; so do their derivatives follow from those of the frequency.
TEST(DampedMode, OfACantileverWithDampingByStiffnessFollowsFromItsFrequencies) {
  constexpr double beta = 1e-4;
  const Found found = found_of(R"({"scene": {"gravity": [0, 0, 0],
      "bodies": {"b": {"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "steel",
        "section": {"type": "rectangle", "width": {"variable": "w"}, "height": {"variable": "h"}},
        "elements": 4, "damping": {"stiffness": 1e-4}}},
      "joints": {"c": {"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": 1e-3, "step": 1e-3},
    "variables": {"w": {"start": 0.012, "lower": 0.001, "upper": 0.1},
                  "h": {"start": 0.02, "lower": 0.001, "upper": 0.1}},
    "responses": {"f2": {"type": "frequency", "mode": 2}, "z2": {"type": "damping-ratio", "mode": 2},
                  "fz": {"type": "frequency", "direction": "z"},
                  "rate": {"type": "growth-rate", "direction": "z"}}})");
  const double second = found.values(0), lowest = found.values(2);
  // ζ of the damped frequency: ω_d = ω √(1 − ζ²) changes no order.
  EXPECT_NEAR(found.values(1) / (0.5 * beta * second), 1.0, 1e-7);
  EXPECT_NEAR(found.values(3) / (-0.5 * beta * lowest * lowest), 1.0, 1e-7);
  EXPECT_LT((found.gradients.row(1) / (0.5 * beta) - found.gradients.row(0)).norm(),
            1e-5 * found.gradients.row(0).norm());
  EXPECT_LT((found.gradients.row(3) / (-beta * lowest) - found.gradients.row(2)).norm(),
            1e-5 * found.gradients.row(2).norm());
}

/// A light shaft of length L, clamped in its first bearing, with a disc of mass m in the middle, damped by
/// β times its stiffness, at a speed Ω; ω² = 768 EI/(7 L³ m).
Found whirling_shaft(double speed) {
  return found_of(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "materials": {{"m": {{"young": 2e11, "poisson": 0.3, "density": 1}}}},
      "bodies": {{"s": {{"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "m",
          "section": {{"type": "circle", "diameter": {{"variable": "d"}}}}, "elements": 2,
          "damping": {{"stiffness": 2e-5}}}},
        "disc": {{"type": "rigid", "at": [0.4, 0, 0], "mass": 8, "inertia": [2e-4, 1e-4, 1e-4, 0, 0, 0]}}}},
      "joints": {{
        "left": {{"type": "revolute", "bodies": ["ground", "s"], "at": [0, 0, 0], "axis": [1, 0, 0],
          "drive": {{"type": "constant-speed", "speed": {{"variable": "speed"}}}}}},
        "right": {{"type": "point-on-line", "bodies": ["ground", "s"], "at": [0.8, 0, 0], "axis": [1, 0, 0]}},
        "hub": {{"type": "fixed", "bodies": ["s", "disc"], "at": [0.4, 0, 0]}}}}}},
    "simulation": {{"end_time": 1e-4, "step": 1e-4}},
    "variables": {{"d": {{"start": 0.02, "lower": 0.01, "upper": 0.04}},
                   "speed": {{"start": {}, "lower": 10, "upper": 999}}}},
    "responses": {{"rate": {{"type": "growth-rate"}}}}}})",
                              speed));
}

/// Damping that turns with the shaft drives its whirl beyond the critical speed: in axes that stand
/// still  m ẅ + β k (ẇ − iΩ w) + k w = 0  for w = y + iz, whose root is nearly iω with
/// Re s = β ω² (Ω/ω − 1)/2 (Genta, Dynamics of Rotating Systems, 2005).
TEST(DampedMode, OfAShaftWithDampingOfItsOwnGrowsBeyondTheCriticalSpeed) {
  const double m = 8.0, beta = 2e-5, d = 0.02, length = 0.8;
  const double stiffness =
      768.0 / 7.0 * 2e11 * std::numbers::pi * std::pow(d, 4) / 64.0 / std::pow(length, 3);
  const double omega = std::sqrt(stiffness / m);  // 205 rad/s
  for (const double speed : {0.6 * omega, 1.7 * omega}) {
    const std::complex<double> half(0.5 * beta * omega * omega, 0.0),
        turning(0.0, beta * omega * omega * speed);
    const std::complex<double> forward = -half + std::sqrt(half * half - omega * omega + turning);
    const Found found = whirling_shaft(speed);
    EXPECT_NEAR(found.values(0), forward.real(), 1e-4 * half.real()) << speed;
    // Re s = β (ω Ω − ω²)/2 with ω ~ d²
    const double by_d = beta * (speed - 2.0 * omega) * omega / d, by_speed = 0.5 * beta * omega;
    EXPECT_NEAR(found.gradients(0, 0), by_d, 1e-3 * std::abs(by_d)) << speed;
    EXPECT_NEAR(found.gradients(0, 1), by_speed, 1e-3 * by_speed) << speed;
  }
}

/// Beck's column with damping by stiffness, pressed along its tip by p EI/L²: without damping it
/// flutters from p = 20.05 on, with a little from 10.94 (Bolotin, Nonconservative Problems of the Theory
/// of Elastic Stability, 1963).
double growth_of_column(double p, double damping) {
  constexpr double stiffness = 7e10 * 0.03 * 1e-6 / 12;
  return found_of(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "materials": {{"m": {{"young": 7e10, "poisson": 0.3, "density": 2700}}}},
      "bodies": {{"c": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
        "section": {{"type": "rectangle", "width": 0.03, "height": 0.01}}, "elements": 10,
        "damping": {{"stiffness": {}}}}}}},
      "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "c"], "at": [0, 0, 0]}}}},
      "loads": {{"P": {{"type": "force", "body": "c", "at": [1, 0, 0], "direction": [-1, 0, 0],
        "follows": true, "value": {{"type": "table", "times": [-1, 0], "values": [{}, {}]}}}}}}}},
    "simulation": {{"end_time": 1e-3, "step": 1e-3}},
    "responses": {{"rate": {{"type": "growth-rate", "direction": "y"}}}}}})",
                              damping, p * stiffness, p * stiffness))
      .values(0);
}

TEST(DampedMode, OfBecksColumnGrowsBeyondItsCriticalLoads) {
  EXPECT_LT(growth_of_column(19.9, 0.0), 1e-3);
  EXPECT_GT(growth_of_column(20.2, 0.0), 1.0);
  EXPECT_LT(growth_of_column(10.8, 1e-5), 0.0);
  EXPECT_GT(growth_of_column(11.1, 1e-5), 0.0);
}

// Elements much shorter than others have stiffnesses whose round-off drowns small differences.

/// The first frequency of a bar on two supports, with the inertia of its turning sections
///     f ∝ h/√(1 + π² h²/(12 L²))
/// has nothing to do with where two loads bend it a little; the element between them is a
/// three-hundredth, or a thousandth, of the bar.
TEST(FrequencyBesideShortElements, HasTheDerivativesOfABar) {
  for (const double gap : {3.0, 1.0}) {
    const auto [problem, x, analysis] = AtStart(problem_from(fmt::format(R"j({{"scene": {{
          "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
            "elements": 6, "section": {{"type": "rectangle", "width": "40 mm", "height": {{"variable": "h"}}}}}}}},
          "joints": {{
            "left": {{"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
            "right": {{"type": "point-on-line", "bodies": ["ground", "bar"], "at": [1, 0, 0], "axis": [1, 0, 0]}}}},
          "loads": {{
            "P": {{"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [0, -1, 0], "value": 10}},
            "Q": {{"type": "force", "body": "bar", "at": [{{"variable": "a"}}, 0, 0], "direction": [0, -1, 0],
                   "value": 10}}}}}},
        "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static"}},
        "variables": {{"h": {{"start": "20 mm", "lower": "5 mm", "upper": "90 mm"}},
                       "a": {{"start": "{} mm", "lower": "500.5 mm", "upper": "900 mm"}}}},
        "responses": {{"f": {{"type": "frequency"}}}}}})j",
                                                                         500.0 + gap)));
    const double f = values_of(*analysis)(0);
    const Eigen::MatrixXd slopes = direct_gradients(*analysis);
    const double turning = std::pow(std::numbers::pi * 0.02, 2) / 12;
    EXPECT_NEAR(slopes(0, 0) * 0.02, f / (1 + turning), 1e-5 * f) << gap;
    EXPECT_NEAR(slopes(0, 1), 0.0, 1e-3 * f) << gap;
  }
}

// Frequencies of mechanisms with bodies that spin, and their derivatives.

/// A top of 2 kg that hangs at a length below a ball joint and spins about the vertical.
const char* const hanging_top = R"j({"scene": {"gravity": [0, -9.81, 0],
    "bodies": {"top": {"type": "rigid", "at": [0, "= -1 * length", 0], "mass": "= mass",
      "inertia": [0.012, 0.02, 0.012, 0, 0, 0], "angular_velocity": [0, "= spin", 0]}},
    "joints": {"pivot": {"type": "spherical", "bodies": ["ground", "top"], "at": [0, 0, 0]}}},
  "effects": {"spatial_motion": "on"},
  "simulation": {"end_time": 1e-4, "step": 1e-4},
  "variables": {"length": {"start": "150 mm", "lower": "100 mm", "upper": "200 mm"},
                "mass": {"start": "2 kg", "lower": "1 kg", "upper": "3 kg"},
                "spin": {"start": "60 rad/s", "lower": "1 rad/s", "upper": "100 rad/s"}},
  "responses": {"slow": {"type": "frequency", "mode": 1}, "fast": {"type": "frequency", "mode": 2}}})j";

/// (I_d + m l²) ω² ∓ I_p Ω ω − m g l = 0, in axes that stand still
double whirl(const Eigen::Vector3d& x, double side) {
  const double l = x(0), m = x(1), momentum = 0.02 * x(2), inertia = 0.012 + m * l * l;
  return (side * momentum + std::sqrt(momentum * momentum + 4 * inertia * m * 9.81 * l)) /
         (2 * inertia);
}

TEST(Whirl, OfATopIsTheClosedFormWithItsDerivatives) {
  const ProblemFile problem = problem_from(hanging_top);
  const Eigen::Vector3d x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Eigen::MatrixXd gradients = direct_gradients(*analysis);
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1.0 : 1.0;
    EXPECT_NEAR(analysis->reductions[i].value, whirl(x, side), 1e-9 * whirl(x, side));
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = 1e-4 * x(k) * Eigen::Vector3d::Unit(k);
      const double slope = (whirl(x + step, side) - whirl(x - step, side)) / 2e-4;
      EXPECT_NEAR(gradients(i, k) * x(k), slope, 1e-6 * whirl(x, side)) << i << " " << k;
    }
  }
}

constexpr double ramp = 0.05, speed = 200.0;

/// The slider-crank with a rod whose frame is given, and deflections against everything.
ProblemFile problem_with(const std::string& rod_frame) {
  ProblemFile problem = sample_problem(
      "slider_crank",
      {"/simulation/end_time=0.06 s", "/simulation/step=1e-4 s", "/scene/bodies/crank/elements=3",
       "/scene/bodies/rod/elements=4", "/scene/bodies/rod/frame=" + rod_frame,
       "/variables/crank_height/start=18 mm",
       R"(/responses/bow_from_frame={"type": "deflection", "body": "rod", "at": 0.5, "over_time": "rms"})",
       R"(/responses/bow_from_chord={"type": "deflection", "body": "rod", "at": 0.5,
            "against": "chord", "over_time": "rms"})",
       R"(/responses/tip_from_frame={"type": "deflection", "body": "crank", "at": 1, "over_time": "rms"})",
       R"(/responses/tip_from_rigid_x={"type": "deflection", "body": "crank", "at": 1,
            "against": "rigid-mechanism", "direction": "x", "over_time": "rms"})",
       R"(/responses/tip_from_rigid_y={"type": "deflection", "body": "crank", "at": 1,
            "against": "rigid-mechanism", "direction": "y", "over_time": "max-abs"})"});
  problem.simulation.newton_tolerance = 1e-12;
  return problem;
}

/// ∫∫(Ω/T)(1 − cos 2πt/T), then Ω t
double crank_angle(double t) {
  const double pi = std::acos(-1.0), w = 2.0 * pi / ramp;
  if (t >= ramp) return speed * (t - 0.5 * ramp);
  return speed / ramp * (t * t / 2.0 - (1.0 - std::cos(w * t)) / (w * w));
}

TEST(DeflectionAgainstTheChord, IsThatInAChordFrame) {
  const AtStart run(problem_with("chord"));
  const Eigen::VectorXd frame = run.history("bow_from_frame"),
                        chord = run.history("bow_from_chord");
  EXPECT_GT(frame.lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_LE((frame - chord).lpNorm<Eigen::Infinity>(), 1e-15);
}

/// Two frames differ by what is of second order: some δ/L = 1e-3 of the deflection.
TEST(DeflectionAgainstTheChord, IsThatOfATangentFrame) {
  const AtStart chord(problem_with("chord")), tangent(problem_with("tangent"));
  const Eigen::VectorXd expected = chord.history("bow_from_chord"),
                        found = tangent.history("bow_from_chord");
  const double size = expected.lpNorm<Eigen::Infinity>();
  EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(), 2e-3 * size);
  EXPECT_GE((tangent.history("bow_from_frame") - expected).lpNorm<Eigen::Infinity>(), 0.5 * size);
}

/// The hub of the crank is prescribed, so the rigid crank is at R(φ) (0.12, 0), and the local y
/// component of the difference is the deflection in the tangent frame.
TEST(DeflectionAgainstTheRigidMechanism, IsThatFromThePrescribedMotion) {
  const AtStart run(problem_with("chord"));
  const Eigen::VectorXd x = run.history("tip_from_rigid_x"), y = run.history("tip_from_rigid_y"),
                        local = run.history("tip_from_frame");
  EXPECT_GT(local.lpNorm<Eigen::Infinity>(), 1e-5);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double angle = crank_angle(run.analysis->trajectory.time(k));
    EXPECT_NEAR(-std::sin(angle) * x(k) + std::cos(angle) * y(k), local(k), 1e-12) << k;
  }
}

/// Where the drive is faster, the rigid mechanism is elsewhere at the end, too: by far more than
/// the deflection changes.
TEST(DeflectionReferences, LeaveOutHowTheRigidMechanismMovesWithTheDesign) {
  ProblemFile problem = sample_problem(
      "slider_crank",
      {"/simulation/end_time=0.06 s", "/simulation/step=1e-4 s", "/scene/bodies/crank/elements=2",
       "/scene/bodies/rod/elements=2",
       R"(/variables/speed={"start": 200, "lower": 100, "upper": 300})",
       R"(/scene/joints/bearing/drive/speed={"variable": "speed"})",
       R"(/responses/tip_from_rigid={"type": "deflection", "body": "crank", "at": 1,
            "against": "rigid-mechanism", "direction": "y", "over_time": "final"})",
       R"(/responses/tip={"type": "position", "body": "crank", "at": 1, "direction": "y", "over_time": "final"})"});
  problem.simulation.newton_tolerance = 1e-12;
  const auto [x, analysis] = started(problem);
  const Eigen::MatrixXd wide = central_differences(problem, x, 2e-4) * x.asDiagonal(),
                        narrow = central_differences(problem, x, 1e-4) * x.asDiagonal();
  const Eigen::MatrixXd best = (4.0 * narrow - wide) / 3.0;
  const Eigen::Index i = response_index(problem, "tip_from_rigid"),
                     tip = response_index(problem, "tip");
  for (const ExactMethod method : {ExactMethod::direct, ExactMethod::adjoint}) {
    const Eigen::MatrixXd found =
        sampled_gradients(*analysis, response_values(*analysis), method) * x.asDiagonal();
    EXPECT_LE((best.row(i) - found.row(i)).lpNorm<Eigen::Infinity>(),
              1e-3 * best.row(i).lpNorm<Eigen::Infinity>())
        << to_string(method);
    EXPECT_GT(found.row(tip).lpNorm<Eigen::Infinity>(),
              10.0 * found.row(i).lpNorm<Eigen::Infinity>());
  }
}

TEST(DeflectionReferences, HaveTheGradientsOfDifferences) {
  const AtStart run(problem_with("tangent"));
  const Eigen::VectorXd x = start_design(run.problem);
  const Eigen::MatrixXd direct = direct_gradients(*run.analysis) * x.asDiagonal();
  const Eigen::MatrixXd wide = central_differences(run.problem, x, 1e-3) * x.asDiagonal(),
                        narrow = central_differences(run.problem, x, 5e-4) * x.asDiagonal();
  const Eigen::MatrixXd best = (4.0 * narrow - wide) / 3.0;
  for (const char* name : {"bow_from_chord", "tip_from_rigid_x", "tip_from_rigid_y"}) {
    const Eigen::Index i = response_index(run.problem, name);
    EXPECT_LE((best.row(i) - direct.row(i)).lpNorm<Eigen::Infinity>(),
              1e-7 * direct.row(i).lpNorm<Eigen::Infinity>())
        << name;
  }
}

std::string bar(const std::string& name, const std::string& from, const std::string& to) {
  return fmt::format(
      R"("{}": {{"type": "beam", "from": {}, "to": {}, "material": "steel", "elements": 1,
      "rigid": true, "section": {{"type": "circle", "diameter": 0.01}}}})",
      name, from, to);
}

/// A crank of r and a rod of l, through a turn: cos of the angle against the normal of the guide is
/// sin φ r/l, so that the least angle is acos(r/l).
TEST(TransmissionAngle, OfASliderCrankIsLeastWhereTheCrankStandsAcross) {
  const double r = 0.1, l = 0.3;
  const std::string text = fmt::format(
      R"({{"scene": {{"bodies": {{{}, {}, "slider": {{"type": "point-mass", "at": [0.4, 0, 0], "mass": 1}}}},
      "joints": {{
        "shaft": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                  "drive": {{"type": "constant-speed", "speed": 6.283185307179586}}}},
        "pin": {{"type": "revolute", "bodies": ["crank", "rod"], "at": [{{"variable": "r"}}, 0, 0]}},
        "wrist": {{"type": "spherical", "bodies": ["rod", "slider"], "at": [0.4, 0, 0]}},
        "guide": {{"type": "point-on-line", "bodies": ["ground", "slider"], "at": [0.4, 0, 0],
                  "axis": [2, 0, 0]}}}}}},
    "simulation": {{"end_time": 1, "step": 0.0025}},
    "variables": {{"r": {{"start": 0.1, "lower": 0.05, "upper": 0.15}}}},
    "responses": {{"mu": {{"type": "transmission-angle", "body": "rod", "joint": "guide", "over_time": "min"}},
                  "at_end": {{"type": "transmission-angle", "bodies": ["crank", "rod"],
                             "over_time": "final"}}}}}})",
      bar("crank", "[0, 0, 0]", R"([{"variable": "r"}, 0, 0])"),
      bar("rod", R"([{"variable": "r"}, 0, 0])", "[0.4, 0, 0]"));
  const Found found = found_of(text);
  EXPECT_NEAR(found.values(0), std::numbers::pi / 2 - std::asin(r / l), 1e-4);
  EXPECT_NEAR(found.values(1), 0.0, 1e-4) << "in line again after a turn";
  // l = 0.4 − r here: sin(π/2 − μ) = r/(0.4 − r).
  const double sine = r / l, slope = -(1 / l + r / (l * l)) / std::sqrt(1 - sine * sine);
  EXPECT_NEAR(found.gradients(0, 0), slope, 1e-3 * std::abs(slope));
}

/// A four-bar with ground d, crank a, coupler b, rocker c: the angle between coupler and rocker follows from
/// the diagonal e² = a² + d² − 2ad cos φ, cos μ = (b² + c² − e²)/(2bc); its gradient is that of
/// differences.
TEST(TransmissionAngle, OfAFourBarIsThatOfTheTriangleOverItsDiagonal) {
  const auto text_of = [](double end) {
    const double a = 0.1, b = 0.3, c = 0.25, d = 0.32;
    const double e = d - a, cosine = (e * e + b * b - c * c) / (2 * e * b);
    const std::string tip =
        fmt::format("[{:.17g}, {:.17g}, 0]", a + b * cosine, b * std::sqrt(1 - cosine * cosine));
    return fmt::format(
        R"({{"scene": {{"bodies": {{{}, {}, {}}},
      "joints": {{
        "shaft": {{"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
                  "drive": {{"type": "constant-speed", "speed": 1}}}},
        "one": {{"type": "revolute", "bodies": ["crank", "coupler"], "at": [0.1, 0, 0]}},
        "two": {{"type": "revolute", "bodies": ["coupler", "rocker"], "at": {}}},
        "three": {{"type": "revolute", "bodies": ["ground", "rocker"], "at": [{{"variable": "d"}}, 0, 0]}}}}}},
    "simulation": {{"end_time": {}, "step": 0.01}},
    "variables": {{"d": {{"start": 0.32, "lower": 0.3, "upper": 0.34}}}},
    "responses": {{"mu": {{"type": "transmission-angle", "bodies": ["coupler", "rocker"],
                         "over_time": "final"}}}}}})",
        bar("crank", "[0, 0, 0]", "[0.1, 0, 0]"), bar("coupler", "[0.1, 0, 0]", tip),
        bar("rocker", R"([{"variable": "d"}, 0, 0])", tip), tip, end);
  };
  for (const double phi : {0.5, 2.0}) {
    const double a = 0.1, b = 0.3, c = 0.25, d = 0.32;
    const double square = a * a + d * d - 2 * a * d * std::cos(phi);
    const double cosine = (b * b + c * c - square) / (2 * b * c);
    const Found found = found_of(text_of(phi));
    EXPECT_NEAR(found.values(0), std::acos(std::abs(cosine)), 1e-6) << phi;
    const Eigen::VectorXd more = Eigen::VectorXd::Constant(1, d + 1e-5),
                          less = Eigen::VectorXd::Constant(1, d - 1e-5);
    const double slope =
        (found_of(text_of(phi), &more).values(0) - found_of(text_of(phi), &less).values(0)) / 2e-5;
    EXPECT_NEAR(found.gradients(0, 0) / slope, 1.0, 1e-5) << phi;
  }
}

}  // namespace
}  // namespace pleuel::test::frequency_sensitivity_test
