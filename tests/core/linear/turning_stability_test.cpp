#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/linear/linearization.hpp"
#include "core/linear/modes.hpp"
#include "core/response/analysis.hpp"
#include "core/trust/check_list.hpp"
#include "tests/core/start/quasi_static_beam.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::turning_stability_test {
namespace {

// Shafts, rotors and columns that turn: where their elastic equilibrium is stable.

using namespace quasi_static_beam;

/// A shaft of 1 m × 10 mm × h between a ball joint and a line, which turns about itself at Ω and is
/// pressed by P, both relative to its first critical speed and its Euler load.
/// @param damping  by stiffness [s]
std::string shaft(const std::string& frame, double h, double speed, double press,
                  double damping = 0.0) {
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 7e10, "poisson": 0.3, "density": 2700}}}},
      "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
                       "section": {{"type": "rectangle", "width": 0.01, "height": {}}},
                       "elements": 6, "frame": "{}", "angular_velocity": [{}, 0, 0],
                       "damping": {{"stiffness": {}}}}}}},
      "joints": {{"a": {{"type": "spherical", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
                "l": {{"type": "point-on-line", "bodies": ["ground", "b"], "at": [1, 0, 0], "axis": [1, 0, 0]}}}},
      "loads": {{"p": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [-1, 0, 0], "value": {}}}}}}},
      "effects": {{"spatial_motion": "on"}},
      "simulation": {{"end_time": 2e-4, "step": 1e-4, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "b", "at": 1, "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "b", "at": 1, "direction": "y", "over_time": "final"}}}}}})",
                     h, frame,
                     speed * std::pow(std::numbers::pi, 2) * std::sqrt(7e10 / 2700 / 12) * 0.01,
                     damping, press * std::pow(std::numbers::pi, 2) * 7e10 * h * 1e-6 / 12);
}

/// In axes that turn with it the waves n of a shaft have ω² = n⁴ b − n² p in units of its lowest
/// critical speed, with b = 1 and p in its thin plane, (h/b)² and p in the other one: K = ω² − Ω²,
///     (s² + K₁)(s² + K₂) + 4Ω² s² = 0
/// which grows unless K₁ K₂ > 0, K₁ + K₂ + 4Ω² > 2 √(K₁ K₂).
bool is_stable_shaft(double ratio, double speed, double press) {
  for (int n : {1, 2, 3}) {
    const double square = speed * speed, n2 = n * n;
    const double thin = n2 * n2 - n2 * press - square;
    const double thick = n2 * n2 * ratio * ratio - n2 * press - square;
    if (thin * thick < 0.0) return false;
    if (thin + thick + 4.0 * square < 2.0 * std::sqrt(thin * thick)) return false;
  }
  return true;
}

/// Between its critical speeds a flat shaft grows; beyond them, and a round one at any speed, it does
/// not, whatever the frame of the body is, and a press beyond its Euler load may be borne.
TEST(QuasiStaticStart, OfAShaftThatTurnsIsFoundWhereItIsStable) {
  for (const double h : {0.0101, 0.012, 0.02}) {
    for (const char* frame : {"tangent", "tangent-end", "chord", "mean-axis"}) {
      for (const double speed : {0.5, 1.5, 2.5, 6.0}) {
        for (const double press : {0.0, 0.2, 0.8, 1.2}) {
          const std::string error = error_of(shaft(frame, h, speed, press));
          EXPECT_EQ(error.empty(), is_stable_shaft(h / 0.01, speed, press))
              << h << " " << frame << " " << speed << " " << press << ": " << error;
        }
      }
    }
  }
}

/// What gyroscopic forces alone hold, damping that turns with the shaft lets go (Kelvin, Tait &
/// Chetaev): it is stable only where K₁ > 0.
TEST(QuasiStaticStart, OfAShaftBeyondItsCriticalSpeedIsRefusedWhereItDampsItself) {
  for (const char* frame : {"tangent", "chord", "mean-axis"}) {
    EXPECT_EQ(error_of(shaft(frame, 0.0101, 0.85, 0.2, 1e-4)), "") << frame;
    for (const double speed : {1.5, 2.5}) {
      EXPECT_EQ(error_of(shaft(frame, 0.0101, speed, 0.2)), "") << frame << " " << speed;
      EXPECT_THAT(error_of(shaft(frame, 0.0101, speed, 0.2, 1e-4)), HasSubstr("\"b\" whirls"))
          << frame << " " << speed;
    }
  }
}

