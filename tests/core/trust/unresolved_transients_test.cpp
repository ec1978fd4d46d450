#include "core/base/eager_matrices.hpp"
#include "core/integration/fast_vibration.hpp"
#include "core/trust/check_list.hpp"
#include "core/trust/checks.hpp"
#include "tests/core/trust/trust_scenes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::unresolved_transients_test {
namespace {

// Swings that the steps pass over. A steel rod of 1 m and 400 mm² is clamped at one end and has a
// mass at the other: its first axial vibration is far faster than steps of 5 ms.

using testing::IsSupersetOf;

constexpr double young = 2.1e11, density = 7850, area = 4e-4, tip = 5.0, force = 8000.0;
constexpr double stiffness = young * area;  ///< of 1 m [N/m]

ProblemFile pulled_rod(const std::string& pull, const std::vector<std::string>& changes = {}) {
  return read_scene(fmt::format(
                        R"({{"scene": {{"bodies": {{
                "rod": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel",
                  "section": {{"type": "rectangle", "width": 0.02, "height": 0.02}},
                  "elements": 4, "frame": "tangent"}},
                "tip": {{"type": "point-mass", "at": [1, 0, 0], "mass": {}}}}},
              "joints": {{
                "clamp": {{"type": "fixed", "bodies": ["ground", "rod"], "at": [0, 0, 0]}},
                "pin": {{"type": "spherical", "bodies": ["rod", "tip"], "at": [1, 0, 0]}}}},
              "loads": {{"pull": {{"type": "force", "body": "tip", "at": [1, 0, 0],
                                   "direction": [1, 0, 0], "value": {}}}}}}},
              "simulation": {{"end_time": 0.1, "step": 5e-3}},
              "responses": {{
                "pull": {{"type": "section-force", "body": "rod", "part": "axial", "at": 0, "over_time": "max"}},
                "press": {{"type": "section-force", "body": "rod", "part": "axial", "at": 0, "over_time": "min"}},
                "stretch": {{"type": "position", "body": "tip", "direction": "x", "over_time": "max-abs"}},
                "hold": {{"type": "reaction-force", "joint": "clamp", "direction": "x", "over_time": "max-abs"}},
                "end": {{"type": "section-force", "body": "rod", "part": "axial", "at": 0,
                         "over_time": "final"}}}}}})",
                        tip, pull),
                    changes);
}

double analyze_pull(const ProblemFile& problem) {
  return analyze(problem, start_design(problem))->reductions.front().value;
}

const std::string jump = R"({"type": "step", "to": 8000, "time": "20 ms"})";

std::vector<Finding> findings(const ProblemFile& problem) {
  return findings_of(problem, check_unresolved_transients);
}

/// By how much the peak of a message would be larger.
double told_factor(const std::vector<Finding>& found) {
  const std::string words = "The peak would be ";
  const std::string& text = found.at(0).text;
  return std::stod(text.substr(text.find(words) + words.size()));
}

/// A mass on a spring (1 MN/m, 1 kg: 6 ms), beside what else the changes bring; in
/// steps of 20 ms, which a scheme without spectral radius damps at once.
ProblemFile sprung_mass(const std::string& push, const std::vector<std::string>& changes = {}) {
  return read_scene(fmt::format(
                        R"({{"scene": {{"bodies": {{
                "mass": {{"type": "point-mass", "at": [1, 0, 0], "mass": 1}}}},
              "joints": {{"guide": {{"type": "point-on-line", "bodies": ["ground", "mass"],
                                     "at": [1, 0, 0], "axis": [1, 0, 0]}}}},
              "loads": {{
                "spring": {{"type": "spring", "bodies": ["ground", "mass"],
                            "at": [[0, 0, 0], [1, 0, 0]], "stiffness": 1e6, "damping": 20}},
                "push": {{"type": "force", "body": "mass", "at": [1, 0, 0],
                          "direction": [1, 0, 0], "value": {}}}}}}},
              "simulation": {{"end_time": 0.4, "step": 0.02, "spectral_radius": 0}},
              "responses": {{"hold": {{"type": "spring-force", "load": "spring", "over_time": "max"}}}}}})",
                        push),
                    changes);
}

std::string steps_of_load(const std::string& times, const std::string& values,
                          const std::string& more = "") {
  return fmt::format(R"({{"type": "table", "times": {}, "values": {}, "interpolation": "step"{}}})",
                     times, values, more);
}

