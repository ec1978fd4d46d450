#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/design/design_solve.hpp"
#include "optimization/design/peak_problem.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/problems/loaded_crank.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::lateral_limit_test {
namespace {

// A limit on lateral buckling decides an optimum.

constexpr double length = 1.2, height = 0.04, force = 10.0, young = 2.1e11, shear = 8.0e10,
                 density = 7850.0;

/// A flat bar on edge, clamped at one end, with a force across at the other.
ProblemFile flat_bar() {
  return problem_from(R"j({"scene": {
    "materials": {"steel": {"young": "210 GPa", "poisson": 0.3125, "density": 7850, "strength": "235 MPa"}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [1.2, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": {"variable": "b"}, "height": "40 mm"}, "elements": 16}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {"f": {"type": "force", "body": "bar", "at": [1.2, 0, 0], "direction": [0, -1, 0], "value": "10 N"}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static", "resolution_check": false},
  "variables": {"b": {"start": "5 mm", "lower": "0.5 mm", "upper": "20 mm"}},
  "responses": {"mass": {"type": "mass"},
    "stress": {"type": "stress", "body": "bar", "part": "utilization", "over_time": "max"},
    "sideways": {"type": "lateral-buckling", "body": "bar", "over_time": "max"}},
  "objective": {"minimize": "mass"},
  "constraints": {"stress": {"response": "stress", "upper": 0.5},
                  "sideways": {"response": "sideways", "upper": 0.5}}})j");
}

/// F/F_cr with F_cr = 4.0126 √(EI GJ)/L² (Timoshenko & Gere, §6.3), J = hb³/3 (1 − 0.63 b/h), over
/// √(1 − EI/EI_bending).
double closed_form(double b) {
  const double cube = height * b * b * b;
  const double lateral = young * cube / 12, twisting = shear * cube / 3 * (1 - 0.63 * b / height);
  const double held = std::sqrt(1 - b * b / (height * height));
  return force * held * length * length / (4.0126 * std::sqrt(lateral * twisting));
}

/// The share falls as b⁻³: an error of 1e-3 of sixteen elements is a third of that in b. Stress alone
/// would be content with 0.4 mm.
TEST(LateralLimit, SizesAFlatBar) {
  const Result result = verified_optimum(flat_bar(), SolveOptions());
  double low = 1e-4, high = 0.02;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (closed_form(middle) > 0.5 ? low : high) = middle;
  }
  EXPECT_NEAR(result.x(0) / low, 1.0, 1e-3);
  EXPECT_NEAR(result.evaluation.objective, density * height * result.x(0) * length, 1e-9);
  const double stress = force * length / (result.x(0) * height * height / 6);
  EXPECT_LT(stress, 0.5 * 235e6);
}

constexpr double strut_length = 1.0, press = 1e4;

/// A strut between a universal joint and a line, b wide along z and h high along y, with a limit on
/// its buckling. In space.
ProblemFile strut(const std::string& response, const std::string& over_time = "max") {
  return problem_from(R"j({"scene": {
    "materials": {"steel": {"young": "210 GPa", "poisson": 0.3125, "density": 7850}},
    "bodies": {"strut": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
      "section": {"type": "rectangle", "width": {"variable": "b"}, "height": {"variable": "h"}}, "elements": 8}},
    "joints": {
      "foot": {"type": "universal", "bodies": ["ground", "strut"], "at": [0, 0, 0],
               "axis": [0, 0, 1], "second_axis": [0, 1, 0]},
      "head": {"type": "point-on-line", "bodies": ["ground", "strut"], "at": [1, 0, 0], "axis": [1, 0, 0]}},
    "loads": {"press": {"type": "force", "body": "strut", "at": [1, 0, 0],
                        "direction": [-1, 0, 0], "value": "10 kN"}}},
  "effects": {"spatial_motion": "on", "geometric_stiffening": "off"},
  "simulation": {"end_time": "4 ms", "step": "1 ms", "initial_state": "quasi-static", "resolution_check": false},
  "variables": {"b": {"start": "20 mm", "lower": "5 mm", "upper": "60 mm"},
                "h": {"start": "40 mm", "lower": "5 mm", "upper": "60 mm"}},
  "responses": {"mass": {"type": "mass"},
    "share": {"type": ")j" +
                      response + R"(", "body": "strut", "over_time": ")" + over_time + R"("}},
  "objective": {"minimize": "mass"},
  "constraints": {"share": {"response": "share", "upper": 0.5}}})");
}

