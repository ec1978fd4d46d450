#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/trust/check_list.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::state_law_test {
namespace {

/// A block of 2 kg that slides along x, at first with 3 m/s, and what acts in its slide.
ProblemFile sliding_block(const std::string& in_slide, double end_time,
                          const std::vector<std::string>& overrides = {}) {
  return problem_from(R"({
  "scene": {
    "bodies": {"block": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0], "velocity": [3, 0, 0]}},
    "joints": {"slide": {"type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0], "axis": [1, 0, 0]}},
    "loads": {"brake": {"type": "joint", "joint": "slide", )" +
                          in_slide + R"(}}
  },
  "simulation": {"end_time": )" +
                          std::to_string(end_time) +
                          R"(, "step": 2e-4},
  "responses": {
    "far": {"type": "position", "body": "block", "direction": "x", "over_time": "max"},
    "x": {"type": "position", "body": "block", "direction": "x", "over_time": "final"},
    "v": {"type": "velocity", "body": "block", "direction": "x", "over_time": "final"}
  }
})",
                      overrides);
}

/// m v²/2 = k x⁴/4; the period of ẍ = −α x³ is 7.41629871/(x_max √α) (a complete elliptic
/// integral: 4 K(1/2)).
TEST(CubicSpring, HasTheAmplitudeAndThePeriodOfItsEnergy) {
  const double m = 2.0, v = 3.0, k = 5e4;
  const double amplitude = std::pow(2.0 * m * v * v / k, 0.25);
  const double period = 7.4162987092054876 / (amplitude * std::sqrt(k / m));
  const auto [problem, x, analysis] =
      AtStart(sliding_block(R"("resistance": "= 50 kN/m^3*displacement^3")", period));
  const Eigen::VectorXd values = values_of(*analysis);
  EXPECT_NEAR(values(0), amplitude, 1e-5 * amplitude);
  EXPECT_NEAR(values(1), 0.0, 2e-4 * amplitude);
  EXPECT_NEAR(values(2), v, 2e-4 * v);
}

/// m v̇ = −F tanh(v/s):  sinh(v/s) = sinh(v₀/s) exp(−F t/(m s))
TEST(Friction, SlowsTheBlockDownAsItsEquationSays) {
  const double m = 2.0, v0 = 3.0, F = 40.0, s = 0.5, t = 0.16;
  const ProblemFile problem = sliding_block(
      R"("resistance": {"type": "friction", "value": "40 N", "speed": "0.5 m/s"})", t);
  const double expected = s * std::asinh(std::sinh(v0 / s) * std::exp(-F * t / (m * s)));
  EXPECT_NEAR(value_at_start(problem, "v"), expected, 1e-5);  // (F h/(m s))²/12 = 5e-6 of 1 m/s
  EXPECT_GT(expected, 0.1);                                   // it still moves
}

/// On a spring it turns back where its speed passes through that of full friction within a step: what
/// Newton's method needs there, the steps before do not tell. Against differences with steps of 1e-6 of
/// simulations that are as exact as they can be; 1e-2: friction bends within 0.3 mm/s.
TEST(Friction, HasTheGradientOfItsStepsWhereItTurnsBackWithinOne) {
  for (const double end : {0.5, 1.3}) {
    const auto [problem, x, analysis] = AtStart(sliding_block(
        R"("resistance": {"type": "friction", "value": "0.5 N", "speed": "0.3 mm/s"},
           "stiffness": {"variable": "k"})",
        end,
        {"/scene/bodies/block/mass=1", "/scene/bodies/block/velocity=[1, 0, 0]",
         "/simulation/step=2.094395 ms",
         R"(/variables={"k": {"start": 100, "lower": 50, "upper": 150}})"}));
    const Eigen::MatrixXd direct = direct_gradients(*analysis);
    ProblemFile exact = problem;
    exact.simulation.newton_tolerance = 1e-14;
    const Eigen::MatrixXd differences = central_differences(exact, x, 1e-6);
    EXPECT_LE((direct - differences).cwiseAbs().maxCoeff(), 1e-2 * direct.cwiseAbs().maxCoeff())
        << direct.transpose() << "\n"
        << differences.transpose();
  }
}

