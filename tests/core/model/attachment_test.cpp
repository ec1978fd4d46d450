#include "core/model/attachment.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/model/body_builder.hpp"
#include "tests/support/places.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::attachment_test {
namespace {

/// The beams of a mechanism in space with nodal displacements or with modes as coordinates, what
/// they were built with, and a bent state of them.
class Bodies {
 public:
  explicit Bodies(std::optional<int> modes = {}) {
    for (Body& body : sample_.scene.bodies) {
      auto& beam = std::get<BeamBody>(body.shape);
      beam.reduction.reset();
      beam.damping = {};
      if (modes) beam.reduction = CraigBampton{*modes, {}};
      context_.beam_effects[body.name] = decide_effects(body, effects_);
    }
    int coordinates = 0;
    for (const Body& body : sample_.scene.bodies) {
      bodies_.push_back(make_body_model(body, context_, coordinates));
      coordinates += bodies_.back().frame.size() + bodies_.back().elastic_size();
    }
    state_.q = Eigen::VectorXd::Zero(coordinates);
    state_.v = state_.a = state_.q;
    for (const BodyModel& body : bodies_) {
      for (int i = 0; i < body.elastic_size(); ++i) {
        state_.q(body.elastic_offset() + i) = 1e-3 * std::sin(1.0 + 7.0 * i);
      }
    }
  }

  Attachment at(const std::string& body, const Point& point) const {
    return Attachment(body, point, bodies_, context_);
  }
  const BodyModel& model(const std::string& name) const { return *find_named(bodies_, name); }
  const BeamBody& beam(const std::string& name) const {
    return std::get<BeamBody>(find_named(sample_.scene.bodies, name)->shape);
  }
  Point along(const std::string& name, double share) const {
    const Eigen::Vector3d from = resolve_point(beam(name).from, sample_.design);
    const Eigen::Vector3d to = resolve_point(beam(name).to, sample_.design);
    const Eigen::Vector3d point = from + share * (to - from);
    return {point.x(), point.y(), point.z()};
  }
  const Design<double>& design() const { return sample_.design; }
  const Body& body(const std::string& name) const {
    return *find_named(sample_.scene.bodies, name);
  }
  const State& state() const { return state_; }

