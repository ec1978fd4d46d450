#include <complex>

#include <Eigen/LU>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/integration/period_map.hpp"
#include "core/response/analysis.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/sensitivity/steady_machines.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::periodic_test {
namespace {

using namespace steady;

ProblemFile with_run_up(ProblemFile problem, int turns) {
  problem.simulation.period = 0.0;
  problem.simulation.end_time *= turns;
  return problem;
}

/// The largest difference of the histories from those of the last turn after a run-up, relative to
/// the largest value of each.
double difference_from_run_up(const ProblemFile& problem, int turns) {
  const auto steady = analyze(problem, start_design(problem));
  const auto [longer, x, transient] = AtStart(with_run_up(problem, turns));
  double largest = 0.0;
  for (std::size_t i = 0; i < steady->responses.size(); ++i) {
    const Eigen::MatrixXd& history = steady->histories[i];
    if (history.size() == 0) continue;
    const Eigen::MatrixXd last = transient->histories[i].rightCols(history.cols());
    largest =
        std::max(largest, (history - last).cwiseAbs().maxCoeff() / history.cwiseAbs().maxCoeff());
  }
  return largest;
}

/// By direct differentiation, the adjoint, and central differences of whole searches.
void expect_equal_gradients(const ProblemFile& file) {
  const auto [x, analysis] = started(file);
  const Eigen::MatrixXd direct = gradients(file, x, *analysis, GradientMethod::direct),
                        adjoint = gradients(file, x, *analysis, GradientMethod::adjoint),
                        differences =
                            gradients(file, x, *analysis, GradientMethod::central_difference,
                                      {.difference_step = 1e-4});
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    const double size = direct.row(i).lpNorm<Eigen::Infinity>();
    EXPECT_LT((direct - adjoint).row(i).lpNorm<Eigen::Infinity>(), 1e-9 * size)
        << file.responses[static_cast<std::size_t>(i)].name;
    const double round_off = 1e-9 * std::abs(values_of(*analysis)(i));
    EXPECT_LT((direct - differences).row(i).lpNorm<Eigen::Infinity>(), 1e-6 * size + round_off)
        << file.responses[static_cast<std::size_t>(i)].name;
  }
}

class SteadyMachine : public testing::TestWithParam<std::string> {
 protected:
  static ProblemFile problem(const std::vector<std::string>& overrides = {}) {
    if (GetParam() == "slider_crank") return slider_crank(overrides);
    if (GetParam() == "four_bar") return four_bar(overrides);
    return six_bar(overrides);
  }
};

INSTANTIATE_TEST_SUITE_P(Mechanisms, SteadyMachine,
                         testing::Values("slider_crank", "four_bar", "six_bar"),
                         [](const auto& mechanism) { return mechanism.param; });

TEST_P(SteadyMachine, RunsAsAfterFiftyTurns) {
  EXPECT_LT(difference_from_run_up(problem(), 50), 1e-6);
}

/// The search ends below newton_tolerance (1e-10), or where round-off lets nothing shrink any more:
/// that of the six-bar is 6e-11 … 4e-10 of the scale of a coordinate, whatever the tolerance (1e-9
/// … 1e-13), that of the four-bar 2e-11 … 2.1e-10 where gravity changes by 1e-15 … 2e-13 of itself.
TEST_P(SteadyMachine, IsFoundWithinLessPeriodsThanARunUpTakes) {
  const auto [file, x, analysis] = AtStart(problem());
  const PeriodicStart& found = *analysis->trajectory.periodic;
  EXPECT_LE(found.simulations, 8);
  EXPECT_LE(found.differentiations, 2);
  const bool is_bar = GetParam() != "slider_crank";
  EXPECT_LE(found.gap, is_bar ? 1e-9 : file.simulation.newton_tolerance);
  EXPECT_LT(found.growth, 1.0);
}

