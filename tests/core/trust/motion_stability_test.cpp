#include <utility>

#include "core/trust/check_list.hpp"
#include "core/trust/checks.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/test.hpp"

/// What grows along a motion, or from an equilibrium that is never left, and on which elements and steps it is
/// seen.

/// Of members that buckle together, portals and columns of several parts, against closed forms.

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

ProblemFile followed(const FollowedColumn& column) {
  constexpr double bending = 7e10 * 0.03 * 1e-6 / 12;
  const std::string value =
      fmt::format(fmt::runtime(column.value), column.press * bending, column.press * bending);
  const OneBeam beam{.name = "c",
                     .material = "aluminium",
                     .section = rectangle(0.03, 0.01),
                     .elements = 8,
                     .more = fmt::format(R"("damping": {{"stiffness": {}}})", column.damping),
                     .materials = plain_aluminium,
                     .bodies = column.bodies,
                     .joints = on_ground("wall", "fixed", "c", "[0, 0, 0]") + column.joints,
                     .end_loads = {{value, "[-1, 0, 0]", R"("follows": true)", "P"}},
                     .loads = column.loads,
                     .simulation = time_loop(column.end_time, 1e-3)};
  return beam.problem(column.overrides);
}

std::vector<Finding> findings_of_followed(const FollowedColumn& column) {
  return findings_of(followed(column), check_stability);
}

TEST(MotionStability, OfBecksColumnIsLostByFlutterOnly) {
  EXPECT_TRUE(findings_of_followed({5.0}).empty());
  EXPECT_TRUE(findings_of_followed({19.0}).empty());
  const Finding beyond = only(findings_of_followed({22.0}));
  EXPECT_TRUE(beyond.is_serious);
  EXPECT_NE(beyond.text.find("flutter"), std::string::npos) << beyond.text;
}

/// A simulation that failed is judged up to three quarters of its time.
TEST(MotionBefore, IsJudgedByWhatMakesASimulationFail) {
  const auto before = [](const ProblemFile& problem) {
    return findings_before_failure(problem, start_design(problem), 0.4);
  };
  EXPECT_THAT(before(followed({5.0})), IsEmpty());
  EXPECT_THAT(only(before(followed({22.0}))).text, HasSubstr("flutter"));
  const ProblemFile coarse = followed(
      {.press = 5.0, .value = R"({{"type": "harmonic", "amplitude": {}, "frequency": 300}})"});
  EXPECT_THAT(only(before(coarse)).text, HasSubstr("changes faster than the steps can follow"));
}

/// Beside it a rigid pendulum that a dead force presses, and a soft spring holds too weakly: it turns away as
/// exp(√(F/mL) t) = exp(32 t), faster than the column flutters, and is no matter of elasticity.
TEST(MotionStability, OfBecksColumnIsLostBesideWhatFallsFaster) {
  const auto beside_pendulum = [](double press) {
    return findings_of_followed(
        {.press = press,
         .bodies = R"("p": {"type": "rigid", "at": [5, 0.1, 0], "mass": 1,
                     "inertia": [1e-4, 1e-4, 1e-4, 0, 0, 0]})",
         .joints = R"(, "pin": {"type": "revolute", "bodies": ["ground", "p"], "at": [5, 0, 0]})",
         .loads = R"("dead": {"type": "force", "body": "p", "at": [5, 0.1, 0],
                                "direction": [0, -1, 0], "value": 100},
                       "soft": {"type": "spring", "bodies": ["ground", "p"],
                                "at": [[6, 0.1, 0], [5, 0.1, 0]], "stiffness": 1, "free_length": 1})"});
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
      R"({{"type": "table", "interpolation": "monotone", "times": [0, 0.2, 0.3, 9], "values": [0, 0, {}, {}]}})";
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
    const std::string first = "[0, 0, 0]", last = "[1, 0, 0]", along = R"("axis": [1, 0, 0])";
    const std::string clamps = on_ground("a", "fixed", "bar", first) + ", " +
                               on_ground("b", "prismatic", "bar", last, along);
    const OneBeam bar{
        .name = "bar",
        .material = "light",
        .section = rectangle(0.02, 0.01),
        .elements = 1,
        .more = R"("damping": {"stiffness": 1e-4})",
        .materials = R"("light": {"young": 2.1e11, "poisson": 0.3, "density": 100})",
        .joints = ends == "clamps" ? clamps : on_two_supports("bar"),
        .end_loads = {{fmt::format(R"({{"type": "ramp", "to": {}, "end": 0.05}})", press),
                       "[-1, 0, 0]"}},
        .simulation = time_loop(1.0, 0.0025)};
    return findings_of(bar.problem(), check_stability);
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
  const OneBeam strut{
      .name = "c",
      .material = "aluminium",
      .section = rectangle(0.01, 0.01),
      .elements = 6,
      .more = R"("damping": {"stiffness": 1e-6})",
      .materials = plain_aluminium,
      .joints = on_two_supports("c"),
      .end_loads = {{fmt::format(R"({{"type": "harmonic", "amplitude": {}, "frequency": {}}})",
                                 share * wave * bending, speed * frequency),
                     "[-1, 0, 0]"}},
      .simulation = time_loop(0.5, 5e-4)};
  return findings_of(strut.problem(), check_stability);
}