/// P/P_E with P_E = π² E I/L², I = across thick³/12.
double euler_share(double thick, double across) {
  const double inertia = across * std::pow(thick, 3) / 12;
  return press * strut_length * strut_length /
         (std::numbers::pi * std::numbers::pi * young * inertia);
}

class BucklingInBothPlanes : public testing::TestWithParam<const char*> {};

/// Both shares ½, b³h = bh³: a square with a⁴ = 12 P L²/(½ π² E). The lightest one: below it, one of
/// the shares is larger.
TEST_P(BucklingInBothPlanes, MakesAStrutSquare) {
  const double side = 0.01 * std::pow(euler_share(0.01, 0.01) / 0.5, 0.25);
  for (const char* backend : {"nlopt-slsqp", "ipopt"}) {
    DesignProblem design(strut(GetParam()));
    const Result result = solve_design(design, {.backend = backend});
    EXPECT_EQ(result.status, Status::verified) << backend << ": " << result.message;
    EXPECT_NEAR(result.x(0) / side, 1.0, 2e-4) << backend;
    EXPECT_NEAR(result.x(1) / side, 1.0, 2e-4) << backend;
    EXPECT_NEAR(result.evaluation.objective / (density * side * side * strut_length), 1.0, 1e-4);
  }
}

/// One limit is a row for each plane and window; each has the share of its plane, with the slopes of
/// 1/(thick³ across).
TEST_P(BucklingInBothPlanes, AreRowsOfTheirOwn) {
  DesignProblem design(strut(GetParam()));
  const ResponseSettings& share = design.file().responses[1];
  EXPECT_EQ(place_count(design.file(), share), 2);
  PeakProblem peaks(design, 1);
  for (const Eigen::Vector2d& x :
       {Eigen::Vector2d(0.02, 0.03), Eigen::Vector2d(0.03, 0.02), Eigen::Vector2d(0.02, 0.02)}) {
    const Evaluation rows = peaks.evaluate(x, Request::values_and_gradients);
    ASSERT_EQ(rows.constraints.size(), 2);
    const double b = x(0), h = x(1), along_z = euler_share(b, h), along_y = euler_share(h, b);
    const bool is_z_first =
        std::abs(rows.constraint_jacobian(0, 0) * b) > std::abs(rows.constraint_jacobian(0, 1) * h);
    const Eigen::Index z = is_z_first ? 0 : 1, y = 1 - z;
    EXPECT_NEAR(rows.constraints(z) / along_z, 1.0, 1e-4);
    EXPECT_NEAR(rows.constraints(y) / along_y, 1.0, 1e-4);
    const Eigen::MatrixXd slopes = rows.constraint_jacobian * x.asDiagonal();
    EXPECT_LT((slopes.row(z) / along_z - Eigen::RowVector2d(-3, -1)).norm(), 1e-3);
    EXPECT_LT((slopes.row(y) / along_y - Eigen::RowVector2d(-1, -3)).norm(), 1e-3);
    for (Eigen::Index variable = 0; variable < 2; ++variable) {
      const Eigen::Vector2d step = 1e-4 * x(variable) * Eigen::Vector2d::Unit(variable);
      const Eigen::Vector2d difference = (peaks.evaluate(x + step, Request::values).constraints -
                                          peaks.evaluate(x - step, Request::values).constraints) /
                                         2e-4;
      EXPECT_LT((difference - slopes.col(variable)).norm(), 1e-6 * slopes.norm());
    }
  }
}

/// What is no peak is that of the weaker plane at each instant: here all the time the same.
TEST_P(BucklingInBothPlanes, CountByTheWorseAtEachInstant) {
  for (const char* over_time : {"max", "max-abs", "min", "mean", "rms", "final"}) {
    const ProblemFile file = strut(GetParam(), over_time);
    for (const Eigen::Vector2d& x : {Eigen::Vector2d(0.02, 0.03), Eigen::Vector2d(0.03, 0.02)}) {
      EXPECT_NEAR(analyze(file, x)->reductions[1].value / euler_share(0.02, 0.03), 1.0, 1e-4)
          << over_time;
    }
    const bool is_divided = std::string(over_time).starts_with("max");
    EXPECT_EQ(place_count(file, file.responses[1]), is_divided ? 2 : 1) << over_time;
  }
}

