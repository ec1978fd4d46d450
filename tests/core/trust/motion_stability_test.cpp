#include <utility>

#include "core/trust/check_list.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/test.hpp"

/// What grows along a motion, or from an equilibrium that is never left, and on which elements and steps it is
/// seen.
namespace pleuel::test::motion_stability_test {
namespace {

/// EI of a square column of 10 mm.
constexpr double stiffness = 2.1e11 * 1e-8 / 12;

const std::string clamp =
    R"("wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]})";

/// A clamped column under a force that follows its tip (Beck 1952): stable up to 20.05 EI/L², though dead
/// loads buckle it at 2.47 EI/L². With some damping it flutters from 10.94 EI/L² on.
struct FollowedColumn {
  double press;          ///< [EI/L²]
  double damping = 0.0;  ///< by stiffness [s]
  std::string value = R"({{"type": "ramp", "to": {}, "end": 0.01}})";
  double end_time = 0.4;
  std::string bodies = "", joints = "", loads = "";  ///< beside it
  std::vector<std::string> overrides = {};
};

std::vector<Finding> findings_of_followed(const FollowedColumn& column) {
  constexpr double bending = 7e10 * 0.03 * 1e-6 / 12;
  const std::string value =
      fmt::format(fmt::runtime(column.value), column.press * bending, column.press * bending);
  return findings_of(read_scene(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "materials": {{"m": {{"young": 7e10, "poisson": 0.3, "density": 2700}}}},
      "bodies": {{"c": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
        "section": {{"type": "rectangle", "width": 0.03, "height": 0.01}}, "elements": 8,
        "damping": {{"stiffness": {}}}}}{}}},
      "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "c"], "at": [0, 0, 0]}}{}}},
      "loads": {{"P": {{"type": "force", "body": "c", "at": [1, 0, 0], "direction": [-1, 0, 0],
        "follows": true, "value": {}}}{}}}}},
    "simulation": {{"end_time": {}, "step": 1e-3}},
    "responses": {{"mass": {{"type": "mass"}}}}}})",
                                            column.damping, column.bodies, column.joints, value,
                                            column.loads, column.end_time),
                                column.overrides),
                     check_stability);
}

TEST(MotionStability, OfBecksColumnIsLostByFlutterOnly) {
  EXPECT_TRUE(findings_of_followed({5.0}).empty());
  EXPECT_TRUE(findings_of_followed({19.0}).empty());
  const Finding beyond = only(findings_of_followed({22.0}));
  EXPECT_TRUE(beyond.is_serious);
  EXPECT_NE(beyond.text.find("flutter"), std::string::npos) << beyond.text;
}

/// Beside it a rigid pendulum that a dead force presses, and a soft spring holds too weakly: it turns away as
/// exp(√(F/mL) t) = exp(32 t), faster than the column flutters, and is no matter of elasticity.
TEST(MotionStability, OfBecksColumnIsLostBesideWhatFallsFaster) {
  const auto beside_pendulum = [](double press) {
    return findings_of_followed(
        {.press = press,
         .bodies = R"(, "p": {"type": "rigid", "at": [5, 0.1, 0], "mass": 1,
                     "inertia": [1e-4, 1e-4, 1e-4, 0, 0, 0]})",
         .joints = R"(, "pin": {"type": "revolute", "bodies": ["ground", "p"], "at": [5, 0, 0]})",
         .loads = R"(, "dead": {"type": "force", "body": "p", "at": [5, 0.1, 0],
                                "direction": [0, -1, 0], "value": 100},
                       "soft": {"type": "spring", "bodies": ["ground", "p"],
                                "at": [[6, 0.1, 0], [5, 0.1, 0]], "stiffness": 1,
                                "free_length": 1})"});
  };
  const Finding before = only(beside_pendulum(15.0));
  EXPECT_EQ(before.text.find("\"c\""), std::string::npos) << before.text;
  const Finding beyond = only(beside_pendulum(22.0));
  EXPECT_TRUE(beyond.is_serious);
  EXPECT_NE(beyond.text.find("\"c\""), std::string::npos) << beyond.text;
}

/// A load of 16 EI/L² that comes later; with damping a disturbance grows as exp(4.6 t)
/// (damped_mode_test.cpp), by exp(6.9) in 1.5 s.
TEST(MotionStability, OfBecksColumnIsLostWhenItsLoadComesLate) {
  const std::string late =
      R"({{"type": "table", "interpolation": "monotone", "times": [0, 0.2, 0.3, 9],
                               "values": [0, 0, {}, {}]}})";
  EXPECT_TRUE(findings_of_followed({9.0, 1e-3, late, 1.8}).empty());
  const Finding finding = only(findings_of_followed({16.0, 1e-3, late, 1.8}));
  EXPECT_TRUE(finding.is_serious);
  EXPECT_NE(finding.text.find("flutter"), std::string::npos) << finding.text;
}