TEST_P(SteadyMachine, EndsWhereItBegins) {
  const auto [file, x, analysis] = AtStart(problem());
  for (std::size_t i = 0; i < analysis->histories.size(); ++i) {
    const Eigen::MatrixXd& history = analysis->histories[i];
    if (history.size() == 0) continue;
    const double size = history.cwiseAbs().maxCoeff();
    EXPECT_LT((history.leftCols(1) - history.rightCols(1)).cwiseAbs().maxCoeff(), 1e-8 * size);
  }
}

TEST_P(SteadyMachine, HasEqualGradientsByAllMethods) {
  expect_equal_gradients(problem({"/simulation/newton_tolerance=1e-13"}));
}

/// The same machine of beams and point masses elsewhere.
ProblemFile moved_along_x(ProblemFile file, double distance) {
  const auto move = [distance](Point& point) { point[0].constant += distance; };
  for (Body& body : file.scene.bodies) {
    if (auto* beam = std::get_if<BeamBody>(&body.shape)) {
      move(beam->from);
      move(beam->to);
    } else {
      move(std::get<PointMass>(body.shape).at);
    }
  }
  for (Joint& joint : file.scene.joints) move(joint.at);
  return file;
}

/// 50 m from the origin positions carry a hundred times the round-off: the gap no longer comes below
/// 1e-10 of a coordinate (4e-9), and does not have to. 1e-5: accelerations carry it over h².
TEST(SteadySixBar, IsFoundWhereItsGapIsRoundOff) {
  const ProblemFile near = six_bar(), far = moved_along_x(near, 50.0);
  const auto there = analyze(far, start_design(far)), here = analyze(near, start_design(near));
  EXPECT_LE(there->trajectory.periodic->gap, 1e-7);
  for (std::size_t i = 0; i < near.responses.size(); ++i) {
    if (time_derivative_of(near.responses[i]) == TimeDerivative::none) continue;
    const double value = here->reductions[i].value;
    EXPECT_NEAR(there->reductions[i].value, value, 1e-5 * std::abs(value))
        << near.responses[i].name;
  }
}

TEST(SteadyMotor, RunsAsAfterFiftyTurns) {
  const ProblemFile file = motor();
  EXPECT_LT(difference_from_run_up(file, 50), 1e-6);
}

// From rest the motor takes longer than a period to its speed: the crank is behind by turns. As of
// the six-bar, the gap is round-off: 5e-11 … 4e-10 whatever the tolerance (1e-9 … 1e-13), where a
// period leaves 0.7 % of a disturbance; on which side of 1e-10 it ends depends on the processor.
TEST(SteadyMotor, MayStartSlowly) {
  ProblemFile file = motor();
  for (Load& load : file.scene.loads) {
    if (load.name != "motor") continue;
    auto& control = *std::get<JointForce>(load.element).control;
    control.proportional = 10.0;
    control.derivative = 0.3;
  }
  const auto analysis = analyze(file, start_design(file));
  EXPECT_LE(analysis->trajectory.periodic->gap, 1e-9);
}

TEST(SteadyMotor, HasEqualGradientsByAllMethods) {
  ProblemFile file = motor();
  file.simulation.newton_tolerance = 1e-13;
  expect_equal_gradients(file);
}

TEST(SteadyMotionInSpace, RunsAsAfterTwentyTurns) {
  EXPECT_LT(difference_from_run_up(spatial(), 20), 1e-6);
}

TEST(SteadyMotionInSpace, HasEqualGradientsByAllMethods) {
  expect_equal_gradients(spatial({"/simulation/newton_tolerance=1e-13"}));
}

/// What else a simulation may be asked for.
class SteadySetting : public testing::TestWithParam<std::vector<std::string>> {};

