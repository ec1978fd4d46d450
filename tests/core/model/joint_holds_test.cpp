#include "core/model/joint_holds.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/model/attachment.hpp"
#include "core/model/body_builder.hpp"
#include "tests/support/model_state.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

/// What mechanisms hold of a bar from the origin to (1, 0, 0) m, which bends.

namespace pleuel::test::joint_holds_test {
namespace {

constexpr std::array<bool, 3> all = {true, true, true}, none = {false, false, false};

std::string beam(const std::string& from, const std::string& to) {
  return fmt::format(R"({{"type": "beam", "from": {}, "to": {}, "material": "steel", "elements": 2,
                         "section": {{"type": "circle", "diameter": "10 mm"}}}})",
                     from, to);
}
const std::string bar = R"("bar": )" + beam("[0, 0, 0]", "[1, 0, 0]");

std::string rigid(const std::string& name, const std::string& at) {
  return fmt::format(
      R"(, "{}": {{"type": "rigid", "at": {}, "mass": 1, "inertia": [1, 1, 1, 0, 0, 0]}})", name,
      at);
}

std::string joint(const std::string& name, const std::string& type, const std::string& one,
                  const std::string& other, const std::string& at, const std::string& more = "") {
  return fmt::format(R"("{}": {{"type": "{}", "bodies": ["{}", "{}"], "at": {}{}}})", name, type,
                     one, other, at, more.empty() ? "" : ", " + more);
}

std::vector<JointHold> holds_of_bar(const std::string& bodies, const std::string& joints) {
  const std::string text = fmt::format(
      R"j({{"scene": {{"materials": {{"steel": {{"young": 2.1e11, "poisson": 0.3, "density": 7850}}}},
                      "bodies": {{{}}}, "joints": {{{}}}}},
           "simulation": {{"end_time": 1, "step": 0.1}},
           "responses": {{"mass": {{"type": "mass"}}}}}})j",
      bodies, joints);
  const ProblemFile problem = problem_from(text);
  return JointHolds(problem.scene, {}).of("bar");
}

const std::string zero = "[0, 0, 0]", tip = "[1, 0, 0]";

TEST(JointHolds, OfAClampAreAll) {
  const auto holds = holds_of_bar(bar, joint("wall", "fixed", "ground", "bar", zero));
  ASSERT_EQ(holds.size(), 1);
  EXPECT_EQ(holds[0].displacements, all);
  EXPECT_EQ(holds[0].rotations, all);
}

/// What hangs on the tip holds nothing.
TEST(JointHolds, OfAPayloadAreNone) {
  const auto holds =
      holds_of_bar(bar + rigid("load", tip), joint("wall", "fixed", "ground", "bar", zero) + ", " +
                                                 joint("weld", "fixed", "bar", "load", tip));
  ASSERT_EQ(holds.size(), 2);
  EXPECT_DOUBLE_EQ(holds[1].at, 1.0);
  EXPECT_EQ(holds[1].rotations, none);
  EXPECT_FALSE(holds[1].displacements[1] || holds[1].displacements[2]);
}

/// The apex of three struts cannot move while none of them changes its length, although two alone
/// leave it a way.
TEST(JointHolds, OfAnApexOfThreeStrutsAreThoseOfPins) {
  const std::string other = "[1.6, 0.5, 0]", third = "[1.5, 0, 0.7]";
  const auto ball = [](const std::string& name, const std::string& one, const std::string& two,
                       const std::string& at) { return joint(name, "spherical", one, two, at); };
  const auto holds = holds_of_bar(
      bar + R"(, "b": )" + beam(other, tip) + R"(, "c": )" + beam(third, tip) + rigid("apex", tip),
      ball("1", "ground", "bar", zero) + ", " + ball("2", "ground", "b", other) + ", " +
          ball("3", "ground", "c", third) + ", " + ball("4", "bar", "apex", tip) + ", " +
          ball("5", "b", "apex", tip) + ", " + ball("6", "c", "apex", tip));
  ASSERT_EQ(holds.size(), 2);
  for (const JointHold& hold : holds) {
    EXPECT_EQ(hold.displacements, all);
    EXPECT_FALSE(hold.rotations[1] || hold.rotations[2]);
  }
}

/// The rod of a slider-crank, the guide at 60° to it: the slider cannot leave its place while the rod
/// keeps its length. With a crank that turns by itself both ends move, but the rod stays straight.
TEST(JointHolds, OfTheRodOfASliderCrankAreThoseOfPins) {
  for (const std::string drive :
       {"", R"("drive": {"type": "ramp-to-speed", "speed": 10, "ramp": 0.1})"}) {
    const std::string axis = R"("axis": [0, 0, 1])";
    const auto holds =
        holds_of_bar(bar + rigid("crank", "[0, 0.2, 0]") + rigid("slider", tip),
                     joint("bearing", "revolute", "ground", "crank", "[0, 0.3, 0]",
                           axis + (drive.empty() ? "" : ", " + drive)) +
                         ", " + joint("pin", "spherical", "crank", "bar", zero) + ", " +
                         joint("end", "spherical", "bar", "slider", tip) + ", " +
                         joint("guide", "prismatic", "ground", "slider", tip,
                               R"("axis": [0.5, 0.8660254037844386, 0])"));
    ASSERT_EQ(holds.size(), 2);
    for (const JointHold& hold : holds) {
      EXPECT_EQ(hold.displacements, all) << drive;
      EXPECT_FALSE(hold.rotations[1] || hold.rotations[2]) << drive;
    }
  }
}