/// A column without mass, which points from the rim of a turning hub of 0.5 m towards the axis, with
/// 2 kg at its end.
/// @param out_of_plane    whether it is thin along the axis
/// @param spatial_motion  on, off
std::string inward_column(bool out_of_plane, double speed, const std::string& spatial_motion,
                          double length = 0.3) {
  return fmt::format(R"({{"scene": {{
      "materials": {{"light": {{"young": 2.1e11, "poisson": 0.3, "density": 1}}}},
      "bodies": {{
        "hub": {{"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [0.01, 0.01, 0.01, 0, 0, 0],
                "angular_velocity": [0, 0, {0}]}},
        "column": {{"type": "beam", "from": [0.5, 0, 0], "to": [{6}, 0, 0], "material": "light",
                   "section": {{"type": "rectangle", "width": {1}, "height": {2}}}, "elements": 10,
                   "reference": [0, 1, 0], "angular_velocity": [0, 0, {0}],
                   "velocity": [0, {3}, 0]}},
        "end": {{"type": "rigid", "at": [{6}, 0, 0], "mass": 2,
                "inertia": [2e-7, 2e-7, 2e-7, 0, 0, 0], "angular_velocity": [0, 0, {0}],
                "velocity": [0, {4}, 0]}}}},
      "joints": {{
        "bearing": {{"type": "revolute", "bodies": ["ground", "hub"], "at": [0, 0, 0],
                    "axis": [0, 0, 1], "drive": {{"type": "constant-speed", "speed": {0}}}}},
        "root": {{"type": "fixed", "bodies": ["hub", "column"], "at": [0.5, 0, 0]}},
        "weld": {{"type": "fixed", "bodies": ["column", "end"], "at": [{6}, 0, 0]}}}}}},
      "effects": {{"spatial_motion": "{5}"}},
      "simulation": {{"end_time": 2e-4, "step": 1e-4, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "end", "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "end", "direction": "y", "over_time": "final"}}}}}})",
                     speed, out_of_plane ? 0.004 : 0.02, out_of_plane ? 0.02 : 0.004, 0.5 * speed,
                     (0.5 - length) * speed, spatial_motion, 0.5 - length);
}

/// P = m Ω² (R − L) presses it. Across the turning it keeps its direction: P = π² EI/4L². In the plane
/// it comes from the axis, so that k² = P/EI has tan kL = kR. Its own light elements vibrate 10⁶ times
/// as fast as it buckles.
double critical_speed(bool out_of_plane) {
  constexpr double length = 0.3, radius = 0.5, mass = 2.0;
  const double bending = young * 0.02 * std::pow(0.004, 3) / 12;
  double low = 1.0, high = 0.5 * std::numbers::pi / length - 1e-6;
  for (int i = 0; i < 60; ++i) {
    const double k = 0.5 * (low + high);
    (std::tan(k * length) < k * radius ? low : high) = k;
  }
  const double k = out_of_plane ? 0.5 * std::numbers::pi / length : low;
  return k * std::sqrt(bending / (mass * (radius - length)));
}

/// Its loads are inertia forces, which grow with the square of the speed.
TEST(QuasiStaticStart, OfAColumnThatTurnsInwardsIsFoundBelowItsCriticalSpeed) {
  const std::pair in_space{true, "on"}, thin_in_plane{false, "on"}, in_plane{false, "off"};
  for (const auto& [out_of_plane, spatial] : {in_space, thin_in_plane, in_plane}) {
    const double critical = critical_speed(out_of_plane);
    EXPECT_EQ(error_of(inward_column(out_of_plane, 0.98 * critical, spatial)), "")
        << out_of_plane << spatial;
    for (const double share : {1.02, 1.1, 1.5}) {
      EXPECT_THAT(error_of(inward_column(out_of_plane, share * critical, spatial)),
                  HasSubstr(fmt::format("\"column\" buckles, at some {:.3g} of these loads",
                                        1.0 / (share * share))))
          << out_of_plane << spatial;
    }
  }
}

