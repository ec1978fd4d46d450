#include <gmock/gmock.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/gradients.hpp"
#include "tests/hard/hard_problems.hpp"
#include "tests/hard/rigid_references.hpp"
#include "tests/support/convergence.hpp"

/// Steps that follow the local error, and what is promised of them.
namespace pleuel::test::step_control_test {
namespace {

/// The slider-crank of dead_centres.json with a rod hardly longer than its crank: the slider waits
/// for half a turn and is thrown to the other side within a few degrees.
std::vector<std::string> flicking(const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {
      "/scene/bodies/rod/to=[0.205, 0, 0]", "/scene/bodies/slider/at=[0.205, 0, 0]",
      "/scene/joints/slider_pin/at=[0.205, 0, 0]", "/scene/joints/guide/at=[0.205, 0, 0]",
      // As fast as the crank turns it, −40 · 0.1/0.105 rad/s.
      "/scene/bodies/rod/angular_velocity=[0, 0, -38.095238095238095]", "/simulation/end_time=0.4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

std::string tolerance_of(double tolerance) {
  return fmt::format("/simulation/local_error={:g}", tolerance);
}

class StepControl : public testing::Test {
 protected:
  static ProblemFile problem(std::vector<std::string> overrides,
                             const std::string& formulation = "stabilized-index-2") {
    overrides.push_back("/simulation/formulation=" + formulation);
    return sample_problem("hard/dead_centres", overrides);
  }
  static std::unique_ptr<Analysis> run(const ProblemFile& problem) {
    return analyze(problem, start_design(problem));
  }
  struct Result {
    double end;
    int steps;
  };
  static Result flick(const std::vector<std::string>& more) {
    const auto analysis = run(problem(flicking(more)));
    return {value_of(*analysis, "slider_end"), analysis->trajectory.steps()};
  }
  /// Energy alone says where the crank is at 0.4 s.
  static double exact() {
    static const RigidSliderCrank reference = steel_slider_crank(1.5, 0.105);
    static const double end = reference.slider(reference.coasting_angle(40.0, 0.4));
    return end;
  }
};

/// What the local errors of each regular step may add up to is what all of them add up to, times
/// their number and times what the mechanism makes of it.
TEST_F(StepControl, LeavesAnErrorThatIsProportionalToItsTolerance) {
  std::vector<double> tolerances = {1e-4, 1e-5, 1e-6}, errors;
  for (const double tolerance : tolerances) {
    errors.push_back(std::abs(flick({step_of(4e-3), tolerance_of(tolerance)}).end - exact()));
  }
  EXPECT_NEAR(observed_order(tolerances, errors), 1.0, 0.2);
}

TEST_F(StepControl, NeedsFewerStepsThanEqualOnesForTheSameError) {
  const Result controlled = flick({step_of(4e-3), tolerance_of(1e-6)});
  const Result equal = flick({step_of(0.4 / (2 * controlled.steps))});
  EXPECT_LE(std::abs(controlled.end - exact()), std::abs(equal.end - exact()))
      << controlled.steps << " steps";
}

/// A sequence of halved, quartered and whole steps keeps the order of the scheme: each change
/// begins anew without the old w.
TEST_F(StepControl, ChangesStepsWithoutLossOfOrder) {
  for (const std::string& formulation : formulations()) {
    const auto end_with = [&](int halvings) {
      ProblemFile problem = StepControl::problem({end_of(0.2)}, formulation);
      problem.simulation.step = 8e-3;
      for (int i = 0; i < 25; ++i) {
        const int parts = (1 << halvings) * (i % 3 == 0 ? 1 : i % 3 == 1 ? 4 : 2);
        for (int k = 0; k < parts; ++k) {
          problem.simulation.instants.push_back(8e-3 * (i + static_cast<double>(k) / parts));
        }
      }
      problem.simulation.instants.push_back(0.2);
      return value_of(*run(problem), "slider_end");
    };
    const RigidSliderCrank reference = steel_slider_crank(1.5);
    const double exact = reference.slider(reference.coasting_angle(40.0, 0.2));
    std::vector<double> sizes, errors;
    for (const int halvings : {3, 4, 5, 6}) {
      sizes.push_back(std::ldexp(8e-3, -halvings));
      errors.push_back(std::abs(end_with(halvings) - exact));
    }
    EXPECT_NEAR(observed_order(sizes, errors), 2.0, 0.15) << formulation;
  }
}

/// Of the steps that ran: differences simulate with the very same ones.
TEST_F(StepControl, HasTheGradientOfTheStepsThatRan) {
  ProblemFile problem = StepControl::problem(
      flicking({step_of(4e-3), tolerance_of(1e-4), end_of(0.2),
                R"(/responses/force_peak={"type": "reaction-force",)"
                R"( "joint": "guide", "direction": "y", "over_time": "max-abs"})"}));
  problem.simulation.newton_tolerance = 1e-13;
  const Eigen::VectorXd x = start_design(problem);
  const auto analysis = analyze(problem, x);
  ASSERT_GT(analysis->trajectory.rejected_steps, 0);
  const Eigen::MatrixXd direct = direct_gradients(*analysis);
  const ProblemFile repeated = with_steps_of(analysis->trajectory, problem);
  const Eigen::MatrixXd wide = central_differences(repeated, x, 2e-3),
                        narrow = central_differences(repeated, x, 1e-3);
  const Eigen::MatrixXd differences = (4 * narrow - wide) / 3;
  for (Eigen::Index i = 0; i < direct.rows(); ++i) {
    EXPECT_NEAR(differences(i, 0) / direct(i, 0), 1.0, 1e-6) << problem.responses[i].name;
  }
}

TEST_F(StepControl, RepeatsASequenceOfStepsToRoundOff) {
  const ProblemFile problem = StepControl::problem(flicking({step_of(4e-3), tolerance_of(1e-4)}));
  const auto first = run(problem);
  const auto again = run(with_steps_of(first->trajectory, problem));
  ASSERT_EQ(first->trajectory.time, again->trajectory.time);
  EXPECT_NEAR(value_of(*first, "slider_end"), value_of(*again, "slider_end"), 1e-9);
}

TEST_F(StepControl, SaysWhatErrsTooMuchWithTheSmallestStep) {
  try {
    run(problem(flicking({step_of(4e-3), tolerance_of(1e-9), "/simulation/smallest_step=2 ms"})));
    FAIL() << "2 ms are too much for that";
  } catch (const SimulationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("simulation stopped at t = "));
    EXPECT_THAT(error.what(),
                testing::ContainsRegex("with a step of 0.002 s the local error of the "
                                       "body \"(crank|rod|slider)\""));
  }
}

}  // namespace
}  // namespace pleuel::test::step_control_test
