#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "tests/hard/hard_problems.hpp"
#include "tests/hard/rigid_references.hpp"
#include "tests/support/energy.hpp"

/// Mechanisms whose constraints depend on each other in every position. They move right, or the
/// program says which joints are to blame: nothing in between.
namespace pleuel::test {
namespace {

class RedundantHardCase : public HardCase {
 protected:
  /// The analysis, or null after checking what the failure says.
  static std::unique_ptr<Analysis> run_or_blame(const std::string& name,
                                                const std::string& expected) {
    try {
      return run(name);
    } catch (const SimulationError& error) {
      EXPECT_THAT(error.what(), testing::ContainsRegex(expected));
      return nullptr;
    }
  }
};
PLEUEL_WITH_EACH_FORMULATION(RedundantHardCase);

/// The motion is that of the planar mechanism; forces in the plane are determined, too.
TEST_P(RedundantHardCase, PlanarSliderCrankOfSpatialRevolutesMovesInItsPlaneOrIsRefused) {
  const auto analysis = run_or_blame("redundant_slider_crank", "constrain the same motion twice");
  if (!analysis) return;
  const RigidSliderCrank reference = steel_slider_crank(1.5);
  const double phi = reference.coasting_angle(20.0, 1.0);
  // As for dead_centres.json, the same mechanism in the plane: error of the step.
  EXPECT_NEAR(value_of(*analysis, "slider_end"), reference.slider(phi), 1e-3);
  const auto planar = run("dead_centres");
  EXPECT_NEAR(value_of(*analysis, "slider_end"), value_of(*planar, "slider_end"), 1e-8);
  EXPECT_NEAR(value_of(*analysis, "guide_force") / value_of(*planar, "guide_force"), 1.0, 1e-6);
}

/// Benchmark A04: energy within 1e-3 J for 10 s.
TEST_P(RedundantHardCase, BricardMechanismKeepsItsEnergyOrIsRefused) {
  const auto analysis = run_or_blame("bricard", "hinge");
  if (!analysis) return;
  State state(analysis->model.mechanism.system->coordinates(),
              analysis->model.mechanism.system->multipliers());
  analysis->trajectory.load(0, state);
  const double start = energy_of(analysis->model, state);
  for (int step = 0; step <= analysis->trajectory.steps(); ++step) {
    analysis->trajectory.load(step, state);
    ASSERT_NEAR(energy_of(analysis->model, state), start, 1e-3) << "step " << step;
  }
  EXPECT_LE(largest_violation(*analysis), 1e-9);
}

}  // namespace
}  // namespace pleuel::test