INSTANTIATE_TEST_SUITE_P(
    Settings, SteadySetting,
    testing::Values(
        std::vector<std::string>{"/simulation/formulation=stabilized-index-2"},
        std::vector<std::string>{"/simulation/formulation=index-1", "/simulation/projection=true"},
        std::vector<std::string>{"/simulation/formulation=index-1",
                                 "/simulation/baumgarte=500 1/s"},
        std::vector<std::string>{"/simulation/scheme=newmark"},
        std::vector<std::string>{"/simulation/scheme=implicit-euler"},
        std::vector<std::string>{"/simulation/spectral_radius=0"},
        std::vector<std::string>{"/effects/spatial_motion=on"},
        std::vector<std::string>{"/sensitivity/memory=0.1 MB"},
        std::vector<std::string>{R"(/scene/bodies/rod/reduction={"modes": 2})"},
        std::vector<std::string>{
            "/simulation/end_time=0.2513274122871835",
            R"(/simulation/initial_state={"type": "periodic", "period": 0.12566370614359174})"}),
    named_as_printed());

TEST_P(SteadySetting, RepeatsItselfWithEqualGradients) {
  std::vector<std::string> overrides = {"/simulation/step=1 ms",
                                        "/simulation/newton_tolerance=1e-13"};
  overrides.insert(overrides.end(), GetParam().begin(), GetParam().end());
  const auto [file, x, analysis] = AtStart(slider_crank(overrides));
  for (std::size_t i = 0; i < analysis->histories.size(); ++i) {
    const Eigen::MatrixXd& history = analysis->histories[i];
    if (history.size() == 0) continue;
    EXPECT_LT((history.leftCols(1) - history.rightCols(1)).cwiseAbs().maxCoeff(),
              1e-7 * history.cwiseAbs().maxCoeff())
        << file.responses[i].name;
  }
  const Eigen::MatrixXd direct = gradients(file, x, *analysis, GradientMethod::direct),
                        adjoint = gradients(file, x, *analysis, GradientMethod::adjoint);
  // Round-off of the projection, which is as large from a consistent start (1.1e-8 of the stress).
  const double tolerance = file.simulation.formulation.is_projected ? 1e-7 : 1e-8;
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_LT((direct - adjoint).row(i).lpNorm<Eigen::Infinity>(),
              tolerance * direct.row(i).lpNorm<Eigen::Infinity>())
        << file.responses[static_cast<std::size_t>(i)].name;
  }
}

/// The discrete steady motion is Re(q e^{iωt}) with (Z − H) y = c z for the scheme y⁺ = H y + c z,
/// Z = e^{iωh}, and m a + c v + k q = F.
TEST(SteadyOscillator, IsThatOfTheDiscreteFrequencyResponse) {
  constexpr double c = 8.0;
  const auto [file, x, analysis] = AtStart(Oscillator::with(R"("damping": 8)"));
  const double h = Oscillator::period / Oscillator::steps;
  const std::complex<double> turned =
      std::exp(std::complex<double>(0.0, Oscillator::frequency * h));
  const Scheme scheme = generalized_alpha(h, file.simulation.spectral_radius);
  const Eigen::Matrix4cd shift = turned * Eigen::Matrix4cd::Identity();
  const Eigen::Vector4cd of_z = (shift - scheme.history.cast<std::complex<double>>()).inverse() *
                                scheme.correction.cast<std::complex<double>>();
  const std::complex<double> q = Oscillator::force * of_z(0) /
                                 (Oscillator::m * of_z(2) + c * of_z(1) + Oscillator::k * of_z(0));
  for (int i = 0; i <= Oscillator::steps; ++i) {
    const double expected = std::imag(q * std::pow(turned, i));  // of the sine
    EXPECT_NEAR(analysis->histories[0](0, i), expected, 1e-10 * std::abs(q)) << i;
  }
}

/// A disturbance dies as exp(−c/2m · T), up to the square of the step and the scheme's own damping:
/// of 1/300 of a period of the free vibration here 4e-4.
TEST(SteadyOscillator, ForgetsAsItsDampingSays) {
  for (const double c : {8.0, 0.5, 0.0}) {
    const ProblemFile file = Oscillator::with(fmt::format(R"("damping": {})", c));
    const double expected = std::exp(-0.5 * c / Oscillator::m * Oscillator::period);
    const double growth = analyze(file, start_design(file))->trajectory.periodic->growth;
    EXPECT_NEAR(growth, expected, 1e-3) << c;
    EXPECT_LE(growth, 1.0 + 1e-9) << c;
  }
}