TEST(MotionStability, OfAStrutIsLostInParametricResonance) {
  const Finding finding = only(findings_of_pulsating(0.6, 2.0));
  EXPECT_TRUE(finding.is_serious) << finding.text;
  EXPECT_TRUE(findings_of_pulsating(0.6, 2.6).empty());
}

/// Beyond the load of buckling, but for a twentieth of a period only.
TEST(MotionStability, IsMentionedWhereItIsLostForTooShortATimeToHarm) {
  const OneBeam bar{
      .name = "bar",
      .section = rectangle(0.01, 0.01),
      .elements = 6,
      .more = R"("damping": {"stiffness": 1e-5})",
      .end_loads = {{R"({"type": "half-sine", "amplitude": 600, "duration": 2e-3, "begin": 1e-3})",
                     "[-1, 0, 0]"}},
      .simulation = time_loop(0.02, 1e-4),
      .rest = R"("effects": {"spatial_motion": "on"})"};
  const Finding finding = only(findings_of(bar.problem(), check_stability));
  EXPECT_FALSE(finding.is_serious) << finding.text;
}

std::vector<Finding> findings_of_pendulum(double tip, const std::string& start) {
  const OneBeam rod{
      .name = "rod",
      .to = fmt::format("[0, {}, 0]", tip),
      .section = circle(0.02),
      .elements = 3,
      .joints = on_ground("p", "revolute", "rod", "[0, 0, 0]"),
      .gravity = "[0, -9.81, 0]",
      .simulation = time_loop(0.1, 0.01, fmt::format(R"("initial_state": "{}")", start))};
  return findings_of(rod.problem(), check_stability);
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
        "bodies": {{"bob": {{"type": "rigid", "at": [0, {}, 0], "mass": 2, "inertia": [0.5, 0.5, 0.5, 0, 0, 0]}}}},
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

using test::buckling_findings_of;
using test::findings_of;
using test::read_scene;

const double pi = std::numbers::pi;

/// Two columns with a beam across, pressed at both knees.
std::string portal(double force, const std::string& knee, const std::string& motion,
                   const std::string& start = "quasi-static") {
  const auto beam = [](const std::string& name, const std::string& ends) {
    return fmt::format(R"("{}": {{"type": "beam", {}, "material": "steel", "elements": 4,
        "section": {{"type": "rectangle", "width": 0.04, "height": 0.06}}}})",
                       name, ends);
  };
  const bool is_slow = start == "consistent";
  const auto press = [&](const std::string& body, double at) {
    return fmt::format(R"("{0}": {{"type": "force", "body": "{0}", "at": [{1}, 3, 0],
                                   "direction": [0, -1, 0],
                           "value": {{"type": "table", "times": [0, 0.5], "values": [{3}, {2}]}}}})",
                       body, at, force, is_slow ? 0.0 : force);
  };
  const auto joint = [](const std::string& type, const std::string& one, const std::string& other,
                        double x, double y) {
    return fmt::format(
        R"("{1} {2}": {{"type": "{0}", "bodies": ["{1}", "{2}"], "at": [{3}, {4}, 0]}})", type, one,
        other, x, y);
  };
  const std::string joints =
      joint("fixed", "ground", "left", 0, 0) + ", " + joint("fixed", "ground", "right", 4, 0) +
      ", " + joint(knee, "left", "top", 0, 3) + ", " + joint(knee, "right", "top", 4, 3);
  return fmt::format(
      R"({{"scene": {{"bodies": {{{}, {}, {}}}, "joints": {{{}}}, "loads": {{{}, {}}}}},
      "effects": {{"spatial_motion": "{}"}},
      "simulation": {{"end_time": {}, "step": {}, "initial_state": "{}"}},
      "responses": {{"mass": {{"type": "mass"}}}}}})",
      beam("left", R"("from": [0, 0, 0], "to": [0, 3, 0])"),
      beam("right", R"("from": [4, 0, 0], "to": [4, 3, 0])"),
      beam("top", R"("from": [0, 3, 0], "to": [4, 3, 0])"), joints, press("left", 0),
      press("right", 4), motion, is_slow ? 4.0 : 0.002, is_slow ? 0.01 : 0.001, start);
}

