#include "core/response/lateral_buckling_signal.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/trust/check_list.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

/// A thin bar of 1.2 m, 2 mm × 40 mm, on edge: it bends in the plane x–y.
namespace pleuel::test::lateral_buckling_signal_test {
namespace {

constexpr double young = 2.1e11, shear = 8.0e10, length = 1.2, pi = std::numbers::pi;

struct Bar {
  std::string joints, loads, effects = R"("geometric_stiffening": "off")", body = "";
  int elements = 16;
  std::string bodies = "";  ///< beside it
};

const std::string clamp =
    R"("wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]})";

std::string force(double value, const std::string& direction) {
  return fmt::format(
      R"("f": {{"type": "force", "body": "bar", "at": [1.2, 0, 0], "direction": {}, "value": {}}})",
      direction, value);
}

std::string rigid(const std::string& name, const std::string& at) {
  return fmt::format(R"(, "{}": {{"type": "rigid", "at": {}, "mass": 1e-3,
                                 "inertia": [1e-6, 1e-6, 1e-6, 0, 0, 0]}})",
                     name, at);
}

const std::string space = R"("spatial_motion": "on", "geometric_stiffening": "off")";

ProblemFile problem_of(const Bar& bar) {
  const std::string text = fmt::format(
      R"j({{"scene": {{
    "materials": {{"light": {{"young": 2.1e11, "poisson": 0.3125, "density": 1}}}},
    "bodies": {{"bar": {{"type": "beam", "from": [0, 0, 0], "to": [1.2, 0, 0], "elements": {},
      "material": "light", "section": {{"type": "rectangle", "width": {{"variable": "b"}},
                                       "height": {{"variable": "h"}}}}{}}}{}}},
    "joints": {{{}}}, "loads": {{{}}}}},
  "effects": {{{}}},
  "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static", "newton_tolerance": 1e-13}},
  "variables": {{"b": {{"start": "2 mm", "lower": "1 mm", "upper": "50 mm"}},
                "h": {{"start": "40 mm", "lower": "1 mm", "upper": "90 mm"}}}},
  "responses": {{"share": {{"type": "lateral-buckling", "body": "bar", "over_time": "max"}}}}}})j",
      bar.elements, bar.body, bar.bodies, bar.joints, bar.loads, bar.effects);
  return problem_from(text);
}

std::unique_ptr<Analysis> analysis_of(const Bar& bar) {
  const ProblemFile problem = problem_of(bar);
  return analyze(problem, start_design(problem));
}
double share_of(const Bar& bar) {
  return analysis_of(bar)->reductions[0].value;
}

const double lateral = young * 0.04 * std::pow(0.002, 3) / 12;
/// J = hb³/3 (1 − 0.63 b/h) for b ≪ h (Timoshenko & Goodier, §109).
const double twisting = shear * 0.04 * std::pow(0.002, 3) / 3 * (1 - 0.63 * 0.05);
/// Bending in the plane holds the bar: critical moments are larger by 1/m.
const double m = std::sqrt(1 - 0.05 * 0.05);
const double tip_critical = 4.0126 * std::sqrt(lateral * twisting) / (length * length) / m;
const double euler = pi * pi * lateral / (length * length);

// 2e-3: twist is linear in the elements (1e-3 of a cantilever with sixteen), and forces turn with the
// bent bar.

TEST(LateralBucklingResponse, OfATipForceIsTheClosedForm) {
  for (const char* effects : {R"("geometric_stiffening": "off")", R"("spatial_motion": "on")"}) {
    const Bar bar{clamp, force(0.5 * tip_critical, "[0, -1, 0]"), effects};
    EXPECT_NEAR(share_of(bar) / 0.5, 1.0, 2e-3) << effects;
  }
}

