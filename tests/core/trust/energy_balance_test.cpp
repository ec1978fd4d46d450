/// Energy that is missing.

#include "core/trust/energy_balance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/trust/crank_rocker.hpp"
#include "tests/core/trust/doubts_of.hpp"

namespace pleuel::test::energy_balance_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Of the largest energy, one percent may be missing.
TEST(EnergyBalance, IsDoubtedAboveOnePercent) {
  const ProblemFile problem = read_scene(crank_rocker(driven, closed));
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  Monitors monitors = monitor(analysis->model, analysis->trajectory);
  monitors.energy_error = 0.0098;
  EXPECT_THAT(doubt_energy_balance(TrustedRun{problem, x, *analysis, monitors}), IsEmpty());
  monitors.energy_error = 0.0102;
  const auto doubts = doubt_energy_balance(TrustedRun{problem, x, *analysis, monitors});
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_THAT(doubts[0].text, HasSubstr("balanced to 1 % of"));
}

}  // namespace
}  // namespace pleuel::test::energy_balance_test
