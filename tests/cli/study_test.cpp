#include <fstream>
#include <limits>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::study_test {
namespace {

using ParetoCommand = InProgramFolder;

TEST_F(ParetoCommand, PutsPointsIntoTheGaps) {
  const std::vector<std::string> words =
      joined({"pareto", problem("slider_crank_round"), "-o", "front", "--set", "/pareto/points=3"},
             quick());
  const ProgramRun run = exits(0, folder_.run(joined(words, {"--gap", "20%"})));
  EXPECT_THAT(run.out, HasSubstr("Gaps: neighbours are at most "));
  const nlohmann::json document = folder_.result("front");
  EXPECT_EQ(document.at("gaps").at("asked"), 0.2);
  EXPECT_LE(document.at("gaps").at("largest"), 0.2);
  EXPECT_TRUE(document.at("gaps").at("left").empty());
  EXPECT_GT(document.at("points").size(), 5u);  // a front of 1.2 or more has six gaps
  const ProgramRun few = folder_.run(
      joined(words, {"--overwrite", "--gap", "0.05", "--set", "/pareto/most_points=5"}));
  EXPECT_THAT(few.out, HasSubstr("than 5 points were allowed"));
  EXPECT_THAT(few.out, HasSubstr("(\"most_points\")"));
  EXPECT_THAT(folder_.run(joined(words, {"--overwrite", "--gap", "5"})).err,
              HasSubstr("/pareto/gap must be at least 0.001 and less than 1, got 5"));
}

TEST_F(ParetoCommand, ShowsAllChoicesOfSizesThatNoOtherDominates) {
  const ProgramRun run = folder_.run_quick(
      {"pareto", problem("slider_crank_round"), "-o", "front", "--set",
       R"(/pareto={"responses": ["crank_and_rod", "rod_bow"]})", "--set",
       R"(/variables/crank_diameter={"choices": ["24 mm", "26 mm", "28 mm"]})", "--set",
       R"(/variables/rod_diameter={"choices": ["12 mm", "15 mm", "18 mm"]})"});
  EXPECT_THAT(run.out, HasSubstr("Sizes: all 9 choices of sizes were tried; "));
  const nlohmann::json document = folder_.result("front");
  EXPECT_EQ(document.at("choices").at("combinations"), 9);
  const auto& points = document.at("points");
  ASSERT_GE(points.size(), 2u) << run.out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(points[i].at("sizes").contains("rod_diameter")) << points[i];
    EXPECT_FALSE(points[i].contains("multiplier"));
    if (i == 0) continue;
    const auto &one = points[i - 1].at("objectives"), &next = points[i].at("objectives");
    EXPECT_GT(next.at("rod_bow"), one.at("rod_bow"));
    EXPECT_LT(next.at("crank_and_rod"), one.at("crank_and_rod"));
  }
}

TEST(AccuracyCommand, MeasuresEveryCombination) {
  const ProgramFolder folder;
  const ProgramRun run =
      exits(0, folder.run_quick({"accuracy", problem("slider_crank_round"), "--json", "-o", "study",
                                 "--set", "/accuracy/steps=[4e-4, 2e-4, 1e-4]", "--set",
                                 "/accuracy/elements=[2, 4]"}));
  const nlohmann::json document = run.document();
  ASSERT_EQ(document.at("runs").size(), 6u);
  for (const auto& study_run : document.at("runs")) {
    EXPECT_EQ(study_run.at("errors").size(), 8u);
    EXPECT_EQ(study_run.at("gradient_errors").size(), 8u);
    EXPECT_GT(study_run.at("seconds"), 0.0);
    EXPECT_GT(study_run.at("work").at("factorizations"), 0);
  }
  EXPECT_EQ(document.at("reference").at("step"), 0.5e-4);
  EXPECT_EQ(document.at("reference").at("elements"), 8);
  // What is recommended can be set, and has the values that were measured.
  const nlohmann::json& recommended = document.at("recommended");
  ASSERT_TRUE(recommended.is_object()) << document.at("runs");
  std::vector<std::string> words = {"simulate", problem("slider_crank_round"), "--json", "-o", "s"};
  for (const auto& [pointer, value] : recommended.at("overrides").items()) {
    words.insert(words.end(), {"--set", pointer + "=" + value.dump()});
  }
  // The last setting of a value counts.
  std::vector<std::string> all = joined({words.begin(), words.begin() + 5}, quick());
  all.insert(all.end(), words.begin() + 5, words.end());
  const nlohmann::json simulated = folder.run(all).document();
  for (const auto& [name, error] : recommended.at("errors").items()) {
    const double reference = document.at("reference").at("values").at(name);
    const double value = simulated.at("responses").at(name).at("value");
    EXPECT_LE(std::abs(value - reference), 1.001 * error.get<double>() * std::abs(reference))
        << name;
  }
  EXPECT_EQ(read_csv(folder.path() / "study/accuracy.csv").size(), 1u + 7u);  // and the reference
}

