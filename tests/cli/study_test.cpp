#include <limits>

#include "tests/cli/program.hpp"

namespace pleuel::test::study_test {
namespace {

using Study = InProgramFolder;

TEST_F(Study, OfAFrontPutsPointsIntoTheGaps) {
  const std::string line = "pareto $crank $quick -o run --overwrite --set /pareto/points=3 ";
  EXPECT_THAT(run(line + "--gap 20%").out, HasSubstr("Gaps: neighbours are at most "));
  const json gaps = result().at("gaps");
  EXPECT_EQ(gaps.at("asked"), 0.2);
  EXPECT_LE(gaps.at("largest"), 0.2);
  EXPECT_TRUE(gaps.at("left").empty());
  EXPECT_GT(result().at("points").size(), 5u);  // a front of 1.2 or more has six gaps
  EXPECT_THAT(run_line(folder_.path(), line + "--gap 0.05 --set /pareto/most_points=5").out,
              AllOf(HasSubstr("than 5 points were allowed"), HasSubstr("(\"most_points\")")));
  EXPECT_THAT(refusal(line + "--gap 5"),
              HasSubstr("/pareto/gap must be at least 0.001 and less than 1, got 5"));
}

TEST_F(Study, OfAFrontShowsAllChoicesOfSizesThatNoOtherDominates) {
  const ProgramRun front =
      run_line(folder_.path(),
               "pareto $crank $quick -o run "
               R"(--set '/pareto={"responses": ["crank_and_rod", "rod_bow"]}' )"
               R"(--set '/variables/crank_diameter={"choices": ["24 mm", "26 mm", "28 mm"]}' )"
               R"(--set '/variables/rod_diameter={"choices": ["12 mm", "15 mm", "18 mm"]}')");
  EXPECT_THAT(front.out, HasSubstr("Sizes: all 9 choices of sizes were tried; "));
  EXPECT_EQ(at(result(), "choices/combinations"), 9);
  const json points = result().at("points");
  ASSERT_GE(points.size(), 2u) << front.out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(points[i].at("sizes").contains("rod_diameter")) << points[i];
    EXPECT_FALSE(points[i].contains("multiplier"));
    if (i == 0) continue;
    const json &one = points[i - 1].at("objectives"), &next = points[i].at("objectives");
    EXPECT_GT(next.at("rod_bow"), one.at("rod_bow"));
    EXPECT_LT(next.at("crank_and_rod"), one.at("crank_and_rod"));
  }
}

TEST_F(Study, OfAccuracyMeasuresEveryCombination) {
  const json found = document(
      "accuracy $crank $quick -o study --set '/accuracy/steps=[4e-4, 2e-4, 1e-4]' "
      "--set '/accuracy/elements=[2, 4]'");
  ASSERT_EQ(found.at("runs").size(), 6u);
  for (const json& one : found.at("runs")) {
    EXPECT_EQ(one.at("errors").size(), 8u);
    EXPECT_EQ(one.at("gradient_errors").size(), 8u);
    EXPECT_GT(one.at("seconds"), 0.0);
    EXPECT_GT(number(one, "work/factorizations"), 0);
  }
  EXPECT_EQ(folder_.csv("study/accuracy.csv").size(), 1u + 7u);  // and the reference
  const json& reference = found.at("reference");
  EXPECT_EQ(reference.at("step"), 0.5e-4);
  EXPECT_EQ(reference.at("elements"), 8);
  // What is recommended can be set, and has the values that were measured.
  const json& recommended = found.at("recommended");
  ASSERT_TRUE(recommended.is_object()) << found.at("runs");
  const json simulated = document("simulate $crank $quick" + overrides_of(recommended));
  for (const auto& [name, error] : recommended.at("errors").items()) {
    const double exact = number(reference, "values/" + name);
    EXPECT_LE(std::abs(number(simulated, "responses/" + name + "/value") - exact),
              1.001 * error.get<double>() * std::abs(exact))
        << name;
  }
}

/// d mass = ρ π/2 d l · 0.1 mm grows with the diameter.
TEST_F(Study, OfUncertaintyIsOfTheDesignThatIsGiven) {
  folder_.write("thick.json", R"({"crank_diameter": "30 mm", "rod_diameter": "40 mm"})");
  const auto deviation = [&](const std::string& more) {
    return number(document("uncertainty $crank $quick -o study --overwrite --set '/uncertainty={"
                           R"("parameters": {"rod_diameter": {"deviation": "0.1 mm"}}, )"
                           R"("samples": 2}' )" +
                           more),
                  "responses/crank_and_rod/deviation");
  };
  const double at_start = deviation("");  // 30 mm
  EXPECT_NEAR(at_start, 7850.0 * 0.5 * M_PI * 0.030 * 0.180 * 1e-4, 1e-9);
  EXPECT_NEAR(deviation("--design thick.json"), at_start * 40.0 / 30.0, 1e-9 * at_start);
}

TEST_F(Study, OfStabilityTabulatesFilesTimesFormulations) {
  const json found = document(
      "stability $problems/hard/dead_centres.json $problems/hard/change_point.json -o study");
  const std::size_t runs = 2 * found.at("formulations").size();
  ASSERT_EQ(found.at("runs").size(), runs);
  for (const json& one : found.at("runs")) {
    EXPECT_FALSE(one.contains("failure")) << one;
    EXPECT_LE(one.at("position_drift"), 1e-3);
    EXPECT_GE(at(one, "work/newton_iterations"), at(one, "work/steps"));
  }
  EXPECT_EQ(folder_.csv("study/stability.csv").size(), 1u + runs);
  const json card = folder_.read("study/run_card.json");
  EXPECT_EQ(card.at("inputs").size(), 2u);
  EXPECT_EQ(card.at("problems").size(), 2u);
}

/// A mechanism that one formulation cannot simulate is a result of the study, not its failure.
TEST_F(Study, OfStabilityReportsWhatFails) {
  const json found = document(
      "stability $problems/hard/dead_centres.json --set /simulation/max_newton_iterations=1");
  for (const json& one : found.at("runs")) {
    EXPECT_THAT(one.at("failure").get<std::string>(), HasSubstr("t = "));
  }
  EXPECT_TRUE(folder_.has("runs/dead_centres-stability/stability.csv"));
}

TEST_F(Study, OfPricesWritesWhatItSays) {
  const std::string out = unwrapped(run("prices $crank $quick -o p").out);
  EXPECT_THAT(run("prices $crank $quick --design p/result.json -o broken "
                  "--set '/constraints/rod_strength/upper=20 MPa'",
                  4)
                  .out,
              HasSubstr("the design breaks \"rod_strength\""));
  const json prices = result("p").at("prices");
  const CsvRows rows = folder_.csv("p/prices.csv");
  ASSERT_EQ(rows.size(), 1 + prices.size());
  EXPECT_THAT(rows.front(), ElementsAre("name", "kind", "value", "unit", "per_unit", "per_percent",
                                        "next_limit"));
  double last = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const json& price = prices.at(rows[i].at(0));
    EXPECT_EQ(price.at("kind"), rows[i].at(1));
    EXPECT_EQ(price.at("value"), std::stod(rows[i].at(2)));
    EXPECT_EQ(price.at("per_unit"), std::stod(rows[i].at(4)));
    const double percent = price.at("per_percent");
    EXPECT_EQ(percent, std::stod(rows[i].at(5)));
    EXPECT_NEAR(percent, 0.01 * number(price, "value") * number(price, "per_unit"),
                1e-14 * std::abs(percent));
    EXPECT_LE(std::abs(percent), last);
    last = std::abs(percent);
  }
  // The table shows grams and percent of the same number, in units of engineers.
  const json& density = prices.at("/scene/materials/steel/density");
  EXPECT_THAT(out, HasSubstr(fmt::format("materials/steel/density 7850.0 kg/m^3 +{:.4g} +",
                                         number(density, "per_unit"))));
  EXPECT_THAT(out, HasSubstr(fmt::format("+{:.3f} %", 100.0 * number(density, "per_percent") /
                                                          number(result("p"), "objective/value"))));
}