/// A portal with ten times as many elements: more than 600 coordinates in space.
std::string with_many_elements(std::string text) {
  for (auto at = text.find("\"elements\": 4"); at != std::string::npos;
       at = text.find("\"elements\": 4", at + 1)) {
    text.replace(at, 13, "\"elements\": 40");
  }
  return text;
}

/// Each column would bear 4 π²EI/L² with the other members held, but they sway out of the plane as
/// cantilevers, at π²EI/4L²: the beam across moves and turns with both knees and takes no load, whether
/// it is welded or hinged about the normal of the plane. In the plane the columns are 2.25 times as
/// stiff.
TEST(FrameStability, OfAFrameTogetherIsThatOfCantilevers) {
  const double cantilever = pi * pi * 2.1e11 * (0.06 * std::pow(0.04, 3) / 12) / (4.0 * 9.0);
  for (const char* knee : {"fixed", "revolute"}) {
    for (const auto& [start, told] :
         {std::pair("quasi-static", "equilibrium under the loads at t = 0 is unstable"),
          std::pair("consistent", "a small disturbance of the body")}) {
      SCOPED_TRACE(fmt::format("{} {}", knee, start));
      EXPECT_TRUE(buckling_findings_of(portal(0.97 * cantilever, knee, "auto", start)).empty());
      const std::vector<Finding> findings =
          buckling_findings_of(portal(1.03 * cantilever, knee, "auto", start));
      ASSERT_EQ(findings.size(), 1u);
      EXPECT_TRUE(findings[0].is_serious);
      EXPECT_NE(findings[0].text.find(told), std::string::npos) << findings[0].text;
    }
  }
  EXPECT_EQ(buckling_findings_of(portal(1.03 * cantilever, "fixed", "on", "consistent")).size(),
            1u);
}

/// Hinges at the knees leave each column a cantilever in the plane, too. Of columns that are twice
/// as wide as deep that decides, and does not show where both are pressed alike.
TEST(FrameStability, OfAFrameTogetherInThePlaneIsTold) {
  for (const double width : {0.08, 0.8}) {  // of leaf springs, too
    const double cantilever = pi * pi * 2.1e11 * (width * std::pow(0.04, 3) / 12) / (4.0 * 9.0);
    const auto findings = [&](double share) {
      std::string text = portal(share * cantilever, "revolute", "auto", "consistent");
      const std::string old = R"("width": 0.04, "height": 0.06)";
      for (auto at = text.find(old); at != std::string::npos; at = text.find(old, at)) {
        text.replace(at, old.size(), fmt::format(R"("width": {}, "height": 0.04)", width));
      }
      return buckling_findings_of(text);
    };
    EXPECT_TRUE(findings(0.97).empty()) << width;
    const std::vector<Finding> beyond = findings(1.03);
    ASSERT_EQ(beyond.size(), 1u) << width;
    EXPECT_TRUE(beyond[0].is_serious) << beyond[0].text;
  }
}

