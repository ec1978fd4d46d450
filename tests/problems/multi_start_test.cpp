#include "optimization/design/multi_start.hpp"

#include <filesystem>
#include <fstream>
#include <optional>

#include "core/base/eager_matrices.hpp"
#include "core/scene/problem_reader.hpp"
#include "optimization/backends.hpp"
#include "optimization/design/design_case.hpp"
#include "optimization/design/size_choice.hpp"
#include "tests/optimization/known_problems.hpp"
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
    "responses": {{"x": {{"type": "position", "body": "arm", "at": 1, "direction": "x", "over_time": "final"}}}},
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
  SolveOptions options{.starts = 2};
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

// A cantilever of steps of 100 mm, 20 mm wide, with 1 kN at its tip from the start on, in
// equilibrium. The stress at the root of a step is 6 F (distance to the tip) / (b h²).
constexpr double force = 1000.0, width = 0.02, step_length = 0.1, strength = 100e6;

double least_height(int step, int steps) {
  return std::sqrt(6.0 * force * step_length * (steps - step) / (width * strength));
}

double smallest_above(const std::vector<double>& sizes, double least) {
  double found = 1e9;
  for (const double size : sizes) {
    if (size >= least) found = std::min(found, size);
  }
  return found;
}

std::string mm_list(const std::vector<double>& sizes) {
  std::string text;
  for (const double size : sizes) {
    text += fmt::format("{}\"{} mm\"", text.empty() ? "" : ", ", 1e3 * size);
  }
  return text;
}

struct SizedSteps {
  int steps = 3;
  std::vector<double> sizes{};
  std::string more_variables{};  ///< ", \"name\": {…}"
  std::string width = "\"20 mm\"";
  std::string first_height{};  ///< in place of its variable
  std::string strength = "\"100 MPa\"";
  std::optional<double> sag{};  ///< limit at the tip [m]
};

/// One limit on the stress of each step.
ProblemFile make_cantilever(const SizedSteps& of) {
  std::string segments, variables, responses, constraints;
  for (int i = 0; i < of.steps; ++i) {
    const bool is_given = i == 0 && !of.first_height.empty();
    const std::string comma = i == 0 ? "" : ", ";
    segments += comma + fmt::format(R"({{"section": {{"type": "rectangle", "width": {},
      "height": {}}}, "elements": 1}})",
                                    of.width,
                                    is_given ? of.first_height
                                             : fmt::format(R"({{"variable": "h{}"}})", i));
    if (!is_given) {
      variables += fmt::format(R"({}"h{}": {{"choices": [{}]}})", variables.empty() ? "" : ", ", i,
                               mm_list(of.sizes));
    }
    responses += fmt::format(R"(, "s{0}": {{"type": "stress", "body": "beam", "segment": {0},
      "over_time": "max"}})",
                             i);
    constraints +=
        comma + fmt::format(R"("s{0}": {{"response": "s{0}", "upper": {1}}})", i, of.strength);
  }
  if (of.sag) {
    responses +=
        R"(, "sag": {"type": "deflection", "body": "beam", "at": 1, "over_time": "max-abs"})";
    constraints += fmt::format(R"(, "sag": {{"response": "sag", "upper": {}}})", *of.sag);
  }
  return read_problem_text(fmt::format(R"({{"scene": {{
    "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [{}, 0, 0],
      "material": "steel", "segments": [{}]}}}},
    "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}}}},
    "loads": {{"weight": {{"type": "force", "body": "beam", "at": [{}, 0, 0],
      "direction": [0, -1, 0], "value": "1 kN"}}}}}},
    "simulation": {{"end_time": "2 ms", "step": "1 ms", "initial_state": "quasi-static",
      "resolution_check": false}},
    "variables": {{{}{}}},
    "responses": {{"mass": {{"type": "mass"}}{}}},
    "objective": {{"minimize": "mass"}}, "constraints": {{{}}}}})",
                                       step_length * of.steps, segments, step_length * of.steps,
                                       variables, of.more_variables, responses, constraints),
                           "cantilever.json")
      .complete();
}

