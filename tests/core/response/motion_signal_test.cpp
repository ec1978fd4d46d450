#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"
#include "core/base/rotation_vector.hpp"
#include "core/beam/elastic_basis.hpp"
#include "core/linear/modes.hpp"
#include "core/response/analysis.hpp"
#include "core/response/modal_vectors.hpp"
#include "core/response/whole_turns.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/sample_name.hpp"
#include "tests/support/sample_scenes.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::motion_signal_test {
namespace {

class MotionAlong : public testing::TestWithParam<int> {
 protected:
  Model model_ = all_samples()[GetParam()].build();
};

/// Of elastic coordinates: S_11 + S_22 + S_33 = S_ff.
TEST_P(MotionAlong, OfAllAxesIsTheMassMatrixOfABody) {
  for (const BodyModel& body : model_.bodies) {
    const Invariants<double>& constants = body.invariants;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(body.elastic_size(), body.elastic_size());
    for (int axis = 0; axis < 3; ++axis)
      sum += elastic_mass_along(constants, Eigen::Vector3d::Unit(axis));
    const Eigen::MatrixXd mass = dense_matrix(constants.pattern, constants.mass_matrix);
    EXPECT_LE((sum - mass).norm(), 1e-14 * mass.norm()) << body.name;
  }
}

/// In any state, of turned and deformed bodies: the mass matrix of the equations of motion, R_a.
TEST_P(MotionAlong, OfAllAxesIsTheMassMatrixOfAMechanism) {
  const State state = random_state(model_, 7);
  const Eigen::MatrixXd mass = linearize(model_.mechanism, state).M;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(mass.rows(), mass.cols());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd along = mass_along(model_, state, Eigen::Vector3d::Unit(axis));
    EXPECT_LE((along - along.transpose()).norm(), 1e-14 * mass.norm());
    EXPECT_GE(symmetric_eigenvalues(along).minCoeff(), -1e-12 * mass.norm());
    sum += along;
  }
  EXPECT_LE((sum - mass).norm(), 1e-12 * mass.norm());
}

INSTANTIATE_TEST_SUITE_P(Samples, MotionAlong, testing::Range(0, sample_count), sample_name);

/// Along an oblique axis of all axes that are normal to each other, too.
TEST_P(MotionAlong, OfObliqueAxesIsTheMassMatrix) {
  const State state = random_state(model_, 8);
  const Eigen::MatrixXd mass = linearize(model_.mechanism, state).M;
  const Eigen::Matrix3d axes = rotation_of(Eigen::Vector3d(0.3, -0.7, 1.1));
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(mass.rows(), mass.cols());
  for (int i = 0; i < 3; ++i) sum += mass_along(model_, state, axes.col(i));
  EXPECT_LE((sum - mass).norm(), 1e-12 * mass.norm());
}

/// A point mass at 3 m/s along y and 4 m/s along z: m v² along each.
TEST(MotionAlong, OfAPointMassIsThatOfItsVelocity) {
  Scene scene;
  PointMass body;
  body.mass = 2.0;
  scene.bodies = {{"ball", body}};
  EffectSettings effects;
  effects.spatial_motion = EffectChoice::on;
  const Model model = build_model(scene, effects, {}, {});
  const State state(model.mechanism.system->coordinates(), 0);
  const Eigen::Vector3d velocity(0.0, 3.0, 4.0);
  const double squares[] = {0.0, 9.0, 16.0};
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_DOUBLE_EQ(velocity.dot(mass_along(model, state, Eigen::Vector3d::Unit(axis)) * velocity),
                     2.0 * squares[axis]);
  }
}

/// Two modes that are halves of motion along x and of motion along y are turned until one is all of
/// it.
TEST(CombinationsAlong, TellModesThatCoincideApart) {
  const Eigen::Matrix2d mass = Eigen::Vector2d(2.0, 2.0).asDiagonal(),
                        along = Eigen::Vector2d(2.0, 0.0).asDiagonal();
  Eigen::Matrix2cd modes;
  modes << 0.5, 0.5, 0.5, -0.5;
  const Eigen::MatrixXcd found = modes * combinations_along(modes, mass, along);
  ASSERT_EQ(found.cols(), 1);
  EXPECT_NEAR(std::abs(found(0, 0)), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(std::abs(found(1, 0)), 0.0, 1e-15);
}

/// What moves along two axes alike is along none.
TEST(CombinationsAlong, LeaveOutWhatIsAlongNoAxis) {
  const Eigen::Matrix2d mass = Eigen::Matrix2d::Identity(),
                        along = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  const Eigen::MatrixXcd mode = Eigen::Vector2cd::Constant(std::sqrt(0.5));
  EXPECT_EQ(combinations_along(mode, mass, along).cols(), 0);
}

TEST(WholeTurns, AreAddedWhereAnAngleJumps) {
  Eigen::MatrixXd history(1, 400);
  for (int i = 0; i < 400; ++i) {
    const double angle = 20.0 * std::sin(0.02 * i);  // to and fro, three turns each way
    history(0, i) = std::remainder(angle, 2.0 * std::numbers::pi);
  }
  count_turns(history);
  for (int i = 0; i < 400; ++i) EXPECT_NEAR(history(0, i), 20.0 * std::sin(0.02 * i), 1e-12);
}

/// Two wheels on axes that differ, so that the motion is in space: 100 rad/s for 0.2 s.
TEST(WholeTurns, OfAJointCountInSpace) {
  const char* wheels = R"({
    "scene": {
      "bodies": {
        "one": {"type": "rigid", "at": [0, 0, 0], "mass": 2, "inertia": [0.02, 0.02, 0.02, 0, 0, 0],
                "angular_velocity": [0, 0, 100]},
        "two": {"type": "rigid", "at": [0, 1, 0], "mass": 2, "inertia": [0.02, 0.02, 0.02, 0, 0, 0],
                "angular_velocity": [10, 0, 0]}
      },
      "joints": {
        "first": {"type": "revolute", "bodies": ["ground", "one"], "at": [0, 0, 0], "axis": [0, 0, 1]},
        "second": {"type": "revolute", "bodies": ["ground", "two"], "at": [0, 1, 0], "axis": [1, 0, 0]}
      }
    },
    "simulation": {"end_time": 0.2, "step": "1 ms"},
    "responses": {
      "most": {"type": "joint-position", "joint": "first", "over_time": "max"},
      "mean": {"type": "joint-position", "joint": "first", "over_time": "mean"},
      "of_body": {"type": "angle", "body": "one", "direction": "z", "over_time": "final"}
    }
  })";
  const ProblemFile problem = problem_from(wheels);
  const Eigen::VectorXd values = values_of(*analyze(problem, start_design(problem)));
  EXPECT_NEAR(values(0), 20.0, 1e-6);
  EXPECT_NEAR(values(1), 10.0, 1e-6);
  EXPECT_NEAR(values(2), 20.0, 1e-6);
}

}  // namespace
}  // namespace pleuel::test::motion_signal_test