/// Between two lugs of an arm, whatever carries the arm. The bar may spin about its axis: as one of its
/// ends counts against the other, that spin is held at one of them.
TEST(JointHolds, OfAnArmAreTheSameHoweverTheArmMoves) {
  const std::string lugs = joint("a", "spherical", "arm", "bar", zero) + ", " +
                           joint("b", "spherical", "arm", "bar", tip);
  for (const char* type : {"fixed", "revolute", "spherical", "prismatic"}) {
    const bool has_axis = std::string(type) == "revolute" || std::string(type) == "prismatic";
    const auto holds = holds_of_bar(bar + rigid("arm", "[0.5, 0.1, 0]"),
                                    lugs + ", " +
                                        joint("carrier", type, "ground", "arm", "[-0.3, 0.2, 0]",
                                              has_axis ? R"("axis": [0, 0, 1])" : ""));
    ASSERT_EQ(holds.size(), 2) << type;
    for (const JointHold& hold : holds) {
      EXPECT_EQ(hold.displacements, all) << type;
      EXPECT_FALSE(hold.rotations[1] || hold.rotations[2]) << type;
    }
  }
}

/// A mast on a carriage is a cantilever, as it is on the ground.
TEST(JointHolds, OfACarriageAreThoseOfAClamp) {
  const auto holds = holds_of_bar(
      bar + rigid("carriage", zero),
      joint("weld", "fixed", "carriage", "bar", zero) + ", " +
          joint("rails", "prismatic", "ground", "carriage", zero, R"("axis": [0, 1, 0])"));
  ASSERT_EQ(holds.size(), 1);
  EXPECT_EQ(holds[0].displacements, all);
  EXPECT_EQ(holds[0].rotations, all);
}

/// Between two carriages one end moves across against the other; neither turns.
TEST(JointHolds, OfTwoCarriagesLetOneEndMoveAcross) {
  const auto rails = [](const std::string& name, const std::string& at) {
    return joint(name + "_rails", "prismatic", "ground", name, at, R"("axis": [0, 1, 0])") + ", " +
           joint(name + "_weld", "fixed", name, "bar", at);
  };
  const auto holds = holds_of_bar(bar + rigid("left", zero) + rigid("right", tip),
                                  rails("left", zero) + ", " + rails("right", tip));
  ASSERT_EQ(holds.size(), 2);
  EXPECT_NE(holds[0].displacements[1], holds[1].displacements[1]);
  for (const JointHold& hold : holds) {
    EXPECT_TRUE(hold.displacements[2]);
    EXPECT_EQ(hold.rotations, all);
  }
}

/// A rod that swings about a pin along its local z, with a body on a ball at its tip: against its
/// swing it is held there across itself in the plane of the swing, whatever the global axes are.
TEST(JointHolds, OfASwingingRodDoNotDependOnTheGlobalAxes) {
  const std::vector<std::array<std::string, 2>> tips_and_axes = {
      {"[1, 0, 0]", "[0, 0, 1]"}, {"[2, 1, 2]", "[-4, -2, 5]"}, {"[1, -2, 2]", "[-2, 4, 5]"}};
  for (const auto& [to, axis] : tips_and_axes) {
    const auto holds =
        holds_of_bar(R"("bar": )" + beam(zero, to) + rigid("load", to),
                     joint("pin", "revolute", "ground", "bar", zero, R"("axis": )" + axis) + ", " +
                         joint("ball", "spherical", "bar", "load", to));
    ASSERT_EQ(holds.size(), 2);
    EXPECT_TRUE(holds[1].displacements[1]) << to;
    EXPECT_FALSE(holds[1].displacements[2]) << to;
    EXPECT_TRUE(holds[0].rotations[1]) << to;
    EXPECT_FALSE(holds[0].rotations[2]) << to;
  }
}

/// Of a bar on a slide across no axis of it, both ends turn as a whole: which of them counts as still is
/// said by their places.
TEST(JointHolds, DoNotDependOnTheOrderOfJoints) {
  const std::string slide = joint("slide", "prismatic", "ground", "bar", zero,
                                  R"("axis": [0.2, 1, 0.5])"),
                    hinge = joint("hinge", "spherical", "bar", "load", tip);
  const std::string bodies = bar + rigid("load", tip);
  const auto one = holds_of_bar(bodies, slide + ", " + hinge);
  auto other = holds_of_bar(bodies, hinge + ", " + slide);
  ASSERT_EQ(one.size(), 2);
  ASSERT_EQ(other.size(), 2);
  if (other[0].at > other[1].at) std::swap(other[0], other[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_DOUBLE_EQ(one[i].at, other[i].at);
    EXPECT_EQ(one[i].displacements, other[i].displacements) << i;
    EXPECT_EQ(one[i].rotations, other[i].rotations) << i;
  }
}

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
}  // namespace pleuel::test::joint_holds_test
