#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/design/design_problem.hpp"
#include "optimization/design/design_solve.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/hard/hard_problems.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/differences.hpp"
#include "tests/support/test.hpp"

/// Designs that cannot be simulated beside those that are looked for, and designs at the bounds.

namespace pleuel::test::gradient_test {
namespace {

struct GradientCase {
  std::string name, problem;
  std::vector<std::string> overrides;  ///< short runs: differences of long ones are round-off
  double tolerance;                    ///< relative to the largest entry of a response
};

class HardGradient : public testing::TestWithParam<std::tuple<std::string, GradientCase>> {};

/// The problem of a case; its Newton iterations end at round-off.
ProblemFile problem_of(const GradientCase& hard, const std::string& formulation) {
  std::vector<std::string> overrides = hard.overrides;
  overrides.push_back("/simulation/formulation=" + formulation);
  ProblemFile problem = sample_problem("hard/" + hard.problem, overrides);
  problem.simulation.newton_tolerance = 1e-13;
  return problem;
}

/// Central differences of several steps and Richardson's extrapolation of two: the best of them is
/// as good as the round-off and the truncation of differences allow. Those
/// that are left when it is good enough are not taken.
TEST_P(HardGradient, IsThatOfCentralDifferencesAtTheBestStep) {
  const auto& [formulation, hard] = GetParam();
  const auto [problem, x, analysis] = AtStart(problem_of(hard, formulation));
  const Eigen::VectorXd direct = direct_gradients(*analysis) * x;
  // Against a thousandth of the value where it hardly depends on the design.
  Eigen::VectorXd best = Eigen::VectorXd::Ones(direct.size());
  const auto compare = [&, &analysis = analysis](const Eigen::VectorXd& differences) {
    for (Eigen::Index i = 0; i < direct.size(); ++i) {
      const double value = std::abs(analysis->reductions[i].value);
      const double size = std::max(std::abs(direct(i)), 1e-3 * value);
      best(i) = std::min(best(i), std::abs(differences(i) - direct(i)) / size);
    }
  };
  for (const double step : {1e-3, 1e-2, 1e-4}) {
    const Eigen::VectorXd wide = central_differences(problem, x, step) * x;
    const Eigen::VectorXd narrow = central_differences(problem, x, step / 2) * x;
    compare(narrow);
    compare((4 * narrow - wide) / 3);
    if (best.maxCoeff() <= hard.tolerance) break;
  }
  for (Eigen::Index i = 0; i < direct.size(); ++i) {
    const std::string& name = problem.responses[i].name;
    EXPECT_LE(best(i), hard.tolerance) << name;
  }
}

/// The transposed map, backwards: no differences, no truncation, only round-off. Against a
/// thousandth of the value where it hardly depends on the design.
TEST_P(HardGradient, IsThatOfTheAdjoint) {
  const auto& [formulation, hard] = GetParam();
  const auto [problem, x, analysis] = AtStart(problem_of(hard, formulation));
  const auto values = response_values(*analysis);
  const Eigen::VectorXd direct = sampled_gradients(*analysis, values, ExactMethod::direct) * x;
  const Eigen::VectorXd adjoint = sampled_gradients(*analysis, values, ExactMethod::adjoint) * x;
  for (Eigen::Index i = 0; i < direct.size(); ++i) {
    const double value = std::abs(analysis->reductions[i].value);
    EXPECT_LE(std::abs(adjoint(i) - direct(i)), 1e-8 * std::max(std::abs(direct(i)), 1e-3 * value))
        << problem.responses[i].name;
  }
}

std::string case_name(const testing::TestParamInfo<HardGradient::ParamType>& info) {
  std::string name = std::get<0>(info.param) + std::get<1>(info.param).name;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

/// Limits: measured times ten. Where they are above 1e-8, round-off of the differences is
/// amplified: by the many steps of a coasting mechanism, by stiffness, by vibrations that nothing
/// damps, by the torque of a jump, hundreds of times its mean.
INSTANTIATE_TEST_SUITE_P(
    Problems, HardGradient,
    testing::Combine(
        testing::ValuesIn(formulations()),
        testing::Values(
            GradientCase{"dead_centres", "dead_centres", {"/simulation/end_time=0.4"}, 3e-7},
            GradientCase{"change_point", "change_point", {}, 1e-9},
            GradientCase{"heavy_slider", "heavy_slider", {}, 2e-9},
            GradientCase{"light_slider", "light_slider", {}, 1e-8},
            GradientCase{"stiff_rod", "stiff_rod", {}, 1e-6},
            GradientCase{"soft_rod", "soft_rod", {}, 2e-8},
            GradientCase{"fast_crank", "fast_crank", {"/simulation/end_time=0.01"}, 2e-6},
            GradientCase{
                "inconsistent_start", "inconsistent_start", {"/simulation/end_time=0.1"}, 4e-6},
            GradientCase{"sudden_load", "sudden_load", {"/simulation/end_time=0.05"}, 5e-9},
            GradientCase{"squeezer", "squeezer", {}, 2e-7},
            GradientCase{"free_vibration",
                         "free_vibration",
                         {"/simulation/end_time=20", "/responses/last_peak/from=18"},
                         4e-8},
            GradientCase{"flyball_governor", "flyball_governor", {"/simulation/end_time=1"}, 1e-8},
            GradientCase{"velocity_jump", "velocity_jump", {}, 1.2e-5},
            // Loads out of the plane, which redundant joints share.
            GradientCase{
                "redundant",
                "redundant_slider_crank",
                {"/simulation/end_time=0.2", "/scene/gravity=[0, -9.81, 20]",
                 R"(/responses/pin_force={"type": "reaction-force", "joint": "slider_pin", "direction": "z", "over_time": "rms"})",
                 R"(/responses/pin_moment={"type": "reaction-moment", "joint": "crank_pin", "direction": "magnitude", "over_time": "rms"})"},
                1e-7},
            GradientCase{"thinnest", "light_slider", {"/variables/rod_height/start=4 mm"}, 2e-7},
            GradientCase{"thickest", "light_slider", {"/variables/rod_height/start=40 mm"}, 2e-8},
            GradientCase{"softest", "soft_rod", {"/variables/rod_diameter/start=4 mm"}, 1e-8},
            GradientCase{"heaviest",
                         "fast_crank",
                         {"/variables/slider_mass/start=1 kg", "/simulation/end_time=0.01"},
                         5e-8})),
    case_name);

// The same mechanism in other numbers: whoever writes millimetres, tonnes and newtons gets the
// digits of SI. Plain numbers are taken as they stand, so the file may be in any consistent units.

/// Powers of ten of a unit system: its unit of length and mass in SI; the unit of time is the
/// second.
struct Units {
  double metre;     ///< how many units of length a metre is
  double kilogram;  ///< how many units of mass a kilogram is
  double newton() const { return kilogram * metre; }
  double pascal() const { return newton() / (metre * metre); }
};

std::string problem_text(const Units& u, const std::string& formulation) {
  const auto scaled = [](double value, double unit) {
    return fmt::format("{:.17g}", value * unit);
  };
  const double m = u.metre, density = u.kilogram / (m * m * m);
  const std::string r = scaled(0.1, m), end = scaled(0.35, m);
  return R"({"scene": {"materials": {"steel": {"young": )" + scaled(2.1e11, u.pascal()) +
         R"(, "poisson": 0.3, "density": )" + scaled(7850, density) + R"(}},
  "bodies": {
    "crank": {"type": "beam", "from": [0, 0, 0], "to": [)" +
         r + R"(, 0, 0], "material": "steel",
      "elements": 2, "section": {"type": "rectangle", "width": )" +
         scaled(0.01, m) + R"(, "height": )" + scaled(0.02, m) + R"(}},
    "rod": {"type": "beam", "from": [)" +
         r + R"(, 0, 0], "to": [)" + end +
         R"(, 0, 0], "material": "steel", "elements": 3, "frame": "chord",
      "damping": {"stiffness": 1e-5}, "section": {"type": "circle", "diameter": {"variable": "diameter"}}},
    "slider": {"type": "point-mass", "at": [)" +
         end + R"(, 0, 0], "mass": )" + scaled(0.5, u.kilogram) + R"(}},
  "joints": {
    "bearing": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
      "drive": {"type": "ramp-to-speed", "speed": 100, "ramp": 0.02}},
    "crank_pin": {"type": "revolute", "bodies": ["crank", "rod"], "at": [)" +
         r + R"(, 0, 0]},
    "slider_pin": {"type": "revolute", "bodies": ["rod", "slider"], "at": [)" +
         end + R"(, 0, 0]},
    "guide": {"type": "point-on-line", "bodies": ["ground", "slider"], "at": [)" +
         end +
         R"(, 0, 0], "axis": [1, 0, 0]}}},
  "simulation": {"end_time": 0.05, "step": 1e-4, "formulation": ")" +
         formulation + R"("},
  "variables": {"diameter": {"start": )" +
         scaled(0.012, m) + R"(, "lower": )" + scaled(0.001, m) + R"(, "upper": )" +
         scaled(0.1, m) + R"(}},
  "responses": {
    "end": {"type": "position", "body": "slider", "direction": "x", "over_time": "final"},
    "bow": {"type": "deflection", "body": "rod", "at": 0.5, "over_time": "max-abs"},
    "stress": {"type": "stress", "body": "rod", "over_time": "max"},
    "torque": {"type": "drive-torque", "joint": "bearing", "over_time": "rms"},
    "acceleration": {"type": "acceleration", "body": "slider", "direction": "x", "over_time": "rms"},
    "force": {"type": "reaction-force", "joint": "guide", "direction": "y", "over_time": "rms"}}})";
}

/// Values of all responses, and their derivatives with respect to the logarithm of the diameter, in
/// SI.
Eigen::MatrixXd digits_in(const Units& u, const std::string& formulation) {
  const auto [problem, x, analysis] = AtStart(problem_from(problem_text(u, formulation)));
  Eigen::VectorXd unit(6);
  unit << u.metre, u.metre, u.pascal(), u.newton() * u.metre, u.metre, u.newton();
  Eigen::MatrixXd digits(6, 2);
  digits.col(0) = values_of(*analysis).cwiseQuotient(unit);
  digits.col(1) = (direct_gradients(*analysis) * start_design(problem)).cwiseQuotient(unit);
  return digits;
}

class UnitsHardCase : public HardCase {};
PLEUEL_WITH_EACH_FORMULATION(UnitsHardCase);

/// Derivatives with respect to a logarithm have the unit of the value; where they nearly vanish,
/// the round-off of the value is what can be asked of them.
void expect_same_digits(const Eigen::MatrixXd& scaled, const Eigen::MatrixXd& si) {
  for (Eigen::Index i = 0; i < si.rows(); ++i) {
    const double size = si.row(i).cwiseAbs().maxCoeff();
    EXPECT_NEAR(scaled(i, 0), si(i, 0), 1e-9 * std::abs(si(i, 0))) << "value " << i;
    EXPECT_NEAR(scaled(i, 1), si(i, 1), 1e-9 * size) << "derivative " << i;
  }
}

TEST_P(UnitsHardCase, GivesTheSameDigitsInMillimetresTonnesAndNewtons) {
  expect_same_digits(digits_in({1e3, 1e-3}, GetParam()), digits_in({1.0, 1.0}, GetParam()));
}

TEST_P(UnitsHardCase, GivesTheSameDigitsInMicrometresAndGrams) {
  expect_same_digits(digits_in({1e6, 1e3}, GetParam()), digits_in({1.0, 1.0}, GetParam()));
}

Result optimize(const ProblemFile& file, const std::string& backend) {
  DesignProblem problem(file);
  return solve_design(problem, {.backend = backend, .tolerance = 1e-6});
}

class HardOptimization : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Backends, HardOptimization, testing::ValuesIn(optimizer_names()),
                         formulation_name);

ProblemFile impossible_designs(const std::string& crank_length) {
  return sample_problem("hard/impossible_designs",
                        {"/variables/crank_length/start=" + crank_length});
}

/// The easy start is next to the optimum, on the side from which no step leads into what locks.
TEST_P(HardOptimization, FindsTheOptimumAcrossDesignsThatCannotBeSimulated) {
  const Result easy = verified(optimize(impossible_designs("90 mm"), "nlopt-slsqp"));
  ASSERT_EQ(count_failures(easy.history), 0);
  const Result hard = verified(optimize(impossible_designs("30 mm"), GetParam()));
  EXPECT_GT(count_failures(hard.history), 0) << "the search met no impossible design";
  // Measured 7e-8.
  EXPECT_NEAR(hard.evaluation.objective / easy.evaluation.objective, 1.0, 1e-6);
  EXPECT_LE(hard.max_violation, 1e-6);
}

/// The guide is out of reach below if crank and offset together exceed the rod,
/// r + e > √(c² + (r − e)²), that is r > c²/(4e) = 100 mm.
TEST_P(HardOptimization, FailsOnlyWhereTheMechanismLocks) {
  const Result result = optimize(impossible_designs("30 mm"), GetParam());
  for (const EvaluationRecord& record : result.history) {
    EXPECT_EQ(record.has_failed(), record.x(0) > 0.1) << record.x(0) << record.failure;
  }
}

TEST_P(HardOptimization, FindsTheOptimumFromAnImpossibleStart) {
  const Result easy = optimize(impossible_designs("90 mm"), "nlopt-slsqp");
  const Result result = verified(optimize(impossible_designs("120 mm"), GetParam()));
  EXPECT_NEAR(result.evaluation.objective / easy.evaluation.objective, 1.0, 1e-6);
  EXPECT_THAT(result.message, HasSubstr("the start cannot be evaluated"));
}

/// Where all designs between the bounds lock nothing can be said, and none is called an optimum.
TEST_P(HardOptimization, FailsWhereNoDesignCanBeSimulated) {
  const ProblemFile problem =
      sample_problem("hard/impossible_designs", {"/variables/crank_length/start=120 mm",
                                                 "/variables/crank_length/lower=110 mm",
                                                 "/variables/crank_length/upper=130 mm"});
  const Result result = optimize(problem, GetParam());
  EXPECT_EQ(result.status, Status::failed);
  EXPECT_EQ(count_failures(result.history), result.evaluations);
  EXPECT_THAT(result.message, HasSubstr("other designs between the bounds"));
}

/// The bow of the rod falls with a shorter crank and a higher rod: both bounds are reached.
ProblemFile least_bow(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"/objective/minimize=rod_bow", "/constraints={}"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return sample_problem("hard/impossible_designs", overrides);
}

TEST_P(HardOptimization, EndsExactlyAtTheBoundsThatHoldIt) {
  const ProblemFile problem = least_bow();
  const Result result = verified(optimize(problem, GetParam()));
  // Interior-point methods end beside bounds: within the tolerance of the optimizer.
  EXPECT_NEAR(result.x(0), problem.variables[0].lower, 1e-6 * problem.variables[0].lower);
  EXPECT_NEAR(result.x(1), problem.variables[1].upper, 1e-6 * problem.variables[1].upper);
}

/// β > 0 only at an upper and β < 0 only at a lower bound; moving a bound by δ changes the optimum
/// by −β δ. Central differences over ±0.1 % of the bound: error 1e-6 of the price, and that of the
/// optima, 1e-6 of the objective, over 1e-3.
TEST_P(HardOptimization, PricesTheBoundsThatHoldIt) {
  const Result result = optimize(least_bow(), GetParam());
  const double shorter = result.bound_multipliers(0), higher = result.bound_multipliers(1);
  EXPECT_LT(shorter, 0.0);
  EXPECT_GT(higher, 0.0);
  const auto price = [&](const std::string& bound, double value) {
    const auto least = [&](double factor) {
      return optimize(least_bow({fmt::format("/variables/{}={:.17g}", bound, factor * value)}),
                      GetParam())
          .evaluation.objective;
    };
    return -(least(1.001) - least(0.999)) / (0.002 * value);
  };
  EXPECT_NEAR(price("crank_length/lower", 0.02) / shorter, 1.0, 2e-3);
  EXPECT_NEAR(price("rod_height/upper", 0.03) / higher, 1.0, 2e-3);
}

/// Of a driven mechanism in thirty revolutions: sensitivities of constraints do not drift. Index 1
/// loses them by 5e-4 m in the same time (docs/stability.md).
class LongDesignCase : public HardCase {};
PLEUEL_WITH_EACH_FORMULATION(LongDesignCase);

TEST_P(LongDesignCase, KeepsItsConstraintsForNeighbouringDesigns) {
  const ProblemFile file = problem(
      "impossible_designs",
      {end_of(10.0), "/variables/crank_length/start=60 mm",
       R"(/responses/drift={"type": "constraint-drift", "over_time": "max-abs", "from": "9 s"})"});
  const Eigen::VectorXd x = start_design(file);
  const auto analysis = run(file);
  const Eigen::RowVectorXd gradient =
      direct_gradients(*analysis).row(response_index(file, "drift"));
  EXPECT_LE(value_of(*analysis, "drift"), 1e-12);  // ten Newton tolerances; measured 6e-14 m
  EXPECT_LE(gradient.cwiseProduct(x.transpose()).lpNorm<Eigen::Infinity>(),
            1e-15);  // round-off; measured 9e-17 m
}

struct Corner {
  std::string problem;
  std::vector<std::string> overrides;
  std::vector<bool> is_upper;  ///< one a variable: which bound
  double tolerance;            ///< relative to the largest entry of a response
};

class HardCorner : public testing::TestWithParam<Corner> {};

/// At the bounds, where there may be nothing beyond: the last case ends one per mille
/// before the crank locks. Best of several widths: truncation of seven nodes and round-off of values
/// balance between 3e-3 and 3e-2 (rod_bow of the first case: 5e-8 at 3e-2, 4e-10 at 3e-3).
TEST_P(HardCorner, HasTheGradientOfDifferencesInwards) {
  const Corner& corner = GetParam();
  ProblemFile problem = sample_problem("hard/" + corner.problem, corner.overrides);
  problem.simulation.newton_tolerance = 1e-13;
  Eigen::VectorXd x(corner.is_upper.size());
  for (std::size_t i = 0; i < corner.is_upper.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    x(i) = corner.is_upper[i] ? variable.upper : variable.lower;
  }
  const auto analysis = analyze(problem, x);
  const Eigen::MatrixXd direct = direct_gradients(*analysis);
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const auto values = [&](double change) {
      Eigen::VectorXd moved = x;
      moved(j) += change;
      return values_of(*analyze(problem, moved));
    };
    const bool is_upper = corner.is_upper[j];
    Eigen::VectorXd best = Eigen::VectorXd::Constant(direct.rows(), infinity);
    for (const double relative : {2e-1, 3e-2, 1e-2, 3e-3, 3e-4, 3e-5}) {
      const double width = relative * x(j);
      const Eigen::VectorXd differences =
          derivative_in_interval(values, is_upper ? -width : 0.0, is_upper ? 0.0 : width, 7);
      best = best.cwiseMin((differences - direct.col(j)).cwiseAbs());
    }
    for (Eigen::Index i = 0; i < best.size(); ++i) {
      // Against a thousandth of the value where it hardly depends on the design.
      const double size =
          std::max(direct.row(i).cwiseProduct(x.transpose()).lpNorm<Eigen::Infinity>(),
                   1e-3 * std::abs(analysis->reductions[i].value));
      EXPECT_LE(best(i) * x(j) / size, corner.tolerance)
          << problem.responses[i].name << ", " << problem.variables[j].name;
    }
  }
}

std::string corner_name(const testing::TestParamInfo<Corner>& info) {
  std::string name = info.param.problem + std::to_string(info.index);
  std::erase(name, '_');
  return name;
}

/// Limits: measured times ten, as in gradient_test.cpp; up to round-off, which is not the same in
/// every build.
INSTANTIATE_TEST_SUITE_P(
    Problems, HardCorner,
    testing::Values(
        Corner{
            "impossible_designs", {"/variables/crank_length/upper=99.9 mm"}, {false, false}, 3e-10},
        Corner{
            "impossible_designs", {"/variables/crank_length/upper=99.9 mm"}, {false, true}, 8e-9},
        Corner{
            "impossible_designs", {"/variables/crank_length/upper=99.9 mm"}, {true, false}, 4e-9},
        Corner{"impossible_designs", {"/variables/crank_length/upper=99.9 mm"}, {true, true}, 7e-8},
        Corner{"fast_crank", {"/simulation/end_time=0.01"}, {false}, 5e-7},
        Corner{"flyball_governor", {"/simulation/end_time=1"}, {true}, 4e-8},
        Corner{"light_slider", {}, {false}, 4e-7}, Corner{"soft_rod", {}, {true}, 2e-7},
        Corner{"sudden_load", {"/simulation/end_time=0.05"}, {false}, 2e-9}),
    corner_name);

}  // namespace
}  // namespace pleuel::test::gradient_test