TEST_F(Study, OfPricesIsThatOfTheDesignThatIsGivenIfItIsAnOptimum) {
  run("optimize $crank $quick -o o");
  const json priced = document("prices $crank $quick --design o/result.json -o p");
  EXPECT_EQ(priced.at("status"), "done");
  // Those of limits are the multipliers of the optimization.
  json optimum = result("o");
  bool has_limit = false;
  for (const auto& [name, constraint] : optimum.at("constraints").items()) {
    const double multiplier = constraint.at("multiplier");
    if (multiplier == 0.0) continue;
    const json& price = priced.at("prices").at("/constraints/" + name + "/upper");
    EXPECT_NEAR(number(price, "per_unit") / -multiplier, 1.0, 1e-3) << name;
    has_limit = true;
  }
  EXPECT_TRUE(has_limit);
  optimum["variables"]["rod_diameter"]["value"] = 0.03;
  folder_.write("elsewhere.json", optimum);
  EXPECT_THAT(unwrapped(run("prices $crank $quick --design elsewhere.json -o e", 4).out),
              HasSubstr("the design is no optimum"));
}

/// m = ρ L π d² / 4, so dm/dd = ρ L π d / 2 with ρ = 7850, d = 0.03, L = 0.12 and 0.18.
TEST_F(Study, OfGradientsHasMethodsSideBySideThatAgree) {
  const json found =
      document("gradient $crank $quick --method direct --method central-difference --step 1e-5");
  const json mass = at(found, "responses/crank_and_rod");
  EXPECT_EQ(mass.at("unit"), "kg");
  for (const auto& [variable, length] :
       {std::pair<std::string, double>{"crank_diameter", 0.12}, {"rod_diameter", 0.18}}) {
    const double direct = number(mass, "gradients/direct/" + variable);
    EXPECT_NEAR(direct, 7850 * length * M_PI * 0.03 / 2, 1e-10);
    // A square: only round-off is left.
    EXPECT_NEAR(number(mass, "gradients/central-difference/" + variable) / direct, 1.0, 1e-9);
  }
  EXPECT_TRUE(found.at("seconds").contains("simulate"));
  EXPECT_TRUE(found.at("seconds").contains("direct"));
}

TEST_F(Study, OfGradientsTakesTheMethodOfTheFile) {
  for (const auto& [options, method] :
       {std::pair{"", "adjoint"}, {"--method forward-difference", "forward-difference"}}) {
    const json gradients =
        at(document(R"(gradient $crank $quick --set '/sensitivity={"method": "adjoint"}' )" +
                    std::string(options)),
           "responses/rod_bow/gradients");
    EXPECT_EQ(gradients.size(), 1u);
    EXPECT_TRUE(gradients.contains(method)) << gradients;
  }
}

TEST_F(Study, HasBackends) {
  EXPECT_THAT(document("backends").at("backends").get<std::vector<std::string>>(),
              ::testing::Contains("ipopt"));
}

}  // namespace
}  // namespace pleuel::test::study_test
