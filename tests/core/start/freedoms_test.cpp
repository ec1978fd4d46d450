#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/mechanism/configuration.hpp"
#include "core/response/analysis.hpp"
#include "core/start/degrees_of_freedom.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::freedoms_test {
namespace {

struct Expected {
  std::string problem;
  std::vector<std::string> overrides;
  int coordinates, free;
};

class RigidFreedoms : public testing::TestWithParam<Expected> {};

/// Counted by hand: three coordinates a body in the plane and two a point, six and three in space.
TEST_P(RigidFreedoms, AreThoseOfTheMechanism) {
  const Expected& expected = GetParam();
  const ProblemFile problem = sample_problem(expected.problem, expected.overrides);
  const auto analysis = analyze(problem, start_design(problem));
  State initial;
  analysis->trajectory.states->load(0, initial);
  const DegreesOfFreedom freedoms = rigid_degrees_of_freedom(analysis->model.mechanism, initial);
  EXPECT_EQ(freedoms.coordinates, expected.coordinates);
  EXPECT_EQ(freedoms.free(), expected.free);
}

/// Free motions keep all constraints to first order, and are as many as the freedoms.
TEST_P(RigidFreedoms, AreSpannedByMotionsThatKeepTheConstraints) {
  const ProblemFile problem = sample_problem(GetParam().problem, GetParam().overrides);
  const auto analysis = analyze(problem, start_design(problem));
  Mechanism& mechanism = analysis->model.mechanism;
  State state;
  analysis->trajectory.states->load(0, state);
  const Eigen::MatrixXd motions = free_motions(mechanism, state);
  ASSERT_EQ(motions.cols(), GetParam().free);
  State generic = generic_position(mechanism, state);
  for (State* at : {&state, &generic}) {
    const Eigen::MatrixXd free = free_motions(mechanism, *at);
    ASSERT_EQ(free.cols(), GetParam().free);
    EXPECT_LE(
        (free.transpose() * free - Eigen::MatrixXd::Identity(free.cols(), free.cols())).norm(),
        1e-12);
    for (Eigen::Index i = 0; i < free.cols(); ++i) {
      Eigen::VectorXd before, after;
      State moved = *at;
      mechanism.system->residual(moved, ConstraintLevel::position, before);
      advance(mechanism.rotations, at->q, 1e-6 * mechanism.scale.cwiseProduct(free.col(i)),
              moved.q);
      mechanism.system->residual(moved, ConstraintLevel::position, after);
      // Of second order, and the round-off of positions.
      EXPECT_LE((after - before).tail(mechanism.system->multipliers()).lpNorm<Eigen::Infinity>(),
                1e-10);
    }
  }
}

const std::string brief = "/simulation/end_time=2 ms";

INSTANTIATE_TEST_SUITE_P(
    Problems, RigidFreedoms,
    testing::Values(
        // Driven: crank, rod, and a point.
        Expected{"slider_crank", {"/simulation/end_time=0.25 ms"}, 8, 0},
        // The same without a drive, in the dead centre.
        Expected{"hard/dead_centres", {brief}, 8, 1},
        // A single loop in space, which can move only because one of its constraints is redundant.
        Expected{"hard/bricard", {"/simulation/end_time=20 ms"}, 30, 1}),
    [](const auto& test) {
      std::string name = test.param.problem;
      std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
      return name;
    });

}  // namespace
}  // namespace pleuel::test::freedoms_test