/// Between hinges that turn in the plane only, slope and twist are held at both ends. EI w''' = −M φ'
/// and GJ φ' = M w' have φ = 1 − cos kx with k² = M²/(EI GJ); φ = φ' = 0 at both ends: k = 2π/L.
TEST(LateralBucklingResponse, OfAConstantMomentBetweenHingesIsTheClosedForm) {
  const double moment = 0.4 * 2 * pi * std::sqrt(lateral * twisting) / length / m;
  const std::string loads = fmt::format(
      R"("a": {{"type": "torque", "body": "bar", "at": [0, 0, 0], "direction": [0, 0, 1], "value": {}}},
         "b": {{"type": "torque", "body": "bar", "at": [1.2, 0, 0], "direction": [0, 0, -1], "value": {}}})",
      moment, moment);
  const std::string hinges =
      R"("a": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0], "axis": [0, 0, 1]},
         "b": {"type": "revolute", "bodies": ["carriage", "bar"], "at": [1.2, 0, 0], "axis": [0, 0, 1]},
         "slide": {"type": "prismatic", "bodies": ["ground", "carriage"], "at": [1.2, 0, 0], "axis": [1, 0, 0]})";
  Bar bar{hinges, loads};
  bar.bodies = rigid("carriage", "[1.2, 0, 0]");
  // (2π/16)²/24 = 6.4e-3 of a whole wave of twist.
  EXPECT_NEAR(share_of(bar) / 0.4, 1.0, 8e-3);
}

TEST(LateralBucklingResponse, OfColumnsIsTheirEulerLoad) {
  const std::string slide =
      R"(, "slide": {"type": "prismatic", "bodies": ["ground", "bar"], "at": [1.2, 0, 0], "axis": [1, 0, 0]})";
  const auto pressed = [&](const std::string& joints, double load) {
    return share_of({joints, force(load, "[-1, 0, 0]"), space});
  };
  EXPECT_NEAR(pressed(clamp, 0.1 * euler), 0.4, 1e-4);
  EXPECT_NEAR(pressed(clamp + slide, 0.8 * euler), 0.2, 1e-4);
  EXPECT_EQ(pressed(clamp, -0.8 * euler), 0.0) << "pull";
}

const std::string welds =
    R"("a": {"type": "fixed", "bodies": ["left", "bar"], "at": [0, 0, 0]},
       "b": {"type": "fixed", "bodies": ["bar", "right"], "at": [1.2, 0, 0]},)";

/// Blocks at both ends turn with the bar: on a universal joint and a line it is a column on two pins.
TEST(LateralBucklingResponse, OfAColumnBetweenBlocksIsByWhatHoldsTheBlocks) {
  const std::string blocks = rigid("left", "[0, 0, 0]") + rigid("right", "[1.2, 0, 0]");
  const auto pressed = [&](const std::string& joints) {
    Bar bar{welds + joints, force(0.5 * euler, "[-1, 0, 0]"), space};
    bar.bodies = blocks;
    return share_of(bar);
  };
  const std::string line = R"("l": {"type": "point-on-line", "bodies": ["ground", "right"],
                                    "at": [1.2, 0, 0], "axis": [1, 0, 0]})";
  EXPECT_NEAR(pressed(R"("u": {"type": "universal", "bodies": ["ground", "left"], "at": [0, 0, 0],
                               "axis": [0, 0, 1], "second_axis": [0, 1, 0]},)" +
                      line),
              0.5, 1e-4);
  // A block that is welded to the wall clamps: a clamped and a pinned end, 20.19 EI/L².
  EXPECT_NEAR(
      pressed(R"("u": {"type": "fixed", "bodies": ["ground", "left"], "at": [0, 0, 0]},)" + line),
      0.5 * pi * pi / 20.1907, 1e-4);
}

/// The root of u tan u = ratio below a right angle.
double angle_of(double ratio) {
  double low = 0.0, high = pi / 2;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (middle * std::sin(middle) < ratio * std::cos(middle) ? low : high) = middle;
  }
  return low;
}

