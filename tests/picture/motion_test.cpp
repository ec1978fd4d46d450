#include "picture/motion.hpp"

#include <numeric>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/response/analysis.hpp"
#include "picture/companions.hpp"
#include "picture/drawn_place.hpp"
#include "picture/section_outline.hpp"
#include "picture/thinned.hpp"
#include "tests/picture/picture_problems.hpp"
#include "tests/support/at_start.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::motion_test {
namespace {

constexpr double pi = 3.141592653589793;

std::vector<int> all_steps(const Analysis& analysis) {
  std::vector<int> steps(static_cast<std::size_t>(analysis.trajectory.steps()) + 1);
  std::iota(steps.begin(), steps.end(), 0);
  return steps;
}

Eigen::Quaterniond rotation_at(const BodyTrack& body, Eigen::Index instant) {
  return Eigen::Quaterniond(Eigen::Vector4d(body.rotations.col(instant).head(4)));
}

/// A drive of constant speed ω: every place of a rigid arm is at s (cos ωt, sin ωt).
TEST(Motion, OfARigidArmIsACircle) {
  const ProblemFile rigid = turning_arm(R"("rigid": true)");
  const auto analysis = analyze(rigid, start_design(rigid));
  const Motion motion = sample_motion(rigid.scene, *analysis, all_steps(*analysis));
  const BodyTrack& arm = motion.bodies.front();
  const std::size_t last = arm.stations.size() - 1;
  for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
    const double angle = 20.0 * motion.time(i);
    const Eigen::Vector3d tip = arm.positions.col(i).tail<3>();
    EXPECT_NEAR(tip.x(), 0.4 * std::cos(angle), 1e-9);
    EXPECT_NEAR(tip.y(), 0.4 * std::sin(angle), 1e-9);
    const Eigen::Vector3d x = rotation_at(arm, i) * Eigen::Vector3d::UnitX();
    EXPECT_NEAR(x.x(), std::cos(angle), 1e-9);
    EXPECT_NEAR(x.y(), std::sin(angle), 1e-9);
    EXPECT_LT((motion.bodies[1].positions.col(i) - tip).norm(), 1e-8) << "the ball is on the tip";
  }
  EXPECT_EQ(arm.stations[last], 1.0);
  EXPECT_EQ(arm.stress.size(), 0) << "a rigid body has no stress";
}

/// Whatever coordinates the beam has.
class MotionOfBeams : public ::testing::TestWithParam<const char*> {};

TEST_P(MotionOfBeams, EqualsTheResponsesOfTheSamePlaces) {
  const auto [problem, x, analysis] = AtStart(turning_arm(GetParam()));
  const Motion motion = sample_motion(problem.scene, *analysis, all_steps(*analysis));
  const BodyTrack& arm = motion.bodies.front();
  for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
    const Eigen::Vector3d tip = arm.positions.col(i).tail<3>();
    EXPECT_NEAR(tip.x(), analysis->histories[2](0, i), 1e-12);
    EXPECT_NEAR(tip.y(), analysis->histories[3](0, i), 1e-12);
    EXPECT_EQ(arm.stress(0, i), analysis->histories[1].col(i).maxCoeff());
  }
}

/// No place sees more than the largest stress of the body, and the clamped end sees it.
TEST_P(MotionOfBeams, HasTheLargestStressOfTheBody) {
  const auto [problem, x, analysis] = AtStart(turning_arm(GetParam()));
  const Motion motion = sample_motion(problem.scene, *analysis, all_steps(*analysis));
  const double largest = analysis->histories[0].maxCoeff();
  EXPECT_NEAR(motion.bodies.front().stress.maxCoeff(), largest, 1e-9 * largest);
}

INSTANTIATE_TEST_SUITE_P(Beams, MotionOfBeams,
                         ::testing::Values(R"("frame": "tangent")", R"("frame": "chord")",
                                           R"("frame": "mean-axis")",
                                           R"("reduction": {"modes": 2})", R"("frames": 2)"),
                         named_by_value());

TEST(FramesOfMotion, AreCloseTogetherAndHaveThePeaks) {
  const auto [problem, x, analysis] =
      AtStart(turning_arm(R"("frame": "tangent")", {"/scene/joints/hub/drive/speed=60"}));
  const std::vector<int> steps = frames_of_motion(*analysis, 1000);
  const Motion motion = sample_motion(problem.scene, *analysis, steps);
  EXPECT_EQ(steps.front(), 0);
  EXPECT_EQ(steps.back(), analysis->trajectory.steps());
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_GT(steps[i], steps[i - 1]);
    const double turn =
        rotation_at(motion.bodies.front(), static_cast<Eigen::Index>(i))
            .angularDistance(rotation_at(motion.bodies.front(), static_cast<Eigen::Index>(i) - 1));
    EXPECT_LT(turn, 6.0 * pi / 180.0);  // 4 degrees, and up to a step of 1.7 more
  }
  for (const Sample& sample : analysis->reductions.front().samples) {
    EXPECT_NE(std::find(steps.begin(), steps.end(), sample.step), steps.end());
  }
}

