#include "tests/hard/hard_problems.hpp"
#include "tests/hard/rigid_references.hpp"
#include "tests/support/energy.hpp"

/// Mechanisms whose constraints depend on each other in every position.
namespace pleuel::test {
namespace {

class RedundantHardCase : public HardCase {};
PLEUEL_WITH_EACH_FORMULATION(RedundantHardCase);

/// The motion is that of the planar mechanism; forces in the plane are determined, too.
TEST_P(RedundantHardCase, PlanarSliderCrankOfSpatialRevolutesMovesInItsPlane) {
  const auto analysis = run("redundant_slider_crank");
  const RigidSliderCrank reference = steel_slider_crank(1.5);
  const double phi = reference.coasting_angle(40.0, 1.0);
  // The error of the step is 1.2e-3, as for dead_centres.json, the same mechanism in the plane,
  // which makes the same steps.
  EXPECT_NEAR(value_of(*analysis, "slider_end"), reference.slider(phi), 3e-3);
  const auto planar = run("dead_centres");
  EXPECT_NEAR(value_of(*analysis, "slider_end"), value_of(*planar, "slider_end"), 1e-12);
  EXPECT_NEAR(value_of(*analysis, "guide_force") / value_of(*planar, "guide_force"), 1.0, 1e-10);
}

/// Benchmark A04: energy within 1e-3 J for 10 s.
TEST_P(RedundantHardCase, BricardMechanismKeepsItsEnergy) {
  const auto analysis = run("bricard");
  State state(analysis->model.mechanism.system->coordinates(),
              analysis->model.mechanism.system->multipliers());
  analysis->trajectory.load(0, state);
  const double start = energy_of(analysis->model, state);
  double worst = 0.0;
  for (int step = 0; step <= analysis->trajectory.steps(); ++step) {
    analysis->trajectory.load(step, state);
    worst = std::max(worst, std::abs(energy_of(analysis->model, state) - start));
  }
  EXPECT_LE(worst, 1e-3);                         // measured 2e-4
  EXPECT_LE(largest_violation(*analysis), 1e-9);  // ten Newton tolerances
}

}  // namespace
}  // namespace pleuel::test
