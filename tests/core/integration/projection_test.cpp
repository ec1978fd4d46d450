#include "core/integration/projection.hpp"

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/model/model.hpp"
#include "core/start/initial_state.hpp"
#include "tests/support/sample_scenes.hpp"

namespace pleuel::test::projection_test {
namespace {

/// A point mass that keeps its distance of 2 m from the origin.
Model held_mass() {
  Scene scene;
  scene.bodies = {{"mass", PointMass{{1.2, 1.6, 0.0}, 3.0}}};
  Joint string;
  string.name = "string";
  string.type = JointType::distance;
  string.bodies = {ground_name, "mass"};
  string.at = {0.0, 0.0, 0.0};
  string.to = {1.2, 1.6, 0.0};
  scene.joints = {string};
  return build_model(scene, {.spatial_motion = EffectChoice::on}, {}, {});
}

/// All directions weigh alike: the closest point of the sphere lies on the ray through the mass, and
/// of the velocity its radial part goes.
TEST(Projection, IsRadialForAPointMassOnASphere) {
  Model model = held_mass();
  ASSERT_EQ(model.mechanism.system->coordinates(), 3);
  Projection projection(model.mechanism);
  State state(3, 1);
  state.q = model.mechanism.guess.q;
  const Eigen::Vector3d origin = Eigen::Vector3d(1.2, 1.6, 0.0) - state.q;  // of the coordinates
  const Eigen::Vector3d drifted(1.3, 1.5, 0.1), velocity(-0.7, 2.0, 0.4);
  state.q = drifted - origin;
  state.v = velocity;
  ASSERT_TRUE(projection.apply(state));
  const Eigen::Vector3d expected = 2.0 * drifted.normalized();
  EXPECT_LE((state.q + origin - expected).norm(), 1e-12);
  const Eigen::Vector3d radial = expected.normalized();
  EXPECT_LE((state.v - (velocity - velocity.dot(radial) * radial)).norm(), 1e-12);
}

TEST(Projection, LeavesAStateThatMeetsTheConstraints) {
  for (const SampleScene& sample : all_samples()) {
    Model model = sample.build();
    const State start = initial_state(model.mechanism).state;
    State state = start;
    ASSERT_TRUE(Projection(model.mechanism).apply(state)) << sample.name;
    const Eigen::VectorXd& scale = model.mechanism.scale;
    EXPECT_LE((state.q - start.q).cwiseQuotient(scale).lpNorm<Eigen::Infinity>(), 1e-11)
        << sample.name;
    EXPECT_LE((state.v - start.v).cwiseQuotient(scale).lpNorm<Eigen::Infinity>(),
              1e-10 * (1.0 + start.v.lpNorm<Eigen::Infinity>()))
        << sample.name;
  }
}

}  // namespace
}  // namespace pleuel::test::projection_test