TEST(FramesOfMotion, AreNoMoreThanAskedForAndThePeaks) {
  const auto [problem, x, analysis] = AtStart(turning_arm(R"("frame": "tangent")"));
  const std::size_t peaks = 4 * 3;  // four responses, up to three samples each
  EXPECT_LE(frames_of_motion(*analysis, 20).size(), 20 + 1 + peaks);
}

/// An elastic arm that a drive turns at 20 rad/s, without its elasticity: the tip is at
/// 0.4 m (cos ωt, sin ωt), to the end of the motion.
TEST(RigidMotion, OfAnElasticArmIsACircle) {
  const ProblemFile problem = turning_arm(R"("frame": "chord")");
  const Eigen::VectorXd x = start_design(problem);
  const Model model = build_model(problem.scene, problem.effects, {x.begin(), x.end()},
                                  {x.begin(), x.end()}, problem.sensitivity.invariants);
  const RigidMotion rigid =
      rigid_motion(problem.scene, model, problem.simulation.end_time, problem.simulation.step);
  const Motion& motion = rigid.motion;
  ASSERT_GT(motion.time.size(), 2);
  EXPECT_DOUBLE_EQ(motion.time(motion.time.size() - 1), problem.simulation.end_time);
  for (Eigen::Index i = 0; i < motion.time.size(); ++i) {
    const double angle = 20.0 * motion.time(i);
    const Eigen::Vector3d tip = motion.bodies.front().positions.col(i).tail<3>();
    EXPECT_NEAR(tip.x(), 0.4 * std::cos(angle), 1e-7);
    EXPECT_NEAR(tip.y(), 0.4 * std::sin(angle), 1e-7);
  }
  EXPECT_EQ(motion.bodies.front().stress.size(), 0);
}

TEST(Thinned, KeepsThePeaksOfEveryStretch) {
  Eigen::VectorXd values(10000);
  for (Eigen::Index i = 0; i < values.size(); ++i) values(i) = std::sin(0.7 * double(i));
  values(1234) = 5.0;  // one instant only
  values(8765) = -6.0;
  const std::vector<int> kept = thinned(values, 400, {4321});
  EXPECT_LE(kept.size(), 400 + 3);  // two a stretch, both ends, and the one that must be there
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const int index : {0, 1234, 4321, 8765, 9999}) {
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), index)) << index;
  }
}

TEST(Thinned, LeavesShortCurvesAsTheyAre) {
  EXPECT_EQ(thinned(Eigen::Vector4d(3, 1, 2, 0), 10), (std::vector<int>{0, 1, 2, 3}));
}

const Companion& find(const Companions& companions, const std::string& name) {
  const auto found = std::find_if(companions.all.begin(), companions.all.end(),
                                  [&](const Companion& one) { return one.settings.name == name; });
  if (found == companions.all.end()) throw std::runtime_error("no companion " + name);
  return *found;
}

/// A ball on a circle needs m ω² r; the arm at constant speed has ½ (m_arm (L²/3 + h²/12) + m r²)
/// ω². The scheme is of second order: of relative size (ωh)² = 1e-6 here, times ten.
TEST(Companions, AreForcesAndEnergiesOfTheMechanism) {
  const auto [problem, x, analysis] =
      AtStart(turning_arm(R"("rigid": true)", {"/simulation/step=5e-5"}));
  const Companions companions = find_companions(problem, *analysis);
  const double mass = 7850.0 * 0.4 * 0.01 * 0.02, speed = 20.0, tolerance = 1e-5;
  const double force = 0.3 * speed * speed * 0.4;
  const double energy =
      0.5 * (mass * (0.16 / 3.0 + 0.02 * 0.02 / 12.0) + 0.3 * 0.16) * speed * speed;
  EXPECT_NEAR(find(companions, "force in the joint end").value, force, tolerance * force);
  EXPECT_NEAR(find(companions, "kinetic energy").value, energy, tolerance * energy);
  EXPECT_NEAR(find(companions, "torque of the drive hub").value, 0.0, tolerance * energy);
}

