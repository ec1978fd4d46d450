#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "core/response/effect_measurement.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/core/trust/findings_of.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

/// Natural frequencies and buckling of members that move in a plane: what is out of it counts.
namespace pleuel::test::full_modes_test {
namespace {

using test::findings_of;
using test::read_scene;

constexpr double young = 2.1e11, poisson = 0.3, density = 7850.0, length = 0.8;
constexpr double width = 0.01, height = 0.03;  // along z, out of the plane, and along y
const double pi = std::numbers::pi;

/// A cantilever in the x–y plane with so many modes asked for.
std::string cantilever(const std::string& section, const std::string& effects, int modes,
                       const std::string& more_of_body = "") {
  std::string responses;
  for (int mode = 1; mode <= modes; ++mode) {
    responses += fmt::format(
        R"("m{0}": {{"type": "frequency", "mode": {0}}},
           "b{0}": {{"type": "frequency", "body": "b", "mode": {0}}}{1})",
        mode, mode < modes ? "," : "");
  }
  return fmt::format(
      R"({{"scene": {{
            "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
            "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "m",
                             "section": {}, "elements": 12{}}}}},
            "joints": {{"c": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0],
                             "drive": {{"type": "polynomial", "coefficients": [0]}}}}}}}},
          "effects": {},
          "simulation": {{"end_time": 1e-3, "step": 1e-3}},
          "responses": {{{}}}}})",
      section, more_of_body, effects, responses);
}

Eigen::VectorXd values(const std::string& text) {
  ProblemFile problem = problem_from(text);
  decide_effects(problem);
  return values_of(*analyze(problem, start_design(problem)));
}

const std::string rectangle = R"({"type": "rectangle", "width": 0.01, "height": 0.03})";

/// (βL)² of a cantilever: cos βL cosh βL = −1.
double bending_frequency(double number, double thickness) {
  return number / (length * length) * std::sqrt(young * thickness * thickness / 12.0 / density);
}

/// Twelve cubic elements: some 1e-6; rotary inertia takes ½ (βr)², 1e-3 of the third over the
/// height.
TEST(FrequencyOfAPlanarMechanism, HasTheBendingOutOfThePlane) {
  const Eigen::VectorXd found = values(cantilever(rectangle, "{}", 4));
  const double expected[] = {
      bending_frequency(3.516015268500151, width), bending_frequency(3.516015268500151, height),
      bending_frequency(22.034491564666766, width), bending_frequency(61.697214413549105, width)};
  for (int mode = 0; mode < 4; ++mode) {
    EXPECT_NEAR(found(2 * mode) / expected[mode], 1.0, 2e-3) << mode;
    EXPECT_NEAR(found(2 * mode) / found(2 * mode + 1), 1.0, 1e-7) << "the body's, " << mode;
  }
}

/// (2n − 1) π/2 √(G J/ρ I_p)/L of torsion and √(E/ρ) of stretching, 1e-3 each by twelve linear
/// elements.
TEST(FrequencyOfAPlanarMechanism, HasTorsionAndStretching) {
  // A tube is stiff in bending: its torsion comes early. J = I_p.
  const std::string tube = R"({"type": "tube", "outer_diameter": 0.2, "thickness": 0.002})";
  const Eigen::VectorXd found = values(cantilever(tube, "{}", 6));
  const double twist = pi / 2 / length * std::sqrt(young / (2 * (1 + poisson)) / density);
  const double stretch = pi / 2 / length * std::sqrt(young / density);
  const auto has = [&](double frequency) {
    return (found.array() / frequency - 1.0).abs().minCoeff() < 1e-3;
  };
  EXPECT_TRUE(has(twist)) << found.transpose();
  EXPECT_TRUE(has(stretch)) << found.transpose();
}

/// Whatever takes part in the motion. 1e-7: round-off of eigenvalues over five orders.
TEST(FrequencyOfAMechanism, IsTheSameWhateverEffectsLeaveOutOfTheMotion) {
  const Eigen::VectorXd expected = values(cantilever(rectangle, R"({"spatial_motion": "on"})", 10));
  for (const char* effects :
       {"{}", R"({"spatial_motion": "on", "torsional_elasticity": "off"})",
        R"({"axial_elasticity": "off"})", R"({"tolerance": 0.5})", R"({"tolerance": 1e-6})"}) {
    const Eigen::VectorXd found = values(cantilever(rectangle, effects, 10));
    EXPECT_LE((found.array() / expected.array() - 1.0).abs().maxCoeff(), 1e-7) << effects;
  }
  const Eigen::VectorXd reduced =
      values(cantilever(rectangle, "{}", 10, R"(, "reduction": {"modes": 2})"));
  EXPECT_LE((reduced.array() / expected.array() - 1.0).abs().maxCoeff(), 1e-7);
}