/// Where it reaches beyond the axis, by c, its mass pulls it, with P = m Ω² c, and aside, from the
/// axis, the more it is bent: k² = P/EI has tanh kL = kR.
TEST(QuasiStaticStart, OfAnArmThatReachesBeyondTheAxisIsFoundBelowItsCriticalSpeed) {
  constexpr double length = 0.8, radius = 0.5, mass = 2.0;
  const double bending = young * 0.02 * std::pow(0.004, 3) / 12;
  double low = 1.0, high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double k = 0.5 * (low + high);
    (std::tanh(k * length) > k * radius ? low : high) = k;
  }
  const double critical = low * std::sqrt(bending / (mass * (length - radius)));
  for (const char* spatial : {"on", "off"}) {
    EXPECT_EQ(error_of(inward_column(false, 0.98 * critical, spatial, length)), "") << spatial;
    for (const double share : {1.02, 1.1, 1.5}) {
      EXPECT_THAT(error_of(inward_column(false, share * critical, spatial, length)),
                  HasSubstr(fmt::format("\"column\" buckles, at some {:.3g} of these loads",
                                        1.0 / (share * share))))
          << share << spatial;
    }
  }
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

/// On a hinge with a spring of stiffness c, EI k² = m Ω² (R − L) has tan kL (1 + EI k² R/c) = kR. The
/// spring is a third as stiff as the column, 3 EI/L.
TEST(QuasiStaticStart, OfAColumnOnASpringThatTurnsInwardsIsFoundBelowItsCriticalSpeed) {
  constexpr double length = 0.3, radius = 0.5, mass = 2.0;
  const double bending = young * 0.02 * std::pow(0.004, 3) / 12, spring = bending / length;
  double low = 0.1, high = 0.5 * std::numbers::pi / length - 1e-6;
  for (int i = 0; i < 60; ++i) {
    const double k = 0.5 * (low + high);
    const double turned = std::tan(k * length) * (1.0 + bending * k * k * radius / spring);
    (turned < k * radius ? low : high) = k;
  }
  const double critical = low * std::sqrt(bending / (mass * (radius - length)));
  const std::string fixed = R"("root": {"type": "fixed",)";
  for (const std::string frame : {"tangent", "chord", "mean-axis", "tangent-end"}) {
    const auto on_spring = [&](double share) {
      std::string text = inward_column(false, share * critical, "off");
      text = replaced(text, fixed, R"("root": {"type": "revolute", "axis": [0, 0, 1],)");
      text = replaced(text, R"("elements": 10,)",
                      fmt::format(R"("elements": 10, "frame": "{}",)", frame));
      return replaced(text, R"("joints":)",
                      fmt::format(R"("loads": {{"spring": {{"type": "joint", "joint": "root",
                                     "stiffness": {}}}}}, "joints":)",
                                  spring));
    };
    EXPECT_EQ(error_of(on_spring(0.98)), "") << frame;
    for (const double share : {1.02, 1.1, 1.5}) {
      EXPECT_THAT(error_of(on_spring(share)), HasSubstr("\"column\" buckles")) << frame << share;
    }
  }
}