 private:
  SampleScene sample_ = reduced_sample_in_space();
  EffectSettings effects_;
  BuildContext context_{sample_.scene,  effects_,     sample_.design,
                        sample_.design, std::nullopt, Eigen::Vector3d::Zero()};
  std::vector<BodyModel> bodies_;
  State state_;
};

/// Displacement of a place in local axes, from its rows.
Eigen::VectorXd moved(const Attachment& attachment, const State& state) {
  const Attachment::Rows& rows = attachment.displacement_rows();
  return rows.values * state.q(rows.coordinates);
}

TEST(Attachment, OnTheGroundIsThePointItself) {
  const Bodies bodies;
  const Attachment attachment = bodies.at(ground_name, {0.1, -0.2, 0.3});
  EXPECT_TRUE(attachment.is_ground());
  EXPECT_EQ(attachment.marker().frame.size(), 0);
  EXPECT_EQ(attachment.local_point(bodies.design()), Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(attachment.local_direction({0.0, 0.6, 0.8}, bodies.design()),
            Eigen::Vector3d(0.0, 0.6, 0.8));
}

/// The pose of the body leads from the local point and direction back to those of the scene.
TEST(Attachment, HasItsPointAndDirectionsInTheAxesOfItsBody) {
  const Bodies bodies;
  for (const char* name : {"crank", "rod"}) {
    const Point point = bodies.along(name, 1.0);
    const Attachment attachment = bodies.at(name, point);
    const Pose<double> pose = body_pose(bodies.body(name), bodies.design());
    const Eigen::Vector3d back =
        pose.origin + pose.rotation * attachment.local_point(bodies.design());
    EXPECT_NEAR((back - resolve_point(point, bodies.design())).norm(), 0.0, 1e-15) << name;
    const Eigen::Vector3d direction =
        pose.rotation * attachment.local_direction({0.0, 0.6, 0.8}, bodies.design());
    EXPECT_NEAR((direction - Eigen::Vector3d(0.0, 0.6, 0.8)).norm(), 0.0, 1e-15) << name;
  }
}

/// Nodes, and places between them, against the shape functions of the beam.
TEST(Attachment, MovesAsThePlaceOfItsBeam) {
  for (const std::optional<int> modes : {std::optional<int>(), std::optional<int>(3)}) {
    const Bodies bodies(modes);
    for (const char* name : {"crank", "rod", "flag", "arm"}) {
      const BodyModel& body = bodies.model(name);
      ASSERT_TRUE(body.is_elastic);
      for (const double share : {0.0, 0.37, 1.0}) {
        const Attachment attachment = bodies.at(name, bodies.along(name, share));
        const Eigen::VectorXd rows = moved(attachment, bodies.state());
        const Eigen::Vector3d expected = deflection_at(body, bodies.state(), share);
        EXPECT_NEAR((rows.head(3) - expected).norm(), 0.0, 1e-16 + 1e-12 * expected.norm())
            << name << " at " << share << (modes ? ", modes" : "");
      }
    }
  }
}

/// A marker can name coordinates only where displacements are coordinates.
TEST(Attachment, OfANodeNamesItsCoordinatesAndOfModesNone) {
  const Bodies nodes, modes(2);
  const auto named = [](const Attachment& attachment) {
    const Marker marker = attachment.marker();
    return std::count_if(marker.elastic.begin(), marker.elastic.end(),
                         [](int index) { return index >= 0; });
  };
  const Attachment of_node = nodes.at("crank", nodes.along("crank", 1.0 / 3.0));
  EXPECT_TRUE(of_node.is_direct());
  EXPECT_EQ(named(of_node), 6);
  const Attachment of_modes = modes.at("flag", modes.along("flag", 0.5));
  EXPECT_FALSE(of_modes.is_direct());
  EXPECT_EQ(named(of_modes), 0);
  EXPECT_GT(of_modes.displacement_rows().coordinates.size(), 1u);
}

/// The map to local coordinates gives a marker the displacements that its rows say.
TEST(Attachment, HasLocalCoordinatesThatAreItsDisplacements) {
  const Bodies bodies(2);
  const Attachment tip = bodies.at("rod", bodies.along("rod", 0.5));
  std::vector<Marker> markers = {tip.marker()};
  const CoordinateMap map = make_local(std::span(&tip, 1), markers);
  Eigen::VectorXd columns(map.columns()), local;
  map.gather(bodies.state().q, columns, local);
  const Eigen::VectorXd displacement = moved(tip, bodies.state());
  EXPECT_GT(displacement.head(3).norm(), 0.0);
  for (int i = 0; i < 6; ++i) {
    const int index = markers[0].elastic[i];
    EXPECT_EQ(index < 0 ? 0.0 : local(index), displacement(i)) << i;
  }
}

TEST(ReferenceDirection, IsAUnitVectorAcrossTheAxisInTheAxesOfABeam) {
  const Bodies bodies;
  const std::vector<Attachment> attachments = {bodies.at(ground_name, {0.0, 0.0, 0.0}),
                                               bodies.at("rod", bodies.along("rod", 0.0))};
  const Eigen::Vector3d beam_axis = attachments[1].beam_axes()->col(0);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), beam_axis}) {
    const Eigen::Vector3d direction = reference_direction(attachments, axis);
    EXPECT_NEAR(direction.norm(), 1.0, 1e-15);
    EXPECT_NEAR(direction.dot(axis), 0.0, 1e-15);
  }
  EXPECT_NEAR(std::abs(reference_direction(attachments, {0, 0, 1}).dot(beam_axis)), 1.0, 1e-12);
}

}  // namespace
}  // namespace pleuel::test::attachment_test
