#include "core/scene/beam_mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleuel::test::beam_mesh_test {
namespace {

using testing::ElementsAre;
using testing::Pointwise;

/// A beam of 1 m along x with loads at places [m].
struct LoadedBeam {
  std::vector<Segment> segments;
  std::vector<Number> places;

  Scene scene() const {
    BeamBody beam;
    beam.from = {0.0, 0.0, 0.0};
    beam.to = {1.0, 0.0, 0.0};
    beam.segments = segments;
    Scene scene;
    scene.bodies.push_back({"beam", beam});
    for (const Number& place : places) {
      PointForce force;
      force.body = "beam";
      force.at = {place, 0.0, 0.0};
      scene.loads.push_back({"load", force});
    }
    return scene;
  }
};

BeamMesh mesh_of(const LoadedBeam& loaded, const Design<double>& start) {
  const Scene scene = loaded.scene();
  return make_mesh(scene.bodies.front(), scene, start, true);
}

std::vector<double> shares_of(const LoadedBeam& loaded, const Design<double>& start,
                              const Design<double>& design) {
  const Scene scene = loaded.scene();
  return element_shares(std::get<BeamBody>(scene.bodies.front().shape),
                        make_mesh(scene.bodies.front(), scene, start, true), design);
}

std::vector<Segment> even(int elements) {
  return {{CircleSection{0.02}, elements, {}}};
}

MATCHER(AreClose, "") {
  return std::abs(std::get<0>(arg) - std::get<1>(arg)) < 1e-14;
}

TEST(BeamMesh, IsDividedAtPlaces) {
  const LoadedBeam loaded{even(4), {0.3, 0.5}};
  EXPECT_THAT(shares_of(loaded, {}, {}), Pointwise(AreClose(), {0.25, 0.05, 0.2, 0.25, 0.25}));
  EXPECT_THAT(mesh_of(loaded, {}).attached_nodes, ElementsAre(2, 3));
  EXPECT_FALSE(mesh_of(loaded, {}).depends_on_design());
}

/// Within a hundredth of an element, where nothing holds the node.
TEST(BeamMesh, MovesTheNodeToAPlaceBesideIt) {
  const LoadedBeam loaded{even(4), {0.501, 0.249}};
  EXPECT_THAT(shares_of(loaded, {}, {}), Pointwise(AreClose(), {0.249, 0.252, 0.249, 0.25}));
  EXPECT_THAT(mesh_of(loaded, {}).attached_nodes, ElementsAre(1, 2));
}

/// An end, a boundary of segments and another place stay where they are.
TEST(BeamMesh, HasANodeBesideOneThatIsHeld) {
  LoadedBeam loaded{even(2), {0.501, 0.25, 0.251}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_THAT(shares_of(loaded, {}, {}),
              Pointwise(AreClose(), {0.25, 0.001, 0.249, 0.001, 0.249, 0.25}));
}

/// Within a thousandth of the element.
TEST(BeamMesh, LeavesAPlaceInsideThatIsNextToOneThatIsHeld) {
  LoadedBeam loaded{even(2), {0.5002, 0.9999}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_THAT(shares_of(loaded, {}, {}), Pointwise(AreClose(), {0.25, 0.25, 0.25, 0.25}));
  EXPECT_THAT(mesh_of(loaded, {}).attached_nodes, ElementsAre());
  const ElementPlace inside = find_place(mesh_of(loaded, {}), 0.5002);
  EXPECT_EQ(inside.element, 2);
  EXPECT_NEAR(inside.xi, 0.0008, 1e-12);
}

/// Between the ends the elements of both sides change by one factor.
TEST(BeamMesh, FollowsAPlaceThatAVariableMoves) {
  const LoadedBeam loaded{even(4), {Number::bound(0)}};
  EXPECT_TRUE(mesh_of(loaded, {0.5}).depends_on_design());
  EXPECT_THAT(shares_of(loaded, {0.5}, {0.5}), Pointwise(AreClose(), {0.25, 0.25, 0.25, 0.25}));
  EXPECT_THAT(shares_of(loaded, {0.5}, {0.8}), Pointwise(AreClose(), {0.4, 0.4, 0.1, 0.1}));
}

TEST(BeamMesh, HoldsOtherPlacesAndBoundariesWhereTheyAre) {
  LoadedBeam loaded{even(2), {Number::bound(0), 0.25}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_THAT(shares_of(loaded, {0.75}, {0.6}), Pointwise(AreClose(), {0.25, 0.25, 0.1, 0.4}));
  EXPECT_THAT(shares_of(loaded, {0.4}, {0.3}),
              Pointwise(AreClose(), {0.25, 0.05, 0.2, 0.25, 0.25}));
}

/// At an end and at a boundary there is no node that could go with it.
TEST(BeamMesh, DoesNotFollowFromAnEndOrABoundary) {
  LoadedBeam loaded{even(2), {Number::bound(0)}};
  loaded.segments.push_back(loaded.segments.front());
  EXPECT_FALSE(mesh_of(loaded, {0.5}).depends_on_design());
  EXPECT_FALSE(mesh_of(loaded, {1.0}).depends_on_design());
}

}  // namespace
}  // namespace pleuel::test::beam_mesh_test