/// A strut in rigid eyes, pressed from eye to eye.
/// @param before, after  x of the eyes
Bar strut_in_eyes(const std::string& before, const std::string& after, double press) {
  const std::string joints = fmt::format(
      R"("u": {{"type": "universal", "bodies": ["ground", "left"], "at": [{}, 0, 0],
               "axis": [0, 0, 1], "second_axis": [0, 1, 0]}},
         "l": {{"type": "point-on-line", "bodies": ["ground", "right"], "at": [{}, 0, 0], "axis": [1, 0, 0]}})",
      before, after);
  const std::string loads = fmt::format(
      R"("f": {{"type": "force", "body": "right", "at": [{}, 0, 0], "direction": [-1, 0, 0], "value": {}}})",
      after, press);
  Bar bar{welds + joints, loads, space};
  bar.bodies = rigid("left", fmt::format("[{}, 0, 0]", before)) +
               rigid("right", fmt::format("[{}, 0, 0]", after));
  return bar;
}

/// P = (2u/L)² EI with u tan u = L/2d (tests/core/beam/lateral_buckling_test.cpp).
TEST(LateralBucklingResponse, OfAStrutInRigidEyesIsTheRootOfItsEquation) {
  for (const double share : {0.05, 0.09, 0.12, 0.5}) {
    const double d = share * length, u = angle_of(length / (2 * d));
    const double critical = std::pow(2 * u / length, 2) * lateral;
    const Bar bar =
        strut_in_eyes(fmt::format("{}", -d), fmt::format("{}", length + d), 0.5 * critical);
    EXPECT_NEAR(share_of(bar), 0.5, 1e-4) << share;
  }
}

/// P = (u/L)² EI with u tan u = L/d: a force on a rigid body on top, on a body that is welded to it,
/// on a rigid beam, and the weight of the body.
TEST(LateralBucklingResponse, OfAColumnUnderARigidBodyIsTheRootOfItsEquation) {
  const double d = 0.8 * length, u = angle_of(length / d);
  const double press = 0.5 * std::pow(u / length, 2) * lateral;
  const std::string on_top =
      R"(, "b": {"type": "fixed", "bodies": ["bar", "top"], "at": [1.2, 0, 0]})";
  const auto force_on = [&](const char* body) {
    return fmt::format(R"("f": {{"type": "force", "body": "{}", "at": [{}, 0, 0],
                                 "direction": [-1, 0, 0], "value": {}}})",
                       body, length + d, press);
  };
  Bar bar{clamp + on_top, force_on("top"), space};
  bar.bodies = rigid("top", "[1.5, 0, 0]");
  EXPECT_NEAR(share_of(bar), 0.5, 1e-4);

  Bar upon = bar;
  upon.joints += R"(, "c": {"type": "fixed", "bodies": ["upon", "top"], "at": [1.6, 0.1, 0]})";
  upon.loads = force_on("upon");
  upon.bodies += rigid("upon", "[1.7, 0, 0]");
  EXPECT_NEAR(share_of(upon), 0.5, 1e-4);

  Bar beam = bar;
  beam.bodies = R"(, "top": {"type": "beam", "from": [1.2, 0, 0], "to": [1.9, 0, 0],
    "material": "light", "elements": 2, "rigid": true, "section": {"type": "circle", "diameter": 0.01}})";
  EXPECT_NEAR(share_of(beam), 0.5, 1e-4);

  Bar weight = bar;
  weight.loads = "";
  weight.bodies = fmt::format(R"(, "top": {{"type": "rigid", "at": [{}, 0, 0], "mass": {},
                                  "inertia": [1, 1, 1, 0, 0, 0]}})",
                              length + d, press / 10.0);
  ProblemFile problem = problem_of(weight);
  problem.scene.gravity = {-10.0, 0.0, 0.0};
  EXPECT_NEAR(analyze(problem, start_design(problem))->reductions[0].value, 0.5, 1e-4);
}