/// A shaft almost without mass with a disk of 1 kg on its middle, and a block of 1 kg that does not
/// turn, on a bearing; two dampers hold the block. Stiffness 48 EI/L³ of two pins, L = 1.
/// @param spring  along y, stiffness
std::string held_rotor(double speed, double damping, double damper, double spring = 0.0) {
  return fmt::format(R"({{"scene": {{
      "materials": {{"light": {{"young": 2.1e11, "poisson": 0.3, "density": 10}}}},
      "bodies": {{
        "b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "light",
              "section": {{"type": "circle", "diameter": 0.01}}, "elements": 4, "frame": "chord",
              "angular_velocity": [{0}, 0, 0], "damping": {{"stiffness": {1}}}}},
        "disk": {{"type": "rigid", "at": [0.5, 0, 0], "mass": 1,
                 "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0], "angular_velocity": [{0}, 0, 0]}},
        "block": {{"type": "rigid", "at": [0.5, 0, 0], "mass": 1, "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]}}}},
      "joints": {{
        "a": {{"type": "spherical", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
        "l": {{"type": "point-on-line", "bodies": ["ground", "b"], "at": [1, 0, 0], "axis": [1, 0, 0]}},
        "weld": {{"type": "fixed", "bodies": ["b", "disk"], "at": [0.5, 0, 0]}},
        "bearing": {{"type": "revolute", "bodies": ["b", "block"], "at": [0.5, 0, 0], "axis": [1, 0, 0]}}}},
      "loads": {{
        "y": {{"type": "spring", "bodies": ["ground", "block"], "at": [[0.5, 10, 0], [0.5, 0, 0]],
              "stiffness": {3}, "damping": {2}}},
        "z": {{"type": "spring", "bodies": ["ground", "block"], "at": [[0.5, 0, 10], [0.5, 0, 0]],
              "stiffness": 0, "damping": {2}}}}}}},
      "effects": {{"spatial_motion": "on"}},
      "simulation": {{"end_time": 2e-4, "step": 1e-4, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "disk", "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "disk", "direction": "y", "over_time": "final"}}}}}})",
                     speed, damping, damper, spring);
}

/// With c_i = β k of the shaft, which turns, and c_e of the dampers, which stand still, it whirls from
/// Ω = √(k/m) (1 + c_e/c_i) on (Smith 1933), where m is the
/// mass of disk and block. Without damping nothing grows.
TEST(QuasiStaticStart, OfARotorInDampersIsFoundUpToTheSpeedThatTheyHold) {
  constexpr double mass = 2.0;
  const double stiff = 48 * young * std::numbers::pi * 1e-8 / 64;
  const double critical = std::sqrt(stiff / mass), damping = 1e-3;
  for (const double share : {0.0, 0.5, 2.0}) {
    const double damper = share * damping * stiff, limit = (1.0 + share) * critical;
    EXPECT_EQ(error_of(held_rotor(0.97 * limit, damping, damper)), "") << share;
    EXPECT_THAT(error_of(held_rotor(1.03 * limit, damping, damper)), HasSubstr("\"b\" whirls"))
        << share;
  }
  for (const double speed : {0.9, 1.1, 1.5, 3.0}) {
    EXPECT_EQ(error_of(held_rotor(speed * critical, 0.0, 0.0)), "") << speed;
  }
}

/// In a bearing that is softer one way a round shaft without damping grows at no speed: in axes that
/// stand still y and z are vibrations of their own.
TEST(QuasiStaticStart, OfARoundShaftInABearingThatIsSofterOneWayIsFound) {
  const double stiff = 48 * young * std::numbers::pi * 1e-8 / 64;
  for (const double ratio : {0.3, 3.0}) {
    for (const double speed : {0.9, 1.1, 1.5, 1.9, 2.5}) {
      const double critical = std::sqrt(stiff / 2.0);
      EXPECT_EQ(error_of(held_rotor(speed * critical, 0.0, 0.0, ratio * stiff)), "")
          << ratio << " " << speed;
    }
  }
}

/// A steel blade of 1 m × 20 mm × 30 mm that turns at 50 rad/s about its clamped end.
ProblemFile blade(const std::string& frame, double speed = 50.0) {
  return problem_from(fmt::format(R"({{"scene": {{
          "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
            "section": {{"type": "rectangle", "width": 0.02, "height": 0.03}}, "elements": 6, {}}}}},
          "joints": {{"d": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0],
            "drive": {{"type": "constant-speed", "speed": {}}}}}}}}},
        "simulation": {{"end_time": 1e-3, "step": 1e-4, "initial_state": "quasi-static"}},
        "responses": {{"flap": {{"type": "frequency", "mode": 1}}, "lag": {{"type": "frequency", "mode": 2}}}}}})",
                                  frame, speed));
}

Eigen::VectorXd frequencies(const Analysis& analysis) {
  const Mechanism& mechanism = model_of_modes(analysis).mechanism;
  const State& state = analysis.vibrating->initial.state;
  return frequencies_of(linearize(mechanism, state, turning_of(mechanism, state), false));
}