INSTANTIATE_TEST_SUITE_P(Responses, BucklingInBothPlanes,
                         testing::Values("lateral-buckling", "buckling"), named_by_value());

TEST(LateralLimit, HasOnePlaceInAPlane) {
  ProblemFile file = flat_bar();
  const ResponseSettings& sideways = file.responses[2];
  EXPECT_EQ(place_count(file, sideways), 1);
  file.effects.spatial_motion = EffectChoice::off;
  EXPECT_EQ(place_count(file, sideways), 1);
  file.effects.spatial_motion = EffectChoice::on;
  EXPECT_EQ(place_count(file, sideways), 2);
}

/// A round beam has one Euler load, but its ends may be held differently in both planes.
TEST(LateralLimit, OfARoundBeamHasPlacesByItsJointsOnly) {
  for (const auto& [response, places] :
       {std::pair("buckling", 1), std::pair("lateral-buckling", 2)}) {
    ProblemFile file = strut(response);
    std::get<BeamBody>(file.scene.bodies[0].shape).segments[0].section = CircleSection{0.02};
    EXPECT_EQ(place_count(file, file.responses[1]), places);
  }
}

// The lightest cantilever with a limit on its lowest frequency is square: both planes tie.

constexpr double bar_length = 0.5, limit = 2.0 * std::numbers::pi * 60.0;

ProblemFile mast(const std::string& responses_and_limits) {
  return problem_from(R"j({"scene": {"bodies": {"mast": {"type": "beam", "from": [0, 0, 0],
    "to": [0.5, 0, 0], "elements": 6, "section": {"type": "rectangle", "width": "= w", "height": "= h"},
    "material": "plain"}}, "materials": {"plain": {"young": "210 GPa", "poisson": 0.3, "density": 7850}},
    "joints": {"root": {"type": "fixed", "bodies": ["ground", "mast"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": "2 ms", "step": "1 ms", "resolution_check": false},
  "variables": {"w": {"start": "12 mm", "lower": "5 mm", "upper": "60 mm"},
                "h": {"start": "20 mm", "lower": "5 mm", "upper": "60 mm"}},
  "objective": {"minimize": "m"},
  "responses": {"m": {"type": "mass"}, )j" +
                      responses_and_limits + "}");
}

Result optimized(const ProblemFile& file, const std::string& backend = "nlopt-slsqp") {
  DesignProblem design(file);
  SolveOptions options{.backend = backend};
  return solve_design(design, options);
}

/// ω = 3.516/L² √(E s²/12ρ) of a square of side s, but for rotary inertia (3e-4).
const double side =
    limit * bar_length * bar_length / 3.516015268500151 * std::sqrt(12.0 * 7850.0 / 2.1e11);

/// @param owner  a key of the response: the body, or none for the whole mechanism
std::string limited_along_both_axes(const std::string& owner) {
  return fmt::format(R"j("y": {{"type": "frequency", "direction": "y"{0}}},
                         "z": {{"type": "frequency", "direction": "z"{0}}}}},
  "constraints": {{"stiff": {{"response": "= min(y, z)", "lower": "60 Hz"}}}})j",
                     owner);
}

TEST(MeetingFrequencies, AreVerifiedByTheirDirections) {
  for (const char* owner : {R"(, "body": "mast")", ""}) {
    for (const std::string& backend : optimizer_names()) {
      const Result result = optimized(mast(limited_along_both_axes(owner)), backend);
      EXPECT_EQ(result.status, Status::verified) << backend << ": " << result.message;
      EXPECT_NEAR(result.x(0), side, 1e-3 * side) << backend;
      EXPECT_NEAR(result.x(1), side, 1e-3 * side) << backend;
    }
  }
}