const std::string push_at_once = R"({"type": "step", "to": 100, "time": 0.1})";

/// Another mass of 1 kg on a line along x.
std::vector<std::string> with_mass(const std::string& name, double x, double y,
                                   std::vector<std::string> changes) {
  changes.push_back(fmt::format(
      R"(/scene/bodies/{}={{"type": "point-mass", "at": [{}, {}, 0], "mass": 1}})", name, x, y));
  changes.push_back(fmt::format(
      R"(/scene/joints/rail_of_{0}={{"type": "point-on-line", "bodies": ["ground", "{0}"],
          "at": [{1}, {2}, 0], "axis": [1, 0, 0]}})",
      name, x, y));
  return changes;
}

/// What the run with steps of a 60th of the period has more of the hold.
double true_factor(const ProblemFile& problem) {
  ProblemFile fine = problem;
  fine.simulation.step = 1e-4;
  fine.simulation.spectral_radius = 0.8;
  return analyze_pull(fine) / analyze_pull(problem);
}

void expect_true_factor(const ProblemFile& problem) {
  const std::vector<Finding> found = findings(problem);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(told_factor(found), true_factor(problem), 0.07 * true_factor(problem));
}

/// The rod at rest, and what the pull changes in its equations.
struct SuddenPull {
  std::unique_ptr<Analysis> analysis;
  State state;  ///< behind the jump
  Eigen::VectorXd change;

  explicit SuddenPull(const std::vector<std::string>& changes) {
    const ProblemFile problem = pulled_rod(jump, changes);
    analysis = analyze(problem, start_design(problem));
    analysis->trajectory.states->load(0, state);
    const Eigen::VectorXd without = residual(state);
    state.time = 0.03;
    change = residual(state) - without;
  }

  Mechanism& mechanism() { return analysis->model.mechanism; }
  Eigen::VectorXd residual(const State& at) {
    Eigen::VectorXd residual;
    mechanism().system->residual(at, ConstraintLevel::acceleration, residual);
    return residual;
  }
  FastVibration vibration(double slowest) {
    return FastVibration(mechanism(), state, change, slowest);
  }
};

constexpr double slow = 10.0;

/// x tan x = m/M with x = ω L / c of a rod of the mass m with a mass M at its end (E A u' = ω² M u
/// there), of which four elements make 0.2 %.
TEST(FastVibration, HasThePeriodOfTheRod) {
  SuddenPull pull({});
  const FastVibration found = pull.vibration(slow);
  ASSERT_FALSE(found.is_empty());
  double low = 0.1, high = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    (x * std::tan(x) < density * area / tip ? low : high) = x;
  }
  const double period = 2.0 * std::numbers::pi / (low * std::sqrt(young / density));
  EXPECT_NEAR(found.main_period(), period, 2e-3 * period);
  EXPECT_EQ(found.longest_period(), found.main_period());
  // Slower than what counts as fast.
  EXPECT_TRUE(pull.vibration(1e6).is_empty());
}

/// At any time its state is one of the equations of motion without damping, multipliers included.
TEST(FastVibration, KeepsTheEquationsOfMotion) {
  SuddenPull pull({});
  const FastVibration found = pull.vibration(slow);
  for (const double share : {0.0, 0.2, 0.5, 1.3}) {
    State state = pull.state;
    found.add(share * found.main_period(), state);
    EXPECT_LE(pull.residual(state).cwiseAbs().maxCoeff(), 5e-3 * force) << share;
  }
}

/// Twice as far as F L / E A, half a period later.
TEST(FastVibration, SwingsAsFarAgain) {
  const double stretch = force / stiffness;
  SuddenPull pull({});
  const FastVibration found = pull.vibration(slow);
  double most = 0.0;
  for (double share = 0.0; share < 3.0; share += 0.02) {
    State state = pull.state;
    found.add(share * found.main_period(), state);
    most = std::max(most, (state.q - pull.state.q).maxCoeff());
  }
  EXPECT_NEAR(most, 2.0 * stretch, 0.05 * stretch);
}