/// A frame of too many coordinates for a dense stiffness is not judged, which is said.
TEST(FrameStability, OfALargeFrameTogetherIsSaidNotToBeLookedAt) {
  const double cantilever = pi * pi * 2.1e11 * (0.06 * std::pow(0.04, 3) / 12) / (4.0 * 9.0);
  const std::vector<Finding> findings =
      buckling_findings_of(with_many_elements(portal(1.02 * cantilever, "fixed", "auto")));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_FALSE(findings[0].is_serious);
  EXPECT_NE(findings[0].text.find("more than 600 coordinates"), std::string::npos)
      << findings[0].text;
}

/// So many beams of 10 × 30 mm, welded in line to a column of one metre that is clamped at its foot,
/// upright in the plane of their strong axis, in which a small force pushes.
std::string column(int beams, const std::string& more_bodies, const std::string& more_joints,
                   const std::string& loads) {
  std::string bodies, joints;
  for (int i = 0; i < beams; ++i) {
    bodies += fmt::format(R"({}"c{}": {{"type": "beam", "from": [0, {}, 0], "to": [0, {}, 0],
        "material": "steel", "elements": {}, "section": {{"type": "rectangle", "width": 0.01, "height": 0.03}}}})",
                          i > 0 ? ", " : "", i, double(i) / beams, double(i + 1) / beams,
                          beams > 2 ? 2 : 6);
    joints += fmt::format(
        R"({}"j{}": {{"type": "fixed", "bodies": ["{}", "c{}"], "at": [0, {}, 0]}})",
        i > 0 ? ", " : "", i, i > 0 ? fmt::format("c{}", i - 1) : "ground", i, double(i) / beams);
  }
  const std::string side = fmt::format(R"(, "side": {{"type": "force", "body": "c{}",
      "at": [0, 1, 0], "direction": [1, 0, 0], "value": 1e-3}})",
                                       beams - 1);
  return fmt::format(R"({{"scene": {{"bodies": {{{}{}}}, "joints": {{{}{}}}, "loads": {{{}}}}},
      "simulation": {{"end_time": 0.002, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{"mass": {{"type": "mass"}}}}}})",
                     bodies, more_bodies, joints, more_joints, loads + side);
}

constexpr double column_stiffness = 2.1e11 * 0.03 * 0.01 * 0.01 * 0.01 / 12;  // EI about z

/// Nothing is told at 0.95 of the critical force, and something serious at 1.05.
template <class TextOf>
void expect_critical_force(double force, const TextOf& text_of) {
  EXPECT_TRUE(buckling_findings_of(text_of(0.95 * force)).empty());
  const std::vector<Finding> findings = buckling_findings_of(text_of(1.05 * force));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_TRUE(findings[0].is_serious) << findings[0].text;
}

/// However short the beams are of which it is made: π²EI/4L².
TEST(FrameStability, OfAColumnOfWeldedBeamsIsThatOfTheWhole) {
  for (const int beams : {2, 3, 6}) {
    SCOPED_TRACE(beams);
    expect_critical_force(pi * pi * column_stiffness / 4.0, [&](double force) {
      const std::string load = R"("f": {{"type": "force", "body": "c{}", "at": [0, 1, 0],
                                         "direction": [0, -1, 0], "value": {}}})";
      return column(beams, "", "", fmt::format(fmt::runtime(load), beams - 1, force));
    });
  }
}