/// A mass of 2 kg on a hardening spring with friction, hit every 0.349 s: of its motions with this period one is
/// unstable. From v = 0.211937 m/s on a disturbance turns its sign and grows by 1.0128 in each period (by an
/// integrator of order 8 and differences), wherever the search began.
TEST(SteadyOscillator, IsUnstableWhereverTheSearchBegan) {
  for (const double guess : {0.1, 0.15, 0.4}) {
    const ProblemFile file = problem_from(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0],
        "bodies": {{"m": {{"type": "point-mass", "at": [1, 0, 0], "mass": 2, "velocity": [{}, 0, 0]}}}},
        "joints": {{"g": {{"type": "point-on-line", "bodies": ["ground", "m"], "at": [1, 0, 0], "axis": [1, 0, 0]}}}},
        "loads": {{
          "s": {{"type": "spring", "bodies": ["ground", "m"], "at": [[0, 0, 0], [1, 0, 0]], "stiffness": 800,
                 "damping": 4, "resistance": "= 400 kN/m^3*elongation^3"}},
          "fr": {{"type": "joint", "joint": "g", "resistance": {{"type": "friction", "value": 0.8, "speed": 0.02}}}},
          "F": {{"type": "force", "body": "m", "at": [1, 0, 0], "direction": [1, 0, 0], "value":
            {{"type": "half-sine", "amplitude": 40, "duration": 0.1, "period": 0.3490658503988659}}}}}}}},
      "simulation": {{"end_time": 0.3490658503988659, "step": 2e-4, "initial_state": "periodic"}},
      "responses": {{"m": {{"type": "mass"}}}}}})",
                                                      guess));
    EXPECT_THAT(thrown<SimulationError>([&] { analyze(file, start_design(file)); }),
                HasSubstr("is unstable: disturbances grow by 1.3 %"))
        << guess;
  }
}

/// The mass of a counterweight on the driven end of an arm changes no motion, whose derivatives are
/// round-off then: only the weight that the bearing carries, one g a kilogram, and with its lever
/// of 0.1 m the largest torque, as long as the arm's is larger and turns the other way.
TEST(SteadyMachine, HasGradientsOfAVariableThatChangesForcesOnly) {
  const auto [problem, x, analysis] =
      AtStart(problem_from(R"({"scene": {"gravity": [0, "-9.81 m/s^2", 0],
      "bodies": {
        "arm": {"type": "beam", "from": [0, 0, 0], "to": ["0.5 m", 0, 0], "material": "steel",
          "section": {"type": "rectangle", "width": "20 mm", "height": "20 mm"}, "elements": 2,
          "damping": {"stiffness": "1e-3 s"}},
        "weight": {"type": "rigid", "at": ["-100 mm", 0, 0], "mass": {"variable": "M"},
          "inertia": [0.01, 0.01, 0.01, 0, 0, 0]}},
      "joints": {
        "bearing": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
          "drive": {"type": "constant-speed", "speed": "60 rpm"}},
        "weld": {"type": "fixed", "bodies": ["arm", "weight"], "at": [0, 0, 0]}}},
    "simulation": {"end_time": "1 s", "step": "2 ms", "initial_state": "periodic"},
    "variables": {"M": {"start": "5 kg", "lower": "1 kg", "upper": "20 kg"}},
    "responses": {
      "torque": {"type": "drive-torque", "joint": "bearing", "over_time": "max-abs"},
      "weight": {"type": "reaction-force", "joint": "bearing", "direction": "y", "over_time": "mean"}}})"));
  const auto gradients_by = [&problem = problem, &x = x,
                             &analysis = analysis](GradientMethod method) {
    return gradients(problem, x, *analysis, method);
  };
  const Eigen::MatrixXd direct = gradients_by(GradientMethod::direct),
                        adjoint = gradients_by(GradientMethod::adjoint);
  EXPECT_LE((direct - adjoint).norm(), 1e-8 * adjoint.norm());
  EXPECT_NEAR(std::abs(direct(0, 0)), 9.81 * 0.1, 1e-6);
  EXPECT_NEAR(std::abs(direct(1, 0)), 9.81, 1e-6);
}

