#include "core/response/validity.hpp"

#include "core/base/error.hpp"
#include "core/response/analysis.hpp"
#include "core/response/monitors.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::validity_test {
namespace {

template <class Work>
std::string failure_of(const Work& work) {
  return thrown<SimulationError>([&] { work(); });
}

/// Short, since only what comes out matters.
ProblemFile short_crank(const std::string& density) {
  return sample_problem(
      "slider_crank",
      {"/simulation/end_time=1 ms",
       R"(/scene/materials={"steel":{"young":2.1e11,"poisson":0.3,"density":)" + density + "}}"});
}

std::string failure_with(const std::string& density) {
  const ProblemFile problem = short_crank(density);
  return failure_of([&] { analyze(problem, start_design(problem)); });
}

TEST(NotFinite, IsAFailedSimulationThatNamesTheFirstResponseAndItsTime) {
  EXPECT_EQ(failure_with("7850"), "");
  // Stress squares what is 1e196 times as large.
  const std::string failure = failure_with("1e200");
  EXPECT_THAT(failure, HasSubstr("stress\" is not finite at t = 2.5e-05 s"));
}

TEST(NotFinite, IsAFailureOfTheMonitorsToo) {
  const ProblemFile problem = short_crank("7850");
  const auto analysis = analyze(problem, start_design(problem));
  analysis->trajectory.columns().v()(0, 7) = 1e200;
  EXPECT_THAT(failure_of([&] { monitor(analysis->model, analysis->trajectory); }),
              HasSubstr("energy of the mechanism is not finite at t = 0.000175 s"));
}

/// The shortest beam of the slider-crank is 120 mm long: 0.12 mm are allowed.
TEST(PulledApartJoint, FailsBeyondAThousandthOfTheShortestBeam) {
  const ProblemFile problem = short_crank("7850");
  const auto analysis = analyze(problem, start_design(problem));
  SimulationOptions options{1e-3, 2.5e-5};
  ConstraintGuard guard(analysis->model, options);
  State state;
  analysis->trajectory.states->load(0, state);
  const int crank = analysis->model.body("crank").frame.offset;
  EXPECT_EQ(failure_of([&] { guard.see(0, state); }), "");
  state.q(crank) += 0.11e-3;
  EXPECT_EQ(failure_of([&] { guard.see(0, state); }), "");
  state.q(crank) += 0.02e-3;
  EXPECT_THAT(failure_of([&] { guard.see(0, state); }),
              AllOf(HasSubstr("the joint \"crank_pin\""), HasSubstr("is apart by 0.00013")));
}

/// Index 1 promises accelerations only; Newton's method with a loose tolerance promises little.
TEST(PulledApartJoint, IsJudgedByWhatTheFormulationPromises) {
  const ProblemFile problem = short_crank("7850");
  const auto analysis = analyze(problem, start_design(problem));
  State state;
  analysis->trajectory.states->load(0, state);
  state.q(analysis->model.body("crank").frame.offset) += 0.2e-3;
  SimulationOptions options{1e-3, 2.5e-5};
  options.newton_tolerance = 1e-4;
  EXPECT_EQ(failure_of([&] { ConstraintGuard(analysis->model, options).see(0, state); }), "");
  // A hundred tolerances, of the crank's 120 mm: 1.2 mm.
  const double placed = state.q(analysis->model.body("crank").frame.offset) - 0.2e-3;
  const auto fails_at = [&](double apart) {
    state.q(analysis->model.body("crank").frame.offset) = placed + apart;
    return !failure_of([&] { ConstraintGuard(analysis->model, options).see(0, state); }).empty();
  };
  EXPECT_FALSE(fails_at(1.18e-3));
  EXPECT_TRUE(fails_at(1.22e-3));
  EXPECT_FALSE(fails_at(0.2e-3));
  options.newton_tolerance = 1e-10;
  options.formulation.constraints = ConstraintForm::index_1;
  EXPECT_EQ(failure_of([&] { ConstraintGuard(analysis->model, options).see(0, state); }), "");
  options.formulation.is_projected = true;
  EXPECT_NE(failure_of([&] { ConstraintGuard(analysis->model, options).see(0, state); }), "");
}

}  // namespace
}  // namespace pleuel::test::validity_test
