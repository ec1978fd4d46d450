#include "tests/hard/hard_problems.hpp"
#include "tests/hard/rigid_references.hpp"
#include "tests/support/energy.hpp"

/// Mechanisms whose constraints depend on each other in every position.
namespace pleuel::test::redundancy_test {
namespace {

class RedundantHardCase : public HardCase {};
PLEUEL_WITH_EACH_FORMULATION(RedundantHardCase);

/// The motion is that of the planar mechanism; forces in the plane are determined, too. 2000 steps add
/// up what Newton's method leaves in each, in other ways in the plane and in space.
TEST_P(RedundantHardCase, PlanarSliderCrankOfSpatialRevolutesMovesInItsPlane) {
  const std::vector<std::string> exact = {"/simulation/newton_tolerance=1e-13"};
  const auto analysis = run("redundant_slider_crank", exact);
  const RigidSliderCrank reference = steel_slider_crank(1.5);
  const double phi = reference.coasting_angle(40.0, 1.0);
  // The error of the step is 1.2e-3, as for dead_centres.json, the same mechanism in the plane,
  // which makes the same steps.
  EXPECT_NEAR(value_of(*analysis, "slider_end"), reference.slider(phi), 3e-3);
  const auto planar = run("dead_centres", exact);
  EXPECT_NEAR(value_of(*analysis, "slider_end"), value_of(*planar, "slider_end"), 1e-11);
  EXPECT_NEAR(value_of(*analysis, "guide_force") / value_of(*planar, "guide_force"), 1.0, 1e-10);
}

/// The mechanism is symmetric about its plane, so that weight across it is carried by forces across
/// it and by moments in it: what the plane determines stays as it is, and each body is in balance:
/// the slider's m g is what guide and pin exert on it together.
TEST_P(RedundantHardCase, SpatialRevolutesCarryAWeightAcrossThePlaneTogether) {
  const auto reaction = [](const std::string& joint, const std::string& direction) {
    return fmt::format(
        R"(/responses/{0}_{1}={{"type": "reaction-force", "joint": "{0}", "direction": "{1}", "over_time": "final"}})",
        joint, direction);
  };
  const double across = 7.0;
  const auto analysis =
      run("redundant_slider_crank",
          {"/simulation/end_time=0.1", fmt::format("/scene/gravity=[0, 0, {}]", across),
           reaction("guide", "z"), reaction("slider_pin", "z"), reaction("bearing", "x"),
           reaction("bearing", "z"), reaction("crank_pin", "z")});
  const auto planar = run("dead_centres", {"/simulation/end_time=0.1", reaction("bearing", "x")});
  const auto value = [&](const char* name) { return value_of(*analysis, name); };
  // Measured 6e-9: what Newton's method leaves of the multipliers of index 3.
  EXPECT_NEAR(value("bearing_x") / value_of(*planar, "bearing_x"), 1.0, 6e-8);
  // A joint acts on its second body; bearing and pins on crank, rod and slider, in this order.
  const double slider = 1.5, rod = 7850 * 0.25 * 0.01 * 0.02, crank = 7850 * 0.1 * 0.02 * 0.02;
  EXPECT_NEAR(value("guide_z") + value("slider_pin_z"), -slider * across, 1e-9);
  EXPECT_NEAR(value("crank_pin_z") - value("slider_pin_z"), -rod * across, 1e-9);
  EXPECT_NEAR(value("bearing_z") - value("crank_pin_z"), -crank * across, 1e-9);
  EXPECT_GT(std::abs(value("bearing_z")), 0.1 * across);  // all of them carry
  EXPECT_GT(std::abs(value("guide_z")), 0.1 * across);
}

/// Benchmark A04: energy within 1e-3 J for 10 s.
TEST_P(RedundantHardCase, BricardMechanismKeepsItsEnergy) {
  const auto analysis = run("bricard");
  State state(analysis->model.mechanism.system->coordinates(),
              analysis->model.mechanism.system->multipliers());
  analysis->trajectory.states->load(0, state);
  const double start = energy_of(analysis->model, state);
  double worst = 0.0;
  for (int step = 0; step <= analysis->trajectory.steps(); ++step) {
    analysis->trajectory.states->load(step, state);
    worst = std::max(worst, std::abs(energy_of(analysis->model, state) - start));
  }
  EXPECT_LE(worst, 1e-3);                         // measured 2e-4
  EXPECT_LE(largest_violation(*analysis), 1e-9);  // ten Newton tolerances
}

}  // namespace
}  // namespace pleuel::test::redundancy_test
