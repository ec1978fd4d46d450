#include "tests/cli/readback.hpp"

/// Numbers in sentences and in tables of the model, read back.
namespace pleuel::test::readback_sentences_test {
namespace {

using ReadBackSentences = InProgramFolder;

TEST_F(ReadBackSentences, OfSimulate) {
  const Report report = report_of("simulate", "--set /simulation/formulation=index-1");
  const json& monitors = report.document.at("monitors");
  expect_shown(behind(report.text, "are kept to "), "1", monitors.at("position_drift"));
  expect_shown(behind(report.text, "their rates to "), "1", monitors.at("velocity_drift"));
  expect_shown(behind(report.text, "Energy is balanced to "), "1", monitors.at("energy_error"));
  EXPECT_GT(monitors.at("position_drift"), 0.0);
  EXPECT_NE(monitors.at("position_drift"), monitors.at("velocity_drift"));
  // 20 ms by 0.2 ms.
  EXPECT_THAT(report.text, HasSubstr(": 100 steps of 0.0002 s, "));
}

/// One step that is too long: Newton's method needs it in two halves.
TEST_F(ReadBackSentences, OfStepsThatWereSplit) {
  for (const bool is_long : {true, false}) {
    const Report report = report_of(
        "simulate", fmt::format("--set /simulation/resolution_check=false --set "
                                "/simulation/max_newton_iterations=3 --set /simulation/step={} "
                                "--set /simulation/end_time=2ms",
                                is_long ? "2ms" : "0.1ms"));
    EXPECT_EQ(report.document.at("split_steps"), is_long ? 1 : 0);
    EXPECT_EQ(report.document.at("steps"), is_long ? 2 : 20);
    const bool is_said =
        unwrapped(report.text).find("Newton's method failed in 1 steps, which were split") !=
        std::string::npos;
    EXPECT_EQ(is_said, is_long) << report.text;
  }
}

/// With too few iterations: what is left open, and what it took.
TEST_F(ReadBackSentences, OfAnOptimumThatIsNotVerified) {
  const Report report = report_of("optimize", "--set /optimizer/max_iterations=2", 4);
  const json& document = report.document;
  EXPECT_THAT(report.text, HasSubstr("NOT VERIFIED"));
  expect_shown(behind(report.text, "KKT residual "), "1", document.at("kkt_residual"));
  expect_shown(behind(report.text, "largest violation of a limit "), "1",
               document.at("max_violation"));
  EXPECT_NE(document.at("kkt_residual"), document.at("max_violation"));
  EXPECT_FALSE(document.contains("checked"));
}

/// What was chosen is said, and can be passed on as it is said.
TEST_F(ReadBackSentences, OfAChosenSetting) {
  const Report report = report_of("simulate", "--accuracy 0.5%");
  const json& setting = report.document.at("setting");
  EXPECT_EQ(setting.at("target"), 0.005);
  EXPECT_TRUE(setting.at("met"));
  const std::string of_setting = behind(report.text, "For 0.5 %: a step of ");
  expect_shown(of_setting, "ms", setting.at("step"));
  EXPECT_EQ(number_in(behind(of_setting, "ms and ")), setting.at("elements"));
  const Report again = report_of("simulate", overrides_of(setting));
  for (const auto& [name, response] : again.document.at("responses").items()) {
    const double value = response.at("value");
    EXPECT_NEAR(number(report.document, "responses/" + name + "/value"), value,
                1e-9 * std::abs(value))
        << name;
  }
}

TEST_F(ReadBackSentences, OfWhatEffectsBring) {
  const Report report = report_of("simulate", "--effects");
  const TextTable table(report.text, "without");
  const json& responses = report.document.at("responses");
  std::size_t row = 0;
  for (const json& effect : report.document.at("effects")) {
    if (!effect.contains("influence")) continue;
    ASSERT_LT(row, table.rows());
    EXPECT_EQ(table.text(row, "without"), effect.at("name"));
    EXPECT_EQ(table.text(row, "of"), effect.at("body"));
    const std::string largest = table.text(row++, "largest change of a response");
    if (effect.at("influence").is_null()) {
      EXPECT_EQ(largest, effect.at("failure"));
      continue;
    }
    EXPECT_EQ(effect.at("influence").size(), responses.size());
    EXPECT_EQ(number_in(table.text(row - 1, "iterations")), effect.at("iterations"));
    const bool is_measurable = effect.at("time").at("is_measurable");
    EXPECT_EQ(table.text(row - 1, "time") == "not measurable", !is_measurable);
    // "rod_bow +4.1e-05 mm (+0.14 %)", which stands for all others.
    const std::string name = largest.substr(0, largest.find(' '));
    const auto share = [&](const std::string& of) {
      return number(effect, "influence/" + of) / number(responses, of + "/value");
    };
    EXPECT_NEAR(number_in(largest.substr(largest.find('(') + 1)), 100 * share(name),
                0.06 * std::abs(100 * share(name)))
        << largest;
    const std::string unit = largest.substr(0, largest.find(" ("));
    expect_shown(largest.substr(name.size() + 1), unit.substr(unit.find(' ', name.size() + 1) + 1),
                 number(effect, "influence/" + name));
    for (const auto& [other, value] : responses.items()) {
      EXPECT_LE(std::abs(share(other)), std::abs(share(name)) * 1.0001) << other;
    }
  }
  EXPECT_EQ(row, table.rows());
  EXPECT_EQ(row, 6u);  // three of the crank, three of the rod
}

/// Grams: what changes of all responses make of the optimum by the prices of the limits.
TEST_F(ReadBackSentences, OfWhatEffectsBringInGrams) {
  const Report report = report_of("optimize", "--effects");
  const json& document = report.document;
  const json limits = read_problem("slider_crank_round").at("constraints");
  const TextTable table(report.text, "without");
  std::size_t row = 0, priced = 0;
  for (const json& effect : document.at("effects")) {
    if (!effect.contains("influence")) continue;
    const std::string shown = table.text(row++, "optimum");
    if (effect.at("influence").is_null()) {
      EXPECT_EQ(shown, "–");
      continue;
    }
    double change = effect.at("influence").at(document.at("objective").at("name"));
    for (const auto& [name, limit] : document.at("constraints").items()) {
      const std::string response = limits.at(name).at("response");
      change += number(limit, "multiplier") * number(effect, "influence/" + response);
    }
    expect_shown(shown, "kg", change);
    ++priced;
  }
  EXPECT_EQ(row, table.rows());
  EXPECT_EQ(priced, 4u);
}

/// Without --effects the table has the effects that matter by the numbers of the document: more than
/// 0.1 % of a response or of the optimum. A sentence counts the rest.
TEST_F(ReadBackSentences, OfWhichEffectsMatter) {
  const Report report = report_of("optimize", "--verbose");
  const json& document = report.document;
  const json limits = read_problem("slider_crank_round").at("constraints");
  const std::string text = unwrapped(report.text);
  std::size_t listed = 0, measured = 0;
  for (const json& effect : document.at("effects")) {
    if (!effect.contains("influence") || effect.at("influence").is_null()) {
      EXPECT_FALSE(effect.contains("matters"));
      continue;
    }
    double most = 0.0;
    for (const auto& [name, change] : effect.at("influence").items()) {
      const double value = number(document, "responses/" + name + "/value");
      most = std::max(most, std::abs(change.get<double>() / value));
    }
    if (most > 1e-3) {
      EXPECT_EQ(effect.at("matters"), true);
    }
    listed += effect.at("matters").get<bool>() ? 1 : 0;
    ++measured;
  }
  ASSERT_EQ(measured, 4u);  // two of the crank, two of the rod; elasticity cannot be left out
  EXPECT_THAT(text, HasSubstr("elasticity (crank, rod) cannot be left out"));
  EXPECT_THAT(text, HasSubstr("--effects shows all."));
  const bool has_table = text.find(" without of unknowns iterations optimum ") != std::string::npos;
  EXPECT_EQ(has_table, listed > 0);
  if (has_table) {
    EXPECT_EQ(TextTable(report.text, "without").rows(), listed);
  }
  if (listed < measured) {
    EXPECT_THAT(text, ContainsRegex(fmt::format(
                          "({} further effects? changes? nothing|All effects change nothing)",
                          measured - listed)));
  }
}

/// The verdict in plain words has the error that the document has.
TEST_F(ReadBackSentences, OfAVerdictInPlainWords) {
  const Report report = report_of("optimize", "--verbose");
  const std::string checked = report.document.at("checked");
  EXPECT_THAT(unwrapped(report.text), HasSubstr("In plain words: " + checked + "."));
  EXPECT_THAT(checked, HasSubstr("every limit holds; no design nearby that keeps them is "
                                 "lighter; "));
  const json& objective = report.document.at("objective");
  expect_shown(behind(checked, "change crank_and_rod by "), "1",
               100.0 * number(objective, "error/total") / number(objective, "value"));
}

/// An optimum whose numbers are not known as well as the file asks for is not verified, whatever
/// its gradients say.
TEST_F(ReadBackSentences, OfAnOptimumThatIsNotResolved) {
  const Report report = report_of(
      "optimize", "--set /scene/bodies/rod/elements=1 --set /scene/bodies/crank/elements=1", 4);
  EXPECT_EQ(report.document.at("status"), "unresolved");
  EXPECT_THAT(unwrapped(report.text),
              AllOf(HasSubstr(" NOT VERIFIED (unresolved): optimal by its numbers, but "),
                    Not(HasSubstr("VERIFIED:"))));
  // Nor is its design called an optimum in the table.
  const TextTable table(report.text, "variable");
  EXPECT_TRUE(table.has("end"));
  EXPECT_FALSE(table.has("optimum"));
}

/// Points of which nothing is proven are no front, in the exit code either.
TEST_F(ReadBackSentences, OfAFrontThatIsNotVerified) {
  const Report report =
      report_of("pareto", "--set /pareto/points=2 --set /optimizer/max_iterations=2", 4);
  EXPECT_EQ(report.document.at("status"), "done");  // all points were looked for
  for (const json& point : report.document.at("points")) EXPECT_NE(point.at("status"), "verified");
  EXPECT_THAT(unwrapped(report.text),
              AllOf(HasSubstr("; 0 of 2 points verified"), HasSubstr("NOT VERIFIED: limit 0.1")));
}

TEST_F(ReadBackSentences, OfAccuracy) {
  const Report report = report_of(
      "accuracy",
      R"(--verbose --set '/accuracy={"steps": ["0.4 ms", "0.2 ms"], "elements": [2, 4], "target": 0.5}')");
  const json& reference = report.document.at("reference");
  const json& best = report.document.at("recommended");
  ASSERT_FALSE(best.is_null());
  const std::string text = unwrapped(report.text);
  const std::string of_reference = behind(text, "relative to a reference with a step of ");
  expect_shown(of_reference, "ms", reference.at("step"));
  EXPECT_EQ(number_in(behind(of_reference, "ms and ")), reference.at("elements"));
  const auto worst = [&](const json& errors) {
    double most = 0.0;
    for (const std::string name : report.document.at("counted")) {
      most = std::max(most, errors.at(name).get<double>());
    }
    return most;
  };
  expect_shown(behind(text, "whose own error is estimated at "), "1",
               100.0 * worst(reference.at("errors")));
  expect_shown(behind(text, ", of gradients "), "1",
               100.0 * worst(reference.at("gradient_errors")));
  const std::string of_best = behind(text, "For 50 % take a step of ");
  expect_shown(of_best, "ms", best.at("step"));
  EXPECT_EQ(number_in(behind(of_best, "ms and ")), best.at("elements"));
  expect_shown(behind(text, "elements a segment: "), "ms", best.at("seconds"));
  for (const json& one : report.document.at("recommendations")) {
    const bool is_none = one.at("values").is_null();
    EXPECT_THAT(text,
                HasSubstr(fmt::format("For {:g} % {}", 100.0 * number(one, "error"),
                                      is_none ? "none of these settings" : "take a step of ")));
    if (is_none) break;  // what is more exact is not said
  }
  // One row is marked, and it is that one.
  EXPECT_THAT(report.text,
              ContainsRegex(fmt::format("\n *{:g} +{} .*← recommended\n",
                                        1e3 * number(best, "step"), number(best, "elements"))));
  EXPECT_EQ(report.text.find("← recommended"), report.text.rfind("← recommended"));
}

/// What nothing drives is left to the forces, be it one freedom only; and a beam is as heavy as all
/// of its frames.
TEST_F(ReadBackSentences, OfMechanismsThatForcesMove) {
  EXPECT_THAT(unwrapped(run("check $problems/hard/dead_centres.json --jobs 1 --set "
                            "/simulation/resolution_check=false --set '/simulation/end_time=4 ms'")
                            .out),
              HasSubstr("(none of drives): 1 freedom is left to the forces"));
  EXPECT_THAT(unwrapped(run("show $problems/hard/dead_centres.json").out),
              HasSubstr("1 freedom is left to the forces (of \"crank\", \"rod\")"));
  const TextTable bodies(run("check $crank --jobs 1 $quick --set /scene/bodies/rod/frames=3").out,
                         "body");
  EXPECT_EQ(bodies.number("rod", "frames"), 3);
  // ρ π/4 d² L of 30 mm and 180 mm.
  bodies.expect("rod", "mass [kg]", "kg", 7850 * M_PI / 4 * 0.03 * 0.03 * 0.18);
}

/// A sum of variables with its coefficients: 2 · 30 − 30 mm of the 10 mm that are allowed.
TEST_F(ReadBackSentences, OfALimitOfVariables) {
  const Report report = report_of(
      "simulate",
      R"(--set '/constraints/sizes={"linear": {"crank_diameter": 2, "rod_diameter": -1}, )"
      R"("upper": "10 mm"}')");
  const json sizes = at(report.document, "constraints/sizes");
  EXPECT_NEAR(number(sizes, "value"), 0.03, 1e-15);
  EXPECT_NEAR(number(sizes, "utilisation"), 3.0, 1e-12);
  EXPECT_EQ(sizes.at("kept"), false);
  const TextTable table(report.text, "constraint");
  table.expect("sizes", "value", "mm", 0.03);
  EXPECT_NEAR(table.number("sizes", "used"), 300.0, 1e-9);
}

/// Crank and rod of eight elements: rigid coordinates x, y, φ of bodies and x, y of the point mass.
TEST_F(ReadBackSentences, OfCheck) {
  const std::string line = "check $crank --jobs 1 --effects $quick";
  const std::string text = run(line).out;
  const json checked = document(line);
  const TextTable bodies(text, "body"), effects(text, "effect");
  for (const json& body : checked.at("bodies")) {
    const std::string name = body.at("name");
    const bool is_beam = name != "slider";
    EXPECT_EQ(bodies.number(name, "frames"), body.at("frames"));
    EXPECT_EQ(bodies.number(name, "rigid coordinates"), is_beam ? 3 : 2);
    EXPECT_EQ(bodies.text(name, "elastic"),
              is_beam ? fmt::format("{}", number(body, "coordinates") - 3) : "–");
    if (is_beam) {
      EXPECT_EQ(bodies.number(name, "elements"), body.at("elements"));
    }
  }
  const json& motion = checked.at("rigid_motion");
  EXPECT_THAT(
      unwrapped(text),
      HasSubstr(fmt::format(
          "Rigid motion: {} coordinates, {} independent constraints ({} of drives): the "
          "drives prescribe it",
          number(motion, "coordinates"), number(motion, "constraints"), number(motion, "drives"))));
  // 3 + 3 + 2 coordinates; two of each of three pins, one of the guide, one of the drive.
  EXPECT_EQ(motion.at("coordinates"), 8);
  EXPECT_EQ(motion.at("constraints"), 8);
  // Each effect stands in one row, with all bodies of which it is decided alike.
  for (const json& effect : checked.at("effects")) {
    std::size_t rows = 0;
    for (std::size_t row = 0; row < effects.rows(); ++row) {
      const std::string of = ", " + effects.text(row, "of") + ",";
      const bool is_it = effects.text(row, "effect") == effect.at("name") &&
                         of.find(", " + effect.value("body", "–") + ",") != std::string::npos;
      if (!is_it) continue;
      ++rows;
      EXPECT_EQ(effects.text(row, "built"), effect.at("built") ? "yes" : "no");
      EXPECT_EQ(effects.text(row, "decision"), effect.at("decision"));
    }
    EXPECT_EQ(rows, 1u) << effect;
  }
  EXPECT_LT(effects.rows(), checked.at("effects").size());
}

}  // namespace
}  // namespace pleuel::test::readback_sentences_test
