#include "core/integration/elastic_stability.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/scene/problem_reader.hpp"

/// Starts from elastic equilibrium: those that have to be found, and those that do not exist.
namespace pleuel::test::elastic_stability_test {
namespace {

using testing::HasSubstr;

constexpr double young = 2.1e11, width = 0.02, height = 0.002;
const double stiffness = young * width * std::pow(height, 3) / 12;  // length 1

std::string joint(const std::string& name, const std::string& type, double x,
                  const std::string& axis = "") {
  return fmt::format(R"("{}": {{"type": "{}", "bodies": ["ground", "b"], "at": [{}, 0, 0]{}}})",
                     name, type, x, axis.empty() ? "" : ", \"axis\": " + axis);
}

/// One beam along x, thin in the plane; loads in the plane at its end.
std::string beam(const std::string& joints, double axial, double transverse, int elements = 8,
                 const std::string& effects = "{}", const std::string& frame = "tangent") {
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
                       "section": {{"type": "rectangle", "width": 0.02, "height": 0.002}},
                       "elements": {}, "frame": "{}"}}}},
      "joints": {{{}}},
      "loads": {{"n": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [1, 0, 0],
                      "value": {}}},
               "p": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [0, 1, 0],
                     "value": {}}}}}}},
      "effects": {},
      "simulation": {{"end_time": 0.001, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "b", "at": 1, "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "b", "at": 1, "direction": "y", "over_time": "final"}}}}}})",
                     elements, frame, joints, axial, transverse, effects);
}

/// Tip x and y where the motion begins.
Eigen::Vector2d tip(const std::string& text) {
  const ProblemFile problem = read_problem_text(text, "a.json").complete();
  const auto analysis = analyze(problem, start_design(problem));
  return {analysis->histories[0](0, 0), analysis->histories[1](0, 0)};
}

std::string error_of(const std::string& text) {
  try {
    tip(text);
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "";
}

const std::string clamp = joint("c", "fixed", 0);

/// The elastica of BENCHMARKS for α = PL²/EI = 0.25: 0.0827459 of deflection, 0.0041178 of
/// shortening. The model is linear in bending: its error is α²-small, some 1 %.
TEST(QuasiStaticStart, OfABentCantileverIsNearTheElastica) {
  const Eigen::Vector2d found = tip(beam(clamp, 0.0, 0.25 * stiffness));
  EXPECT_NEAR(found(1) / 0.0827459154, 1.0, 0.01);
  EXPECT_NEAR((1.0 - found(0)) / 0.0041178184, 1.0, 0.03);
}

/// PL³/3EI up to rotations where linear bending is wrong: it is found and left to warnings. The tip
/// falls by ∫½v'² = P²L⁵/15 (EI)²; axial strain is 1e-9.
TEST(QuasiStaticStart, IsFoundForLargeBending) {
  for (double alpha : {0.1, 0.5, 1.0}) {
    for (int elements : {4, 32, 128}) {
      const Eigen::Vector2d found = tip(beam(clamp, 0.0, alpha * stiffness, elements));
      EXPECT_NEAR(found(1) / (alpha / 3.0), 1.0, 1e-5) << alpha;
      EXPECT_NEAR((1.0 - found(0)) / (alpha * alpha / 15.0), 1.0, 1e-2) << alpha;
    }
  }
}

/// A blade of 5 m at 40 rad/s, far stiffer by its pull than by itself, with a lift at its tip: Newton's
/// method at once comes to an equilibrium with its tip turned by radians, which is not stable. The tip
/// rises by as much as the lift grows.
TEST(QuasiStaticStart, OfATurningBladeIsThatOfLoadsThatGrow) {
  const auto rise = [](double lift) {
    const ProblemFile problem = read_problem_text(fmt::format(
                                                      R"j({{"scene": {{"gravity": [0, 0, 0],
                  "materials": {{"m": {{"young": 7.17e10, "poisson": 0.33, "density": 2810}}}},
                  "bodies": {{"blade": {{"type": "beam", "from": [0, 0, 0], "to": [5, 0, 0],
                      "material": "m", "elements": 8, "frame": "tangent",
                      "section": {{"type": "rectangle", "width": 0.01, "height": 0.2}},
                      "angular_velocity": [0, 0, 40]}}}},
                  "joints": {{"hub": {{"type": "revolute", "bodies": ["ground", "blade"],
                      "at": [0, 0, 0], "axis": [0, 0, 1],
                      "drive": {{"type": "constant-speed", "speed": 40}}}}}},
                  "loads": {{"lift": {{"type": "force", "body": "blade", "at": [5, 0, 0],
                      "direction": [0, 0, 1], "value": {}}}}}}},
                "simulation": {{"end_time": 5e-4, "step": 5e-4, "initial_state": "quasi-static"}},
                "responses": {{"tip": {{"type": "position", "body": "blade", "at": 1,
                                       "direction": "z", "over_time": "final"}}}}}})j",
                                                      lift),
                                                  "blade.json")
                                    .complete();
    return analyze(problem, start_design(problem))->histories[0](0, 0);
  };
  const double little = rise(10.0);
  for (double lift : {150.0, 200.0, 300.0, 400.0}) {
    EXPECT_NEAR(rise(lift) / little, lift / 10.0, 1e-2 * lift / 10.0) << lift;
  }
}

