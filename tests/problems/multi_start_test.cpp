#include "optimization/design/multi_start.hpp"

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/design/design_case.hpp"
#include "tests/optimization/backend_names.hpp"
#include "tests/support/problem_runs.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::multi_start_test {
namespace {

/// An arm of 100 mm that is held at the angle phi; the place of its tip, 100 mm · cos phi, is least
/// at the bounds: 100 mm · cos 1 = 54.030 mm and 100 mm · cos 0.8 = 69.671 mm.
ProblemFile held_arm(const std::string& optimizer) {
  return problem_from(fmt::format(R"({{"scene": {{
    "bodies": {{"arm": {{"type": "beam", "from": [0, 0, 0], "to": ["100 mm", 0, 0], "rigid": true,
      "material": "steel", "elements": 2, "section": {{"type": "circle", "diameter": "10 mm"}}}}}},
    "joints": {{"bearing": {{"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
      "drive": {{"type": "constant", "value": {{"variable": "phi"}}}}}}}}}},
    "simulation": {{"end_time": "2 ms", "step": "1 ms"}},
    "variables": {{"phi": {{"start": 0.4, "lower": -1, "upper": 0.8}}}},
    "responses": {{"x": {{"type": "position", "body": "arm", "at": 1, "direction": "x",
      "over_time": "final"}}}},
    "objective": {{"minimize": "x"}}, "optimizer": {}}})",
                                  optimizer));
}

MultiStart solved(const ProblemFile& file, const Execution& execution = {}) {
  const auto starts =
      starts_of(file, Eigen::VectorXd::Constant(1, file.variables[0].start), file.optimizer.starts);
  return solve_from_starts(file, starts, {{}, execution});
}

TEST(MultiStart, FindsTheBestOfTwoLocalOptima) {
  const MultiStart all = solved(held_arm(R"({"starts": 6})"));
  ASSERT_EQ(all.runs.size(), 6u);
  ASSERT_EQ(all.optima.size(), 2u);
  EXPECT_NEAR(all.optima[0].objective, 0.1 * std::cos(1.0), 1e-6);
  EXPECT_NEAR(all.optima[1].objective, 0.1 * std::cos(0.8), 1e-6);
  EXPECT_EQ(all.optima[0].starts.size() + all.optima[1].starts.size(), 6u);
  EXPECT_EQ(all.best.result.x, all.optima[0].x);
  EXPECT_THAT(all.best.result.message, HasSubstr("the best of 2 local optima from 6 starts"));
  EXPECT_EQ(all.runs[0].start(0), 0.4);
  EXPECT_EQ(all.runs[0].optimum, 1u);  // from 0.4 downhill is to 0.8
}

TEST(MultiStart, TakesTheDesignsThatAreGiven) {
  const MultiStart all = solved(held_arm(R"({"starts": [{"phi": "-10 deg"}, {"phi": 0.7}]})"));
  ASSERT_EQ(all.runs.size(), 3u);
  EXPECT_NEAR(all.runs[1].start(0), -M_PI / 18.0, 1e-12);
  EXPECT_EQ(all.optima[0].starts, (std::vector<std::size_t>{1}));
  EXPECT_EQ(all.optima[1].starts, (std::vector<std::size_t>{0, 2}));
}

TEST(MultiStart, CountsAllEvaluations) {
  const MultiStart all = solved(held_arm(R"({"starts": 3})"));
  int sum = 0;
  for (const StartRun& run : all.runs) sum += run.evaluations;
  EXPECT_EQ(all.best.result.evaluations, sum);
  EXPECT_EQ(all.best.result.history.size(), std::size_t(sum));
  EXPECT_EQ(all.best.result.history.back().evaluation, sum);
  EXPECT_EQ(all.best.result.history.front().x(0), 0.4);
}

TEST(MultiStart, DoesNotDependOnTheNumberOfJobs) {
  const ProblemFile file = held_arm(R"({"starts": 5})");
  const MultiStart one = solved(file, {{.jobs = 1}});
  for (const int jobs : {2, 3}) {
    const MultiStart other = solved(file, {{.jobs = jobs}});
    EXPECT_EQ(other.best.result.x, one.best.result.x);
    EXPECT_EQ(other.best.result.message, one.best.result.message);
    ASSERT_EQ(other.best.result.history.size(), one.best.result.history.size());
    for (std::size_t i = 0; i < one.best.result.history.size(); ++i) {
      EXPECT_EQ(other.best.result.history[i].x, one.best.result.history[i].x);
      EXPECT_EQ(other.best.result.history[i].objective, one.best.result.history[i].objective);
    }
    ASSERT_EQ(other.optima.size(), one.optima.size());
    for (std::size_t i = 0; i < one.optima.size(); ++i) {
      EXPECT_EQ(other.optima[i].starts, one.optima[i].starts);
    }
  }
}

