#include "tests/cli/readback.hpp"

/// Studies, read back.
namespace pleuel::test::readback_study_test {
namespace {

using ReadBack = InProgramFolder;

TEST_F(ReadBack, OfPareto) {
  const Report report = report_of("pareto", "--set /pareto/points=3");
  const TextTable table(report.text, "limit [mm]");
  const json& points = report.document.at("points");
  ASSERT_EQ(table.rows(), 3u);
  const auto column = [&](const char* title) { return report.column("pareto.csv", title); };
  for (std::size_t i = 0; i < 3; ++i) {
    const json& point = points.at(i);
    EXPECT_EQ(point.at("status"), "verified");
    EXPECT_EQ(point.at("variables").size(), 2u);
    const double limit = point.at("limit"), multiplier = point.at("multiplier");
    EXPECT_NEAR(limit, (0.1 + 0.15 * double(i)) * 1e-3, 1e-12);
    const double bow = point.at("objectives").at("rod_bow");
    const double mass = point.at("objectives").at("crank_and_rod");
    EXPECT_LT(bow, 0.5e-3);  // [m]
    EXPECT_GT(mass, 0.1);    // [kg]
    table.expect(i, "limit [mm]", "mm", limit);
    table.expect(i, "rod_bow [mm]", "mm", bow);
    table.expect(i, "crank_and_rod [kg]", "kg", mass);
    table.expect(i, "multiplier [kg/mm]", "kg/mm", multiplier);
    const std::string knee = point.at("knee") ? ", knee" : "";
    EXPECT_EQ(table.text(i, "status"), point.at("status").get<std::string>() + knee);
    EXPECT_EQ(report.files.at("pareto.csv")[i + 1][0], point.at("status"));
    EXPECT_EQ(column("limit")[i], limit);
    EXPECT_EQ(column("objective")[i], mass);
    EXPECT_EQ(column("limited")[i], bow);
    EXPECT_EQ(column("multiplier")[i], multiplier);
    for (const auto& [name, value] : point.at("variables").items()) {
      table.expect(i, name + " [mm]", "mm", value);
      EXPECT_EQ(column(("variable:" + name).c_str())[i], value);
    }
    for (const char* key : {"kkt_residual", "evaluations", "seconds"}) {
      EXPECT_EQ(column(key)[i], point.at(key)) << key;
    }
  }
}

TEST_F(ReadBack, OfAccuracy) {
  const Report report = report_of(
      "accuracy",
      R"(--verbose --set '/accuracy={"steps": ["0.4 ms", "0.2 ms"], "elements": [2, 4]}')");
  const TextTable table(report.text, "step [ms]");
  const json& runs = report.document.at("runs");
  ASSERT_EQ(table.rows(), runs.size());
  int bounds = 0;
  // The table counts what is minimized or limited, as the recommendation and the page do.
  const json& counted = report.document.at("counted");
  EXPECT_LT(counted.size(), report.document.at("reference").at("values").size());
  const auto expect_worst = [&](const std::string& shown, const json& errors, const json& least) {
    double most = 0.0;
    std::string name;
    for (const auto& response : counted) {
      const double error = errors.at(response.get<std::string>());
      if (error > most) name = response;
      most = std::max(most, error);
    }
    expect_shown(shown, "1", 100.0 * most);
    EXPECT_THAT(shown, EndsWith(" % " + name));
    // No run is known better than the reference is: then its error stands there, as a bound.
    const bool is_bound = most > 0.0 && most <= least.at(name).get<double>();
    EXPECT_EQ(shown.starts_with("≤ "), is_bound) << shown;
    bounds += is_bound ? 1 : 0;
  };
  const json& reference = report.document.at("reference");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const json& study_run = runs.at(i);
    table.expect(i, "step [ms]", "ms", study_run.at("settings").at("step"));
    EXPECT_EQ(table.number(i, "elements"), study_run.at("settings").at("elements"));
    expect_worst(table.text(i, "largest error"), study_run.at("errors"), reference.at("errors"));
    expect_worst(table.text(i, "of a gradient"), study_run.at("gradient_errors"),
                 reference.at("gradient_errors"));
    table.expect(i, "simulation [ms]", "ms", study_run.at("simulation_seconds"));
    table.expect(i, "gradient [ms]", "ms", study_run.at("gradient_seconds"));
    EXPECT_EQ(table.number(i, "steps"), study_run.at("work").at("steps"));
    EXPECT_EQ(table.number(i, "factorizations"), study_run.at("work").at("factorizations"));
    const auto cell = [&](const std::string& title) {  // the reference is the first line
      return report.column("accuracy.csv", title).at(i + 1);
    };
    for (const char* key : {"step", "elements"}) {
      EXPECT_EQ(cell(key), study_run.at("settings").at(key));
    }
    for (const char* key : {"steps", "newton_iterations", "factorizations"}) {
      EXPECT_EQ(cell(key), study_run.at("work").at(key));
    }
    for (const char* key : {"simulation_seconds", "gradient_seconds"}) {
      EXPECT_EQ(cell(key), study_run.at(key));
    }
    for (const auto& [name, error] : study_run.at("errors").items()) {
      EXPECT_EQ(cell("error:" + name), error);
      EXPECT_EQ(cell("gradient_error:" + name), study_run.at("gradient_errors").at(name));
    }
  }
}

/// Of all runs that are exact enough in what counts, for values and for gradients, the cheapest.
TEST_F(ReadBack, OfRecommendationsForValuesAndForGradients) {
  const Report report =
      report_of("accuracy", R"(--verbose --set '/accuracy={"steps": ["0.8 ms", "0.4 ms", "0.2 ms"],
                                           "elements": [2, 4], "target": 0.02}')");
  const json& document = report.document;
  const auto worst = [&](const json& errors) {
    double most = 0.0;
    for (const json& name : document.at("counted")) {
      most = std::max(most, errors.at(name.get<std::string>()).get<double>());
    }
    return most;
  };
  int differing = 0;
  for (const json& one : document.at("recommendations")) {
    const double target = one.at("error");
    for (const bool with_gradients : {false, true}) {
      const json* best = nullptr;
      const char* seconds = with_gradients ? "seconds" : "simulation_seconds";
      for (const json& study_run : document.at("runs")) {
        if (worst(study_run.at("errors")) > target) continue;
        if (with_gradients && worst(study_run.at("gradient_errors")) > target) continue;
        if (best == nullptr || study_run.at(seconds) < best->at(seconds)) best = &study_run;
      }
      const json& chosen = one.at(with_gradients ? "gradients" : "values");
      ASSERT_EQ(chosen.is_null(), best == nullptr) << target << with_gradients;
      if (best == nullptr) continue;
      EXPECT_EQ(chosen.at("step"), best->at("settings").at("step")) << target << with_gradients;
      EXPECT_EQ(chosen.at("elements"), best->at("settings").at("elements"));
      EXPECT_EQ(chosen.at("seconds"), best->at(seconds));
    }
    const bool are_both = one.at("values").is_object() && one.at("gradients").is_object();
    if (are_both && one.at("values").at("step") != one.at("gradients").at("step")) ++differing;
  }
  EXPECT_EQ(document.at("recommended"), document.at("recommendations").at(0).at("values"));
  EXPECT_EQ(document.at("recommended_for_gradients"),
            document.at("recommendations").at(0).at("gradients"));
  // Values to 2 % take the longest step, gradients half of it.
  EXPECT_GE(differing, 1);
}

/// Deviations and bounds are made again from gradients of another command.
TEST_F(ReadBack, OfUncertainty) {
  const Report report =
      report_of("uncertainty", R"(--histories --set '/uncertainty={"samples": 8, "parameters":
      {"rod_diameter": {"deviation": "0.1 mm"}, "crank_diameter": {"interval": "0.2 mm"}}}')");
  const json gradients =
      report_of("gradient", "--histories --method direct").document.at("responses");
  const TextTable table(report.text, "response"), parameters(report.text, "parameter");
  for (const auto& [name, response] : report.document.at("responses").items()) {
    const json& of = gradients.at(name).at("gradients").at("direct");
    const double rod = of.at("rod_diameter"), crank = of.at("crank_diameter");
    const double value = response.at("value");
    const double parts[] = {rod * 1e-4, crank * 2e-4 / std::sqrt(3.0)};
    const double deviation = std::hypot(parts[0], parts[1]);
    const double bound = std::abs(rod) * 3e-4 + std::abs(crank) * 2e-4;
    EXPECT_NEAR(response.at("deviation"), deviation, 1e-6 * deviation) << name;
    EXPECT_NEAR(response.at("bounds").at(0), value - bound, 1e-6 * bound) << name;
    EXPECT_NEAR(response.at("bounds").at(1), value + bound, 1e-6 * bound) << name;
    EXPECT_NEAR(response.at("shares").at("rod_diameter"),
                parts[0] * parts[0] / (deviation * deviation), 1e-6);
    const std::string unit = table.text(name, "unit");
    table.expect(name, "value", unit, value);
    table.expect(name, "deviation", unit, response.at("deviation"));
    table.expect(name, "bounds ±", unit, bound);
    const json& sampled = response.at("sampled");
    table.expect(name, "sampled mean", unit, sampled.at("mean"));
    table.expect(name, "sampled deviation", unit, sampled.at("deviation"));
    table.expect(name, "lowest", unit, sampled.at("lowest"));
    table.expect(name, "highest", unit, sampled.at("highest"));
    const bool is_rod = parts[0] * parts[0] > parts[1] * parts[1];
    EXPECT_THAT(table.text(name, "from"), StartsWith(is_rod ? "rod_diameter " : "crank_diameter "));
    const double share = response.at("shares").at(is_rod ? "rod_diameter" : "crank_diameter");
    EXPECT_NEAR(number_in(table.text(name, "from").substr(is_rod ? 13 : 15)), 100 * share, 0.5);
    // The other one, too, if it is half a percent or more.
    EXPECT_EQ(table.text(name, "from").find(is_rod ? "crank_diameter " : "rod_diameter ") !=
                  std::string::npos,
              1 - share >= 0.005)
        << table.text(name, "from");
  }
  for (const auto& [name, parameter] : report.document.at("parameters").items()) {
    parameters.expect(name, "value", "mm", parameter.at("value"));
    parameters.expect(name, "deviation", "mm", parameter.at("deviation"));
    parameters.expect(name, "half width", "mm", parameter.at("interval"));
    EXPECT_EQ(parameters.text(name, "unit"), "mm");
  }
  EXPECT_EQ(parameters.text("rod_diameter", "sampled as"), "normal");
  EXPECT_EQ(parameters.text("crank_diameter", "sampled as"), "uniform");
  EXPECT_EQ(report.document.at("samples"), 8);
  EXPECT_EQ(report.files.at("uncertainty.csv")[0].size(), 1u + 3 * 7);  // the mass has no history
  // Of the position, whose response is the end of its history.
  const json& end = report.document.at("responses").at("slider_end");
  const auto last = [&](const char* title) {
    return report.column("uncertainty.csv", title).back();
  };
  EXPECT_EQ(last("slider_end"), end.at("value"));
  EXPECT_NEAR(last("slider_end:deviation"), end.at("deviation"),
              1e-9 * end.at("deviation").get<double>());
  EXPECT_NEAR(last("slider_end:sampled_deviation"), end.at("sampled").at("deviation"), 1e-12);
  EXPECT_NEAR(last("time"), 0.02, 1e-15);
}

TEST_F(ReadBack, OfStability) {
  const Report report = report_of("stability");
  const TextTable table(report.text, "case");
  const json& runs = report.document.at("runs");
  ASSERT_EQ(table.rows(), runs.size());
  const std::vector<std::pair<std::string, std::string>> shown = {
      {"position drift", "position_drift"},
      {"velocity drift", "velocity_drift"},
      {"energy error", "energy_error"},
      {"condition", "condition"}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const json& study_run = runs.at(i);
    EXPECT_EQ(table.text(i, "case"), "slider_crank_round");
    EXPECT_EQ(table.text(i, "formulation"), study_run.at("formulation"));
    EXPECT_EQ(report.files.at("stability.csv")[i + 1][1], study_run.at("formulation"));
    for (const auto& [title, key] : shown) {
      expect_shown(table.text(i, title), "1", study_run.at(key));
      EXPECT_EQ(report.column("stability.csv", key)[i], study_run.at(key));
    }
    const json& work = study_run.at("work");
    EXPECT_EQ(table.number(i, "steps"), work.at("steps"));
    expect_shown(table.text(i, "iterations a step"), "1",
                 work.at("newton_iterations").get<double>() / work.at("steps").get<double>());
    for (const char* key : {"steps", "newton_iterations", "factorizations"}) {
      EXPECT_EQ(report.column("stability.csv", key)[i], work.at(key));
    }
    EXPECT_EQ(table.number(i, "factorizations"), work.at("factorizations"));
    EXPECT_EQ(report.column("stability.csv", "seconds")[i], study_run.at("seconds"));
  }
}

/// The monitors are those of a simulation with that formulation.
TEST_F(ReadBack, OfStabilityIsThatOfSimulations) {
  const json runs = report_of("stability").document.at("runs");
  for (const std::string formulation : {"index-3", "stabilized-index-2", "index-1"}) {
    const json monitors = report_of("simulate", "--set /simulation/formulation=" + formulation)
                              .document.at("monitors");
    const auto found = std::find_if(runs.begin(), runs.end(), [&](const json& one) {
      return one.at("formulation") == formulation;
    });
    ASSERT_NE(found, runs.end());
    for (const char* key : {"position_drift", "velocity_drift", "energy_error"}) {
      EXPECT_EQ(found->at(key), monitors.at(key)) << formulation << " " << key;
    }
    EXPECT_NE(found->at("position_drift"), found->at("velocity_drift"));
  }
}

/// An arm that is held at an angle: the place of its tip, cos φ, against its height, sin φ ≥ limit.
/// From φ = −0.3 the optimum of a low limit is the bound at −1, that of 0.2 is on the far side,
/// where both are better: the points before are dominated.
TEST_F(ReadBack, OfDominatedPoints) {
  folder_.write("arm.json", R"({"name": "arm", "scene": {
      "bodies": {"arm": {"type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "rigid": true,
        "material": "steel", "elements": 2, "section": {"type": "circle", "diameter": "50 mm"}}},
      "joints": {"bearing": {"type": "revolute", "bodies": ["ground", "arm"], "at": [0, 0, 0],
        "drive": {"type": "constant", "value": {"variable": "phi"}}}}},
    "simulation": {"end_time": "2 ms", "step": "1 ms"},
    "variables": {"phi": {"start": -0.3, "lower": -1, "upper": 3.1}},
    "responses": {
      "x": {"type": "position", "body": "arm", "at": 1, "direction": "x", "over_time": "final"},
      "y": {"type": "position", "body": "arm", "at": 1, "direction": "y", "over_time": "final"}},
    "objective": {"minimize": "x"},
    "constraints": {"high": {"response": "y", "lower": 0}},
    "pareto": {"constraint": "high", "from": -0.9, "to": 0.2, "points": 3}})");
  const TextTable table(run("pareto arm.json -o run").out, "limit [mm]");
  const json points = result().at("points");
  ASSERT_EQ(points.size(), 3u);
  ASSERT_NEAR(number(points.at(2), "objectives/x"), -std::sqrt(1 - 0.04), 1e-3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(points.at(i).at("dominated"), i < 2) << i;
    EXPECT_EQ(table.text(i, "status"), i < 2 ? "verified, dominated" : "verified");
  }
}

}  // namespace
}  // namespace pleuel::test::readback_study_test
