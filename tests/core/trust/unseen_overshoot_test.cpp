/// Swings that the steps pass over. A steel rod of 1 m and 400 mm² is clamped at one end and has a
/// mass at the other: its first axial vibration is far faster than steps of 5 ms.

#include "core/trust/unseen_overshoot.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/integration/fast_vibration.hpp"
#include "tests/core/trust/doubts_of.hpp"

namespace pleuel::test::unseen_overshoot_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::SizeIs;
using testing::UnorderedElementsAre;

constexpr double young = 2.1e11, density = 7850, area = 4e-4, tip = 5.0, force = 8000.0;
constexpr double stiffness = young * area;  ///< of 1 m [N/m]

ProblemFile pulled_rod(const std::string& pull, const std::vector<std::string>& changes = {}) {
  return read_scene(fmt::format(
                        R"({{"scene": {{"bodies": {{
                "rod": {{"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0],
                  "material": "steel",
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
                "pull": {{"type": "section-force", "body": "rod", "part": "axial", "at": 0,
                          "over_time": "max"}},
                "press": {{"type": "section-force", "body": "rod", "part": "axial", "at": 0,
                           "over_time": "min"}},
                "stretch": {{"type": "position", "body": "tip", "direction": "x",
                             "over_time": "max-abs"}},
                "hold": {{"type": "reaction-force", "joint": "clamp", "direction": "x",
                          "over_time": "max-abs"}},
                "end": {{"type": "section-force", "body": "rod", "part": "axial", "at": 0,
                         "over_time": "final"}}}}}})",
                        tip, pull),
                    changes);
}

double analyze_pull(const ProblemFile& problem) {
  return analyze(problem, start_design(problem))->reductions.front().value;
}

const std::string jump = R"({"type": "step", "to": 8000, "time": "20 ms"})";

std::vector<Doubt> doubts(const ProblemFile& problem) {
  return doubts_of(problem, doubt_unseen_overshoot);
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

/// F L / E A; and x tan x = m/M with x = ω L / c of a rod of the mass m with a mass M at its end
/// (E A u' = ω² M u there), of which four elements make 0.2 %.
TEST(FastVibration, HasTheEquilibriumAndThePeriodOfTheRod) {
  SuddenPull pull({});
  const FastVibration found = pull.vibration(slow);
  ASSERT_FALSE(found.is_empty());
  State settled = pull.state;
  found.add_settled(settled);
  const double stretch = force / stiffness;
  EXPECT_NEAR((settled.q - pull.state.q).maxCoeff(), stretch, 1e-4 * stretch);
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

/// At any time its state is one of the equations of motion, multipliers and damping included.
TEST(FastVibration, KeepsTheEquationsOfMotion) {
  for (const char* damping : {"1e-6", "1e-4", "1e-3"}) {
    SuddenPull pull({fmt::format("/scene/bodies/rod/damping={{\"stiffness\": {}}}", damping)});
    const FastVibration found = pull.vibration(slow);
    for (const double share : {0.0, 0.2, 0.5, 1.3}) {
      State state = pull.state;
      found.add(share * found.main_period(), state);
      EXPECT_LE(pull.residual(state).cwiseAbs().maxCoeff(), 5e-3 * force)
          << damping << " " << share;
    }
  }
}

/// Twice as far without damping, half a period later; no further than the equilibrium where it creeps.
TEST(FastVibration, SwingsAsFarAgainUnlessItCreeps) {
  const double stretch = force / stiffness;
  const auto farthest = [&](SuddenPull pull) {
    const FastVibration found = pull.vibration(slow);
    double most = 0.0;
    for (double share = 0.0; share < 3.0; share += 0.02) {
      State state = pull.state;
      found.add(share * found.main_period(), state);
      most = std::max(most, (state.q - pull.state.q).maxCoeff());
    }
    return most;
  };
  EXPECT_NEAR(farthest(SuddenPull({})), 2.0 * stretch, 0.05 * stretch);
  const double creeping =
      farthest(SuddenPull({R"(/scene/bodies/rod/damping={"stiffness": 1e-3})"}));
  EXPECT_NEAR(creeping, stretch, 1e-2 * stretch);
  EXPECT_LE(creeping, (1.0 + 1e-6) * stretch);
}

/// More than half of the peaks is missing, as the further modes add to the first, and that the rod is
/// pressed, too; the position of the tip moves by 0.01 % only. With steps of a 170th of the period all is
/// there, and nothing is said.
TEST(UnseenOvershoot, OfALoadThatJumpsIsTold) {
  const std::vector<Doubt> found = doubts(pulled_rod(jump));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("pull", "press", "hold"));
  EXPECT_THAT(found[0].text, HasSubstr("jumps at t = 0.02 s"));
  EXPECT_THAT(found[0].text, HasSubstr("period of 0.0017 s"));
  EXPECT_THAT(found[0].text, HasSubstr("would be 2.14 times as large"));
  const ProblemFile fine = pulled_rod(jump, {"/simulation/step=1e-5"});
  EXPECT_THAT(doubts(fine), IsEmpty());
  const double coarse_pull = analyze_pull(pulled_rod(jump)), fine_pull = analyze_pull(fine);
  EXPECT_NEAR(fine_pull / coarse_pull, 2.2, 0.05);
}

/// The rod that is let go is pressed as much as it was pulled. What is missing of the pull is close to the
/// tenth from which it is told.
TEST(UnseenOvershoot, OfALoadThatIsLetGoIsToldOfTheLeast) {
  const std::vector<Doubt> found =
      doubts(pulled_rod(R"({"type": "table", "times": [0, 0.02], "values": [8000, 0],
                            "interpolation": "step"})",
                        {R"(/simulation/initial_state="quasi-static")"}));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, IsSupersetOf({"press", "hold"}));
  EXPECT_THAT(found[0].text, HasSubstr("larger by far"));
}