/// Round-off grows with the fourth power of the number of elements: some 1e-6 here.
TEST(QuasiStaticStart, IsFoundForFineMeshes) {
  for (int elements : {96, 160}) {
    const Eigen::Vector2d found = tip(beam(clamp, -2.0, 0.1 * stiffness, elements));
    const double k = std::sqrt(2.0 / stiffness);  // beam-column: v = P (tan kL − kL)/(N k)
    const double expected = 0.1 * stiffness * (std::tan(k) - k) / (2.0 * k);
    EXPECT_NEAR(found(1) / expected, 1.0, 1e-5) << elements;
  }
}

/// A force across: the equations of what does not move along hold nothing but round-off.
TEST(QuasiStaticStart, IsFoundWhereNothingPullsAlong) {
  for (int elements : {200, 400}) {
    const Eigen::Vector2d found = tip(beam(clamp, 0.0, 0.007 * stiffness, elements));
    EXPECT_NEAR(found(1) / (0.007 / 3.0), 1.0, 1e-4) << elements;
  }
}

/// Both ends held lengthwise: each of two clamped members carries half of the force, PL³/6EI.
TEST(QuasiStaticStart, OfClampedMembersCoupledAtTheirTipsIsFound) {
  for (const char* type : {"point-on-line", "revolute"}) {
    const std::string text = fmt::format(
        R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{
        "one": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
                "section": {{"type": "rectangle", "width": 0.02, "height": 0.03}}, "elements": 3}},
        "two": {{"type": "beam", "from": [2, 0, 0], "to": [1, 0, 0], "material": "m",
                "section": {{"type": "rectangle", "width": 0.02, "height": 0.03}}, "elements": 3}}}},
      "joints": {{"a": {{"type": "fixed", "bodies": ["ground", "one"], "at": [0, 0, 0]}},
                "b": {{"type": "fixed", "bodies": ["ground", "two"], "at": [2, 0, 0]}},
                "link": {{"type": "{}", "bodies": ["one", "two"], "at": [1, 0, 0], "axis": [{}]}}}},
      "loads": {{"f": {{"type": "force", "body": "one", "at": [1, 0, 0], "direction": [0, -1, 0],
                      "value": 10}}}}}},
      "simulation": {{"end_time": 0.001, "step": 0.001, "initial_state": "quasi-static"}},
      "responses": {{"x": {{"type": "mass"}}, "y": {{"type": "position", "body": "one", "at": 1,
                                                "direction": "y", "over_time": "max-abs"}}}}}})",
        type, std::string(type) == "revolute" ? "0, 0, 1" : "1, 0, 0");
    const ProblemFile problem = read_problem_text(text, "a.json").complete();
    const auto analysis = analyze(problem, start_design(problem));
    const double inertia = 0.02 * std::pow(0.03, 3) / 12;
    EXPECT_NEAR(analysis->reductions[1].value * 6 * young * inertia / 10.0, 1.0, 1e-4) << type;
  }
}