/// A free way, then a stop: m v²/2 = k (p²/2 − δp/2 + δ²/6) at the largest depth p > δ. The scheme
/// errs by about (h √(k/m))²/4 = 1e-4 of p.
TEST(Clearance, StopsTheBlockWhereItsEnergySays) {
  const double m = 2.0, v = 3.0, k = 2e4, gap = 0.1, d = 5e-3;
  const double p = d / 2 + std::sqrt(d * d / 4 - d * d / 3 + m * v * v / k);
  ASSERT_GT(p, d);
  const std::string stops =
      R"("resistance": {"type": "clearance", "lower": "-100 mm", "upper": "100 mm",
                                              "stiffness": "20 kN/m", "rounding": "5 mm"})";
  EXPECT_NEAR(value_at_start(sliding_block(stops, 0.06), "far"), gap + p, 1e-4 * p);
  // Back to where it was, as fast: nothing is lost, on neither side.
  EXPECT_NEAR(value_at_start(sliding_block(stops, 0.12), "v"), -v, 1e-3);
  EXPECT_NEAR(
      value_at_start(sliding_block(stops, 0.12, {"/scene/bodies/block/velocity=[-3, 0, 0]"}), "v"),
      v, 1e-3);
}

TEST(TableOverTheElongation, IsTheSpringThatItsLineSays) {
  const std::string spring =
      R"("damping": 1}, "rope": {"type": "spring", "bodies": ["ground", "block"],
                                 "at": [[-0.5, 0.2, 0], [0, 0, 0]], "free_length": 0.3, )";
  const auto far = [&](const std::string& law) {
    return value_at_start(sliding_block(spring + law, 0.05), "x");
  };
  const double expected = far(R"("stiffness": 900, "damping": 4)");
  EXPECT_NEAR(
      far(R"("damping": 4, "resistance": {"type": "table", "interpolation": "linear", "elongations": [-1, 1], "values": [-900, 900]})"),
      expected, 1e-12);
  EXPECT_NEAR(far(R"("resistance": "= 900 N/m*elongation + 4 N s/m*speed")"), expected, 1e-12);
  EXPECT_NEAR(
      far(R"("stiffness": 900, "resistance": {"type": "table", "interpolation": "spline", "speeds": [-10, 0, 10], "values": [-40, 0, 40]})"),
      expected, 1e-12);
}

/// J s̈ = p (s* − s) − d ṡ from rest, with ω = 20/s and damping ratio 1/2.
ProblemFile controlled_link(const std::string& motor, const std::string& spatial = "auto") {
  return problem_from(R"({"scene": {
    "bodies": {"link": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.05, 0.05, 0.05, 0, 0, 0]}},
    "joints": {"elbow": {"type": "revolute", "bodies": ["ground", "link"], "at": [0, 0, 0]}},
    "loads": {"motor": {"type": "joint", "joint": "elbow", "motor": )" +
                      motor + R"(}}},
  "effects": {"spatial_motion": ")" +
                      spatial + R"("},
  "simulation": {"end_time": 0.2, "step": 2e-4},
  "responses": {
    "s": {"type": "joint-position", "joint": "elbow", "over_time": "final"},
    "power": {"type": "motor-power", "load": "motor", "over_time": "final"}}})");
}

TEST(ControlledMotor, AnswersAStepInClosedForm) {
  const double w = 20.0, zeta = 0.5, t = 0.2, target = 0.2;
  const double wd = w * std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * w * t);
  const double s = target * (1 - decay * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t)));
  const double rate = target * decay * w * w / wd * std::sin(wd * t);
  const std::string gains = R"("proportional": 20, "derivative": 1})";
  for (const char* spatial : {"auto", "on"}) {
    const ProblemFile problem = controlled_link(
        R"({"type": "control", "target": {"type": "constant", "value": 0.2}, )" + gains, spatial);
    EXPECT_NEAR(value_at_start(problem, "s"), s, 1e-5 * target) << spatial;
    EXPECT_NEAR(value_at_start(problem, "power"), (20 * (target - s) - rate) * rate, 1e-3)
        << spatial;
  }
  EXPECT_NEAR(value_at_start(
                  controlled_link(R"("= 20 N m/rad*(0.2 rad - angle) - 1 N m s/rad*speed")"), "s"),
              s, 1e-5 * target);
}