/// A slender bar that bends so far under its load that its stiffening couples both directions: the
/// map of the search is that of a motion on the way, too far from the motion itself to find the
/// derivatives by its end's height. They were refused.
TEST(SteadyBar, HasDerivativesWhereTheMapOfTheSearchIsTooFarAway) {
  const ProblemFile bar = problem_from(R"({"scene": {
        "bodies": {"bar": {"type": "beam", "from": [0, 0, 0], "to": [0.4, {"variable": "rise"}, 0],
                           "material": "steel", "elements": 2, "damping": {"stiffness": "0.1 ms"},
                           "section": {"type": "rectangle", "width": 0.03, "height": {"variable": "height"}}}},
        "joints": {"wall": {"type": "fixed", "bodies": ["ground", "bar"], "at": [0, 0, 0]}},
        "loads": {"press": {"type": "force", "body": "bar", "at": [0.4, {"variable": "rise"}, 0],
          "direction": [0, -1, 0], "value": {"type": "harmonic", "amplitude": "0.5 kN", "frequency": "40 Hz"}}}},
      "simulation": {"end_time": "25 ms", "step": "0.5 ms", "initial_state": "periodic", "newton_tolerance": 1e-12},
      "variables": {"height": {"start": 0.02, "lower": 0.01, "upper": 0.03},
                    "rise": {"start": 1e-3, "lower": 1e-3, "upper": 1e-3}},
      "responses": {"s": {"type": "stress", "body": "bar", "over_time": "max"}}})");
  expect_equal_gradients(bar);
}

// Motions that are no repeated ones, and what is said of them.

std::string failure_of(const ProblemFile& file) {
  return thrown<SimulationError>([&] { started(file); });
}

TEST(SteadyMachineErrors, NameADriveThatDoesNotRepeatItself) {
  const std::string failure =
      failure_of(four_bar({"/scene/joints/crank_bearing/drive/speed=49 rad/s"}));
  EXPECT_THAT(failure, HasSubstr("crank_bearing"));
  EXPECT_THAT(failure, HasSubstr("whole turns"));
}

/// A period that somebody rounded: the crank goes on by 1e-6 of a turn.
TEST(SteadyMachineErrors, TellARoundedPeriod) {
  const std::string failure =
      failure_of(four_bar({"/scene/joints/crank_bearing/drive/speed=50.00005 rad/s"}));
  EXPECT_THAT(failure, HasSubstr("goes through 360.00036 deg: if that is to be 360, write "
                                 "the period as a formula"));
}

