#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "tests/support/places.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::reduced_body_test {
namespace {

/// The slider-crank of the reduced sample with its slider and a spring between nodes, all beams
/// flexible and longer in elements.
SampleScene sample_with(std::optional<int> modes, EffectChoice spatial,
                        ReferenceCondition rod_frame = ReferenceCondition::chord) {
  SampleScene sample = reduced_sample();
  sample.effects.spatial_motion = spatial;
  for (Body& body : sample.scene.bodies) {
    auto& beam = std::get<BeamBody>(body.shape);
    if (body.name == "rod") beam.frame = rod_frame;
    if (body.name == "rod" || body.name == "crank") beam.segments[0].elements = 6;
    beam.damping = {1.0, 1e-4};  // modal damping is for modes only
    if (body.name == "slider") continue;
    beam.reduction.reset();
    if (modes) beam.reduction = CraigBampton{*modes, {}};
  }
  return sample;
}

/// Places along the crank and the rod, the tips of flag and arm: one row each, a column a step.
Eigen::MatrixXd places_of(const SampleScene& sample, int* coordinates = nullptr) {
  Model model = sample.build();
  if (coordinates) *coordinates = model.mechanism.system->coordinates();
  SimulationOptions options{0.05, 5e-4, 0.8};
  options.newton_tolerance = 1e-13;
  const Trajectory trajectory = simulate(model.mechanism, options);
  Eigen::MatrixXd places(15, trajectory.steps() + 1);
  State state;
  for (int step = 0; step <= trajectory.steps(); ++step) {
    trajectory.states->load(step, state);
    places.col(step) << position_of(model.body("crank"), state, 0.6),
        position_of(model.body("rod"), state, 0.0), position_of(model.body("rod"), state, 0.55),
        position_of(model.body("flag"), state, 0.0), position_of(model.body("arm"), state, 1.0);
  }
  return places;
}

double distance_of(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).lpNorm<Eigen::Infinity>();
}

/// All modes span what all nodes span: only round-off differs, multiplied by what the stiffest
/// modes make of it. [m], of a mechanism of half a metre.
TEST(CraigBamptonModes, AllOfThemMoveAsAllNodesDo) {
  for (EffectChoice spatial : {EffectChoice::off, EffectChoice::on}) {
    for (auto frame : {ReferenceCondition::chord, ReferenceCondition::mean_axis}) {
      const auto full = places_of(sample_with({}, spatial, frame));
      const auto reduced = places_of(sample_with(1000, spatial, frame));
      EXPECT_LE(distance_of(reduced, full), 1e-9);
      // They do move, and bend.
      EXPECT_GE((full.col(100) - full.col(0)).lpNorm<Eigen::Infinity>(), 0.02);
    }
  }
}

/// A number means as many modes of bending in the plane, whatever else a beam can do in space.
TEST(CraigBamptonModes, OfANumberAreTheSameInSpaceAsInThePlane) {
  for (auto frame : {ReferenceCondition::chord, ReferenceCondition::mean_axis,
                     ReferenceCondition::tangent, ReferenceCondition::tangent_end}) {
    for (EffectChoice stiffening : {EffectChoice::on, EffectChoice::off}) {
      const auto places_in = [&](EffectChoice spatial) {
        SampleScene sample = sample_with(2, spatial, frame);
        sample.effects.geometric_stiffening = stiffening;
        return places_of(sample);
      };
      // Round-off, multiplied by what the stiffest modes make of it.
      EXPECT_LE(distance_of(places_in(EffectChoice::on), places_in(EffectChoice::off)), 1e-9);
    }
  }
}

/// Measured: 5.8e-6, 2.4e-7, 2.6e-8, 4.1e-9 m.
TEST(CraigBamptonModes, AFewOfThemConverge) {
  int full_size = 0;
  // Less damping than elsewhere: where it is stiff in a step for some of the modes only, starts
  // differ (core/integration/damped_start.hpp), by 1e-6 m here.
  const auto sample_of = [](std::optional<int> modes) {
    SampleScene sample = sample_with(modes, EffectChoice::off);
    for (Body& body : sample.scene.bodies) {
      std::get<BeamBody>(body.shape).damping = {1.0, 5e-5};
    }
    return sample;
  };
  const auto full = places_of(sample_of({}), &full_size);
  double previous = 1.0;
  for (int modes : {0, 1, 2, 4}) {
    int size = 0;
    const double error = distance_of(places_of(sample_of(modes), &size), full);
    EXPECT_LT(error, previous / 3) << modes << " modes";
    EXPECT_LT(size, full_size);
    previous = error;
  }
  EXPECT_LE(previous, 1e-8);
}

}  // namespace
}  // namespace pleuel::test::reduced_body_test