/// A round section bends alike in both planes: each frequency comes twice, and the gradient is that
/// of both. ω ~ d/L² without rotary inertia.
TEST(FrequencyOfAMechanism, OfARoundSectionComesTwiceWithOneGradient) {
  std::string text = cantilever(R"({"type": "circle", "diameter": {"variable": "d"}})",
                                R"({"rotary_inertia": "off"})", 4);
  text.insert(1, R"("variables": {"d": {"start": 0.02, "lower": 0.01, "upper": 0.03}},)");
  const ProblemFile problem = problem_from(text);
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::VectorXd found = values_of(*analysis);
  const Eigen::MatrixXd gradient = direct_gradients(*analysis);
  EXPECT_NEAR(found(0) / found(2), 1.0, 1e-7);
  EXPECT_NEAR(found(4) / found(6), 1.0, 1e-7);
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(gradient(i, 0) * 0.02 / found(i), 1.0, 1e-6) << i;
  }
}

/// ω ~ b/L² for bending over the width, out of the plane: nothing moves there, and the gradient is
/// exact.
TEST(FrequencyOfAPlanarMechanism, HasTheGradientOfTheModeOutOfThePlane) {
  std::string text = cantilever(
      R"({"type": "rectangle", "width": {"variable": "b"}, "height": {"variable": "h"}})",
      R"({"rotary_inertia": "off"})", 1);
  text.insert(1, R"("variables": {"b": {"start": 0.01, "lower": 0.005, "upper": 0.03},
                                  "h": {"start": 0.03, "lower": 0.005, "upper": 0.05}},)");
  const ProblemFile problem = problem_from(text);
  const auto analysis = analyze(problem, start_design(problem));
  const Eigen::MatrixXd gradient = direct_gradients(*analysis);
  for (Eigen::Index i = 0; i < 2; ++i) {
    const double value = values_of(*analysis)(i);
    EXPECT_NEAR(gradient(i, 0) * 0.01 / value, 1.0, 1e-6);
    EXPECT_NEAR(gradient(i, 1) * 0.03 / value, 0.0, 1e-6);
  }
}

/// The six lowest of a four-bar of elastic members, in its plane and out of it, at rest and
/// stressed: differences of fourth order of whole analyses, 1e-7 of each frequency. The same with
/// members that leave something out of the motion.
TEST(FrequencyOfAMechanism, HasTheGradientOfDifferences) {
  for (const char* start : {"consistent", "quasi-static"}) {
    for (const char* effects : {"{}", R"({"axial_elasticity": "off"})"}) {
      std::vector<std::string> overrides = {
          "/simulation/end_time=0.2 ms",
          "/constraints={}",
          std::string("/effects=") + effects,
          std::string("/simulation/initial_state=") + start,
          "/objective/minimize=f1",
          R"(/scene/bodies/coupler/section/width={"variable": "width"})",
          R"(/variables/width={"start": "8 mm", "lower": "4 mm", "upper": "12 mm"})"};
      std::string responses = "/responses={";
      for (int mode = 1; mode <= 6; ++mode) {
        responses += fmt::format(R"({}"f{}": {{"type": "frequency", "mode": {}}})",
                                 mode > 1 ? ", " : "", mode, mode);
      }
      overrides.push_back(responses + "}");
      ProblemFile problem = sample_problem("four_bar", overrides);
      problem.simulation.newton_tolerance = 1e-13;
      const Eigen::VectorXd x = start_design(problem);
      const auto analysis = analyze(problem, x);
      const Eigen::VectorXd found = values_of(*analysis);
      ASSERT_EQ(found.size(), 6);
      for (Eigen::Index i = 1; i < 6; ++i) EXPECT_GT(found(i), 1.001 * found(i - 1));
      const Eigen::MatrixXd direct = direct_gradients(*analysis) * x.asDiagonal();
      const Eigen::MatrixXd wide = central_differences(problem, x, 4e-3) * x.asDiagonal();
      const Eigen::MatrixXd narrow = central_differences(problem, x, 2e-3) * x.asDiagonal();
      const Eigen::MatrixXd error = (4.0 * narrow - wide) / 3.0 - direct;
      for (Eigen::Index i = 0; i < 6; ++i) {
        EXPECT_LE(error.row(i).lpNorm<Eigen::Infinity>(), 1e-7 * found(i))
            << "mode " << i + 1 << ", " << start << ", " << effects;
        EXPECT_GT(direct.row(i).lpNorm<Eigen::Infinity>(), 1e-2 * found(i));
      }
    }
  }
}

