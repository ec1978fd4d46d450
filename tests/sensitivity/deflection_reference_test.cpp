#include "core/base/eager_matrices.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "sensitivity/sampled_gradients.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::deflection_reference_test {
namespace {

constexpr double ramp = 0.05, speed = 200.0;

/// The slider-crank with a rod whose frame is given, and deflections against everything.
ProblemFile problem_with(const std::string& rod_frame) {
  ProblemFile problem = sample_problem(
      "slider_crank",
      {"/simulation/end_time=0.06 s", "/simulation/step=1e-4 s", "/scene/bodies/crank/elements=3",
       "/scene/bodies/rod/elements=4", "/scene/bodies/rod/frame=" + rod_frame,
       "/variables/crank_height/start=18 mm",
       R"(/responses/bow_from_frame={"type": "deflection", "body": "rod", "at": 0.5,
            "over_time": "rms"})",
       R"(/responses/bow_from_chord={"type": "deflection", "body": "rod", "at": 0.5,
            "against": "chord", "over_time": "rms"})",
       R"(/responses/tip_from_frame={"type": "deflection", "body": "crank", "at": 1,
            "over_time": "rms"})",
       R"(/responses/tip_from_rigid_x={"type": "deflection", "body": "crank", "at": 1,
            "against": "rigid-mechanism", "direction": "x", "over_time": "rms"})",
       R"(/responses/tip_from_rigid_y={"type": "deflection", "body": "crank", "at": 1,
            "against": "rigid-mechanism", "direction": "y", "over_time": "max-abs"})"});
  problem.simulation.newton_tolerance = 1e-12;
  return problem;
}

struct Simulated {
  ProblemFile problem;
  std::unique_ptr<Analysis> analysis;

  explicit Simulated(const std::string& rod_frame)
      : problem(problem_with(rod_frame)), analysis(analyze(problem, start_design(problem))) {}

  Eigen::VectorXd history(const std::string& response) const {
    return analysis->histories[response_index(problem, response)].row(0);
  }
};

/// ∫∫(Ω/T)(1 − cos 2πt/T), then Ω t
double crank_angle(double t) {
  const double pi = std::acos(-1.0), w = 2.0 * pi / ramp;
  if (t >= ramp) return speed * (t - 0.5 * ramp);
  return speed / ramp * (t * t / 2.0 - (1.0 - std::cos(w * t)) / (w * w));
}

TEST(DeflectionAgainstTheChord, IsThatInAChordFrame) {
  const Simulated run("chord");
  const Eigen::VectorXd frame = run.history("bow_from_frame"),
                        chord = run.history("bow_from_chord");
  EXPECT_GT(frame.lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_LE((frame - chord).lpNorm<Eigen::Infinity>(), 1e-15);
}

/// Two frames differ by what is of second order: some δ/L = 1e-3 of the deflection.
TEST(DeflectionAgainstTheChord, IsThatOfATangentFrame) {
  const Simulated chord("chord"), tangent("tangent");
  const Eigen::VectorXd expected = chord.history("bow_from_chord"),
                        found = tangent.history("bow_from_chord");
  const double size = expected.lpNorm<Eigen::Infinity>();
  EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(), 2e-3 * size);
  EXPECT_GE((tangent.history("bow_from_frame") - expected).lpNorm<Eigen::Infinity>(), 0.5 * size);
}

/// The hub of the crank is prescribed, so the rigid crank is at R(φ) (0.12, 0), and the local y
/// component of the difference is the deflection in the tangent frame.
TEST(DeflectionAgainstTheRigidMechanism, IsThatFromThePrescribedMotion) {
  const Simulated run("chord");
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
       R"(/responses/tip={"type": "position", "body": "crank", "at": 1, "direction": "y",
            "over_time": "final"})"});
  problem.simulation.newton_tolerance = 1e-12;
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
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
  const Simulated run("tangent");
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

struct Found {
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;  ///< a row each response
};

Found found_of(const std::string& text, const Eigen::VectorXd* x = nullptr) {
  const ProblemFile problem = problem_from(text, {});
  const auto analysis = analyze(problem, x != nullptr ? *x : start_design(problem));
  return {values_of(*analysis), direct_gradients(*analysis)};
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
    "responses": {{"mu": {{"type": "transmission-angle", "body": "rod", "joint": "guide",
                         "over_time": "min"}},
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
}  // namespace pleuel::test::deflection_reference_test
