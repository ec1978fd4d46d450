/// A verdict for every variable: small parts of the objective, bad scales, variables without
/// influence. All optima are closed forms.

#include <map>

#include "core/base/eager_matrices.hpp"
#include "optimization/backends.hpp"
#include "optimization/solve.hpp"
#include "tests/optimization/known_problems.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::small_part_test {
namespace {

/// Two cantilevers under tip loads, the second one so much lighter: mass 1 + part at b h = 1, and
/// stress 1/(b h²) ≤ 1 each. A high section is light: b goes to its bound 0.5, and h is √2 there,
/// so that b h = √2/2 for both. They share nothing.
KnownProblem two_beams(double part) {
  const auto formulas = [part](const auto& x) {
    return responses(x[0] * x[1] + part * x[2] * x[3], 1.0 / (x[0] * x[1] * x[1]),
                     1.0 / (x[2] * x[3] * x[3]));
  };
  return {"two beams",
          by_formulas({{"big width", 1.0, 0.5, 10.0},
                       {"big height", 2.0, 0.1, 5.0},
                       {"small width", 1.0, 0.5, 10.0},
                       {"small height", 2.0, 0.1, 5.0}},
                      {{"big stress", -infinity, 1.0}, {"small stress", -infinity, 1.0}}, formulas),
          std::sqrt(0.5) * (1.0 + part)};
}

class SmallPart : public testing::TestWithParam<std::string> {};

TEST_P(SmallPart, IsAsGoodAsTheLargeOne) {
  for (const double part : {0.02, 1e-3, 1e-4}) {
    KnownProblem known = two_beams(part);
    const Result result = verified(solve(known.problem, {.backend = GetParam()}));
    EXPECT_NEAR(result.x[0] * result.x[1], std::sqrt(0.5), 1e-4) << part;
    // The variable residual leaves 1e-4 of a part: kkt_audit.hpp.
    EXPECT_NEAR(result.x[2] * result.x[3], std::sqrt(0.5), 1e-3) << part;
    // Price of the small stress limit: m = √(b/σ) part, dm/dσ = −m/2.
    EXPECT_NEAR(result.constraint_multipliers[1], 0.5 * part * std::sqrt(0.5), 0.02 * part);
  }
}

/// f = Σ w (z + 1/z) with z = x / unit: a minimum of 2 w at x = unit, made by the objective alone.
TEST_P(SmallPart, MayHaveItsMinimumInside) {
  const Eigen::Vector3d units(1e-6, 1.0, 1e3), weights(1.0, 1e-3, 0.02);
  std::vector<Variable> variables;
  for (int i = 0; i < 3; ++i) {
    variables.push_back({"x" + std::to_string(i), 2.0 * units[i], 0.1 * units[i], 9.0 * units[i]});
  }
  FunctionProblem problem = by_formulas(variables, {}, [&](const auto& x) {
    const auto part = [&](int i) { return weights[i] * (x[i] / units[i] + units[i] / x[i]); };
    return responses(part(0) + part(1) + part(2));
  });
  const Result result = verified(solve(problem, {.backend = GetParam()}));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(result.x[i] / units[i], 1.0, 0.02) << i;
}

/// x + 2y ≥ 3, 2x + y ≥ 3 and, through the same corner (1, 1), x + y ≥ 2 twice: four limits for two
/// variables.
TEST_P(SmallPart, MayBeHeldByDependentLimits) {
  FunctionProblem problem = by_formulas(
      {{"x", 3.0, 0.0, 10.0}, {"y", 2.0, 0.0, 10.0}},
      {{"a", 3.0, infinity}, {"b", 3.0, infinity}, {"c", 2.0, infinity}, {"d", 2.0, infinity}},
      [](const auto& x) {
        const auto sum = x[0] + x[1];
        return responses(sum + 0.1 * x[1], sum + x[1], sum + x[0], sum, sum);
      });
  const Result result = verified(solve(problem, {.backend = GetParam()}));
  EXPECT_NEAR(result.evaluation.objective, 2.1, 1e-4 * 2.1);
}

/// One variable that changes nothing and one that only a limit far away sees.
TEST_P(SmallPart, MayBeNothingAtAll) {
  FunctionProblem problem =
      by_formulas({{"x", 3.0, 0.5, 10.0}, {"nothing", 2.0, 0.0, 10.0}, {"loose", 2.0, 0.0, 10.0}},
                  {{"holds", -infinity, 1.0}, {"far", -infinity, 100.0}},
                  [](const auto& x) { return responses(x[0], 1.0 / x[0], x[2]); });
  const Result result = verified(solve(problem, {.backend = GetParam()}));
  EXPECT_NEAR(result.evaluation.objective, 1.0, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Backends, SmallPart, testing::ValuesIn(optimizer_names()),
                         name_of_backend);

/// The big beam at its optimum, the small one on its stress limit b h² = 1 with 5 % more mass than
/// needed: h = √2/1.05 gives b h = 1/h. Or with slack: 5 % wider than its stress asks for.
TEST(Verdict, OfASmallPartThatIsTooHeavyIsNotVerified) {
  const double root = std::sqrt(2.0);
  for (const double part : {0.02, 1e-3, 1e-4, 1e-5}) {
    KnownProblem known = two_beams(part);
    const auto verdict_at = [&](double width, double height) {
      return judge_anew(known.problem, Eigen::Vector4d(0.5, root, width, height));
    };
    const double low = root / 1.05;
    std::vector<Verdict> heavy = {verdict_at(1.0 / (low * low), low)};
    if (part == 1e-3) heavy.push_back(verdict_at(0.5, 1.05 * root));
    for (const Verdict& verdict : heavy) {
      EXPECT_EQ(verdict.status, Status::stalled) << part << verdict.message;
      EXPECT_THAT(verdict.message, HasSubstr("small"));
    }
    EXPECT_EQ(verdict_at(1.0 / (root * root), root).status, Status::verified) << part;
  }
}

/// 1 + ½ k x²: what is left is ½ k x².
TEST(Verdict, EstimatesWhatIsLeftToTheOptimum) {
  constexpr double k = 100.0, x = 4e-5;
  FunctionProblem problem = by_formulas(
      {{"x", 1.0, -1.0, 1.0}, {"y", 0.5, -1.0, 1.0}}, {},
      [](const auto& z) { return responses(1.0 + 0.5 * k * (z[0] * z[0] + 4.0 * z[1] * z[1])); });
  const Verdict verdict = judge_anew(problem, Eigen::Vector2d(x, 0.0));
  EXPECT_EQ(verdict.status, Status::verified) << verdict.message;
  EXPECT_NEAR(verdict.gain_left, 0.5 * k * x * x, 1e-3 * 0.5 * k * x * x);
}

/// 10 + ½ (x − 1)² of x from 0.5 to 10, begun at 3: near 1 the residual is |x − 1| times the scale
/// 1 of x over that of the gradient, min(2, f/10) = 1.
FunctionProblem shallow_bowl() {
  return by_formulas({{"x", 3.0, 0.5, 10.0}}, {}, [](const auto& x) {
    return responses(10.0 + 0.5 * (x[0] - 1.0) * (x[0] - 1.0));
  });
}

Verdict verdict_at(FunctionProblem problem, double x) {
  return judge_anew(problem, Eigen::VectorXd::Constant(1, x));
}

/// What is allowed of the KKT residual, 1e-3, and no more.
TEST(Verdict, IsVerifiedUpToTheResidualThatIsAllowed) {
  for (const double side : {-1.0, 1.0}) {
    const Verdict within = verdict_at(shallow_bowl(), 1.0 + side * 0.95e-3);
    const Verdict beyond = verdict_at(shallow_bowl(), 1.0 + side * 3e-3);
    EXPECT_EQ(within.status, Status::verified) << within.message;
    EXPECT_EQ(beyond.status, Status::stalled);
    EXPECT_NEAR(beyond.audit.residual, 3e-3, 2e-5);
    EXPECT_THAT(beyond.message, HasSubstr("not proven optimal: relative KKT residual 0.003"));
  }
}

/// x ≥ 1 is what holds x, and 0.05 % of x are left to it: more than the 0.01 % that may be.
TEST(Verdict, WithSlackAtTheLimitThatHoldsItIsNotVerified) {
  const FunctionProblem problem = by_formulas({{"x", 3.0, 0.5, 10.0}}, {{"least", 1.0, infinity}},
                                              [](const auto& x) { return responses(x[0], x[0]); });
  const Verdict slack = verdict_at(problem, 1.0005);
  EXPECT_EQ(slack.status, Status::stalled) << slack.message;
  EXPECT_NEAR(slack.gain_left, 5e-4, 1e-5);
  EXPECT_EQ(verdict_at(problem, 1.00005).status, Status::verified);
}

/// An optimum of which no design beside it can be evaluated has gradients that nothing proves.
TEST(Verdict, WithoutDesignsBesideItIsNotVerified) {
  FunctionProblem bowl = shallow_bowl();
  const Eigen::VectorXd optimum = Eigen::VectorXd::Ones(1), start = checked_start(bowl);
  FunctionProblem lonely = changed(bowl, [&](const Eigen::VectorXd& x, Evaluation&) {
    if (x != optimum && x != start) throw EvaluationFailure("locks");
  });
  EXPECT_EQ(judge_anew(bowl, start, optimum).status, Status::verified);
  const Verdict verdict = judge_anew(lonely, start, optimum);
  EXPECT_EQ(verdict.status, Status::stalled) << verdict.message;
  EXPECT_THAT(verdict.message, HasSubstr("its gradients are unproven"));
}

/// |x − 0.3| + x/10: the minimum is a kink. Nothing else may be called an optimum.
TEST(Verdict, BesideAKinkIsNotVerified) {
  for (const std::string& backend : optimizer_names()) {
    FunctionProblem problem(
        {{"x", 0.9, 0.0, 1.0}}, {}, [](const Eigen::VectorXd& x, Request request) {
          Evaluation evaluation;
          evaluation.objective = 1.0 + std::abs(x[0] - 0.3) + 0.1 * x[0];
          evaluation.constraints.resize(0);
          if (request == Request::values) return evaluation;
          evaluation.objective_gradient = Eigen::VectorXd::Constant(1, x[0] > 0.3 ? 1.1 : -0.9);
          evaluation.constraint_jacobian.resize(0, 1);
          return evaluation;
        });
    const Result result = solve(problem, {.backend = backend});
    const bool is_optimum = std::abs(result.x[0] - 0.3) < 1e-4;
    EXPECT_TRUE(is_optimum || result.status != Status::verified) << backend << result.message;
  }
}

/// MMA left alone with a loose tolerance stops at 1e-3 of the optimum of the cantilever.
TEST(Polish, FinishesAnAnswerThatIsNearlyAnOptimum) {
  KnownProblem known = cantilever();
  SolveOptions options{.backend = "nlopt-mma", .tolerance = 1e-3, .max_restarts = 0};
  const Result polished = verified(solve(known.problem, options));
  EXPECT_EQ(polished.backend, "nlopt-mma");
  EXPECT_EQ(polished.polished_with, "nlopt-slsqp");
  EXPECT_THAT(polished.message, HasSubstr("polished with nlopt-slsqp"));
  EXPECT_NEAR(polished.evaluation.objective, known.optimum, 1e-6 * known.optimum);

  options.max_polishes = 0;
  const Result rough = solve(known.problem, options);
  EXPECT_EQ(rough.polished_with, "");
  EXPECT_GT(rough.evaluation.objective, known.optimum * (1.0 + 1e-6));
}

/// Steps are counted, designs that only prove something are not.
TEST(Purpose, TellsStepsFromTheAudit) {
  KnownProblem known = cantilever();
  const Result result = solve(known.problem, {.backend = "nlopt-mma", .tolerance = 1e-3});
  int steps = 0;
  std::map<Purpose, int> evaluations;
  for (const EvaluationRecord& record : result.history) {
    ++evaluations[record.purpose];
    const bool is_audit = record.purpose == Purpose::audit;
    steps += !is_audit && record.request == Request::values_and_gradients ? 1 : 0;
    EXPECT_EQ(record.iteration, steps) << record.evaluation;
  }
  EXPECT_EQ(result.history.front().purpose, Purpose::search);
  EXPECT_EQ(result.iterations, steps);
  EXPECT_GE(evaluations[Purpose::audit], 6);  // the values of the gradient check
  EXPECT_GT(evaluations[Purpose::polish], 0);
  EXPECT_THAT(result.message, HasSubstr("other local optima were not looked for"));
}

}  // namespace
}  // namespace pleuel::test::small_part_test
