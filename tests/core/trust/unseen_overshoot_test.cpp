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

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
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

const std::string jump = R"({"type": "step", "to": 8000, "time": "20 ms"})";

std::vector<Doubt> doubts(const ProblemFile& problem) {
  return doubts_of(problem, doubt_unseen_overshoot);
}

/// F L / E A, and ω² = E A / L (M + m/3) of the rod that stretches as at rest, which is Rayleigh's
/// quotient.
TEST(FastVibration, OfARodIsThatOfItsStatics) {
  const double damping = 1e-5;
  const ProblemFile problem =
      pulled_rod(jump, {fmt::format("/scene/bodies/rod/damping={{\"stiffness\": {}}}", damping)});
  const auto analysis = analyze(problem, start_design(problem));
  const Mechanism& mechanism = analysis->model.mechanism;
  State state;
  analysis->trajectory.states->load(0, state);
  Eigen::VectorXd without, with;
  mechanism.system->residual(state, ConstraintLevel::acceleration, without);
  state.time = 0.03;
  mechanism.system->residual(state, ConstraintLevel::acceleration, with);
  constexpr double sigma = 1.0;
  const FastVibration found = fast_vibration(mechanism, state, with - without, sigma);
  const double stretch = force / stiffness, mass = tip + density * area / 3.0;
  const double frequency = std::sqrt(stiffness / mass);
  EXPECT_NEAR(found.settled_q.maxCoeff(), stretch, 1e-6 * stretch);
  EXPECT_NEAR(found.frequency, frequency, 1e-6 * frequency);
  const double ratio = damping * frequency / 2.0;
  EXPECT_NEAR(found.damping_ratio, ratio, 1e-6 * ratio);
  EXPECT_NEAR(found.overshoot(),
              std::exp(-std::numbers::pi * ratio / std::sqrt(1.0 - ratio * ratio)), 1e-6);
  // Slower than what counts as fast: nothing is left.
  EXPECT_LT(fast_vibration(mechanism, state, with - without, 100.0 * frequency)
                .settled_q.cwiseAbs()
                .maxCoeff(),
            1e-3 * stretch);
}

TEST(FastVibration, GoesNoFurtherThanItsEquilibriumWhereItCreeps) {
  FastVibration creeping;
  creeping.damping_ratio = 1.5;
  EXPECT_EQ(creeping.overshoot(), 0.0);
  EXPECT_EQ(FastVibration{}.overshoot(), 1.0);
}

/// Half of the peaks is missing; the position of the tip moves by 0.01 % only. With steps of a 170th
/// of the period all is there, the further modes add their tenth, and nothing is said.
TEST(UnseenOvershoot, OfALoadThatJumpsIsTold) {
  const std::vector<Doubt> found = doubts(pulled_rod(jump));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_TRUE(found[0].is_serious);
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("pull", "hold"));
  EXPECT_THAT(found[0].text, HasSubstr("jumps at t = 0.02 s"));
  EXPECT_THAT(found[0].text, HasSubstr("period of 0.0017 s"));
  EXPECT_THAT(found[0].text, HasSubstr("would be 1.86 times as large"));
  const ProblemFile fine = pulled_rod(jump, {"/simulation/step=1e-5"});
  EXPECT_THAT(doubts(fine), IsEmpty());
  const double pull = analyze(fine, start_design(fine))->reductions.front().value;
  EXPECT_GT(pull, 2.0 * force);
  EXPECT_LT(pull, 2.3 * force);
}

/// The rod that is let go is pressed as much as it was pulled.
TEST(UnseenOvershoot, OfALoadThatIsLetGoIsToldOfTheLeast) {
  const std::vector<Doubt> found =
      doubts(pulled_rod(R"({"type": "table", "times": [0, 0.02], "values": [8000, 0],
                            "interpolation": "step"})",
                        {R"(/simulation/initial_state="quasi-static")"}));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, ElementsAre("press"));
  EXPECT_THAT(found[0].text, HasSubstr("78.9 times as large"));
}

/// Generalized-α of little dissipation keeps the swing from an undeformed start, if at wrong times;
/// the implicit Euler method loses it.
TEST(UnseenOvershoot, OfASuddenStartIsTold) {
  const std::string euler = R"(/simulation/scheme="implicit-euler")";
  const std::vector<Doubt> found = doubts(pulled_rod("8000", {euler}));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].responses, UnorderedElementsAre("pull", "hold"));
  EXPECT_THAT(found[0].text, HasSubstr("begin undeformed"));
  EXPECT_THAT(doubts(pulled_rod("8000")), IsEmpty());
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
  EXPECT_THAT(found[0].text, HasSubstr("would be 1.91 times as large"));
}

/// A ramp far slower than the vibration, damping without a swing, a window that ends before.
TEST(UnseenOvershoot, IsNotToldWhereThereIsNone) {
  EXPECT_THAT(
      doubts(pulled_rod(R"({"type": "table", "times": [0.02, 0.06], "values": [0, 8000]})")),
      IsEmpty());
  EXPECT_THAT(doubts(pulled_rod(jump, {R"(/scene/bodies/rod/damping={"stiffness": 1e-3})"})),
              IsEmpty());
  EXPECT_THAT(doubts(pulled_rod(jump, {"/responses/pull/to=0.015", "/responses/hold/to=0.015"})),
              IsEmpty());
}

}  // namespace
}  // namespace pleuel::test::unseen_overshoot_test