struct Answer {
  StagedSolution solution;
  SizeChoiceReport report;
  const Result& result() const { return solution.result; }
};

Answer solved_sizes(const ProblemFile& file, int jobs = 1) {
  const Execution execution{{.jobs = jobs}, nullptr};
  MultiStart all = solve_from_starts(file, {start_design(file)}, {{}, execution});
  Answer answer;
  answer.solution = std::move(all.best);
  answer.report = choose_sizes(answer.solution, {{}, execution});
  return answer;
}

void expect_closed_form(const Answer& answer, const std::vector<double>& sizes, int steps) {
  for (int i = 0; i < steps; ++i) {
    EXPECT_DOUBLE_EQ(answer.result().x(i), smallest_above(sizes, least_height(i, steps))) << i;
  }
}

TEST(SizeChoice, TakesTheSmallestSizesThatAreStrongEnough) {
  const std::vector<double> sizes = {0.02, 0.03, 0.012, 0.025, 0.035};  // in no order
  const Answer answer = solved_sizes(make_cantilever({.steps = 3, .sizes = sizes}));
  expect_closed_form(answer, sizes, 3);
  EXPECT_EQ(answer.result().status, Status::verified) << answer.result().message;
  EXPECT_TRUE(answer.report.is_exhaustive);
  EXPECT_EQ(answer.report.combinations, 125.0);
  EXPECT_EQ(answer.report.tried, 125);
  EXPECT_THAT(answer.result().message, HasSubstr("the best of all 125 choices"));
  // Between the sizes each step is as high as it must be: 7850 kg/m³ · b · 100 mm · Σ h.
  double relaxed = 0.0;
  for (int i = 0; i < 3; ++i) relaxed += 7850.0 * width * step_length * least_height(i, 3);
  EXPECT_NEAR(answer.report.relaxed_objective, relaxed, 2e-4 * relaxed);
  EXPECT_GT(answer.report.penalty(answer.result().evaluation.objective), 0.0);
}

TEST(SizeChoice, IsTheSameForAnyNumberOfJobs) {
  const ProblemFile file = make_cantilever({.steps = 2, .sizes = {0.02, 0.03, 0.025, 0.035}});
  const Answer one = solved_sizes(file, 1), two = solved_sizes(file, 2);
  EXPECT_EQ(one.result().x, two.result().x);
  EXPECT_EQ(one.result().evaluation.objective, two.result().evaluation.objective);
  EXPECT_EQ(one.result().evaluations, two.result().evaluations);
  EXPECT_EQ(one.result().message, two.result().message);
}

TEST(SizeChoice, FindsWhatIsBestAmongTooManyChoicesToTryAll) {
  // 8⁹ = 1.3e8; the closed form is known for each step by itself.
  const std::vector<double> sizes = {0.010, 0.016, 0.020, 0.024, 0.030, 0.036, 0.042, 0.052};
  const Answer answer = solved_sizes(make_cantilever({.steps = 9, .sizes = sizes}));
  expect_closed_form(answer, sizes, 9);
  EXPECT_EQ(answer.result().status, Status::verified) << answer.result().message;
  EXPECT_FALSE(answer.report.is_exhaustive);
  EXPECT_LT(answer.report.tried, 200);
  EXPECT_THAT(answer.result().message, HasSubstr("which no choice can beat if"));
}

/// Of the tip, by bending alone (E = 210 GPa): F/(3 E I) (a³ − c³) of each step from c to a before
/// the tip.
double sag(const std::vector<double>& heights) {
  const auto steps = static_cast<int>(heights.size());
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double inertia = width * std::pow(heights[i], 3) / 12.0;
    const double a = step_length * (steps - i), c = a - step_length;
    sum += force / (3.0 * 210e9 * inertia) * (a * a * a - c * c * c);
  }
  return sum;
}