TEST(MeetingFrequencies, WithoutADirectionAreAdvisedToTakeOne) {
  const Result result = optimized(mast(R"("f": {"type": "frequency"}},
  "constraints": {"stiff": {"response": "f", "lower": "60 Hz"}})"));
  EXPECT_EQ(result.status, Status::stalled);
  EXPECT_NEAR(result.x(0), side, 2e-3 * side);
  EXPECT_THAT(result.message, HasSubstr("f coincides with the frequency of another mode"));
  EXPECT_THAT(result.message, Not(HasSubstr("windows")));
}

// A limit on fatigue decides an optimum.

/// A light bar in two segments, pulled by 3 kN + 2 kN sin ωt at its end and by as much at the end of
/// the first segment: 6 kN and 4 kN in the first one.
ProblemFile stepped_bar() {
  return problem_from(R"j({"scene": {"gravity": [0, 0, 0],
    "materials": {"light": {"young": "200 GPa", "poisson": 0.3, "density": 1,
      "ultimate_strength": "400 MPa", "endurance_limit": "100 MPa"}},
    "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0], "material": "light",
      "segments": [
        {"section": {"type": "rectangle", "width": {"variable": "a"}, "height": "10 mm"}, "elements": 1},
        {"section": {"type": "rectangle", "width": {"variable": "b"}, "height": "10 mm"}, "elements": 1}]}},
    "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
    "loads": {
      "pull": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0], "value": "3 kN"},
      "shake": {"type": "force", "body": "bar", "at": [0.5, 0, 0], "direction": [1, 0, 0],
                "value": {"type": "harmonic", "amplitude": "2 kN", "frequency": "10 Hz"}},
      "pull_2": {"type": "force", "body": "bar", "at": [0.25, 0, 0], "direction": [1, 0, 0], "value": "3 kN"},
      "shake_2": {"type": "force", "body": "bar", "at": [0.25, 0, 0], "direction": [1, 0, 0],
                "value": {"type": "harmonic", "amplitude": "2 kN", "frequency": "10 Hz"}}}},
  "effects": {"geometric_stiffening": "off"},
  "simulation": {"end_time": "0.1 s", "step": "1 ms", "initial_state": "quasi-static", "resolution_check": false},
  "variables": {"a": {"start": "20 mm", "lower": "1 mm", "upper": "50 mm"},
                "b": {"start": "20 mm", "lower": "1 mm", "upper": "50 mm"}},
  "responses": {"mass": {"type": "mass"}, "life": {"type": "fatigue", "body": "bar", "criterion": "goodman"}},
  "objective": {"minimize": "mass"},
  "constraints": {"life": {"response": "life", "upper": 0.5}}})j");
}

/// One limit on the whole beam is one on each of its segments, but not on windows of time.
TEST(FatigueLimit, IsDividedBySegmentsOnly) {
  DesignProblem design(stepped_bar());
  PeakProblem peaks(design, 4);
  EXPECT_EQ(peaks.constraints().size(), 2U);
  const Eigen::VectorXd x = Eigen::Vector2d(0.02, 0.01);
  const Evaluation at = peaks.evaluate(x, Request::values_and_gradients);
  // σ_a/S_e + σ_m/S_u of 200 mm² and of 100 mm².
  EXPECT_NEAR(at.constraints(0), 4e3 / 2e-4 / 100e6 + 6e3 / 2e-4 / 400e6, 1e-4);
  EXPECT_NEAR(at.constraints(1), 2e3 / 1e-4 / 100e6 + 3e3 / 1e-4 / 400e6, 1e-4);
  EXPECT_NEAR(at.constraint_jacobian(0, 0) * 0.02, -at.constraints(0), 1e-3);
  EXPECT_NEAR(at.constraint_jacobian(1, 1) * 0.01, -at.constraints(1), 1e-3);
  EXPECT_NEAR(at.constraint_jacobian(0, 1) * 0.01, 0.0, 1e-3);
}

/// Both segments at their limit: A = (F_a/S_e + F_m/S_u)/0.5, 110 mm² and 55 mm².
TEST(FatigueLimit, SizesBothSegments) {
  const Result result = verified_optimum(stepped_bar(), SolveOptions());
  EXPECT_NEAR(result.x(0) * 0.01, (4e3 / 100e6 + 6e3 / 400e6) / 0.5, 1e-8);
  EXPECT_NEAR(result.x(1) * 0.01, (2e3 / 100e6 + 3e3 / 400e6) / 0.5, 1e-8);
}

}  // namespace
}  // namespace pleuel::test::lateral_limit_test