/// Columns beyond their Euler loads by 1.3 in the plane: 1/1.3 of the loads is what they bear.
TEST(QuasiStaticStart, RefusesColumnsBeyondTheirEulerLoad) {
  const double unit = std::pow(std::numbers::pi, 2) * stiffness;
  struct Case {
    std::string name, joints, frame;
    double load;
  };
  const std::string guide = joint("g", "point-on-line", 1, "[1, 0, 0]");
  for (const Case& column :
       {Case{"free", clamp, "tangent", unit / 4},
        Case{"pinned", joint("p", "revolute", 0) + "," + guide, "chord", unit},
        Case{"clamped and pinned", clamp + "," + guide, "tangent", 2.045748 * unit}}) {
    for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
      EXPECT_EQ(error_of(beam(column.joints, -0.9 * column.load, 0.0, 8, effects, column.frame)),
                "")
          << column.name << effects;
      const std::string error =
          error_of(beam(column.joints, -1.3 * column.load, 0.0, 8, effects, column.frame));
      EXPECT_THAT(error, HasSubstr("is unstable")) << column.name << effects;
      EXPECT_THAT(error, HasSubstr("the body \"b\" buckles, at some 0.769 of these loads"));
    }
    const std::string bent =
        error_of(beam(column.joints, -1.3 * column.load, 1e-3, 8, "{}", column.frame));
    EXPECT_THAT(bent, HasSubstr("0.769")) << "with a force across: " << column.name;
  }
}

/// What is not held may fall as it likes: a pendulum upside down has no equilibrium, its beam has.
TEST(QuasiStaticStart, LeavesMotionsOfTheWholeMechanismAlone) {
  EXPECT_EQ(error_of(beam(joint("p", "revolute", 0), -0.01 * stiffness, 0.0)), "");
}

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
                "l": {{"type": "point-on-line", "bodies": ["ground", "b"], "at": [1, 0, 0],
                      "axis": [1, 0, 0]}}}},
      "loads": {{"p": {{"type": "force", "body": "b", "at": [1, 0, 0], "direction": [-1, 0, 0],
                      "value": {}}}}}}},
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

/// A column without mass, 0.3 m long, which points from the rim of a turning hub of 0.5 m towards the
/// axis, with 2 kg at its end.
/// @param out_of_plane  whether it is thin along the axis
std::string inward_column(bool out_of_plane, double speed) {
  return fmt::format(R"({{"scene": {{
      "materials": {{"light": {{"young": 2.1e11, "poisson": 0.3, "density": 1}}}},
      "bodies": {{
        "hub": {{"type": "rigid", "at": [0, 0, 0], "mass": 1, "inertia": [0.01, 0.01, 0.01, 0, 0, 0],
                "angular_velocity": [0, 0, {0}]}},
        "column": {{"type": "beam", "from": [0.5, 0, 0], "to": [0.2, 0, 0], "material": "light",
                   "section": {{"type": "rectangle", "width": {1}, "height": {2}}}, "elements": 10,
                   "reference": [0, 1, 0], "angular_velocity": [0, 0, {0}],
                   "velocity": [0, {3}, 0]}},
        "end": {{"type": "rigid", "at": [0.2, 0, 0], "mass": 2,
                "inertia": [2e-7, 2e-7, 2e-7, 0, 0, 0], "angular_velocity": [0, 0, {0}],
                "velocity": [0, {4}, 0]}}}},
      "joints": {{
        "bearing": {{"type": "revolute", "bodies": ["ground", "hub"], "at": [0, 0, 0],
                    "axis": [0, 0, 1], "drive": {{"type": "constant-speed", "speed": {0}}}}},
        "root": {{"type": "fixed", "bodies": ["hub", "column"], "at": [0.5, 0, 0]}},
        "weld": {{"type": "fixed", "bodies": ["column", "end"], "at": [0.2, 0, 0]}}}}}},
      "effects": {{"spatial_motion": "on"}},
      "simulation": {{"end_time": 2e-4, "step": 1e-4, "initial_state": "quasi-static"}},
      "responses": {{
        "x": {{"type": "position", "body": "end", "direction": "x", "over_time": "final"}},
        "y": {{"type": "position", "body": "end", "direction": "y", "over_time": "final"}}}}}})",
                     speed, out_of_plane ? 0.004 : 0.02, out_of_plane ? 0.02 : 0.004, 0.5 * speed,
                     0.2 * speed);
}