using UncertaintyCommand = InProgramFolder;

/// d mass = ρ π/2 d l · 0.1 mm grows with the diameter.
TEST_F(UncertaintyCommand, IsOfTheDesignThatIsGiven) {
  std::ofstream(folder_.path() / "thick.json")
      << R"({"crank_diameter": "30 mm", "rod_diameter": "40 mm"})";
  const std::string block =
      R"(/uncertainty={"parameters": {"rod_diameter": {"deviation": "0.1 mm"}}, "samples": 2})";
  const auto deviation = [&](const std::vector<std::string>& more) {
    const ProgramRun run =
        exits(0, folder_.run(joined(joined({"uncertainty", problem("slider_crank_round"), "--json",
                                            "-o", "study", "--overwrite", "--set", block},
                                           quick()),
                                    more)));
    return run.document().at("responses").at("crank_and_rod").at("deviation").get<double>();
  };
  const double at_start = deviation({});  // 30 mm
  EXPECT_NEAR(at_start, 7850.0 * 0.5 * M_PI * 0.030 * 0.180 * 1e-4, 1e-9);
  EXPECT_NEAR(deviation({"--design", "thick.json"}), at_start * 40.0 / 30.0, 1e-9 * at_start);
}

TEST_F(UncertaintyCommand, AsksForItsSettings) {
  const ProgramRun run = exits(2, folder_.run({"uncertainty", problem("slider_crank_round")}));
  EXPECT_THAT(run.err, HasSubstr("/uncertainty is missing"));
}

using StabilityCommand = InProgramFolder;

TEST_F(StabilityCommand, TabulatesFilesTimesFormulations) {
  const nlohmann::json document =
      exits(0, folder_.run({"stability", problem("hard/dead_centres"), problem("hard/change_point"),
                            "--json", "-o", "study"}))
          .document();
  const std::size_t runs = 2 * document.at("formulations").size();
  ASSERT_EQ(document.at("runs").size(), runs);
  for (const auto& study_run : document.at("runs")) {
    EXPECT_FALSE(study_run.contains("failure")) << study_run;
    EXPECT_LE(study_run.at("position_drift"), 1e-3);
    EXPECT_GE(study_run.at("work").at("newton_iterations"), study_run.at("work").at("steps"));
  }
  EXPECT_EQ(read_csv(folder_.path() / "study/stability.csv").size(), 1u + runs);
  const nlohmann::json card = read_json(folder_.path() / "study/run_card.json");
  EXPECT_EQ(card.at("inputs").size(), 2u);
  EXPECT_EQ(card.at("problems").size(), 2u);
}

/// A mechanism that one formulation cannot simulate is a result of the study, not its failure.
TEST_F(StabilityCommand, ReportsWhatFails) {
  const ProgramRun run = exits(0, folder_.run({"stability", problem("hard/dead_centres"), "--json",
                                               "--set", "/simulation/max_newton_iterations=1"}));
  for (const auto& study_run : run.document().at("runs")) {
    EXPECT_THAT(study_run.at("failure").get<std::string>(), HasSubstr("t = "));
  }
  EXPECT_TRUE(
      std::filesystem::exists(folder_.path() / "runs/dead_centres-stability/stability.csv"));
}