/// An end that a joint of the bar holds along its axis has its force there, whatever else is on it.
TEST(LateralBucklingResponse, OfAPinnedEndIsNotChangedByABodyOnIt) {
  const std::string joints =
      R"("u": {"type": "universal", "bodies": ["ground", "bar"], "at": [0, 0, 0],
               "axis": [0, 0, 1], "second_axis": [0, 1, 0]},
         "l": {"type": "point-on-line", "bodies": ["ground", "bar"], "at": [1.2, 0, 0], "axis": [1, 0, 0]})";
  Bar bar{joints, force(0.5 * euler, "[-1, 0, 0]"), space};
  EXPECT_NEAR(share_of(bar), 0.5, 1e-4);
  bar.joints += R"(, "w": {"type": "fixed", "bodies": ["bar", "weight"], "at": [0, 0, 0]})";
  bar.bodies = rigid("weight", "[-0.3, 0, 0]");
  EXPECT_NEAR(share_of(bar), 0.5, 1e-4);
}

/// Two joints of an eye at different distances hold its slope: two clamped ends, 4π² EI/L².
TEST(LateralBucklingResponse, OfEyesThatAreHeldTwiceIsThatOfClampedEnds) {
  Bar bar = strut_in_eyes("-0.12", "1.32", 2.0 * euler);
  bar.joints += R"(, "m": {"type": "point-on-line", "bodies": ["ground", "left"],
                           "at": [-0.4, 0, 0], "axis": [1, 0, 0]},
                     "n": {"type": "point-on-line", "bodies": ["ground", "right"],
                           "at": [1.6, 0, 0], "axis": [1, 0, 0]})";
  EXPECT_NEAR(share_of(bar), 0.5, 1e-4);
}

/// What hangs on the tip of a column holds nothing, however it hangs there.
TEST(LateralBucklingResponse, OfAColumnIsNotChangedByWhatItsTipCarries) {
  const std::string pod =
      R"(, "p": {"type": "fixed", "bodies": ["bar", "pod"], "at": [1.2, 0, 0]})";
  const std::string payload =
      R"(, "q": {"type": "spherical", "bodies": ["pod", "payload"], "at": [1.2, 0, 0]})";
  Bar bar{clamp + pod + payload, force(0.1 * euler, "[-1, 0, 0]"), space};
  bar.bodies = rigid("pod", "[1.2, 0, 0]") +
               R"(, "payload": {"type": "point-mass", "at": [1.2, 0, 0], "mass": 1e-3})";
  EXPECT_NEAR(share_of(bar), 0.4, 1e-4);
}

/// A square bar whose end slides across it goes along its line, be it along an axis of the section or
/// between both.
TEST(LateralBucklingResponse, OfASquareBarOnALineIsTheSameHoweverTheLineIsTurned) {
  const auto share_on_line = [&](const char* axis) {
    const std::string line = fmt::format(
        R"(, "l": {{"type": "point-on-line", "bodies": ["ground", "bar"], "at": [1.2, 0, 0], "axis": {}}})",
        axis);
    // Half of the force presses the first half of the bar, the other half pulls at the second.
    const std::string middle =
        R"("f": {"type": "force", "body": "bar", "at": [0.6, 0, 0], "direction": [-1, 0, 0], "value": 1000})";
    const ProblemFile problem = problem_of({clamp + line, middle, space});
    return analyze(problem, Eigen::Vector2d(0.01, 0.01))->reductions[0].value;
  };
  const double along_axis = share_on_line("[0, 0, 1]");
  EXPECT_GT(along_axis, 0.1);
  EXPECT_NEAR(share_on_line("[0, 1, 1]") / along_axis, 1.0, 1e-6);
  EXPECT_NEAR(share_on_line("[0, 1, 2]") / along_axis, 1.0, 1e-6);
}

/// The gradient of nothing is nothing.
TEST(LateralBucklingResponse, HasNoGradientWhereNothingBuckles) {
  const auto analysis = analysis_of({clamp, force(10.0, "[1, 0, 0]"), R"("spatial_motion": "on")"});
  EXPECT_EQ(direct_gradients(*analysis), Eigen::MatrixXd::Zero(1, 2));
}