/// More than half of the peaks is missing, as the further modes add to the first, and that the rod
/// is pressed, too; the position of the tip moves by 0.01 % only. With steps of a 170th of the
/// period all is there, and nothing is said.
TEST(UnseenOvershoot, OfALoadThatJumpsIsTold) {
  const std::vector<Finding> found = findings(pulled_rod(jump));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("pull", "press", "hold"));
  EXPECT_THAT(found[0].text, HasSubstr("jumps at t = 0.02 s"));
  EXPECT_THAT(found[0].text, HasSubstr("period of 0.0017 s"));
  const ProblemFile fine = pulled_rod(jump, {"/simulation/step=1e-5"});
  EXPECT_THAT(findings(fine), IsEmpty());
  const double coarse_pull = analyze_pull(pulled_rod(jump)), fine_pull = analyze_pull(fine);
  EXPECT_NEAR(fine_pull / coarse_pull, told_factor(found), 0.05);
}

/// The rod that is let go is pressed as much as it was pulled. What is missing of the pull is close
/// to the tenth from which it is told.
TEST(UnseenOvershoot, OfALoadThatIsLetGoIsToldOfTheLeast) {
  const Finding found =
      only(findings(pulled_rod(R"({"type": "table", "times": [0, 0.02], "values": [8000, 0],
                            "interpolation": "step"})",
                               {R"(/simulation/initial_state="quasi-static")"})));
  EXPECT_THAT(found.responses, IsSupersetOf({"press", "hold"}));
  EXPECT_THAT(found.text, HasSubstr("larger by far"));
}

/// Which the implicit Euler method loses.
TEST(UnseenOvershoot, OfASuddenStartIsTold) {
  const std::string euler = R"(/simulation/scheme="implicit-euler")";
  const Finding found = only(findings(pulled_rod("8000", {euler})));
  EXPECT_THAT(found.responses, IsSupersetOf({"pull", "hold"}));
  EXPECT_THAT(found.text, HasSubstr("begin undeformed"));
  EXPECT_THAT(findings(pulled_rod("8000", {euler, R"(/simulation/initial_state="quasi-static")"})),
              IsEmpty());
}

/// Inertia forces jump with the acceleration: twice (M + ρ A L) a.
TEST(UnseenOvershoot, OfADriveWhoseAccelerationJumpsIsTold) {
  const std::vector<Finding> found = findings(pulled_rod(
      "0", {R"(/scene/joints/clamp={"type": "prismatic", "bodies": ["ground", "rod"],
               "at": [0, 0, 0], "axis": [1, 0, 0],
               "drive": {"type": "expression", "value": "= 400 m/s^2 * max(0 s, t - 20 ms)^2"}})",
            R"(/responses/hold={"type": "drive-force", "joint": "clamp", "over_time": "max-abs"})",
            R"(/simulation/scheme="implicit-euler")", "/scene/bodies/rod/section/width=0.05",
            "/scene/bodies/rod/section/height=0.05"}));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("press", "hold"));
  EXPECT_NEAR(told_factor(found), 1.9, 0.1);
}

/// Formulas of what swings, cycles of it, and windows that begin behind the jump.
TEST(UnseenOvershoot, IsThatOfFormulasCyclesAndLaterWindows) {
  const std::vector<std::string> limits = {
      R"(/responses/twice={"type": "expression", "value": "= 2 * pull"})",
      R"(/responses/late={"type": "section-force", "body": "rod", "part": "axial", "at": 0,
          "over_time": "max", "from": 0.021})",
      R"(/objective={"minimize": "twice"})",
      R"(/constraints={"late": {"response": "late", "upper": "1 MN"}})",
      R"(/scene/bodies/rod/section/width={"variable": "width"})",
      R"(/variables={"width": {"start": 0.02, "lower": 0.01, "upper": 0.05}})"};
  const ProblemFile problem = pulled_rod(jump, limits);
  const Finding found = only(findings(problem));
  EXPECT_THAT(found.responses, UnorderedElementsAre("pull", "late"));
  const StartRun start(problem);
  const Trust trust = judge_run(start.run());
  for (std::size_t i = 0; i < problem.responses.size(); ++i) {
    const std::string& name = problem.responses[i].name;
    if (name != "twice" && name != "late") continue;
    ASSERT_TRUE(trust.errors[i]) << name;
    EXPECT_FALSE(trust.errors[i]->is_resolved()) << name;
  }
}

/// A ramp far slower than the vibration, damping without a swing, a window that ends before.
TEST(UnseenOvershoot, IsNotToldWhereThereIsNone) {
  EXPECT_THAT(
      findings(pulled_rod(R"({"type": "table", "times": [0.02, 0.06], "values": [0, 8000]})")),
      IsEmpty());
  EXPECT_THAT(findings(pulled_rod(jump, {R"(/scene/bodies/rod/damping={"stiffness": 1e-3})"})),
              IsEmpty());
  EXPECT_THAT(findings(pulled_rod(jump, {"/responses/pull/to=0.015", "/responses/hold/to=0.015",
                                         "/responses/press/to=0.015"})),
              IsEmpty());
}

