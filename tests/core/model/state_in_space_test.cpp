#include "core/model/state_in_space.hpp"

#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "core/response/full_mechanism.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test::state_in_space_test {
namespace {

FrameMotion<double> motion_of(const BodyModel& body, const State& state) {
  const int first = body.frame.offset, size = body.frame.size();
  return frame_motion<double>(body.frame, state.q.segment(first, size),
                              state.v.segment(first, size), state.a.segment(first, size));
}

Eigen::Matrix<double, 6, Eigen::Dynamic> deformation(const BodyModel& body,
                                                     const Eigen::VectorXd& of) {
  return body.places.displacements(of.segment(body.elastic_offset(), body.elastic_size()));
}

/// Positions are those of the plane. Constraints of index 3 hold for positions: velocities (1.2e-5 of the largest) and
/// accelerations of a step differ from consistent ones by the order of the step.
TEST(StateInSpace, HasTheAccelerationsOfTheMotionInThePlane) {
  const ProblemFile problem =
      sample_problem("slider_crank", {"/simulation/end_time=20 ms", "/simulation/step=0.05 ms",
                                      "/scene/joints/bearing/drive/ramp=20 ms"});
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> design(x.begin(), x.end());
  const auto analysis = analyze(problem, x);
  const auto space = make_full_mechanism(problem, design, design);
  State state;
  analysis->trajectory.states->load(330, state);
  const std::optional<State> here = state_in_space(analysis->model, state, space->model);
  ASSERT_TRUE(here);
  EXPECT_GT(here->q.size(), state.q.size());
  for (std::size_t i = 0; i < space->model.bodies.size(); ++i) {
    const BodyModel &flat = analysis->model.bodies[i], &body = space->model.bodies[i];
    const FrameMotion<double> expected = motion_of(flat, state), found = motion_of(body, *here);
    EXPECT_LE((found.A - expected.A).norm(), 1e-12) << body.name;
    EXPECT_LE((found.r_dot - expected.r_dot).norm(), 1e-4 * expected.r_dot.norm()) << body.name;
    EXPECT_LE((found.r_ddot - expected.r_ddot).norm(), 1e-3 * expected.r_ddot.norm()) << body.name;
    if (body.elastic_size() == 0) continue;
    EXPECT_LE((deformation(body, here->q) - deformation(flat, state.q)).norm(),
              1e-9 * deformation(flat, state.q).norm())
        << body.name;
  }
}

/// Who leaves the stretch out in the plane has a member in space that no force presses.
TEST(StateInSpace, IsNoneWhereThePlaneLeavesTheStretchOut) {
  const ProblemFile problem =
      sample_problem("slider_crank", {"/simulation/end_time=2 ms", "/simulation/step=1 ms",
                                      "/effects={\"axial_elasticity\": \"off\"}"});
  const Eigen::VectorXd x = start_design(problem);
  const Design<double> design(x.begin(), x.end());
  const auto analysis = analyze(problem, x);
  const auto space = make_full_mechanism(problem, design, design);
  State state;
  analysis->trajectory.states->load(1, state);
  EXPECT_FALSE(state_in_space(analysis->model, state, space->model));
}

}  // namespace
}  // namespace pleuel::test::state_in_space_test