/// What a motor without error follows, it does not leave: s* = t², as J s̈ is fed forward.
TEST(ControlledMotor, FollowsTheRateOfItsTarget) {
  const ProblemFile problem = controlled_link(
      R"({"type": "control", "target": {"type": "polynomial", "coefficients": [0, 0, 1]}, "proportional": 2000, "derivative": 40})");
  // Behind by J s̈*/p = 0.05 · 2/2000 rad once the start has died away (d/p = 0.02 s).
  EXPECT_NEAR(value_at_start(problem, "s"), 0.04 - 5e-5, 1e-6);
}

/// A disc that turns at 30 rad/s, and a block with a force along its slide and a torque about z.
ProblemFile pushed_block_and_disc(const std::string& force, const std::string& torque,
                                  const std::string& spatial = "auto") {
  return problem_from(R"({"scene": {
    "bodies": {"disc": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0]},
               "block": {"type": "rigid", "at": [2, 0, 0], "mass": 2, "inertia": [1, 1, 1, 0, 0, 0]}},
    "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "disc"], "at": [0, 0, 0],
                 "drive": {"type": "constant-speed", "speed": 30}},
               "slide": {"type": "prismatic", "bodies": ["ground", "block"], "at": [2, 0, 0], "axis": [1, 0, 0]}},
    "loads": {"gas": {"type": "force", "body": "block", "at": [2, 0, 0], "direction": [1, 0, 0], "value": )" +
                      force +
                      R"(},
              "turn": {"type": "torque", "body": "block", "at": [2, 0, 0], "direction": [0, 0, 1], "value": )" +
                      torque + R"(}}},
  "effects": {"spatial_motion": ")" +
                      spatial + R"("},
  "simulation": {"end_time": 0.5, "step": 1e-3},
  "responses": {"v": {"type": "velocity", "body": "block", "direction": "x", "over_time": "final"},
                "M": {"type": "reaction-moment", "joint": "slide", "direction": "z", "over_time": "final"}}})");
}

std::string over_bearing(const std::string& formula) {
  return R"({"type": "expression", "joint": "bearing", "value": ")" + formula + "\"}";
}

TEST(ForceOverAnAngle, IsThatOfTimeWhereTheAngleIs) {
  const double expected = value_at_start(
      pushed_block_and_disc(R"({"type": "harmonic", "amplitude": 5, "frequency": 30, "offset": 2})",
                            "0"),
      "v");
  for (const char* spatial : {"auto", "on"}) {
    const ProblemFile problem =
        pushed_block_and_disc(over_bearing("= 2 N + 5 N*sin(angle)"),
                              over_bearing("= 3 N m*cos(angle) + 0.1 N m s/rad*speed"), spatial);
    EXPECT_NEAR(value_at_start(problem, "v"), expected, 1e-9) << spatial;
    EXPECT_NEAR(value_at_start(problem, "M"), -3.0 * std::cos(15.0) - 3.0, 1e-6) << spatial;
  }
}

/// By every angle of two turns, that repeat: 15 rad are one period of 4π and 2.43 rad of the next,
/// in which the force rises by 8/π per rad.
TEST(ForceOverAnAngle, RepeatsItsTable) {
  const ProblemFile problem = pushed_block_and_disc(
      R"({"type": "table", "joint": "bearing", "angles": [0, "180 deg", "360 deg"], "values": [0, 8, 0],
          "period": "720 deg", "interpolation": "linear"})",
      "0");
  const double pi = std::numbers::pi, rest = 15.0 - 4 * pi;
  const double impulse = (8.0 * pi + 4.0 / pi * rest * rest) / 30.0;
  EXPECT_NEAR(value_at_start(problem, "v"), impulse / 2.0, 1e-4);
}