/// What came before its window, and how long the step behind a jump happens to be, does not matter.
TEST(UnseenOvershoot, IsMeasuredWithinTheWindow) {
  expect_true_factor(sprung_mass(steps_of_load("[0, 0.1, 0.2]", "[2000, 100, 200]"),
                                 {R"(/simulation/initial_state="quasi-static")",
                                  "/responses/hold/from=0.18", "/scene/loads/spring/damping=200"}));
  expect_true_factor(sprung_mass(
      push_at_once, {"/scene/loads/spring/stiffness=141376",
                     R"(/responses/other={"type": "position", "body": "mass", "direction": "x",
                         "over_time": "mean", "from": 0.1052})"}));
}

/// A damper that blocks one of two masses leaves the other one to swing.
TEST(UnseenOvershoot, IsNotDampedByADamperElsewhere) {
  expect_true_factor(sprung_mass(
      "0", with_mass("end", 2, 0,
                     {
                         R"(/scene/loads/between={"type": "spring", "bodies": ["mass", "end"],
                "at": [[1, 0, 0], [2, 0, 0]], "stiffness": 1e6, "damping": 1e5})",
                         fmt::format(
                             R"(/scene/loads/pull={{"type": "force", "body": "end", "at": [2, 0, 0],
                            "direction": [1, 0, 0], "value": {}}})",
                             push_at_once)})));
}

/// A spring that hardens is far stiffer than where the steps leave it, so that of its swing a sixth
/// is missing.
TEST(UnseenOvershoot, IsMostOfThatOfHardeningSprings) {
  const ProblemFile problem = sprung_mass(
      push_at_once,
      {R"(/scene/loads/spring/resistance={"type": "expression", "value": "= 1e15 N/m^3 * elongation^3"})"});
  const std::vector<Finding> found = findings(problem);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(told_factor(found), true_factor(problem), 0.18 * true_factor(problem));
}

/// Friction beyond the load carries it: 1100 N of 1000. With 300 N of friction it swings by 1.7
/// times.
TEST(UnseenOvershoot, IsHeldByDryFriction) {
  const std::string push = R"({"type": "step", "to": 1000, "time": 0.1})";
  const auto friction = [](double value) {
    return fmt::format(
        R"(/scene/loads/spring/resistance={{"type": "friction", "value": {}, "speed": 0.01}})",
        value);
  };
  const std::string undamped = "/scene/loads/spring/damping=0";
  EXPECT_THAT(findings(sprung_mass(push, {undamped, friction(1100)})), IsEmpty());
  expect_true_factor(sprung_mass(push, {undamped, friction(300)}));
}

/// Forty jumps of another mass hide none of this one, nor do forty of its own those of a late
/// window.
TEST(UnseenOvershoot, IsFoundAmongManyJumps) {
  std::string times = "[0", values = "[0";
  for (int i = 1; i <= 40; ++i) {
    times += fmt::format(", {}", 0.01 * i);
    values += i % 2 == 1 ? ", 2000" : ", 0";
  }
  const std::string toggles = steps_of_load(times + "]", values + "]");
  expect_true_factor(sprung_mass(
      R"({"type": "step", "to": 100, "time": 0.255})",
      with_mass(
          "other", 1, 1,
          {"/simulation/step=0.005",
           R"(/scene/loads/soft={"type": "spring", "bodies": ["ground", "other"],
           "at": [[0, 1, 0], [1, 1, 0]], "stiffness": 1e6, "damping": 20})",
           fmt::format(R"(/scene/loads/toggle={{"type": "force", "body": "other", "at": [1, 1, 0],
                       "direction": [1, 0, 0], "value": {}}})",
                       toggles)})));
  expect_true_factor(sprung_mass(
      toggles,
      {"/simulation/step=0.005", "/scene/loads/spring/damping=400", "/responses/hold/from=0.38"}));
}

