#include "core/integration/freedoms.hpp"

#include <gtest/gtest.h>

#include "core/response/analysis.hpp"
#include "tests/support/problem_runs.hpp"

namespace pleuel::test {
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
  analysis->trajectory.load(0, initial);
  const Freedoms freedoms = rigid_freedoms(analysis->model.mechanism, initial);
  EXPECT_EQ(freedoms.coordinates, expected.coordinates);
  EXPECT_EQ(freedoms.free(), expected.free);
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
}  // namespace pleuel::test