/// P = m Ω² (R − L) presses it. Across the turning it keeps its direction: P = π² EI/4L². In the plane
/// it comes from the axis, so that k² = P/EI has tan kL = kR. Its own light elements vibrate 10⁶ times
/// as fast as it buckles.
TEST(QuasiStaticStart, OfAColumnThatTurnsInwardsIsFoundBelowItsCriticalSpeed) {
  constexpr double length = 0.3, radius = 0.5, mass = 2.0;
  const double bending = young * 0.02 * std::pow(0.004, 3) / 12;
  double low = 1.0, high = 0.5 * std::numbers::pi / length - 1e-6;
  for (int i = 0; i < 60; ++i) {
    const double k = 0.5 * (low + high);
    (std::tan(k * length) < k * radius ? low : high) = k;
  }
  for (const bool out_of_plane : {true, false}) {
    const double k = out_of_plane ? 0.5 * std::numbers::pi / length : low;
    const double critical = k * std::sqrt(bending / (mass * (radius - length)));
    EXPECT_EQ(error_of(inward_column(out_of_plane, 0.98 * critical)), "") << out_of_plane;
    for (const double share : {1.02, 1.1}) {
      EXPECT_THAT(error_of(inward_column(out_of_plane, share * critical)), HasSubstr("buckles"))
          << out_of_plane << " " << share;
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
        "block": {{"type": "rigid", "at": [0.5, 0, 0], "mass": 1,
                  "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]}}}},
      "joints": {{
        "a": {{"type": "spherical", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
        "l": {{"type": "point-on-line", "bodies": ["ground", "b"], "at": [1, 0, 0],
              "axis": [1, 0, 0]}},
        "weld": {{"type": "fixed", "bodies": ["b", "disk"], "at": [0.5, 0, 0]}},
        "bearing": {{"type": "revolute", "bodies": ["b", "block"], "at": [0.5, 0, 0],
                    "axis": [1, 0, 0]}}}},
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

/// A spring that presses a stiff column towards a point d beyond its tip pushes the tip aside, with
/// P w/d: a soft spring k at the foot holds it up to P L (1 + L/d) = k.
TEST(ElasticStability, OfAColumnThatASpringPressesAsideEndsEarlier) {
  const double k = 0.01 * stiffness, d = 0.5, K = 100.0;
  const double critical = k / (1.0 + 1.0 / d);
  for (const double share : {0.95, 1.05, 2.0, 4.0}) {
    std::string text = beam(joint("foot", "revolute", 0.0), 0.0, 0.0);
    const std::string loads = R"("loads": {)";
    text.replace(text.find(loads), loads.size(),
                 loads + fmt::format(
                             R"("k": {{"type": "joint", "joint": "foot", "stiffness": {}}},
                                "s": {{"type": "spring", "bodies": ["ground", "b"],
                                      "at": [[{}, 0, 0], [1, 0, 0]], "stiffness": {},
                                      "free_length": {}}}, )",
                             k, 1.0 + d, K, d + share * critical / K));
    EXPECT_EQ(error_of(text).find("is unstable") != std::string::npos, share > 1.0) << share;
  }
}

/// A column that a spring of stiffness k holds at its foot buckles at P = u² EI/L² with u tan u = k L/EI
/// (Timoshenko & Gere, Theory of Elastic Stability, §2.3), between that of a rigid bar, P L = k, and
/// that of a clamped column.
TEST(ElasticStability, OfAColumnOnASpringEndsAtTheLoadOfBothTogether) {
  const std::string in_a_plane = "{}", in_space = R"({"spatial_motion": "on"})";
  for (const auto& spring :
       {std::pair(0.1, in_a_plane), std::pair(1.0, in_a_plane), std::pair(10.0, in_a_plane),
        std::pair(1000.0, in_a_plane), std::pair(1.0, in_space), std::pair(1000.0, in_space)}) {
    const double ratio = spring.first;
    const std::string& effects = spring.second;
    double low = 0.0, high = std::numbers::pi / 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (middle * std::tan(middle) < ratio ? low : high) = middle;
    }
    const double critical = low * low * stiffness;
    const auto on_spring = [&](double share) {
      std::string text = beam(joint("foot", "revolute", 0.0), -share * critical, 0.0, 8, effects);
      const std::string loads = R"("loads": {)";
      return text.replace(text.find(loads), loads.size(),
                          loads + fmt::format(R"("k": {{"type": "joint", "joint": "foot",
                                                       "stiffness": {}}}, )",
                                              ratio * stiffness));
    };
    EXPECT_EQ(error_of(on_spring(0.98)), "") << ratio;
    EXPECT_THAT(error_of(on_spring(1.02)), HasSubstr("is unstable")) << ratio;
    // Beyond the load that the spring bears alone, too.
    EXPECT_THAT(error_of(on_spring(3.0)), HasSubstr("is unstable")) << ratio;
  }
}

/// A balanced wheel on the tip of that column, which a motor turns at any speed, neither holds it
/// nor sets it on its way.
TEST(ElasticStability, OfAColumnOnASpringIsThatOfTheColumnBelowAWheel) {
  // Of k L = EI: u tan u = 1.
  const double critical = 0.8603335890193798 * 0.8603335890193798 * stiffness;
  const auto below_a_wheel = [&](double share, double speed) {
    std::string text = beam(joint("foot", "revolute", 0.0), -share * critical, 0.0, 8);
    const auto add = [&](const std::string& before, const std::string& more) {
      text.replace(text.find(before), before.size(), before + more);
    };
    add(R"("loads": {)", fmt::format(R"("k": {{"type": "joint", "joint": "foot",
                                              "stiffness": {}}}, )",
                                     stiffness));
    add(R"("bodies": {)", fmt::format(R"("wheel": {{"type": "rigid", "at": [1, 0, 0], "mass": 0.2,
                                "inertia": [1e-4, 1e-4, 1e-4, 0, 0, 0],
                                "angular_velocity": [0, 0, {}]}}, )",
                                      speed));
    add(R"("joints": {)", fmt::format(R"("motor": {{"type": "revolute", "bodies": ["b", "wheel"],
                                "at": [1, 0, 0],
                                "drive": {{"type": "constant-speed", "speed": {}}}}}, )",
                                      speed));
    return text;
  };
  for (const double speed : {0.0, 1.0, 50.0, 300.0}) {
    EXPECT_EQ(error_of(below_a_wheel(0.98, speed)), "") << speed;
    EXPECT_THAT(error_of(below_a_wheel(1.02, speed)), HasSubstr("is unstable")) << speed;
    EXPECT_THAT(error_of(below_a_wheel(1.3, speed)), HasSubstr("is unstable")) << speed;
  }
}