TEST(SteadyMachineErrors, NameALoadThatDoesNotRepeatItself) {
  const std::string failure = failure_of(
      four_bar({R"(/scene/loads/push={"type": "force", "body": "rocker", "at": ["400 mm", 0, 0],
          "direction": [1, 0, 0], "value": {"type": "harmonic", "amplitude": 1, "frequency": 60}})"}));
  EXPECT_THAT(failure, HasSubstr("push"));
}

/// Pushed along by 0.1 N s/m of its speed it grows by 0.5 % in a period.
TEST(SteadyMachineErrors, TellAMotionThatGrows) {
  const std::string failure = failure_of(
      Oscillator::with(R"("motor": {"type": "expression", "value": "= 0.1 N s/m*speed"})"));
  EXPECT_THAT(failure, HasSubstr("is unstable: disturbances grow by 0.5"));
}

/// The motion of this design repeats itself; those of others do not with its period.
TEST(SteadyMachineErrors, NameAVariableThatSetsThePeriod) {
  const AtStart start(Oscillator::with(R"("damping": 8)", R"({"variable": "speed"})"));
  for (const GradientMethod method : {GradientMethod::direct, GradientMethod::adjoint}) {
    EXPECT_THAT(thrown<SimulationError>(
                    [&] { gradients(start.problem, start.x, *start.analysis, method); }),
                HasSubstr("push no longer repeats itself"))
        << "no complaint";
  }
}

/// A mass on a crank, whose radius loads the joint between both along the radius only: its moment is
/// round-off, which does not repeat itself. F = m r ω².
TEST(SteadyMachineErrors, AreNoneOfARadiusThatLeavesAJointWithoutMoment) {
  for (const double step : {1e-4, 5e-5, 2.5e-5}) {
    const AtStart start(problem_from(
        R"({"scene": {"gravity": [0, 0, 0], "bodies": {
        "crank": {"type": "rigid", "at": [0, 0, 0], "mass": 5, "inertia": [0, 0, 0.02, 0, 0, 0]},
        "counter": {"type": "point-mass", "at": ["= r", 0, 0], "mass": 1}},
      "joints": {
        "main": {"type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0],
          "drive": {"type": "constant-speed", "speed": "3000 rpm"}},
        "cw": {"type": "fixed", "bodies": ["crank", "counter"], "at": ["= r", 0, 0]}}},
    "simulation": {"end_time": "20 ms", "step": 1e-4, "initial_state": "periodic"},
    "variables": {"r": {"start": "50 mm", "lower": "30 mm", "upper": "60 mm"}},
    "responses": {"R": {"type": "reaction-force", "joint": "main", "direction": "magnitude",
                        "over_time": "max"}}})",
        {fmt::format("/simulation/step={}", step)}));
    const double square = std::pow(100.0 * std::numbers::pi, 2);
    EXPECT_NEAR(direct_gradients(*start.analysis)(0, 0), square, 1e-3 * square) << step;  // (ω h)²
  }
}

TEST(SteadyMachineErrors, NameAMotionThatNothingBringsBack) {
  const std::string failure =
      failure_of(problem_from(R"({"name": "free", "scene": {"gravity": [0, 0, 0],
        "bodies": {"cart": {"type": "point-mass", "at": [0, 0, 0], "mass": 1}},
        "joints": {"guide": {"type": "point-on-line", "bodies": ["ground", "cart"],
                             "at": [0, 0, 0], "axis": [1, 0, 0]}},
        "loads": {"push": {"type": "force", "body": "cart", "at": [0, 0, 0], "direction": [1, 0, 0],
          "value": {"type": "harmonic", "amplitude": 1, "frequency": 62.83185307179586}}}},
        "simulation": {"end_time": 0.1, "step": 1e-3, "initial_state": "periodic"},
        "responses": {"x": {"type": "position", "body": "cart", "direction": "x", "over_time": "max"}}})"));
  EXPECT_THAT(failure, HasSubstr("\"cart\""));
  EXPECT_THAT(failure, HasSubstr("nothing has brought back"));
}

/// A disc on a tube, twisted to and fro without damping: neither grows nor dies, wherever in its
/// period it begins. On the way to its motion it turns on the average, and that motion would grow.
TEST(SteadyMachineErrors, AreNoneOfAMotionThatIsFoundFromOneThatGrows) {
  for (const double phase : {0.0, 90.0}) {
    const ProblemFile disc =
        problem_from(fmt::format(R"({{"scene": {{"gravity": [0, 0, 0], "bodies": {{
              "tube": {{"type": "beam", "from": [0, 0, 0], "to": [0, 0, 0.6], "material": "steel",
                "section": {{"type": "tube", "outer_diameter": 0.03, "thickness": 0.003}}, "elements": 4}},
              "disc": {{"type": "rigid", "at": [0, 0, 0.6], "mass": 20, "inertia": [0.2, 0.2, 0.4, 0, 0, 0]}}}},
            "joints": {{
              "wall": {{"type": "fixed", "bodies": ["ground", "tube"], "at": [0, 0, 0]}},
              "hub": {{"type": "fixed", "bodies": ["tube", "disc"], "at": [0, 0, 0.6]}}}},
            "loads": {{"twist": {{"type": "torque", "body": "disc", "at": [0, 0, 0.6],
              "direction": [0, 0, 1], "value": {{"type": "harmonic", "amplitude": 1,
                "frequency": "40 Hz", "phase": "{} deg"}}}}}}}},
          "simulation": {{"end_time": 0.025, "step": 1e-4, "initial_state": "periodic"}},
          "responses": {{"hold": {{"type": "reaction-moment", "joint": "wall", "direction": "z",
                                   "over_time": "max"}}}}}})",
                                 phase));
    EXPECT_EQ(failure_of(disc), "") << phase;
  }
}