/// 0.5 s is 0.1 s behind the first period of 0.4 s, but for round-off.
TEST(UnseenOvershoot, OfAMotionThatRepeatsItselfIsToldWhereverTheLoadJumps) {
  const std::string periodic = R"(/simulation/initial_state={"type": "periodic", "period": 0.4})";
  for (const double on : {0.04, 0.1, 0.12, 0.3}) {
    const ProblemFile problem =
        sprung_mass(steps_of_load(fmt::format("[0, {}, {}, 0.4]", on, on + 0.08), "[0, 100, 0, 0]",
                                  R"(, "period": 0.4)"),
                    {periodic});
    const std::vector<Finding> found = findings(problem);
    ASSERT_THAT(found, SizeIs(1)) << on;
    EXPECT_NEAR(told_factor(found), true_factor(problem), 0.1 * true_factor(problem)) << on;
    EXPECT_THAT(found[0].text, Not(HasSubstr("quasi-static"))) << on;
  }
}

/// Steps of index 3 that are divided suddenly have a transient in the forces of joints: not in the
/// peaks that are told. 200 rad/s in steps of 2 ms.
TEST(UnseenOvershoot, OfForcesOfAFastMechanismIsNoTransientOfTheSteps) {
  const ProblemFile coarse =
      read_problem(
          source_folder() + "/problems/slider_crank.json",
          {R"(/scene/loads={"hit": {"type": "force", "body": "slider", "at": ["300 mm", 0, 0],
          "direction": [1, 0, 0], "value": {"type": "step", "to": -2000, "time": 0.08}}})",
           R"(/scene/joints/bearing/drive/ramp="10 ms")", "/simulation/step=2e-3",
           R"(/scene/bodies/crank/damping={"stiffness": "1e-4 s"})",
           R"(/scene/bodies/rod/damping={"stiffness": "1e-4 s"})",
           R"(/responses/pin={"type": "reaction-force", "joint": "slider_pin", "direction": "x",
           "over_time": "max-abs"})",
           R"(/constraints/pin={"response": "pin", "upper": "1 MN"})"})
          .complete();
  EXPECT_THAT(findings(coarse), IsEmpty());
}

/// A swing that is over long before its window begins is none: 5 % of damping, 60 and 1500 periods.
TEST(UnseenOvershoot, IsOverInWindowsFarBehind) {
  for (const double end : {0.6, 10.0}) {
    EXPECT_THAT(
        findings(sprung_mass(push_at_once, {fmt::format("/simulation/end_time={}", end),
                                            "/scene/loads/spring/damping=100",
                                            fmt::format("/responses/hold/from={}", end - 0.1)})),
        IsEmpty())
        << end;
  }
}

/// Its window is in the period after the jump, 10 ms before the end of this one.
TEST(UnseenOvershoot, GoesOnInTheNextPeriod) {
  const ProblemFile problem =
      sprung_mass(steps_of_load("[0, 0.39, 0.4]", "[0, 100, 0]", R"(, "period": 0.4)"),
                  {R"(/simulation/initial_state={"type": "periodic", "period": 0.4})",
                   "/responses/hold/to=0.08"});
  const std::vector<Finding> found = findings(problem);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(told_factor(found), true_factor(problem), 0.1 * true_factor(problem));
}

/// A place that swings little beside where it is has no warning: its bar knows what the steps pass over.
TEST(UnseenOvershoot, IsInTheBarsOfWhatHasNoWarning) {
  const ProblemFile problem = pulled_rod(jump);
  const StartRun start(problem);
  const Trust trust = judge_run(start.run());
  const auto stretch = static_cast<std::size_t>(response_index(problem, "stretch"));
  ProblemFile fine = problem;
  fine.simulation.step = 1e-5;
  const double truth = analyze(fine, start.x)->reductions[stretch].value;
  const double missed = std::abs(truth - start.analysis->reductions[stretch].value);
  ASSERT_TRUE(trust.errors[stretch]);
  // The run with short steps has twenty of them a period: it sees all but 1 %.
  EXPECT_GE(trust.errors[stretch]->step.bound, 0.97 * missed);
  EXPECT_GT(missed, 0.3 * force / stiffness) << "the swing doubles the stretch of 8 kN";
}

// Peaks that the start decides.

/// A cantilever of 1 m whose tip is pushed: its first period is 62 ms.
ProblemFile pushed_cantilever(const std::string& push,
                              const std::vector<std::string>& changes = {}) {
  return read_scene(
      fmt::format(
          R"({{"scene": {{"bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
              "material": "steel", "section": {{"type": "rectangle", "width": 0.03, "height": 0.02}},
              "elements": 4, "frame": "tangent"}}}},
              "joints": {{"clamp": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}}}},
              "loads": {{"push": {{"type": "force", "body": "beam", "at": [1, 0, 0],
                                   "direction": [0, -1, 0], "value": {}}}}}}},
              "effects": {{"geometric_stiffening": "off"}},
              "simulation": {{"end_time": 0.2, "step": 0.0002}},
              "responses": {{
                "tip": {{"type": "deflection", "body": "beam", "at": 1, "over_time": "max-abs"}},
                "pull": {{"type": "section-force", "body": "beam", "part": "axial",
                          "at": 0.5, "over_time": "max-abs"}},
                "end": {{"type": "deflection", "body": "beam", "at": 1, "over_time": "final"}}}}}})",
          push),
      changes);
}