/// A mast of 1 m with a fan of four blades, which turns about its axis or across it and is pressed
/// by a share of the Euler load π² EI/4L² of the mast. Its first vibration has some 30 rad/s.
std::string fan_on_a_mast(const std::string& axis, double speed, double share) {
  const double press = share * std::pow(std::numbers::pi, 2) * 2.1e11 * 0.03 * 1e-6 / 12 / 4;
  const bool is_about_mast = axis == "[1, 0, 0]";
  const std::string turn = fmt::format(R"("angular_velocity": [{}, 0, {}])",
                                       is_about_mast ? speed : 0.0, is_about_mast ? 0.0 : speed);
  std::string blades, welds;
  for (int i = 0; i < 4; ++i) {
    const double way = i % 2 == 0 ? 0.3 : -0.3;
    const Eigen::Vector3d end =
        is_about_mast ? Eigen::Vector3d(1.0, i < 2 ? way : 0.0, i < 2 ? 0.0 : way)
                      : Eigen::Vector3d(1.0 + (i < 2 ? way : 0.0), i < 2 ? 0.0 : way, 0.0);
    blades += fmt::format(R"(, "blade{}": {{"type": "beam", "from": [1, 0, 0], "to": [{}, {}, {}],
                              "material": "m", "elements": 2, {},
                              "section": {{"type": "rectangle", "width": 0.01, "height": 0.01}}}})",
                          i, end(0), end(1), end(2), turn);
    welds += fmt::format(R"(, "weld{0}": {{"type": "fixed", "bodies": ["hub", "blade{0}"],
                             "at": [1, 0, 0]}})",
                         i);
  }
  return fmt::format(R"({{"scene": {{
      "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
      "bodies": {{"mast": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "m",
                          "section": {{"type": "rectangle", "width": 0.03, "height": 0.01}},
                          "elements": 4}},
                 "hub": {{"type": "rigid", "at": [1, 0, 0], "mass": 0.2,
                         "inertia": [1e-4, 1e-4, 1e-4, 0, 0, 0], {}}}{}}},
      "joints": {{"root": {{"type": "fixed", "bodies": ["ground", "mast"], "at": [0, 0, 0]}},
                 "motor": {{"type": "revolute", "bodies": ["mast", "hub"], "at": [1, 0, 0], "axis": {},
                           "drive": {{"type": "constant-speed", "speed": {}}}}}{}}},
      "loads": {{"across": {{"type": "force", "body": "mast", "at": [1, 0, 0],
                           "direction": [0, 0, 1], "value": 1e-3}},
                "press": {{"type": "force", "body": "mast", "at": [1, 0, 0],
                          "direction": [-1, 0, 0], "value": {}}}}}}},
      "simulation": {{"end_time": 1e-4, "step": 1e-4, "initial_state": "quasi-static"}},
      "responses": {{"y": {{"type": "position", "body": "mast", "at": 1, "direction": "y",
                          "over_time": "final"}},
                    "z": {{"type": "position", "body": "mast", "at": 1, "direction": "z",
                          "over_time": "final"}}}}}})",
                     turn, blades, axis, speed, welds, press);
}

