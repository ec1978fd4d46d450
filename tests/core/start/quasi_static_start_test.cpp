#include "core/base/eager_matrices.hpp"
#include "core/start/equilibrium.hpp"
#include "tests/core/start/quasi_static_beam.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Starts from elastic equilibrium: those that have to be found, and those that do not exist.
namespace pleuel::test::quasi_static_start_test {
namespace {

using namespace quasi_static_beam;

/// The elastica for α = PL²/EI = 0.25 (its equation by shooting): 0.0827459 of deflection, 0.0041178 of
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
    const ProblemFile problem = problem_from(fmt::format(
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
        lift));
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
    const ProblemFile problem = problem_from(text);
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

}  // namespace
}  // namespace pleuel::test::quasi_static_start_test
