#include "picture/motion.hpp"

#include <numeric>

#include <Eigen/Geometry>

#include "core/base/eager_matrices.hpp"
#include "picture/companions.hpp"
#include "picture/thinned.hpp"
#include "tests/picture/picture_problems.hpp"
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
  const ProblemFile problem = turning_arm(GetParam());
  const auto analysis = analyze(problem, start_design(problem));
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
  const ProblemFile problem = turning_arm(GetParam());
  const auto analysis = analyze(problem, start_design(problem));
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
  const ProblemFile problem =
      turning_arm(R"("frame": "tangent")", {"/scene/joints/hub/drive/speed=60"});
  const auto analysis = analyze(problem, start_design(problem));
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
  const ProblemFile problem = turning_arm(R"("frame": "tangent")");
  const auto analysis = analyze(problem, start_design(problem));
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
  const ProblemFile problem = turning_arm(R"("rigid": true)", {"/simulation/step=5e-5"});
  const auto analysis = analyze(problem, start_design(problem));
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
  const ProblemFile problem = turning_arm(
      R"("frame": "tangent")",
      {R"(/responses/hub_force={"type": "reaction-force", "joint": "hub", "direction": "magnitude", "over_time": "max"})"});
  const auto analysis = analyze(problem, start_design(problem));
  for (const Companion& one : find_companions(problem, *analysis).all) {
    EXPECT_NE(one.settings.name, "force in the joint hub");
    EXPECT_EQ(one.value, std::abs(one.history(one.peak)));
  }
}

}  // namespace
}  // namespace pleuel::test::motion_test
