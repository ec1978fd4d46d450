#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "tests/support/convergence.hpp"
#include "tests/support/energy.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::pendulum_test {
namespace {

/// IFToMM benchmark A01: 1 kg at 1 m, from (−1, 0) at rest.
Eigen::Vector2d pendulum_at(double time, double step, EffectChoice spatial) {
  Scene scene;
  scene.gravity = {0.0, -9.81, 0.0};
  // In space a body needs some inertia about the rod; it does not turn that way.
  const double inertia = spatial == EffectChoice::on ? 0.1 : 0.0;
  scene.bodies = {{"mass", RigidBody{{-1.0, 0.0, 0.0}, 1.0, {inertia, 0.0, 0.0, 0.0, 0.0, 0.0}}}};
  Joint joint;
  joint.name = "pin";
  joint.bodies = {ground_name, "mass"};
  joint.at = {0.0, 0.0, 0.0};
  scene.joints = {joint};
  Model model = build_model(scene, {.spatial_motion = spatial}, {}, {});
  SimulationOptions options{time, step, 0.8};
  options.newton_tolerance = 1e-12;
  const Trajectory trajectory = simulate(model.mechanism, options);
  return trajectory.columns().q().col(trajectory.steps()).head<2>();
}

/// IFToMM benchmark A01, exact. Richardson's step removes the h² of the error; measured 3e-10.
TEST(Pendulum, IsWhereTheEllipticFunctionsPutIt) {
  for (auto spatial : {EffectChoice::off, EffectChoice::on}) {
    const double h = 1e-3;
    const Eigen::Vector2d coarse = pendulum_at(1.0, h, spatial),
                          fine = pendulum_at(1.0, h / 2, spatial);
    const Eigen::Vector2d found = fine + (fine - coarse) / 3;
    EXPECT_NEAR(found.x(), 0.98629175113188, 3e-9);
    EXPECT_NEAR(found.y(), -0.16501085312554, 3e-9);
    EXPECT_NEAR(fine.x(), 0.98629175113188, 1e-5);
  }
}

/// A rubber beam that falls from the horizontal and swings, without damping.
double energy_drift(double step) {
  Scene scene = swinging_beam(0.5, RectangleSection{0.02, 0.02}, 3);
  scene.materials[0] = {"steel", 5e6, 0.3, 1100.0};
  Model model = build_model(scene, {}, {}, {});
  SimulationOptions options{0.5, step, 1.0};
  options.spectral_radius = 0.95;
  options.newton_tolerance = 1e-11;
  const Trajectory trajectory = simulate(model.mechanism, options);
  State state;
  trajectory.states->load(0, state);
  const double start = energy_of(model, state);
  double drift = 0.0;
  for (int i = 0; i <= trajectory.steps(); ++i) {
    trajectory.states->load(i, state);
    drift = std::max(drift, std::abs(energy_of(model, state) - start));
  }
  return drift / (0.5 * 9.81 * model.bodies[0].mass * 0.5);  // against what falling sets free
}

TEST(FlexiblePendulum, KeepsItsEnergyTheBetterTheSmallerTheStep) {
  std::vector<double> steps, drifts;
  for (double step : {4e-4, 2e-4, 1e-4}) {
    steps.push_back(step);
    drifts.push_back(energy_drift(step));
  }
  EXPECT_NEAR(observed_order(steps, drifts), 2.0, 0.25);
  EXPECT_LE(drifts.back(), 1e-4);
}

}  // namespace
}  // namespace pleuel::test::pendulum_test