/// What presses by a link of length h above the tip pushes it aside as it leans: with u² = PL²/EI
/// tan u = u (1 + h/L), for h = L/5 u = 0.695450. The same with a spring in place of a rigid link.
TEST(FrameStability, OfAColumnUnderWhatLeansIsTold) {
  constexpr double u = 0.695450;
  ASSERT_NEAR(std::tan(u), 1.2 * u, 1e-5);
  const double critical = u * u * column_stiffness;
  expect_critical_force(critical, [](double force) {
    return column(1, "", "",
                  fmt::format(R"("s": {{"type": "spring", "bodies": ["ground", "c0"],
                         "at": [[0, 1.2, 0], [0, 1, 0]], "stiffness": 1000, "free_length": {}}})",
                              0.2 + force / 1000));
  });
  expect_critical_force(critical, [](double force) {
    return column(1, R"(, "link": {"type": "rigid", "at": [0, 1.1, 0], "mass": 1e-3,
                                   "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]},
                        "push": {"type": "rigid", "at": [0, 1.2, 0], "mass": 1e-3,
                                 "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]})",
                  R"(, "low": {"type": "spherical", "bodies": ["c0", "link"], "at": [0, 1, 0]},
                       "high": {"type": "spherical", "bodies": ["link", "push"], "at": [0, 1.2, 0]},
                       "guide": {"type": "prismatic", "bodies": ["ground", "push"],
                                 "at": [0, 1.2, 0], "axis": [0, 1, 0]})",
                  fmt::format(R"("f": {{"type": "force", "body": "push", "at": [0, 1.2, 0],
                                        "direction": [0, -1, 0], "value": {}}})",
                              force));
  });
}

/// Columns that are pressed most one after the other, but too much when they are pressed together.
TEST(FrameStability, OfAFrameTogetherIsLookedForWhereAllIsPressedMost) {
  const double cantilever = pi * pi * 2.1e11 * (0.06 * std::pow(0.04, 3) / 12) / (4.0 * 9.0);
  const auto findings = [&](double together) {
    std::string text = portal(1.0, "fixed", "auto", "consistent");
    for (const char* values : {"0, {1}, {0}, 0, 0", "0, 0, {0}, {1}, 0"}) {
      const std::string old = R"("times": [0, 0.5], "values": [0, 1])";
      const auto at = text.find(old);
      EXPECT_NE(at, std::string::npos);
      text.replace(
          at, old.size(),
          fmt::format(R"("times": [0, 0.2, 0.3, 0.4, 0.5], "values": [{}])",
                      fmt::format(fmt::runtime(values), together * cantilever, 1.06 * cantilever)));
    }
    return buckling_findings_of(text);
  };
  EXPECT_TRUE(findings(0.9).empty());
  const std::vector<Finding> beyond = findings(1.04);
  ASSERT_EQ(beyond.size(), 1u);
  EXPECT_FALSE(beyond[0].is_serious) << "for an instant only: " << beyond[0].text;
}

/// In space without geometric stiffening, which is simulated once more with it; and of too many
/// coordinates.
TEST(FrameStability, OfAFrameInSpaceIsToldWithoutStiffeningAndWhereItIsTooLarge) {
  const double cantilever = pi * pi * 2.1e11 * (0.06 * std::pow(0.04, 3) / 12) / (4.0 * 9.0);
  const auto findings = [](std::string text) {
    return findings_of(read_scene(text), check_stability);
  };
  const std::string off = R"(on", "geometric_stiffening": "off)";
  for (const char* start : {"quasi-static", "consistent"}) {
    EXPECT_TRUE(findings(portal(0.97 * cantilever, "fixed", off, start)).empty());
    const std::vector<Finding> beyond = findings(portal(1.03 * cantilever, "fixed", off, start));
    ASSERT_EQ(beyond.size(), 1u);
    EXPECT_TRUE(beyond[0].is_serious);
  }
  const std::vector<Finding> unseen =
      findings(with_many_elements(portal(0.5 * cantilever, "fixed", "on")));
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_FALSE(unseen[0].is_serious);
  EXPECT_NE(unseen[0].text.find("more than 600 coordinates"), std::string::npos) << unseen[0].text;
}

}  // namespace
}  // namespace pleuel::test::motion_stability_test