/// The least sum of heights of four steps that keep both limits, by all choices of the closed form.
double lightest_of_all(const std::vector<double>& sizes, double limit) {
  double least = 1e9;
  for (const double a : sizes) {
    for (const double b : sizes) {
      for (const double c : sizes) {
        for (const double d : sizes) {
          const std::vector<double> heights = {a, b, c, d};
          bool is_strong = true;
          for (int i = 0; i < 4; ++i) is_strong &= heights[i] >= least_height(i, 4) * (1 - 1e-5);
          if (is_strong && sag(heights) <= limit) least = std::min(least, a + b + c + d);
        }
      }
    }
  }
  return least;
}

TEST(SizeChoice, TradesOneSizeForAnotherWhereALimitJoinsThem) {
  const std::vector<double> sizes = {0.014, 0.018, 0.022, 0.026, 0.03, 0.036, 0.042, 0.05, 0.06};
  for (const double limit : {1.5e-3, 1.0e-3, 0.7e-3}) {
    const Answer answer = solved_sizes(make_cantilever({.steps = 4, .sizes = sizes, .sag = limit}));
    EXPECT_FALSE(answer.report.is_exhaustive);  // 6561
    EXPECT_NEAR(answer.result().x.sum(), lightest_of_all(sizes, limit), 1e-9) << limit;
    EXPECT_EQ(answer.result().status, Status::verified) << answer.result().message;
  }
}

/// Tubes of several walls are not in order of stiffness: 24 of them for each half of a cantilever
/// of 600 mm with 400 N, 160 MPa and 4 mm. Found by one size anywhere in its list, where it stopped
/// 30 % above.
TEST(SizeChoice, LooksThroughListsWhoseSectionsGoUpAndDown) {
  struct Tube {
    double outer, wall;
    double inner() const { return outer - 2.0 * wall; }
    double area() const { return 0.25 * std::numbers::pi * (outer * outer - inner() * inner()); }
    double inertia() const {
      return std::numbers::pi / 64.0 * (std::pow(outer, 4) - std::pow(inner(), 4));
    }
  };
  std::vector<Tube> tubes;
  std::string sections, names;
  for (const double outer : {0.020, 0.025, 0.030, 0.038, 0.044, 0.050}) {
    for (const double wall : {0.0015, 0.002, 0.003, 0.004}) {
      const std::string comma = tubes.empty() ? "" : ", ", name = fmt::format("T{}", tubes.size());
      sections +=
          comma + fmt::format(R"("{}": {{"type": "tube", "outer_diameter": {}, "thickness": {}}})",
                              name, outer, wall);
      names += comma + fmt::format("\"{}\"", name);
      tubes.push_back({outer, wall});
    }
  }
  constexpr double load = 400.0, length = 0.6, half = 0.3, young = 210e9;
  double lightest = 1e9;
  for (const Tube& root : tubes) {
    for (const Tube& tip : tubes) {
      const double stress = std::max(load * length * root.outer / root.inertia(),
                                     load * half * tip.outer / tip.inertia()) /
                            2.0;
      const double bent = load / (3.0 * young) *
                          ((std::pow(length, 3) - std::pow(half, 3)) / root.inertia() +
                           std::pow(half, 3) / tip.inertia());
      if (stress > 160e6 || bent > 4e-3) continue;
      lightest = std::min(lightest, 7850.0 * half * (root.area() + tip.area()));
    }
  }
  const std::string folder = testing::TempDir() + "/walls";
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/tubes.json") << fmt::format(R"({{"sections": {{{}}}}})", sections);
  std::ofstream(folder + "/cantilever.json") << fmt::format(
      R"({{"scene": {{"gravity": [0, 0, 0], "catalogue": "tubes.json",
            "materials": {{"plain": {{"young": 210e9, "poisson": 0.3, "density": 7850}}}},
            "bodies": {{"beam": {{"type": "beam", "from": [0, 0, 0], "to": [0.6, 0, 0],
              "material": "plain", "segments": [
                {{"section": {{"variable": "root"}}, "elements": 1, "length_fraction": 0.5}},
                {{"section": {{"variable": "tip"}}, "elements": 1, "length_fraction": 0.5}}]}}}},
            "joints": {{"wall": {{"type": "fixed", "bodies": ["ground", "beam"], "at": [0, 0, 0]}}}},
            "loads": {{"pull": {{"type": "force", "body": "beam", "at": [0.6, 0, 0],
              "direction": [0, 1, 0], "value": 400}}}}}},
          "simulation": {{"end_time": 2e-3, "step": 1e-3, "initial_state": "quasi-static",
            "resolution_check": false}},
          "variables": {{"root": {{"choices": [{0}]}}, "tip": {{"choices": [{0}]}}}},
          "responses": {{"mass": {{"type": "mass"}},
            "stress": {{"type": "stress", "body": "beam", "over_time": "max"}},
            "sag": {{"type": "deflection", "body": "beam", "at": 1, "over_time": "max-abs"}}}},
          "objective": {{"minimize": "mass"}},
          "constraints": {{"stress": {{"response": "stress", "upper": 160e6}},
                           "sag": {{"response": "sag", "upper": 4e-3}}}}}})",
      names);
  const Answer answer = solved_sizes(read_problem(folder + "/cantilever.json").complete());
  EXPECT_TRUE(answer.report.are_lists_tried);
  EXPECT_EQ(answer.result().status, Status::verified) << answer.result().message;
  EXPECT_NEAR(answer.result().evaluation.objective, lightest, 1e-4 * lightest);
  EXPECT_THAT(answer.result().message, HasSubstr("none with one size exchanged is better"));
}