/// Which the implicit Euler method loses.
TEST(UnseenOvershoot, OfASuddenStartIsTold) {
  const std::string euler = R"(/simulation/scheme="implicit-euler")";
  const std::vector<Doubt> found = doubts(pulled_rod("8000", {euler}));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("pull", "press", "hold"));
  EXPECT_THAT(found[0].text, HasSubstr("begin undeformed"));
  EXPECT_THAT(doubts(pulled_rod("8000", {euler, R"(/simulation/initial_state="quasi-static")"})),
              IsEmpty());
}

/// Inertia forces jump with the acceleration: twice (M + ρ A L) a.
TEST(UnseenOvershoot, OfADriveWhoseAccelerationJumpsIsTold) {
  const std::vector<Doubt> found = doubts(pulled_rod(
      "0", {R"(/scene/joints/clamp={"type": "prismatic", "bodies": ["ground", "rod"],
               "at": [0, 0, 0], "axis": [1, 0, 0],
               "drive": {"type": "expression", "value": "= 400 m/s^2 * max(0 s, t - 20 ms)^2"}})",
            R"(/responses/hold={"type": "drive-force", "joint": "clamp", "over_time": "max-abs"})",
            R"(/simulation/scheme="implicit-euler")", "/scene/bodies/rod/section/width=0.05",
            "/scene/bodies/rod/section/height=0.05"}));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("press", "hold"));
  EXPECT_THAT(found[0].text, HasSubstr("would be 1.89 times as large"));
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
  const std::vector<Doubt> found = doubts(problem);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("pull", "late"));
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  const Monitors monitors = monitor(analysis->model, analysis->trajectory);
  const Trust trust = judge_run(TrustedRun{problem, x, *analysis, monitors});
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
      doubts(pulled_rod(R"({"type": "table", "times": [0.02, 0.06], "values": [0, 8000]})")),
      IsEmpty());
  EXPECT_THAT(doubts(pulled_rod(jump, {R"(/scene/bodies/rod/damping={"stiffness": 1e-3})"})),
              IsEmpty());
  EXPECT_THAT(doubts(pulled_rod(jump, {"/responses/pull/to=0.015", "/responses/hold/to=0.015",
                                       "/responses/press/to=0.015"})),
              IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::unseen_overshoot_test