/// What turns and what it turns on both deform: the fan is no reason to refuse the mast above its
/// resonance, nor to bear more than it does alone.
TEST(ElasticStability, OfAnElasticRotorOnAnElasticStandIsThatOfEach) {
  for (const std::string axis : {"[1, 0, 0]", "[0, 0, 1]"}) {
    for (const double speed : {0.0, 5.0, 60.0, 200.0}) {
      EXPECT_EQ(error_of(fan_on_a_mast(axis, speed, 0.9)), "") << axis << speed;
      if (speed <= 60.0) {
        EXPECT_THAT(error_of(fan_on_a_mast(axis, speed, 1.05)),
                    HasSubstr("\"mast\" buckles, at some 0.95"))
            << axis << speed;
      }
    }
  }
}

/// The load that it buckles at is that of linear buckling, whatever rides on it without being
/// pressed.
TEST(ElasticStability, TheLoadOfBucklingIsThatOfTheMastBelowItsArms) {
  EXPECT_THAT(error_of(fan_on_a_mast("[0, 0, 1]", 0.0, 2.0)),
              HasSubstr("at some 0.5 of these loads"));
}

/// Euler's load of two pins, π² EI/L², and of a cantilever, a quarter of it, whatever the frame of
/// the body is that the load turns with, and however many there are.
TEST(ElasticStability, TheLoadOfBucklingIsThatOfEveryFrame) {
  const std::string pins =
      joint("a", "revolute", 0.0) + ", " + joint("b", "point-on-line", 1.0, "[1, 0, 0]");
  for (const std::string frame : {"tangent", "chord", "tangent-end", "mean-axis"}) {
    for (const double share : {1.1, 1.5, 3.0}) {
      const double euler = std::numbers::pi * std::numbers::pi * stiffness;
      const std::string at = fmt::format("buckles, at some {:.3g} of", 1.0 / share);
      EXPECT_THAT(error_of(beam(pins, -share * euler, 0.0, 8, "{}", frame)), HasSubstr(at))
          << frame << share;
      EXPECT_THAT(error_of(beam(clamp, -0.25 * share * euler, 0.0, 8, "{}", frame)), HasSubstr(at))
          << frame << share;
    }
  }
}

/// Divided into frames, and under its own weight: q L³/EI = 7.837 (Timoshenko & Gere, Theory of Elastic
/// Stability, art. 2.12).
TEST(ElasticStability, TheLoadOfBucklingIsThatOfDividedBeamsAndOfWeight) {
  const auto with = [](std::string text, const std::string& place, const std::string& more) {
    return text.replace(text.find(place), place.size(), more + place);
  };
  const double euler = 0.25 * std::numbers::pi * std::numbers::pi * stiffness;
  EXPECT_THAT(error_of(with(beam(clamp, -1.5 * euler, 0.0), R"("elements":)", R"("frames": 4, )")),
              HasSubstr("buckles, at some 0.667 of"));
  const double weight = 2.0 * 7.837 * stiffness / (7850 * width * height);
  const std::string text = error_of(with(beam(clamp, 0.0, 0.0), R"("materials":)",
                                         fmt::format(R"("gravity": [{}, 0, 0], )", -weight)));
  const std::string before = "buckles, at some ";
  ASSERT_THAT(text, HasSubstr(before));
  EXPECT_NEAR(std::stod(text.substr(text.find(before) + before.size())), 0.5, 0.005);
}

}  // namespace
}  // namespace pleuel::test::elastic_stability_test