/// Southwell: flapping ω₀² + 1.193 Ω² (Wright et al. 1982 to Ω = ω₀: 1.193 within 0.2 %), lagging
/// less Ω². With any frame of the body, which is only another choice of coordinates.
TEST(TurningAxes, GiveARotatingBeamItsFrequenciesInAnyFrame) {
  const double mass = 7850 * 0.02 * 0.03, young = 2.1e11, square = 50.0 * 50.0;
  const double flap = 3.5160 * 3.5160 * young * 0.03 * std::pow(0.02, 3) / 12 / mass;
  const double lag = 3.5160 * 3.5160 * young * 0.02 * std::pow(0.03, 3) / 12 / mass;
  for (const char* frame :
       {R"("frame": "tangent")", R"("frame": "chord")", R"("frame": "mean-axis")",
        R"("frame": "tangent-end")", R"("frames": 2)"}) {
    const auto [problem, x, analysis] = AtStart(blade(frame));
    const Eigen::VectorXd found = frequencies(*analysis);
    EXPECT_NEAR(found(0), std::sqrt(flap + 1.193 * square), 0.003 * found(0)) << frame;
    EXPECT_NEAR(found(1), std::sqrt(lag + 0.193 * square), 0.003 * found(1)) << frame;
  }
}

TEST(TurningAxes, LeaveTheFrequenciesOfAMechanismAtRest) {
  const auto [problem, x, analysis] = AtStart(blade(R"("frame": "chord")", 0.0));
  const Eigen::VectorXd found = frequencies(*analysis);
  EXPECT_NEAR(found(0), analysis->mechanism_frequencies(0), 1e-9 * found(0));
  EXPECT_NEAR(found(5), analysis->mechanism_frequencies(5), 1e-9 * found(5));
}

TEST(Frequencies, AreDoubtedWhereTheAxesMatter) {
  const auto findings = [](const ProblemFile& problem) {
    const auto [x, analysis] = started(problem);
    return check_frequencies({problem, x, *analysis, Monitors{}});
  };
  EXPECT_TRUE(findings(blade(R"("frame": "tangent")")).empty());
  EXPECT_TRUE(findings(blade(R"("frame": "chord")", 0.0)).empty());
  const std::vector<Finding> found = findings(blade(R"("frame": "chord")"));
  ASSERT_EQ(found.size(), 1u);  // all frequencies in one sentence
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_NE(found[0].text.find("\"flap\" is "), std::string::npos);
  EXPECT_NE(found[0].text.find("faster or slower by the speed, "), std::string::npos);
}

/// A shaft with damping of its own in a bearing of two springs: growth is known where these are alike, and
/// coefficients are constant in axes that turn with the shaft; a ratio is another one in each axes.
TEST(GrowthRates, AreDoubtedWhereNoAxesHaveConstantCoefficients) {
  const auto findings = [](double across, double speed, const char* type) {
    const auto [problem, x, analysis] =
        AtStart(problem_from(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "bodies": {{"s": {{"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "steel",
          "section": {{"type": "circle", "diameter": 0.02}}, "elements": 2, "damping": {{"stiffness": 2e-5}}}},
        "disc": {{"type": "rigid", "at": [0.4, 0, 0], "mass": 8, "inertia": [2e-4, 1e-4, 1e-4, 0, 0, 0]}}}},
      "joints": {{
        "left": {{"type": "revolute", "bodies": ["ground", "s"], "at": [0, 0, 0], "axis": [1, 0, 0],
          "drive": {{"type": "constant-speed", "speed": {}}}}},
        "hub": {{"type": "fixed", "bodies": ["s", "disc"], "at": [0.4, 0, 0]}}}},
      "loads": {{
        "y": {{"type": "spring", "bodies": ["ground", "s"], "at": [[0.8, -1, 0], [0.8, 0, 0]], "stiffness": 1e6}},
        "-y": {{"type": "spring", "bodies": ["ground", "s"], "at": [[0.8, 1, 0], [0.8, 0, 0]], "stiffness": 1e6}},
        "z": {{"type": "spring", "bodies": ["ground", "s"], "at": [[0.8, 0, -1], [0.8, 0, 0]], "stiffness": {}}},
        "-z": {{"type": "spring", "bodies": ["ground", "s"], "at": [[0.8, 0, 1], [0.8, 0, 0]], "stiffness": {}}}}}}},
    "simulation": {{"end_time": 1e-4, "step": 1e-4}},
    "responses": {{"asked": {{"type": "{}"}}}}}})",
                                         speed, across, across, type)));
    return check_frequencies({problem, x, *analysis, Monitors{}});
  };
  EXPECT_THAT(findings(1e6, 250.0, "growth-rate"), IsEmpty());
  EXPECT_THAT(findings(3e5, 0.0, "growth-rate"), IsEmpty());
  for (const Finding& found :
       {only(findings(3e5, 250.0, "growth-rate")), only(findings(1e6, 250.0, "damping-ratio"))}) {
    EXPECT_TRUE(found.is_serious);
    EXPECT_THAT(found.responses, ElementsAre("asked"));
  }
}