/// A rod between two pins, pressed: −N/P_E about the weaker axis, whatever the motion has.
TEST(Buckling, IsAboutTheWeakerAxisAlsoInThePlane) {
  const auto pressed = [](const std::string& effects) {
    return fmt::format(R"({{"scene": {{
        "materials": {{"m": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
        "bodies": {{"b": {{"type": "beam", "from": [0, 0, 0], "to": [0.8, 0, 0], "material": "m",
                         "section": {{"type": "i", "width": 0.02, "height": 0.04,
                                     "flange_thickness": 0.002, "web_thickness": 0.002}},
                         "elements": 4, "frame": "chord"}},
                  "s": {{"type": "point-mass", "at": [0.8, 0, 0], "mass": 0.1}}}},
        "joints": {{"a": {{"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]}},
                  "c": {{"type": "revolute", "bodies": ["b", "s"], "at": [0.8, 0, 0]}},
                  "g": {{"type": "point-on-line", "bodies": ["ground", "s"], "at": [0.8, 0, 0],
                       "axis": [1, 0, 0]}}}},
        "loads": {{"f": {{"type": "force", "body": "s", "at": [0.8, 0, 0], "direction": [-1, 0, 0],
                        "value": 300}}}}}},
        "effects": {},
        "simulation": {{"end_time": 1e-4, "step": 1e-4, "initial_state": "quasi-static"}},
        "responses": {{"n": {{"type": "buckling", "body": "b", "over_time": "max"}}}}}})",
                       effects);
  };
  // Two flanges and a web: I about the web's plane.
  const double inertia = 2 * 0.002 * std::pow(0.02, 3) / 12 + 0.036 * std::pow(0.002, 3) / 12;
  const double euler = pi * pi * young * inertia / (length * length);
  for (const char* effects : {"{}", R"({"spatial_motion": "on"})"}) {
    EXPECT_NEAR(values(pressed(effects))(0) * euler / 300.0, 1.0, 1e-6) << effects;
  }
}

std::string pendulum(const std::string& gravity) {
  return fmt::format(R"({{"scene": {{"gravity": {},
      "bodies": {{"bob": {{"type": "rigid", "at": [0, 0.4, 0], "mass": 0.7,
                         "inertia": [0, 0, 0.03, 0, 0, 0]}}}},
      "joints": {{"j": {{"type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 0]}}}}}},
      "simulation": {{"end_time": 1e-3, "step": 1e-3}},
      "responses": {{"f": {{"type": "frequency"}}}}}})",
                     gravity);
}

/// γ² = m g L/(I + m L²): upside down it falls as exp(γt).
TEST(FrequencyOfAMechanism, OfAnUnstableModeIsNegativeAndMentioned) {
  const double expected = std::sqrt(0.7 * 9.81 * 0.4 / (0.03 + 0.7 * 0.16));
  const std::string text = pendulum("[0, -9.81, 0]");
  EXPECT_NEAR(values(text)(0), -expected, 1e-8);
  EXPECT_NEAR(values(pendulum("[0, 9.81, 0]"))(0), expected, 1e-8);
  const std::vector<Finding> findings = findings_of(read_scene(text));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].text.find("is unstable where it starts"), std::string::npos);
  EXPECT_EQ(findings[0].responses, std::vector<std::string>{"f"});
  EXPECT_TRUE(findings_of(read_scene(pendulum("[0, 9.81, 0]"))).empty());
}

/// η = Ω √(ρAL⁴/EI) = 4 lifts the first flap frequency from λ = 3.516 to 5.585 (Wright et al.
/// 1982), which a start of undeformed members does not have.
TEST(FrequencyOfAMechanism, OfARotatingBeamHasItsStressHoweverItStarts) {
  const double radius = std::sqrt(width * width / 12.0);  // thin out of the plane: flap
  const double unit = 1.0 / (length * length) * std::sqrt(young / density) * radius;
  const auto rotating = [&](const std::string& start, double eta = 4.0) {
    std::string text = cantilever(rectangle, "{}", 1);
    const auto replace = [&](const std::string& from, const std::string& to) {
      text.replace(text.find(from), from.size(), to);
    };
    replace(R"({"type": "polynomial", "coefficients": [0]})",
            fmt::format(R"({{"type": "constant-speed", "speed": {:.12g}}})", eta * unit));
    replace(R"("step": 1e-3)", R"("step": 1e-3, "initial_state": ")" + start + "\"");
    return text;
  };
  for (const char* start : {"quasi-static", "consistent"}) {
    EXPECT_NEAR(values(rotating(start))(0) / unit, 5.585001, 5e-3 * 5.585) << start;
  }
}

/// A clamp that is there twice holds as once.
TEST(FrequencyOfAMechanism, IsThatWithoutItsRedundantConstraints) {
  const std::string once = cantilever(rectangle, "{}", 3);
  std::string twice = once;
  const std::string joints = R"("joints": {)";
  twice.insert(twice.find(joints) + joints.size(),
               R"("again": {"type": "revolute", "bodies": ["ground", "b"], "at": [0, 0, 0]},)");
  const Eigen::VectorXd expected = values(once), found = values(twice);
  EXPECT_LE((found.array() / expected.array() - 1.0).abs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace pleuel::test::full_modes_test