/// However many frames the beam has, and of a reduced one what its modes make. 3e-3: frames that turn
/// with the bar see an axial force F sin θ, which presses with F θ/P = 3e-3 of its Euler load.
TEST(LateralBucklingResponse, OfADividedOrReducedBeamIsThatOfTheWhole) {
  const Bar bar{clamp, force(0.5 * tip_critical, "[0, -1, 0]")};
  const double whole = share_of(bar);
  for (const char* body :
       {R"(, "frames": 2)", R"(, "frames": 4)", R"(, "reduction": {"modes": 2})"}) {
    Bar other = bar;
    other.body = body;
    EXPECT_NEAR(share_of(other) / whole, 1.0, 3e-3) << body;
  }
}

TEST(LateralBucklingResponse, IsWhatTheDoubtTells) {
  const ProblemFile problem = problem_of({clamp, force(0.8 * tip_critical, "[0, -1, 0]")});
  const double share = analyze(problem, start_design(problem))->reductions[0].value;
  const std::vector<Finding> findings = test::findings_of(problem, check_sideways_buckling);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NE(findings[0].text.find(fmt::format("critical load is {:.3g} times", 1.0 / share)),
            std::string::npos)
      << findings[0].text;
}

/// A bar that swings under its weight and a force that turns: N and M change in time, in the plane
/// and in space, whole, divided and reduced.
class GradientsOfLateralBuckling
    : public testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  static ProblemFile swinging() {
    const auto& [effects, body] = GetParam();
    Bar bar{R"("hinge": {"type": "revolute", "bodies": ["ground", "bar"], "at": [0, 0, 0],
                         "axis": [0, 0, 1], "drive": {"type": "ramp-to-speed", "speed": 8, "ramp": "20 ms"}})",
            force(3.0, "[-1, -2, 0]"), effects, body, 6};
    ProblemFile problem = problem_of(bar);
    problem.simulation.end_time = 0.02;
    problem.scene.materials[0].density = 7850.0;
    for (const OverTime kind : {OverTime::rms, OverTime::mean, OverTime::final}) {
      ResponseSettings more = problem.responses[0];
      more.name = fmt::format("share {}", static_cast<int>(kind));
      more.over_time = kind;
      problem.responses.push_back(more);
    }
    return problem;
  }
};