std::vector<Finding> startup_findings(const ProblemFile& problem) {
  return findings_of(problem, check_startup_transient);
}

/// Without damping a load that is there at once deflects twice as far as at rest (the second and
/// further modes, 3 % of the deflection, take their share at other times).
TEST(SuddenStart, OfAConstantLoadIsToldByHowMuch) {
  const Finding found = only(startup_findings(pushed_cantilever("20")));
  EXPECT_FALSE(found.is_serious);
  EXPECT_THAT(found.responses, ElementsAre("tip"));
  EXPECT_THAT(found.text, HasSubstr("the start decides \"tip\": "));
  EXPECT_THAT(found.text, HasSubstr("it would be 0.50"));
}

/// Laws that begin with a jump say so themselves; such that begin at zero shake nothing.
TEST(SuddenStart, IsNotToldOfLawsThatJumpOrBeginAtZero) {
  EXPECT_THAT(startup_findings(pushed_cantilever(
                  R"({"type": "step", "from": 0, "to": 20, "time": 0, "rise": 0})")),
              IsEmpty());
  EXPECT_THAT(startup_findings(pushed_cantilever(
                  R"({"type": "table", "times": [0, 0.1, 1], "values": [0, 20, 20]})")),
              IsEmpty());
}

TEST(SuddenStart, IsNoneFromEquilibriumOrWithDeflectionsThatAreGiven) {
  EXPECT_THAT(
      startup_findings(pushed_cantilever("20", {"/simulation/initial_state=\"quasi-static\""})),
      IsEmpty());
  EXPECT_THAT(startup_findings(pushed_cantilever(
                  "20", {R"(/scene/bodies/beam/initial_deflections=[{"at": [1, 0, 0],
                         "direction": [0, 1, 0], "displacement": 0.001}])"})),
              IsEmpty());
}

/// No comparison run where the file asks for none.
TEST(SuddenStart, IsNotLookedForWithoutChecks) {
  EXPECT_THAT(startup_findings(pushed_cantilever("20", {"/simulation/resolution_check=false"})),
              IsEmpty());
}

/// What has come to rest before the window begins is not of the start.
TEST(SuddenStart, ThatHasDiedOutIsNotTold) {
  const std::vector<std::string> damped = {R"(/scene/bodies/beam/damping={"mass": 80})",
                                           "/responses/tip/from=0.15"};
  EXPECT_THAT(startup_findings(pushed_cantilever("20", damped)), IsEmpty());
  EXPECT_THAT(startup_findings(pushed_cantilever("20", {damped[0]})), SizeIs(1));
}

/// A crank that turns at full speed from the first instant, with and without a run-up.
TEST(SuddenStart, OfADriveIsToldAndNotOfARunUp) {
  const auto crank = [](const std::string& drive) {
    return read_scene(fmt::format(
        R"({{"scene": {{"bodies": {{"arm": {{"type": "beam", "from": [0, 0, 0], "to": [0.5, 0, 0],
            "material": "steel", "section": {{"type": "rectangle", "width": 0.01, "height": 0.004}},
            "elements": 4}}, "block": {{"type": "point-mass", "at": [0.5, 0, 0], "mass": 0.1}}}},
            "joints": {{"shaft": {{"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0], "drive": {}}},
                        "end": {{"type": "fixed", "bodies": ["arm", "block"], "at": [0.5, 0, 0]}}}}}},
            "simulation": {{"end_time": 0.4, "step": 0.0005}},
            "responses": {{"bend": {{"type": "stress", "body": "arm", "over_time": "max"}}}}}})",
        drive));
  };
  EXPECT_THAT(startup_findings(crank(R"({"type": "constant-speed", "speed": 60})")), SizeIs(1));
  EXPECT_THAT(startup_findings(crank(R"({"type": "ramp-to-speed", "speed": 60, "ramp": 0.2})")),
              IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::unresolved_transients_test