using PricesCommand = InProgramFolder;

TEST_F(PricesCommand, WritesWhatItSays) {
  const ProgramRun run =
      exits(0, folder_.run_quick({"prices", problem("slider_crank_round"), "-o", "p"}));
  const nlohmann::json result = folder_.result("p");
  const ProgramRun broken =
      folder_.run_quick({"prices", problem("slider_crank_round"), "--design", "p/result.json", "-o",
                         "broken", "--set", "/constraints/rod_strength/upper=20 MPa"});
  EXPECT_THAT(exits(4, broken).out, HasSubstr("the design breaks \"rod_strength\""));
  const nlohmann::json& prices = result.at("prices");
  const double mass = result.at("objective").at("value");
  const auto rows = read_csv(folder_.path() / "p/prices.csv");
  ASSERT_EQ(rows.size(), 1 + prices.size());
  EXPECT_EQ(rows.front(), (std::vector<std::string>{"name", "kind", "value", "unit", "per_unit",
                                                    "per_percent", "next_limit"}));
  double last = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const nlohmann::json& price = prices.at(rows[i].at(0));
    EXPECT_EQ(price.at("kind"), rows[i].at(1));
    EXPECT_EQ(price.at("value"), std::stod(rows[i].at(2)));
    EXPECT_EQ(price.at("per_unit"), std::stod(rows[i].at(4)));
    const double percent = price.at("per_percent");
    EXPECT_EQ(percent, std::stod(rows[i].at(5)));
    EXPECT_NEAR(percent,
                0.01 * price.at("value").get<double>() * price.at("per_unit").get<double>(),
                1e-14 * std::abs(percent));
    EXPECT_LE(std::abs(percent), last);
    last = std::abs(percent);
  }
  // The table shows grams and percent of the same number, in units of engineers.
  const nlohmann::json& density = prices.at("/scene/materials/steel/density");
  const double share = 100.0 * density.at("per_percent").get<double>() / mass;
  EXPECT_THAT(unwrapped(run.out),
              HasSubstr(fmt::format("materials/steel/density 7850.0 kg/m^3 +{:.4g} +",
                                    density.at("per_unit").get<double>())));
  EXPECT_THAT(unwrapped(run.out), HasSubstr(fmt::format("+{:.3f} %", share)));
}

TEST_F(PricesCommand, AreThoseOfTheDesignThatIsGivenIfItIsAnOptimum) {
  const std::string file = problem("slider_crank_round");
  ASSERT_EQ(folder_.run_quick({"optimize", file, "-o", "o"}).exit_code, 0);
  const nlohmann::json priced =
      exits(0,
            folder_.run_quick({"prices", file, "--design", "o/result.json", "--json", "-o", "p"}))
          .document();
  EXPECT_EQ(priced.at("status"), "done");
  // Those of limits are the multipliers of the optimization.
  const nlohmann::json optimum = folder_.result("o");
  bool has_limit = false;
  for (const auto& [name, constraint] : optimum.at("constraints").items()) {
    const double multiplier = constraint.at("multiplier");
    if (multiplier == 0.0) continue;
    const auto& price = priced.at("prices").at("/constraints/" + name + "/upper");
    EXPECT_NEAR(price.at("per_unit").get<double>() / -multiplier, 1.0, 1e-3) << name;
    has_limit = true;
  }
  EXPECT_TRUE(has_limit);

  nlohmann::json start = optimum;
  start["variables"]["rod_diameter"]["value"] = 0.03;
  std::ofstream(folder_.path() / "elsewhere.json") << start;
  EXPECT_THAT(unwrapped(exits(4, folder_.run_quick(
                                     {"prices", file, "--design", "elsewhere.json", "-o", "e"}))
                            .out),
              HasSubstr("the design is no optimum"));
}