TEST(Companions, DoNotRepeatWhatTheFileAsksFor) {
  const auto [problem, x, analysis] = AtStart(turning_arm(
      R"("frame": "tangent")",
      {R"(/responses/hub_force={"type": "reaction-force", "joint": "hub", "direction": "magnitude", "over_time": "max"})"}));
  for (const Companion& one : find_companions(problem, *analysis).all) {
    EXPECT_NE(one.settings.name, "force in the joint hub");
    EXPECT_EQ(one.value, std::abs(one.history(one.peak)));
  }
}

Design<double> start_of(const ProblemFile& problem) {
  const Eigen::VectorXd x = start_design(problem);
  return {x.begin(), x.end()};
}

/// The place at t = 0, global axes [m]: the inverse of drawn_place().
Eigen::Vector3d position_at_start(const Scene& scene, const DrawnPlace& place,
                                  const Design<double>& design) {
  if (place.body < 0) return place.point;
  const Body& holder = scene.bodies[place.body];
  if (const auto* beam = std::get_if<BeamBody>(&holder.shape); beam && place.share >= 0.0) {
    const Eigen::Vector3d from = resolve_point(beam->from, design),
                          to = resolve_point(beam->to, design);
    return from + place.share * (to - from);
  }
  const Pose<double> pose = body_pose(holder, design);
  return pose.origin + pose.rotation * place.point;
}

TEST(DrawnPlace, LiesWhereTheFilePutsIt) {
  const ProblemFile problem = turning_arm(R"("frame": "tangent")");
  const Design<double> x = start_of(problem);
  const Point quarter = {Number(0.1), Number(0.0), Number(0.0)};
  for (const char* body : {"arm", "ball", "ground"}) {
    const DrawnPlace place = drawn_place(problem.scene, body, quarter, x);
    EXPECT_LT((position_at_start(problem.scene, place, x) - Eigen::Vector3d(0.1, 0, 0)).norm(),
              1e-15)
        << body;
  }
  EXPECT_DOUBLE_EQ(drawn_place(problem.scene, "arm", quarter, x).share, 0.25);
  EXPECT_EQ(drawn_place(problem.scene, "ground", quarter, x).body, -1);
}

/// A rigid beam holds points beside its axis, too.
TEST(DrawnPlace, BesideARigidBeamIsAPointOfItsFrame) {
  const ProblemFile problem = turning_arm(R"("rigid": true)");
  const Design<double> x = start_of(problem);
  const Point beside = {Number(0.1), Number(0.05), Number(0.0)};
  const DrawnPlace place = drawn_place(problem.scene, "arm", beside, x);
  EXPECT_LT(place.share, 0.0);
  EXPECT_LT((position_at_start(problem.scene, place, x) - Eigen::Vector3d(0.1, 0.05, 0)).norm(),
            1e-15);
}

/// Area, ∫y² dA and ∫z² dA of a polygon by Green's theorem; anticlockwise ones count positive.
Eigen::Vector3d integrals(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
    const double cross = a.x() * b.y() - b.x() * a.y();
    sum.x() += cross / 2.0;
    sum.y() += cross * (a.x() * a.x() + a.x() * b.x() + b.x() * b.x()) / 12.0;
    sum.z() += cross * (a.y() * a.y() + a.y() * b.y() + b.y() * b.y()) / 12.0;
  }
  return sum;
}

/// The outline against the closed forms that the mechanics uses.
void expect_properties(const Section& section, double tolerance) {
  const SectionOutline outline = section_outline(section, {});
  const SectionProperties<double> exact = resolve_section<double>(section, {});
  Eigen::Vector3d drawn = integrals(outline.outer);
  if (!outline.inner.empty()) drawn -= integrals(outline.inner);
  EXPECT_NEAR(drawn.x(), exact.area, tolerance * exact.area);
  EXPECT_NEAR(drawn.y(), exact.inertia_z, 2.0 * tolerance * exact.inertia_z);
  EXPECT_NEAR(drawn.z(), exact.inertia_y, 2.0 * tolerance * exact.inertia_y);
}

TEST(SectionOutline, OfCornersHasAreaAndInertiaOfTheSection) {
  constexpr double round_off = 1e-12;
  expect_properties(RectangleSection{0.02, 0.03}, round_off);
  expect_properties(BoxSection{0.04, 0.06, 0.003}, round_off);
  expect_properties(ISection{0.05, 0.08, 0.006, 0.004}, round_off);
}

