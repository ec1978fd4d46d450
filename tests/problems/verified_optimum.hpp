#pragma once

#include "optimization/design/design_solve.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test {

/// What a search from the start of a problem file ends with: an optimum, or a failure of the test.
inline Result verified_optimum(const ProblemFile& file) {
  DesignProblem design(file);
  const Result result = solve_design(design, {});
  EXPECT_EQ(result.status, Status::verified) << result.message;
  return result;
}

}  // namespace pleuel::test