TEST(SizeChoice, SaysThatNoChoiceKeepsTheLimits) {
  // 3 steps need 30 mm at the wall.
  const Answer answer = solved_sizes(make_cantilever({.steps = 3, .sizes = {0.02, 0.015, 0.025}}));
  EXPECT_EQ(answer.result().status, Status::infeasible);
  EXPECT_THAT(
      answer.result().message,
      AllOf(HasSubstr("none of the 27 choices of sizes keeps all limits"), HasSubstr("s0")));
  EXPECT_EQ(answer.result().x(0), 0.025);  // breaks them least
  EXPECT_TRUE(answer.report.is_choice);
}

TEST(SizeChoice, OptimizesOtherVariablesForEachChoice) {
  // The width is free and one height is chosen: b h² is needed, the mass is b h, so the largest
  // height and the width that it needs are best.
  const Answer answer = solved_sizes(make_cantilever(
      {.steps = 1,
       .sizes = {0.02, 0.03, 0.04},
       .more_variables = R"(, "b": {"start": "20 mm", "lower": "1 mm", "upper": "60 mm"})",
       .width = R"({"variable": "b"})"}));
  EXPECT_EQ(answer.result().status, Status::verified) << answer.result().message;
  EXPECT_EQ(answer.result().x(0), 0.04);
  EXPECT_NEAR(answer.result().x(1), 6.0 * force * step_length / (strength * 0.04 * 0.04), 1e-6);
}

TEST(SizeChoice, GoesWithFormulas) {
  // The first step is as high as 1.5 times the second, which is chosen: 30 mm / 1.5 at the wall and
  // least_height(1, 2) for itself.
  const Answer answer = solved_sizes(make_cantilever(
      {.steps = 2, .sizes = {0.012, 0.016, 0.018, 0.02, 0.03}, .first_height = R"("= 1.5 * h1")"}));
  const double least = std::max(least_height(0, 2) / 1.5, least_height(1, 2));
  EXPECT_DOUBLE_EQ(answer.result().x(0), smallest_above({0.012, 0.016, 0.018, 0.02, 0.03}, least));
  EXPECT_EQ(answer.result().status, Status::verified) << answer.result().message;
}

TEST(SizeChoice, OfOneSizeIsThatOne) {
  const Answer answer = solved_sizes(make_cantilever({.steps = 2, .sizes = {0.03, 0.03}}));
  EXPECT_EQ(answer.report.combinations, 1.0);
  EXPECT_EQ(answer.result().x, Eigen::VectorXd::Constant(2, 0.03));
  EXPECT_EQ(answer.result().status, Status::verified) << answer.result().message;
}

}  // namespace
}  // namespace pleuel::test::multi_start_test