TEST_P(GradientsOfLateralBuckling, OfBothMethodsAndOfDifferencesAgree) {
  const auto [problem, x, analysis] = AtStart(swinging());
  for (const Reduction& reduction : analysis->reductions) EXPECT_GT(reduction.value, 0.01);
  const Eigen::MatrixXd direct =
      gradients(problem, x, *analysis, GradientMethod::direct) * x.asDiagonal();
  const Eigen::MatrixXd adjoint =
      gradients(problem, x, *analysis, GradientMethod::adjoint) * x.asDiagonal();
  const Eigen::MatrixXd wide = central_differences(problem, x, 2e-3) * x.asDiagonal();
  const Eigen::MatrixXd narrow = central_differences(problem, x, 1e-3) * x.asDiagonal();
  const Eigen::MatrixXd differences = (4.0 * narrow - wide) / 3.0;
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const double scale = direct.row(i).lpNorm<Eigen::Infinity>();
    const auto error = [&](const Eigen::MatrixXd& other) {
      return (other - direct).row(i).lpNorm<Eigen::Infinity>() / scale;
    };
    EXPECT_LT(error(adjoint), 1e-10) << problem.responses[i].name;
    EXPECT_LT(error(differences), 1e-6) << problem.responses[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, GradientsOfLateralBuckling,
    testing::Values(std::pair(R"("geometric_stiffening": "off")", ""),
                    std::pair(R"("geometric_stiffening": "on")", ""),
                    std::pair(R"("spatial_motion": "on")", ""), std::pair("", R"(, "frames": 2)"),
                    std::pair("", R"(, "reduction": {"modes": 2})")),
    named_by([](const auto& body) { return std::string(body.first) + body.second; }));

/// Eyes, and a body on a mast, whose lengths are variables as the section is.
TEST(GradientsOfFittings, OfBothMethodsAndOfDifferencesAgree) {
  const Bar strut = strut_in_eyes("\"= -40*b\"", "\"= 1.2 m + 60*b\"", 0.3 * euler);
  Bar mast{clamp + R"(, "b": {"type": "fixed", "bodies": ["bar", "top"], "at": [1.2, 0, 0]})",
           R"("f": {"type": "force", "body": "top", "at": ["= 1.2 m + 10*h", 0, 0],
                    "direction": [-1, 1, 0], "value": 3})"};
  mast.bodies = rigid("top", "[1.5, 0, 0]");
  for (const Bar& bar : {strut, mast}) {
    const auto [problem, x, analysis] = AtStart(problem_of(bar));
    EXPECT_GT(analysis->reductions[0].value, 0.1);
    const auto scaled = [&x = x](const Eigen::MatrixXd& slopes) {
      return Eigen::MatrixXd(slopes * x.asDiagonal());
    };
    const Eigen::MatrixXd direct = scaled(gradients(problem, x, *analysis, GradientMethod::direct));
    const Eigen::MatrixXd adjoint =
        scaled(gradients(problem, x, *analysis, GradientMethod::adjoint));
    const Eigen::MatrixXd wide = scaled(central_differences(problem, x, 2e-3));
    const Eigen::MatrixXd narrow = scaled(central_differences(problem, x, 1e-3));
    const double scale = direct.lpNorm<Eigen::Infinity>();
    EXPECT_LT((adjoint - direct).lpNorm<Eigen::Infinity>(), 1e-10 * scale);
    EXPECT_LT(((4.0 * narrow - wide) / 3.0 - direct).lpNorm<Eigen::Infinity>(), 1e-6 * scale);
  }
}

/// The pendulum swings about its ball without bending: against its own motion it is clamped there.
TEST(LateralBucklingResponse, OfAPendulumIsThatOfACantilever) {
  const std::string ball =
      R"("ball": {"type": "spherical", "bodies": ["ground", "bar"], "at": [0, 0, 0]})";
  const std::string press = force(0.1 * euler, "[-1, 0, 0]");
  EXPECT_NEAR(share_of({ball, press, space}), share_of({clamp, press, space}), 1e-6);
}

/// With a rigid body on its tip it is the cantilever with that body: P = (u/L)² EI, u tan u = L/d.
TEST(LateralBucklingResponse, OfAPendulumWithARigidTipIsThatOfACantilever) {
  const double d = 0.25 * length, u = angle_of(length / d);
  for (const char* pivot : {R"("type": "spherical")", R"("type": "revolute", "axis": [0, 1, 0])"}) {
    Bar bar{fmt::format(R"("pivot": {{{}, "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
                           "weld": {{"type": "fixed", "bodies": ["bar", "tip"], "at": [1.2, 0, 0]}})",
                        pivot),
            fmt::format(R"("f": {{"type": "force", "body": "tip", "at": [{}, 0, 0],
                                  "direction": [-1, 0, 0], "value": {}}})",
                        length + d, 0.5 * std::pow(u / length, 2) * lateral),
            space};
    bar.bodies = rigid("tip", "[1.3, 0, 0]");
    EXPECT_NEAR(share_of(bar), 0.5, 1e-4) << pivot;
  }
}

TEST(LateralBucklingResponse, IsRefusedWhereNoJointHoldsTheBeam) {
  const std::string said = thrown<InputError>([&] { analysis_of({"", force(1.0, "[1, 0, 0]")}); });
  EXPECT_NE(std::string(said).find("\"share\""), std::string::npos) << said;
  EXPECT_NE(std::string(said).find("no joint holds"), std::string::npos);
}

}  // namespace
}  // namespace pleuel::test::lateral_buckling_signal_test