/// All laws of state in one mechanism, in a plane and in space, with their numbers as variables.
ProblemFile everything(const std::string& spatial) {
  return problem_from(R"json({
  "scene": {
    "bodies": {
      "wheel": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.1, 0.1, 0.1, 0, 0, 0], "angular_velocity": [0, 0, 9]},
      "arm": {"type": "beam", "from": [0.5, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 2,
              "section": {"type": "rectangle", "width": 0.01, "height": 0.01}, "damping": {"stiffness": 1e-3}}},
    "joints": {
      "bearing": {"type": "revolute", "bodies": ["ground", "wheel"], "at": [0, 0, 0]},
      "pivot": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0.5, 0, 0]}},
    "loads": {
      "motor": {"type": "joint", "joint": "bearing",
                "motor": "= 1 N m*torque*(1 - speed/(20 rad/s)) + 0.1 N m*sin(angle)*cos(30 rad/s*t)",
                "resistance": {"type": "friction", "value": {"variable": "brake"}, "speed": "2 rad/s"}},
      "hold": {"type": "joint", "joint": "pivot", "rest": {"variable": "rest"},
               "motor": {"type": "control", "target": {"type": "step", "to": {"variable": "goal"}, "rise": 0.05},
                         "proportional": {"variable": "gain"}, "derivative": 0.3},
               "resistance": {"type": "clearance", "lower": -0.02, "upper": {"variable": "gap"}, "stiffness": 30, "rounding": 0.5}},
      "gas": {"type": "force", "body": "arm", "at": [1, 0, 0], "direction": [0, 1, 0], "follows": true,
              "value": {"type": "expression", "joint": "bearing", "value": "= 4 N*torque*sin(angle + 0.3 rad) + 0.1 N s/rad*speed"}},
      "twist": {"type": "torque", "body": "arm", "at": [1, 0, 0], "direction": [0, 0, 1],
                "value": {"type": "table", "joint": "bearing", "angles": [0, 2, 4], "values": [0, "= 1 N m/rad*gap", 0],
                          "period": 6.283185307179586, "interpolation": "spline"}},
      "rope": {"type": "spring", "bodies": ["wheel", "arm"], "at": [[0, 0.1, 0], [1, 0, 0]],
               "resistance": "= 30 N/m*elongation + 900 N/m^3*torque*elongation^3 + 2 N*tanh(speed/(0.5 m/s))"}}
  },
  "simulation": {"end_time": 0.1, "step": 1e-3, "newton_tolerance": 1e-13},
  "variables": {
    "torque": {"start": 1.2, "lower": 0.1, "upper": 3},
    "brake": {"start": "0.4 N m", "lower": 0.1, "upper": 1},
    "goal": {"start": "0.2 rad", "lower": 0.1, "upper": 1},
    "gain": {"start": "25 N m/rad", "lower": 1, "upper": 100},
    "rest": {"start": "0.01 rad", "lower": 0, "upper": 1},
    "gap": {"start": "0.05 rad", "lower": 0.01, "upper": 1}},
  "responses": {
    "turn": {"type": "joint-position", "joint": "bearing", "over_time": "final"},
    "angle": {"type": "angle", "body": "arm", "direction": "z", "over_time": "final"},
    "power": {"type": "motor-power", "load": "hold", "over_time": "mean"},
    "loss": {"type": "damper-power", "load": "rope", "over_time": "mean"},
    "tip": {"type": "acceleration", "body": "arm", "at": 1, "direction": [1, 2, 2], "over_time": "rms"},
    "Q": {"type": "section-force", "body": "arm", "at": 0.3, "part": "shear-y", "over_time": "rms"}},
  "objective": {"minimize": "loss"}
})json",
                      {"/effects/spatial_motion=" + spatial});
}