/// In another process, and back: all that a search knows, and the problem that it ended with, whose
/// steps are chosen here.
TEST(MultiStart, SearchesFromEachDesignAsIfThatWereTheOnlyOne) {
  ProblemFile file = held_arm(R"({"starts": 2})");
  file.accuracy.target = 1e-3;
  file.accuracy.chooses_setting = true;
  const auto starts = starts_of(file, Eigen::VectorXd::Constant(1, 0.4), 2);
  SolveOptions options;
  options.starts = 2;
  const MultiStart all = solve_from_starts(file, starts, {options, {{.jobs = 2}}});
  const std::size_t best = all.optima.at(0).starts.at(0);
  const StagedSolution alone = solve_in_stages(file, starts.at(best), {options});
  EXPECT_EQ(all.best.result.x, alone.result.x);
  EXPECT_EQ(all.best.result.evaluation.objective_gradient,
            alone.result.evaluation.objective_gradient);
  EXPECT_EQ(all.best.result.warnings, alone.result.warnings);
  ASSERT_EQ(all.best.stages.size(), alone.stages.size());
  EXPECT_EQ(setting_text(all.best.problem->file()), setting_text(alone.problem->file()));
  EXPECT_EQ(all.best.problem->method()->reason, alone.problem->method()->reason);
}

TEST(MultiStart, CountsASearchThatTakesTooLongAsOneThatFailed) {
  ProblemFile slow = held_arm(R"({"starts": 2})");
  slow.simulation.end_time = 1000.0;  // minutes of work
  const MultiStart all = solved(slow, {{.jobs = 2, .time_limit = 1e-6}});
  EXPECT_EQ(all.best.result.status, Status::failed);
  EXPECT_THAT(all.best.result.message, HasSubstr("start 1 was lost: it took longer than"));
  EXPECT_TRUE(all.optima.empty());
  EXPECT_EQ(all.best.result.x(0), 0.4);
}

TEST(MultiStart, SaysOfOneStartThatOthersWereNotLookedFor) {
  const MultiStart all = solved(held_arm("{}"));
  EXPECT_THAT(all.best.result.message, HasSubstr("other local optima were not looked for"));
  EXPECT_TRUE(all.optima.size() == 1 && all.runs.size() == 1);
}

TEST(MultiStart, RefusesADesignOutsideTheBounds) {
  EXPECT_THAT(thrown<InputError>([&] { held_arm(R"({"starts": [{"phi": 2}]})"); }),
              HasSubstr("/optimizer/starts/0/phi"));
}

/// A cantilever of four pieces of 200 mm under a force of 500 N at its tip, each 20 mm wide and h
/// high, with one limit of 80 MPa for all of it. Each piece is stressed most at its inner end, by
/// 6 F l / (b h²) with the distance l to the tip: h = √(6 F l / (b σ)).
class SteppedCantilever : public testing::TestWithParam<std::string> {
 protected:
  static constexpr double force = 500.0, width = 0.02, stress = 80e6, piece = 0.2;

  static ProblemFile file() {
    std::string segments, variables;
    for (int i = 1; i <= 4; ++i) {
      const char* comma = i < 4 ? "," : "";
      segments += fmt::format(R"({{"elements": 1, "section": {{"type": "rectangle", "width": {},
        "height": {{"variable": "h{}"}}}}}}{})",
                              width, i, comma);
      variables += fmt::format(
          R"("h{}": {{"start": "90 mm", "lower": "5 mm", "upper": "200 mm"}}{})", i, comma);
    }
    return problem_from(fmt::format(
        R"({{"scene": {{"gravity": [0, 0, 0], "bodies": {{"beam": {{"type": "beam",
        "from": [0, 0, 0], "to": [{}, 0, 0], "material": "steel", "segments": [{}]}}}},
      "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}}}},
      "loads": {{"tip": {{"type": "force", "body": "beam", "at": [{}, 0, 0],
        "direction": [0, -1, 0], "value": {}}}}}}},
      "effects": {{"geometric_stiffening": "off"}},
      "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static",
        "resolution_check": false}},
      "variables": {{{}}},
      "responses": {{"mass": {{"type": "mass"}},
        "stress": {{"type": "stress", "body": "beam", "over_time": "max"}}}},
      "objective": {{"minimize": "mass"}},
      "constraints": {{"strength": {{"response": "stress", "upper": {}}}}}}})",
        4 * piece, segments, 4 * piece, force, variables, stress));
  }
};

TEST_P(SteppedCantilever, IsFullyStressedInAllItsPiecesByOneLimit) {
  DesignProblem problem(file());
  const Result result = solve_design(problem, {.backend = GetParam()});
  double volume = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double height = std::sqrt(6.0 * force * (4 - i) * piece / (width * stress));
    EXPECT_NEAR(result.x(i), height, 1e-3 * height) << i;
    volume += width * height * piece;
  }
  // The verdict allows a gain of 1e-4.
  EXPECT_NEAR(result.evaluation.objective, 7850.0 * volume, 2e-4 * 7850.0 * volume);
  EXPECT_EQ(result.backend, GetParam());
  EXPECT_TRUE(result.status == Status::verified || result.status == Status::unresolved)
      << result.message;
}

INSTANTIATE_TEST_SUITE_P(Backends, SteppedCantilever, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

}  // namespace
}  // namespace pleuel::test::multi_start_test