/// A column under a force that follows its free end flutters from 20.05 EI/L² on (Beck 1952).
TEST(Frequencies, AreDoubtedWhereAFollowerForceMakesThemGrow) {
  const auto findings = [](double load) {
    const double stiffness = 2.1e11 * 0.013 * std::pow(0.01, 3) / 12;
    const auto [problem, x, analysis] = AtStart(problem_from(fmt::format(R"({{"scene": {{
          "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
            "section": {{"type": "rectangle", "width": 0.01, "height": 0.013}}, "elements": 8}}}},
          "joints": {{"f": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
          "loads": {{"p": {{"type": "force", "body": "b", "at": [1, 0, 0], "follows": true,
            "direction": [-1, 0, 0], "value": {}}}}}}},
        "simulation": {{"end_time": 1e-3, "step": 1e-4, "initial_state": "quasi-static"}},
        "responses": {{"first": {{"type": "frequency"}}}}}})",
                                                                         load * stiffness)));
    return check_stability({problem, x, *analysis, Monitors{}});
  };
  EXPECT_TRUE(findings(20.0).empty());
  const std::vector<Finding> found = findings(20.15);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].text.find("(flutter)"), std::string::npos) << found[0].text;
}

/// A cantilever that a moment at its tip bends by 0.084 rad. Counted in a frame at the free end its
/// fourth frequency is 2.6 % below that of six frames along it, where rotations are small.
TEST(Frequencies, AreDoubtedWhereMoreFramesChangeThem) {
  const auto bent = [](const char* from, const char* to, int frames) {
    return problem_from(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
          "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
          "bodies": {{"b": {{"type": "beam", "from": {0}, "to": {1}, "material": "m",
            "section": {{"type": "rectangle", "width": 0.008, "height": 0.016}}, "elements": 6, "frames": {2}}}}},
          "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "b"], "at": [0, 0, 0]}}}},
          "loads": {{"moment": {{"type": "torque", "body": "b", "at": [0.6, 0, 0],
                               "direction": [0, 1, 0], "value": 20}}}}}},
        "simulation": {{"end_time": 1e-3, "step": 5e-4, "initial_state": "quasi-static"}},
        "responses": {{"first": {{"type": "frequency", "mode": 1}},
                      "fourth": {{"type": "frequency", "mode": 4}}}}}})",
                                    from, to, frames));
  };
  const char *wall = "[0, 0, 0]", *tip = "[0.6, 0, 0]";
  const auto fourth = [](const ProblemFile& problem) {
    return values_of(*analyze(problem, start_design(problem)))(1);
  };
  const double divided = fourth(bent(wall, tip, 6));
  EXPECT_NEAR(fourth(bent(wall, tip, 1)), divided, 0.003 * divided);
  EXPECT_NEAR(fourth(bent(tip, wall, 1)), 0.974 * divided, 0.002 * divided);
  const auto left_out = [](const TrustedRun& run) { return compare_variants(run).findings; };
  EXPECT_TRUE(findings_of(bent(wall, tip, 1), left_out).empty());
  EXPECT_TRUE(findings_of(bent(wall, tip, 6), left_out).empty());
  const std::vector<Finding> findings = findings_of(bent(tip, wall, 1), left_out);
  ASSERT_EQ(findings.size(), 1);
  EXPECT_EQ(findings[0].responses, std::vector<std::string>{"fourth"});
}

}  // namespace
}  // namespace pleuel::test::turning_stability_test