/// A screen on two leaf springs, shaken by a mass that turns in it.
ProblemFile screen(int revolutions_per_minute) {
  return problem_from(
      fmt::format(R"j({{"constants": {{"n": "{} rpm", "tilt": "25 deg", "len": "350 mm"}},
    "scene": {{"bodies": {{
      "left": {{"type": "beam", "from": [0, 0, 0], "to": ["= -len*sin(tilt)", "= len*cos(tilt)", 0],
        "material": "steel", "elements": 4, "damping": {{"stiffness": "0.5 ms"}},
        "section": {{"type": "rectangle", "width": "120 mm", "height": "5 mm"}}}},
      "right": {{"type": "beam", "from": [0.8, 0, 0], "to": ["= 800 mm - len*sin(tilt)", "= len*cos(tilt)", 0],
        "material": "steel", "elements": 4, "damping": {{"stiffness": "0.5 ms"}},
        "section": {{"type": "rectangle", "width": "120 mm", "height": "5 mm"}}}},
      "trough": {{"type": "rigid", "at": ["= 400 mm - len*sin(tilt)", "= len*cos(tilt) + 50 mm", 0], "mass": 80,
        "inertia": [0, 0, 8, 0, 0, 0]}},
      "unbalance": {{"type": "rigid", "at": ["= 460 mm - len*sin(tilt)", "= len*cos(tilt) + 50 mm", 0], "mass": 5,
        "inertia": [0, 0, 0.002, 0, 0, 0], "angular_velocity": [0, 0, "= n"], "velocity": [0, "= 60 mm*n/(1 rad)", 0]}}}},
    "joints": {{
      "foot_left": {{"type": "fixed", "bodies": ["ground", "left"], "at": [0, 0, 0]}},
      "foot_right": {{"type": "fixed", "bodies": ["ground", "right"], "at": [0.8, 0, 0]}},
      "top_left": {{"type": "fixed", "bodies": ["left", "trough"], "at": ["= -len*sin(tilt)", "= len*cos(tilt)", 0]}},
      "top_right": {{"type": "fixed", "bodies": ["right", "trough"],
        "at": ["= 800 mm - len*sin(tilt)", "= len*cos(tilt)", 0]}},
      "motor": {{"type": "revolute", "bodies": ["trough", "unbalance"],
        "at": ["= 400 mm - len*sin(tilt)", "= len*cos(tilt) + 50 mm", 0],
        "drive": {{"type": "constant-speed", "speed": "= n"}}}}}}}},
  "simulation": {{"end_time": "= 2*pi*1 rad/n", "step": "0.2 ms", "initial_state": "periodic"}},
  "responses": {{"mass": {{"type": "mass"}}}}}})j",
                  revolutions_per_minute));
}

/// Stiff coordinates are counted in units far from those of the soft ones: that is no round-off.
TEST(SteadyMachines, AreFoundAtAnySpeed) {
  for (const int speed : {360, 380, 400, 450, 480})
    EXPECT_EQ(failure_of(screen(speed)), "") << speed;
}

}  // namespace
}  // namespace pleuel::test::periodic_test