/// A polygon of 32 corners in a circle lacks 1 − (32/2π) sin(2π/32) = 0.64 % of its area.
TEST(SectionOutline, OfRoundSectionsIsNearlyTheirs) {
  expect_properties(CircleSection{0.03}, 0.0065);
  expect_properties(EllipseSection{0.02, 0.05}, 0.0065);
  expect_properties(TubeSection{0.04, 0.004}, 0.0065);
}

/// A full tube and a full box have no hole.
TEST(SectionOutline, HasNoHoleWhereTheWallsMeet) {
  EXPECT_TRUE(section_outline(TubeSection{0.04, 0.02}, {}).inner.empty());
  EXPECT_TRUE(section_outline(BoxSection{0.04, 0.06, 0.02}, {}).inner.empty());
}

TEST(SectionOutline, OfAGeneralSectionHasItsRadiiOfGyration) {
  const GeneralSection section{6e-4, 2e-8, 4.5e-8, 1e-8, {{0.015, 0.01, 0.0}}};
  const Eigen::Vector3d drawn = integrals(section_outline(section, {}).outer);
  EXPECT_NEAR(drawn.y() / drawn.x(), 4.5e-8 / 6e-4, 1e-12);
  EXPECT_NEAR(drawn.z() / drawn.x(), 2e-8 / 6e-4, 1e-12);
  EXPECT_FALSE(section_outline(section, {}).is_exact);
}

/// By the divergence theorem, of faces that are fans of triangles; of points behind a surface that
/// is not closed, or turned inside out, it is another number.
double volume(const SweptSurface& surface) {
  double sum = 0.0;
  for (const std::vector<int>& face : surface.faces) {
    const Eigen::Vector3d a = surface.points.col(face[0]);
    for (std::size_t k = 2; k < face.size(); ++k) {
      const Eigen::Vector3d b = surface.points.col(face[k - 1]), c = surface.points.col(face[k]);
      sum += a.dot(b.cross(c)) / 6.0;
    }
  }
  return sum;
}

SweptSurface surface_of(const ProblemFile& problem, int step) {
  const auto [x, analysis] = started(problem);
  const Motion motion = sample_motion(problem.scene, *analysis, {0, step});
  return swept_beam(std::get<BeamBody>(problem.scene.bodies.front().shape),
                    Design<double>(x.begin(), x.end()), motion.bodies.front(), 1);
}

TEST(SweptBeam, OfARigidArmEnclosesItsVolume) {
  const SweptSurface surface = surface_of(turning_arm(R"("rigid": true)"), 60);
  EXPECT_NEAR(volume(surface), 0.4 * 0.01 * 0.02, 1e-12);
  EXPECT_EQ(surface.stress.size(), 0);
}

/// 32 corners of a circle of diameter d enclose 32/2 sin(2π/32) d²/4.
TEST(SweptBeam, OfATubeEnclosesItsWallOnly) {
  const SweptSurface surface =
      surface_of(turning_arm(R"("rigid": true)",
                             {R"(/scene/bodies/arm/section={"type": "tube", "outer_diameter": 0.03,
                      "thickness": 0.005})"}),
                 30);
  const double corners = 16.0 * std::sin(2.0 * M_PI / 32.0) / 4.0;
  EXPECT_NEAR(volume(surface), 0.4 * corners * (0.03 * 0.03 - 0.02 * 0.02), 1e-12);
}

BeamBody& arm_of(ProblemFile& problem) {
  return std::get<BeamBody>(problem.scene.bodies.front().shape);
}

TEST(SweptBeam, OfSegmentsHasTheSectionOfEach) {
  ProblemFile problem = turning_arm(R"("rigid": true)");
  ProblemFile other = turning_arm(R"("rigid": true)", {"/scene/bodies/arm/section/width=0.03"});
  Segment first = arm_of(problem).segments.front(), second = arm_of(other).segments.front();
  first.fraction = 0.3;
  second.fraction = 0.7;
  arm_of(problem).segments = {first, second};
  EXPECT_NEAR(volume(surface_of(problem, 30)), 0.4 * 0.02 * (0.3 * 0.01 + 0.7 * 0.03), 1e-12);
}

TEST(SweptBeam, OfAnElasticArmHasStressAtItsPoints) {
  const SweptSurface surface = surface_of(turning_arm(R"("frame": "tangent")"), 60);
  ASSERT_EQ(surface.stress.size(), surface.points.cols());
  EXPECT_GT(surface.stress.maxCoeff(), 0.0);
  // Bent by some µm: the volume changes little.
  EXPECT_NEAR(volume(surface), 0.4 * 0.01 * 0.02, 1e-3 * 0.4 * 0.01 * 0.02);
}

}  // namespace
}  // namespace pleuel::test::motion_test
