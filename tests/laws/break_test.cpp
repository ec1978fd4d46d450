#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "core/integration/simulate.hpp"
#include "core/scene/time_breaks.hpp"
#include "tests/laws/law_problems.hpp"
#include "tests/support/convergence.hpp"

namespace pleuel::test::break_test {
namespace {

SimulationOptions options_with(const std::vector<double>& breaks) {
  SimulationOptions options{1.0, 0.01, 0.8};
  options.breaks = breaks;
  return options;
}

bool holds(const std::vector<double>& instants, double time) {
  return std::find(instants.begin(), instants.end(), time) != instants.end();
}

TEST(Instants, AreEqualWithoutBreaks) {
  const std::vector<double> instants = regular_instants(options_with({}));
  ASSERT_EQ(instants.size(), 101U);
  for (int i = 0; i <= 100; ++i) EXPECT_EQ(instants[i], 1.0 * i / 100);
}

/// A stretch of n + 0.x steps is made in n + 1 equal ones: n ≥ 8 here.
TEST(Instants, LieOnBreaksWithStepsThatDifferLittle) {
  const std::vector<double> breaks = {0.7112, 0.333, -0.5, 0.0, 0.0859, 1.0, 1.7};
  const std::vector<double> instants = regular_instants(options_with(breaks));
  for (const double time : {0.0, 0.0859, 0.333, 0.7112, 1.0}) EXPECT_TRUE(holds(instants, time));
  EXPECT_EQ(instants.back(), 1.0);
  for (std::size_t i = 1; i < instants.size(); ++i) {
    EXPECT_LE(instants[i] - instants[i - 1], 0.01 * (1 + 1e-12));
    EXPECT_GE(instants[i] - instants[i - 1], 0.01 * 8 / 9);
  }
}

TEST(Instants, LeaveOutBreaksThatFollowEachOtherTooClosely) {
  const std::vector<double> instants = regular_instants(options_with({0.5, 0.5011, 0.5031}));
  EXPECT_TRUE(holds(instants, 0.5));
  EXPECT_FALSE(holds(instants, 0.5011));
  EXPECT_TRUE(holds(instants, 0.5031));
}

/// Regular steps that meet a break are left as they are.
TEST(Instants, StayEqualWhereBreaksLieOnThem) {
  const std::vector<double> with = regular_instants(options_with({0.25, 0.5})),
                            without = regular_instants(options_with({}));
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) EXPECT_NEAR(with[i], without[i], 1e-15);
}

TEST(Breaks, AreTheTimesOfTablesButForSamplesOfSomethingSmooth) {
  const auto breaks_of = [](const std::string& interpolation, double step) {
    const ProblemFile problem =
        pushed_block(R"({"type": "table", "times": [0, 0.05, 0.07], "values": [0, 1, 0],
                         "interpolation": ")" +
                     interpolation + "\"}");
    return time_breaks(problem.scene, {1.0, step}).size() / 2;  // two loads
  };
  EXPECT_EQ(breaks_of("linear", 1e-3), 3U);
  EXPECT_EQ(breaks_of("linear", 1e-2), 1U);
  EXPECT_EQ(breaks_of("step", 1e-2), 3U);
  EXPECT_EQ(breaks_of("monotone", 1e-3), 2U);
}

/// A push F from t₁ to t₂, between the steps: v = F (t₂ − t₁)/m, x = v (T − (t₁ + t₂)/2). Without
/// instants there the impulse errs by up to F h/2.
TEST(SteppedLoad, GivesItsImpulseWhereverItFallsBetweenSteps) {
  const double force = 6.0, from = 0.0313, to = 0.0771, mass = 2.0;
  const double v = force * (to - from) / mass, x = v * (0.1 - (from + to) / 2);
  const std::string table = R"({"type": "table", "times": [0, 0.0313, 0.0771], "values": [0, 6, 0],
                                "interpolation": "step"})";
  for (const char* radius : {"0", "0.8"}) {
    std::vector<double> steps, errors;
    for (const double h : {2e-3, 1e-3, 5e-4, 2.5e-4}) {
      const ProblemFile problem =
          pushed_block(table, {"/simulation/step=" + std::to_string(h),
                               std::string("/simulation/spectral_radius=") + radius});
      const auto analysis = analyze(problem, start_design(problem));
      const Eigen::VectorXd values = values_of(*analysis);
      steps.push_back(h);
      errors.push_back(std::abs(values(0) - x) + 0.1 * std::abs(values(1) - v));
      EXPECT_LE(errors.back(), 2 * force / mass * h * h) << radius << " " << h;
    }
    EXPECT_GE(observed_order(steps, errors), 1.7) << radius;
  }
}

/// Across the slide the block does not move: the reaction is the load.
TEST(Peak, OfWhatFollowsALoadIsThatOfTheLoad) {
  for (const char* interpolation : {"step", "linear", "monotone"}) {
    const ProblemFile problem =
        pushed_block(std::string(R"({"type": "table", "times": [0, 0.0213, 0.0457, 0.0834],
                        "values": [0, 5, 20, 1], "interpolation": ")") +
                     interpolation + "\"}");
    EXPECT_NEAR(value_at_start(problem, "reaction"), 20.0, 20.0 * 2e-3) << interpolation;
    if (std::string(interpolation) == "monotone") continue;
    EXPECT_NEAR(value_at_start(problem, "reaction"), 20.0, 1e-9) << interpolation;
  }
}

/// A press that closes within 50 ms, as the default has it: never below zero, never above.
TEST(LoadTable, IsStraightUnlessToldOtherwise) {
  const ProblemFile press = pushed_block(
      R"({"type": "table", "times": [0, 0.025, 0.03, 0.035, 0.06], "values": [0, 0, 20, 0, 0]})");
  // Half the base times the height, over the mass.
  EXPECT_NEAR(value_at_start(press, "v"), 0.5 * 0.01 * 20 / 2, 1e-12);
  EXPECT_NEAR(value_at_start(press, "reaction"), 20.0, 1e-9);
}

}  // namespace
}  // namespace pleuel::test::break_test