using Gradient = InProgramFolder;

TEST_F(Gradient, MethodsStandSideBySideAndAgree) {
  const nlohmann::json document =
      exits(0, folder_.run_quick({"gradient", problem("slider_crank_round"), "--method", "direct",
                                  "--method", "central-difference", "--step", "1e-5", "--json"}))
          .document();
  const auto& mass = document.at("responses").at("crank_and_rod");
  EXPECT_EQ(mass.at("unit"), "kg");
  const auto& gradients = mass.at("gradients");
  for (const char* variable : {"crank_diameter", "rod_diameter"}) {
    const double direct = gradients.at("direct").at(variable);
    const double difference = gradients.at("central-difference").at(variable);
    EXPECT_NEAR(difference / direct, 1.0, 1e-9) << variable;  // a square: only round-off is left
  }
  EXPECT_TRUE(document.at("seconds").contains("simulate"));
  EXPECT_TRUE(document.at("seconds").contains("direct"));
}

TEST_F(Gradient, OfTheMassIsThatOfTwoCylinders) {
  const ProgramRun run = folder_.run_quick({"gradient", problem("slider_crank_round"), "--json"});
  const auto gradients =
      run.document().at("responses").at("crank_and_rod").at("gradients").at("direct");
  // m = ρ L π d² / 4, so dm/dd = ρ L π d / 2 with ρ = 7850, d = 0.03, L = 0.12 and 0.18.
  EXPECT_NEAR(gradients.at("crank_diameter"), 7850 * 0.12 * M_PI * 0.03 / 2, 1e-10);
  EXPECT_NEAR(gradients.at("rod_diameter"), 7850 * 0.18 * M_PI * 0.03 / 2, 1e-10);
}

TEST_F(Gradient, WritesTheDerivativesOfHistories) {
  const ProgramRun run = exits(0, folder_.run_quick({"gradient", problem("slider_crank_round"),
                                                     "--histories", "-o", "run"}));
  const auto rows = read_csv(folder_.path() / "run" / "gradients.csv");
  const auto column = [&](const std::string& title) {
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    EXPECT_NE(found, rows[0].end()) << title;
    return static_cast<std::size_t>(found - rows[0].begin());
  };
  EXPECT_EQ(column("time"), 0u);
  EXPECT_EQ(rows.size(), read_csv(folder_.path() / "run" / "trajectory.csv").size());
  // The slider's last position, which is that of the end.
  const nlohmann::json result = folder_.result("run");
  const auto& end = result.at("responses").at("slider_end");
  EXPECT_EQ(std::stod(rows.back()[column("slider_end")]), end.at("value"));
  const double expected = end.at("gradients").at("direct").at("rod_diameter");
  EXPECT_NEAR(std::stod(rows.back()[column("slider_end:rod_diameter")]) / expected, 1.0, 1e-9);
}

TEST_F(Gradient, TakesTheMethodOfTheFile) {
  const std::vector<std::string> adjoint =
      joined({"gradient", problem("slider_crank_round"), "--json", "--set",
              R"(/sensitivity={"method": "adjoint"})"},
             quick());
  const auto methods = [&](const std::vector<std::string>& words) {
    std::vector<std::string> names;
    const nlohmann::json document = folder_.run(words).document();
    for (const auto& [name, gradient] :
         document.at("responses").at("rod_bow").at("gradients").items()) {
      names.push_back(name);
    }
    return names;
  };
  EXPECT_THAT(methods(adjoint), ElementsAre("adjoint"));
  EXPECT_THAT(methods(joined(adjoint, {"--method", "forward-difference"})),
              ElementsAre("forward-difference"));
}

TEST(Backends, AreListed) {
  const ProgramFolder folder;
  const auto backends = folder.run({"backends", "--json"}).document().at("backends");
  EXPECT_THAT(backends.get<std::vector<std::string>>(), ::testing::Contains("ipopt"));
}

}  // namespace
}  // namespace pleuel::test::study_test