TEST(LawsOfState, HaveTheGradientOfTheirSimulation) {
  for (const char* spatial : {"auto", "on"}) {
    const ProblemFile problem = everything(spatial);
    const auto [direct, adjoint, expected] = law_gradients(problem);
    EXPECT_LE(relative_difference(adjoint, direct), 1e-10) << spatial;
    for (Eigen::Index i = 0; i < expected.rows(); ++i) {
      for (Eigen::Index j = 0; j < expected.cols(); ++j) {
        EXPECT_NEAR(direct(i, j), expected(i, j), 1e-6 * expected.row(i).norm())
            << spatial << " " << problem.responses[static_cast<std::size_t>(i)].name << " " << j;
      }
    }
  }
}

TEST(LawOfState, IsAnsweredWithItsPlace) {
  const auto refusal = [](const std::string& in_slide) -> std::string {
    return thrown<InputError>([&] { sliding_block(in_slide, 0.1); });
  };
  EXPECT_THAT(refusal(R"("resistance": 5)"),
              HasSubstr("/scene/loads/brake/resistance must be an object"));
  EXPECT_THAT(refusal(R"("resistance": "= 5 N/rad*angle")"), HasSubstr("unknown name \"angle\""));
  EXPECT_THAT(
      refusal(
          R"("resistance": {"type": "table", "displacements": [0, 1], "values": [0, 1], "interpolation": "step"})"),
      HasSubstr("is for tables over time"));
  EXPECT_THAT(refusal(R"("resistance": {"type": "clearance", "stiffness": 5, "rounding": 1})"),
              HasSubstr("/scene/loads/brake/resistance needs \"lower\" or \"upper\""));
  EXPECT_THAT(refusal(R"("motor": {"type": "control", "proportional": 5})"),
              HasSubstr("/scene/loads/brake/motor is missing the key \"target\""));
  EXPECT_THAT(refusal(R"("motor": {"type": "table", "file": "none.csv", "columns": [1, 2]})"),
              HasSubstr("/scene/loads/brake/motor is missing the key \"over\""));
}

// A drive against dry friction, which turns round at its ends.

/// 2 kg that go to and fro by 100 mm at 10 rad/s against 20 N.
double largest_force(double step, const std::string& over_time) {
  const ProblemFile problem = problem_from(fmt::format(
      R"j({{"scene": {{"bodies": {{"m": {{"type": "point-mass", "at": [0, 0, 0], "mass": 2}}}},
                "joints": {{"rail": {{"type": "point-on-line", "bodies": ["ground", "m"],
                  "at": [0, 0, 0], "axis": [1, 0, 0],
                  "drive": {{"type": "harmonic", "amplitude": 0.1, "frequency": "10 rad/s"}}}}}},
                "loads": {{"rub": {{"type": "joint", "joint": "rail",
                  "resistance": {{"type": "friction", "value": 20, "speed": "1 mm/s"}}}}}}}},
              "simulation": {{"end_time": 1.5, "step": {}}},
              "responses": {{"force": {{"type": "drive-force", "joint": "rail", "over_time": "{}"}}}}}})j",
      step, over_time));
  return analyze(problem, start_design(problem))->reductions[0].value;
}

/// m a + F = 2 · 0.1 · 10² + 20 N just before the ends; the last instant before misses (ω h)²/2 of
/// the inertia at most. A parabola through the samples beside would add up to 5 N with any step.
TEST(FrictionReversal, HasThePeakOfInertiaAndFriction) {
  for (const double step : {1e-2, 5e-3, 2e-3}) {
    const double missed = 20.0 * 0.5 * 100.0 * step * step + 0.01;
    EXPECT_NEAR(largest_force(step, "max"), 40.0, missed) << step;
    EXPECT_NEAR(largest_force(step, "min"), -40.0, missed) << step;
    EXPECT_NEAR(largest_force(step, "max-abs"), 40.0, missed) << step;
  }
}

}  // namespace
}  // namespace pleuel::test::state_law_test