/// Steps much longer than its vibration damp it; with one element it does not flutter at all.
TEST(MotionStability, OfBecksColumnIsLostWhateverTheSteps) {
  const std::vector<std::string> coarse = {"/simulation/step=0.1", "/scene/bodies/c/elements=1"};
  EXPECT_TRUE(findings_of_followed({.press = 15.0, .overrides = coarse}).empty());
  const Finding beyond = only(findings_of_followed({.press = 30.0, .overrides = coarse}));
  EXPECT_TRUE(beyond.is_serious);
  EXPECT_NE(beyond.text.find("flutters"), std::string::npos) << beyond.text;
}

/// One element buckles at 12 EI/L² between pins, and never between clamps; Euler: π² and 4π² EI/L². Two
/// are within 1 and 2 % of him.
TEST(MotionStability, OfAColumnIsLostWhateverItsElements) {
  const auto findings = [&](const std::string& ends, double press) {
    const auto end = [](const char* name, const std::string& type, double at) {
      return fmt::format(R"j("{}": {{"type": {}, "bodies": ["ground", "bar"], "at": [{}, 0, 0]}})j",
                         name, type, at);
    };
    const bool is_clamped = ends == "clamps";
    return findings_of(
        read_scene(fmt::format(R"j({{"scene": {{
          "materials": {{"light": {{"young": 2.1e11, "poisson": 0.3, "density": 100}}}},
          "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": 1,
                              "material": "light", "damping": {{"stiffness": 1e-4}},
                              "section": {{"type": "rectangle", "width": 0.02, "height": 0.01}}}}}},
          "joints": {{{}, {}}},
          "loads": {{"press": {{"type": "force", "body": "bar", "at": [1, 0, 0],
                               "direction": [-1, 0, 0],
                               "value": {{"type": "ramp", "to": {}, "end": 0.05}}}}}}}},
        "simulation": {{"end_time": 1, "step": 0.0025}},
        "responses": {{"mass": {{"type": "mass"}}}}}})j",
                               end("a", is_clamped ? R"("fixed")" : R"("revolute")", 0),
                               end("b",
                                   is_clamped ? R"("prismatic", "axis": [1, 0, 0])"
                                              : R"("point-on-line", "axis": [1, 0, 0])",
                                   1),
                               press)),
        check_stability);
  };
  const double pins = std::numbers::pi * std::numbers::pi * 2.0 * stiffness;
  for (const auto& [ends, load] : {std::pair("pins", pins), std::pair("clamps", 4.0 * pins)}) {
    EXPECT_TRUE(findings(ends, 0.9 * load).empty()) << ends;
    const std::vector<Finding> beyond = findings(ends, 1.1 * load);
    ASSERT_EQ(beyond.size(), 1u) << ends;
    EXPECT_TRUE(beyond[0].is_serious);
    EXPECT_NE(beyond[0].text.find("buckles"), std::string::npos) << beyond[0].text;
  }
}

/// A strut on pins under a force P sin(νt): its deflection follows q̈ + ω² (1 − P/P_E sin νt) q = 0
/// (Mathieu), which grows for ν = 2ω as exp(ω P/(4 P_E) t) and not for ν = 2.6ω, while the strut stays
/// straight in its own motion (Bolotin, The Dynamic Stability of Elastic Systems, 1964).
std::vector<Finding> findings_of_pulsating(double share, double speed) {
  constexpr double bending = 7e10 * 0.01 * 1e-6 / 12, wave = 9.869604401089358;
  const double frequency = wave * std::sqrt(bending / (2700 * 1e-4));
  return findings_of(read_scene(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
      "materials": {{"m": {{"young": 7e10, "poisson": 0.3, "density": 2700}}}},
      "bodies": {{"c": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
        "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}, "elements": 6,
        "damping": {{"stiffness": 1e-6}}}}}},
      "joints": {{"a": {{"type": "revolute", "bodies": ["ground", "c"], "at": [0, 0, 0]}},
        "l": {{"type": "point-on-line", "bodies": ["ground", "c"], "at": [1, 0, 0],
              "axis": [1, 0, 0]}}}},
      "loads": {{"P": {{"type": "force", "body": "c", "at": [1, 0, 0], "direction": [-1, 0, 0],
        "value": {{"type": "harmonic", "amplitude": {}, "frequency": {}}}}}}}}},
    "simulation": {{"end_time": 0.5, "step": 5e-4}},
    "responses": {{"mass": {{"type": "mass"}}}}}})",
                                            share * wave * bending, speed * frequency)),
                     check_stability);
}

TEST(MotionStability, OfAStrutIsLostInParametricResonance) {
  const Finding finding = only(findings_of_pulsating(0.6, 2.0));
  EXPECT_TRUE(finding.is_serious) << finding.text;
  EXPECT_TRUE(findings_of_pulsating(0.6, 2.6).empty());
}

/// Beyond the load of buckling, but for a twentieth of a period only.
TEST(MotionStability, IsMentionedWhereItIsLostForTooShortATimeToHarm) {
  const std::string pulse =
      R"({"type": "half-sine", "amplitude": 600, "duration": 2e-3, "begin": 1e-3})";
  std::string text = fmt::format(R"({{"scene": {{
      "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "elements": 6,
        "material": "steel", "damping": {{"stiffness": 1e-5}},
        "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}}}}},
      "joints": {{{}}},
      "loads": {{"press": {{"type": "force", "body": "bar", "at": [1, 0, 0], "direction": [-1, 0, 0],
        "value": {}}}}}}},
    "effects": {{"spatial_motion": "on"}},
    "simulation": {{"end_time": 0.02, "step": 1e-4}},
    "responses": {{"mass": {{"type": "mass"}}}}}})",
                                 clamp, pulse);
  const Finding finding = only(findings_of(read_scene(text), check_stability));
  EXPECT_FALSE(finding.is_serious) << finding.text;
}

std::vector<Finding> findings_of_pendulum(double tip, const std::string& start) {
  return findings_of(read_scene(fmt::format(R"({{"scene": {{"gravity": [0, -9.81, 0],
      "bodies": {{"rod": {{"type": "beam", "from": [0, 0, 0], "to": [0, {}, 0], "elements": 3,
        "material": "steel", "section": {{"type": "circle", "diameter": 0.02}}}}}},
      "joints": {{"p": {{"type": "revolute", "bodies": ["ground", "rod"], "at": [0, 0, 0]}}}}}},
    "simulation": {{"end_time": 0.1, "step": 0.01, "initial_state": "{}"}},
    "responses": {{"mass": {{"type": "mass"}}}}}})",
                                            tip, start)),
                     check_stability);
}

/// Upside down it falls as exp(√(3g/2L) t), which its motion, exactly upright, does not show. Who does
/// not ask for an equilibrium may let it fall.
TEST(MotionStability, OfAPendulumThatIsSaidToBeInEquilibriumIsAsked) {
  const Finding upright = only(findings_of_pendulum(1.0, "quasi-static"));
  EXPECT_TRUE(upright.is_serious);
  EXPECT_NE(upright.text.find(fmt::format("exp({:.4g}", std::sqrt(1.5 * 9.81))), std::string::npos)
      << upright.text;
  EXPECT_TRUE(findings_of_pendulum(-1.0, "quasi-static").empty());
  EXPECT_TRUE(findings_of_pendulum(1.0, "consistent").empty());
}

/// A rigid one stays upright whatever the file asks: exp(√(m g l/J) t), with J about the pin.
TEST(MotionStability, OfAnEquilibriumThatIsNeverLeftIsAsked) {
  const auto findings = [](double at) {
    return findings_of(read_scene(fmt::format(R"({{"scene": {{"gravity": [0, -9.81, 0],
        "bodies": {{"bob": {{"type": "rigid", "at": [0, {}, 0], "mass": 2,
                            "inertia": [0.5, 0.5, 0.5, 0, 0, 0]}}}},
        "joints": {{"p": {{"type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 0]}}}}}},
      "simulation": {{"end_time": 0.1, "step": 0.01}},
      "responses": {{"mass": {{"type": "mass"}}}}}})",
                                              at)),
                       check_stability);
  };
  EXPECT_TRUE(findings(-1.0).empty());
  const Finding upright = only(findings(1.0));
  EXPECT_TRUE(upright.is_serious);
  EXPECT_NE(upright.text.find(fmt::format("exp({:.4g}", std::sqrt(2.0 * 9.81 / 2.5))),
            std::string::npos)
      << upright.text;
}

}  // namespace
}  // namespace pleuel::test::motion_stability_test
