#include "tests/cli/readback.hpp"

#include <fstream>
#include <set>

#include "tests/support/test.hpp"

namespace pleuel::test::readback_test {
namespace {

// Simulations, gradients, optima, and names in CSV files, read back.

using nlohmann::json;

using ReadBack = InProgramFolder;

/// Beside each history the half-width of its band; at the peak about that of the response's bar.
TEST_F(ReadBack, OfBandsAroundHistories) {
  const Report report = run({"simulate", file});
  for (const char* name : {"rod_bow", "crank_tip"}) {
    const std::vector<double> history = report.column("trajectory.csv", name);
    const std::vector<double> band = report.column("trajectory.csv", std::string(name) + ":error");
    std::size_t peak = 0;
    for (std::size_t k = 0; k < history.size(); ++k) {
      EXPECT_GE(band[k], 0.0);
      if (std::abs(history[k]) > std::abs(history[peak])) peak = k;
    }
    const double bar = report.document.at("responses").at(name).at("error").at("total");
    EXPECT_GT(band[peak], 0.2 * bar) << name;
    EXPECT_LT(band[peak], 20 * bar) << name;
  }
}

/// The end of the rod is held on the x axis: what is left beside it is round-off.
TEST_F(ReadBack, OfRoundOffIsZero) {
  const ProgramRun run = exits(
      0, folder_.run_quick(
             {"simulate", problem("slider_crank_round"), "-o", "run", "--no-report", "--set",
              R"(/responses/beside={"type": "position", "body": "rod", "at": 1, "direction": "y",
                                    "over_time": "max-abs"})"}));
  const json document = folder_.result("run");
  EXPECT_GT(document.at("responses").at("beside").at("value"), 0.0);
  const TextTable table(run.out, "response");
  EXPECT_EQ(table.text(table.row_of("beside"), "value"), "0");
  EXPECT_NE(table.text(table.row_of("rod_bow"), "value"), "0");
}

TEST_F(ReadBack, OfSimulate) {
  const Report report = run({"simulate", file});
  const TextTable table(report.text, "response");
  const json& responses = report.document.at("responses");
  ASSERT_EQ(table.rows(), responses.size());
  for (const auto& [name, response] : responses.items()) {
    const std::size_t row = table.row_of(name);
    expect_shown(table.text(row, "value"), table.text(row, "unit"), response.at("value"));
  }
  EXPECT_EQ(table.text(table.row_of("rod_stress"), "unit"), "MPa");
  EXPECT_EQ(table.text(table.row_of("rod_bow"), "unit"), "mm");
  // The start breaks the limit on the stress of the crank, 245 of 200 MPa, and keeps the others.
  const TextTable limits(report.text, "constraint");
  const json& constraints = report.document.at("constraints");
  ASSERT_EQ(limits.rows(), 4u);
  for (const auto& [name, constraint] : constraints.items()) {
    const std::size_t row = limits.row_of(name);
    const std::string unit = limits.text(row, "unit");
    const double of_limit = constraint.at("limit"), of_value = constraint.at("value");
    expect_shown(limits.text(row, "value"), unit, of_value);
    expect_shown(limits.text(row, "limit"), unit, of_limit);
    expect_shown(limits.text(row, "used"), "1", 100 * of_value / of_limit);
    expect_shown(limits.text(row, "margin"), unit, of_limit - of_value);
    EXPECT_EQ(constraint.at("kept"), name != "crank_strength") << name;
  }
  EXPECT_EQ(constraints.at("crank_strength").at("value"), responses.at("crank_stress").at("value"));
  EXPECT_THAT(report.text, ContainsRegex("crank_strength .* BROKEN\n"));
  EXPECT_THAT(report.text, ContainsRegex("rod_strength .* kept\n"));
  const auto value = [&](const char* name) -> double { return responses.at(name).at("value"); };
  const auto column = [&](const char* name) { return report.column("trajectory.csv", name); };
  // Peaks lie between the instants: of second order in the step, here up to 1e-3.
  for (const char* name : {"rod_stress", "rod_bow", "torque_peak"}) {
    EXPECT_NEAR(largest(column(name)) / value(name), 1.0, 3e-3) << name;
  }
  EXPECT_EQ(column("slider_end").back(), value("slider_end"));
  const std::vector<double> time = column("time");
  for (std::size_t i = 0; i < time.size(); ++i) EXPECT_NEAR(time[i], 2e-4 * double(i), 1e-15);
}

/// Units of a derivative are those of its response by those of its variable.
TEST_F(ReadBack, OfGradient) {
  const Report report = run({"gradient", file, "--histories", "--method", "direct", "--method",
                             "central-difference", "--step", "1e-3"});
  const TextTable table(report.text, "response");
  const json& responses = report.document.at("responses");
  ASSERT_EQ(table.rows(), 2 * responses.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const json& gradients = responses.at(table.text(row, "response")).at("gradients");
    const std::string variable = table.text(row, "variable");
    std::vector<double> values;
    for (const char* method : {"direct", "central-difference"}) {
      values.push_back(gradients.at(method).at(variable));
      expect_shown(table.text(row, method), table.text(row, "unit"), values.back());
    }
    const double spread = std::abs(values[0] - values[1]) / largest(values);
    expect_shown(table.text(row, "relative difference"), "1", spread);
  }
  EXPECT_EQ(table.text(table.row_of("rod_stress"), "unit"), "MPa/mm");
  // A final value has the derivative of its history's end.
  EXPECT_EQ(report.column("gradients.csv", "slider_end").back(),
            responses.at("slider_end").at("value"));
  for (const char* variable : {"crank_diameter", "rod_diameter"}) {
    const double expected = responses.at("slider_end").at("gradients").at("direct").at(variable);
    const double read =
        report.column("gradients.csv", fmt::format("slider_end:{}", variable)).back();
    EXPECT_NEAR(read, expected, 1e-9 * std::abs(expected)) << variable;
  }
}

class ReadBackOptimum : public testing::Test {
 protected:
  const Report report_ = run({"optimize", file, "--verbose"});
  const json& document_ = report_.document;
};

TEST_F(ReadBackOptimum, Variables) {
  const TextTable table(report_.text, "variable");
  ASSERT_EQ(table.rows(), document_.at("variables").size());
  for (const auto& [name, variable] : document_.at("variables").items()) {
    const std::size_t row = table.row_of(name);
    EXPECT_EQ(table.text(row, "unit"), "mm");
    expect_shown(table.text(row, "optimum"), "mm", variable.at("value"));
    for (const char* key : {"start", "lower", "upper"}) {
      expect_shown(table.text(row, key), "mm", variable.at(key));
    }
  }
}

TEST_F(ReadBackOptimum, Objective) {
  const json& objective = document_.at("objective");
  const std::size_t begin = report_.text.find("\ncrank_and_rod: ") + 1;
  const std::string line = report_.text.substr(begin, report_.text.find('\n', begin) - begin);
  const std::string start = line.substr(line.find(':')), end = line.substr(line.find("→"));
  expect_shown(start.substr(0, start.find("→")), "kg", objective.at("start"));
  expect_shown(end.substr(0, end.find("kg")), "kg", objective.at("value"));
  const double change =
      objective.at("value").get<double>() / objective.at("start").get<double>() - 1;
  expect_shown(line.substr(line.find('(')), "1", 100 * change);
}

TEST_F(ReadBackOptimum, Constraints) {
  const TextTable table(report_.text, "constraint");
  const double objective = document_.at("objective").at("value");
  ASSERT_EQ(table.rows(), document_.at("constraints").size());
  int active = 0;
  for (const auto& [name, constraint] : document_.at("constraints").items()) {
    const std::size_t row = table.row_of(name);
    const std::string unit = table.text(row, "unit");
    EXPECT_EQ(unit, constraint.at("unit") == "Pa" ? "MPa" : "mm");
    const double value = constraint.at("value"), limit = constraint.at("limit");
    const double multiplier = constraint.at("multiplier");
    expect_shown(table.text(row, "value"), unit, value);
    expect_shown(table.text(row, "limit"), unit, limit);
    EXPECT_THAT(table.text(row, "limit"), StartsWith("≤"));
    expect_shown(table.text(row, "used"), "1", 100 * value / limit);
    EXPECT_NEAR(constraint.at("utilisation"), value / limit, 1e-12);
    if (multiplier == 0.0) continue;
    ++active;
    EXPECT_GT(multiplier, 0.0);
    expect_shown(table.text(row, "multiplier [kg/unit]"), "kg/" + unit, multiplier);
    // More room makes the best design lighter.
    expect_shown(table.text(row, "at +1 % limit"), "1",
                 -multiplier * 0.01 * limit / objective * 100);
  }
  EXPECT_GE(active, 1);
}

/// A lower limit: raising it costs.
TEST_F(ReadBack, OfALowerLimit) {
  const Report report =
      run({"optimize", file, "--verbose", "--set",
           R"(/constraints={"least": {"response": "crank_and_rod", "lower": "1000 g"}})", "--set",
           R"(/pareto={"constraint": "least", "from": "1 kg", "to": "2 kg"})"});
  const TextTable table(report.text, "constraint");
  EXPECT_THAT(table.text(0, "limit"), StartsWith("≥"));
  expect_shown(table.text(0, "limit"), table.text(0, "unit"), 1.0);
  const json& constraint = report.document.at("constraints").at("least");
  EXPECT_EQ(constraint.at("side"), "lower");
  // The mass is its own limit: a multiplier of −1, and one percent more costs one percent.
  EXPECT_NEAR(constraint.at("multiplier"), -1.0, 1e-4);
  EXPECT_EQ(table.text(0, "at +1 % limit"), "+1.00 %");
  const double value = constraint.at("value");
  EXPECT_NEAR(constraint.at("utilisation"), 1.0 / value, 1e-9);
  expect_shown(table.text(0, "used"), "1", 100.0 / value);
}

TEST_F(ReadBackOptimum, History) {
  const auto column = [&](const std::string& title) {
    return report_.column("history.csv", title);
  };
  const std::vector<double> objective = column("objective"), step = column("step");
  const std::vector<double> violation = column("max_violation");
  ASSERT_EQ(objective.size(), document_.at("evaluations").get<std::size_t>());
  const std::vector<std::pair<std::string, double>> limits = {{"crank_strength", 200e6},
                                                              {"rod_strength", 200e6},
                                                              {"rod_stiffness", 0.2e-3},
                                                              {"crank_stiffness", 0.5e-3}};
  const std::vector<double> crank = column("variable:crank_diameter");
  const std::vector<double> rod = column("variable:rod_diameter");
  for (std::size_t i = 0; i < objective.size(); ++i) {
    EXPECT_EQ(column("evaluation")[i], double(i + 1));
    // ρ π d² L / 4 of both, 7850 kg/m³, 120 and 180 mm.
    const double mass = 7850 * M_PI / 4 * (0.12 * crank[i] * crank[i] + 0.18 * rod[i] * rod[i]);
    EXPECT_NEAR(objective[i], mass, 1e-12);
    double worst = 0.0;
    for (const auto& [name, limit] : limits) {
      worst = std::max(worst, column("constraint:" + name)[i] / limit - 1);
    }
    EXPECT_NEAR(violation[i], worst, 1e-12);
    if (i == 0) continue;
    // Variables are scaled by their start, 30 mm.
    const double change =
        std::max(std::abs(crank[i] - crank[i - 1]), std::abs(rod[i] - rod[i - 1]));
    EXPECT_NEAR(step[i], change / 0.03, 1e-12);
  }
  const double optimum = document_.at("objective").at("value");
  EXPECT_TRUE(std::find(objective.begin(), objective.end(), optimum) != objective.end());
}

/// The lines while it works, in the unit of the objective.
TEST_F(ReadBackOptimum, Iterations) {
  const TextTable table(report_.text, "iteration");
  const std::vector<double> iterations = report_.column("history.csv", "iteration");
  std::size_t shown = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string first = table.text(row, "iteration");
    if (first == "polish" || first == "audit") continue;  // what the evaluations from here are for
    ++shown;
    EXPECT_EQ(first, fmt::format("{}", shown));
    const auto found = std::find(iterations.begin(), iterations.end(), double(shown));
    ASSERT_NE(found, iterations.end());
    const auto i = static_cast<std::size_t>(found - iterations.begin());
    expect_shown(table.text(row, "objective [kg]"), "kg",
                 report_.column("history.csv", "objective")[i]);
    expect_shown(table.text(row, "max violation"), "1",
                 report_.column("history.csv", "max_violation")[i]);
  }
  EXPECT_EQ(shown, document_.at("iterations").get<std::size_t>());
  // The answer is proven by designs beside it, which are no iterations.
  EXPECT_EQ(table.row_of("audit"), shown);
}

TEST_F(ReadBack, OfCheck) {
  const auto checked = [&](const std::vector<std::string>& more) {
    return folder_.run(joined(joined({"check", file, "--jobs", "1"}, quick()), more));
  };
  const std::string text = checked({}).out;
  const json document = checked({"--json"}).document();
  const TextTable table(text, "response"), variables(text, "variable"), bodies(text, "body");
  for (const auto& [name, response] : document.at("responses").items()) {
    const std::size_t row = table.row_of(name);
    const json& derivatives = response.at("derivatives");
    expect_shown(table.text(row, "value"), table.text(row, "unit"), response.at("value"));
    if (derivatives.at("error") > 0) {
      expect_shown(table.text(row, "derivative"), "1", derivatives.at("error"));
    }
    EXPECT_THAT(table.text(row, "derivative"), StartsWith("agrees"));
    if (derivatives.at("adjoint_error") > 0) {
      expect_shown(table.text(row, "adjoint"), "1", derivatives.at("adjoint_error"));
    }
    expect_shown(table.text(row, "noise"), "1", derivatives.at("noise"));
    // So many decimal digits of them are right, and no more: all of a number of 64 bits are 15.
    const auto expect_digits = [&](const char* of, double error) {
      const int digits = derivatives.at("digits").at(of);
      EXPECT_LE(error, std::pow(10.0, -digits)) << name << ", " << of;
      if (digits == 15) return;
      EXPECT_GT(error, std::pow(10.0, -digits - 1)) << name << ", " << of;
    };
    expect_digits("value", derivatives.at("noise"));
    expect_digits("gradient", derivatives.at("error"));
    EXPECT_EQ(table.text(row, "digits"),
              fmt::format("{} / {}", derivatives.at("digits").at("value").get<int>(),
                          derivatives.at("digits").at("gradient").get<int>()));
  }
  for (const auto& [name, variable] : document.at("variables").items()) {
    for (const char* key : {"start", "lower", "upper"}) {
      expect_shown(variables.text(variables.row_of(name), key), "mm", variable.at(key));
    }
  }
  for (const auto& body : document.at("bodies")) {
    expect_shown(bodies.text(bodies.row_of(body.at("name")), "mass [kg]"), "kg", body.at("mass"));
  }
}

/// The largest step since the line before, in variables over their start.
TEST_F(ReadBackOptimum, StepsOfIterations) {
  const TextTable table(report_.text, "iteration");
  const CsvRows& rows = report_.files.at("history.csv");
  const std::vector<double> steps = report_.column("history.csv", "step"),
                            iterations = report_.column("history.csv", "iteration");
  const auto purpose = static_cast<std::size_t>(
      std::find(rows[0].begin(), rows[0].end(), "purpose") - rows[0].begin());
  double largest = 0.0;
  int shown = 0;
  std::size_t line = 0;
  std::string last = "search";
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (rows[i + 1][purpose] != last) {
      last = rows[i + 1][purpose];
      largest = 0.0;
    }
    largest = std::max(largest, steps[i]);
    if (last == "audit" || int(iterations[i]) <= shown) continue;
    while (table.text(line, "iteration") != fmt::format("{}", int(iterations[i]))) {
      ASSERT_LT(++line, table.rows());
    }
    expect_shown(table.text(line, "step"), "1", largest);
    shown = int(iterations[i]);
    largest = 0.0;
  }
  EXPECT_GT(shown, 2);
}

/// Values of the responses at the start and at the end are those of simulations.
TEST_F(ReadBack, OfTheResponsesOfAnOptimum) {
  const ProgramRun optimum = folder_.run_quick({"optimize", file, "-o", "best"});
  const json responses = folder_.result("best").at("responses");
  const auto simulated = [&](const std::vector<std::string>& design) {
    return folder_.run(joined(joined({"simulate", file, "--json"}, quick()), design))
        .document()
        .at("responses");
  };
  const json start = simulated({}), end = simulated({"--design", "best/result.json"});
  ASSERT_EQ(responses.size(), start.size());
  for (const auto& [name, response] : responses.items()) {
    EXPECT_EQ(response.at("start"), start.at(name).at("value")) << name;
    EXPECT_EQ(response.at("value"), end.at(name).at("value")) << name;
    EXPECT_EQ(response.at("unit"), start.at(name).at("unit")) << name;
  }
}

/// Commas, quotes and line breaks stay in their cell; what a spreadsheet would run does not.
TEST_F(ReadBack, OfNamesThatCsvCannotHoldAsTheyAre) {
  auto document = read_json(file);
  json responses;
  const std::vector<std::string> names = {"a \"quoted\", name", "=1+1", "+1", "-1", "@SUM(A1)"};
  for (const std::string& name : names) {
    responses[name] = {
        {"type", "position"}, {"body", "slider"}, {"direction", "x"}, {"over_time", "final"}};
  }
  document["responses"] = responses;
  for (const char* block : {"objective", "constraints", "pareto", "accuracy"})
    document.erase(block);
  std::ofstream(folder_.path() / "named.json") << document;
  const ProgramRun run = exits(0, folder_.run_quick({"simulate", "named.json", "-o", "run"}));
  const std::string text = read_file(folder_.path() / "run/trajectory.csv");
  EXPECT_THAT(text, HasSubstr("\"a \"\"quoted\"\", name\""));
  EXPECT_THAT(parse_csv(text).front(),
              testing::IsSupersetOf({std::string("time"), names[0], std::string("'=1+1"),
                                     std::string("'+1"), std::string("'-1"),
                                     std::string("'@SUM(A1)"), std::string("'=1+1:error")}));
  // Numbers stay numbers.
  EXPECT_EQ(parse_csv(text)[1].front(), "0");
}

TEST_F(ReadBackOptimum, Effort) {
  EXPECT_THAT(unwrapped(report_.text),
              HasSubstr(fmt::format("{}: {} evaluations, {} with gradients ({}), {} restarts",
                                    document_.at("backend").get<std::string>(),
                                    document_.at("evaluations").get<int>(),
                                    document_.at("gradient_evaluations").get<int>(),
                                    document_.at("gradients").at("method").get<std::string>(),
                                    document_.at("restarts").get<int>())));
  EXPECT_NE(document_.at("evaluations"), document_.at("gradient_evaluations"));
}

// Error bars, read back.

/// A cell of the column of errors against its document.
void expect_bar(const std::string& shown, const std::string& unit, const json& error) {
  if (error.is_null()) {
    EXPECT_EQ(shown, "–");
  } else if (error.at("total").is_null()) {
    EXPECT_EQ(shown, "not resolved");
  } else if (error.at("total") == 0.0) {
    EXPECT_EQ(shown, "exact");
  } else {
    const std::string sign = "± ";
    ASSERT_TRUE(shown.starts_with(sign)) << shown;
    expect_shown(shown.substr(sign.size()), unit, error.at("total"));
  }
}

/// What the step leaves in a value is what an eighth of it changes; bars have some reserve.
TEST(ReadBackErrors, OfSimulateAreThoseOfTheirResponse) {
  const Report report = run({"simulate", file});
  const json responses = report.document.at("responses");
  const ProgramFolder folder;
  const json finer = folder
                         .run(joined(joined({"simulate", file, "--json"}, quick()),
                                     {"--set", "/simulation/step=0.025 ms", "--set",
                                      "/simulation/resolution_check=false"}))
                         .document()
                         .at("responses");
  const TextTable table(report.text, "response");
  int bars = 0;
  for (const auto& [name, response] : responses.items()) {
    const std::size_t row = table.row_of(name);
    const json& error = response.at("error");
    expect_bar(table.text(row, "error"), table.text(row, "unit"), error);
    if (std::abs(error.value("order", 0.0) - 2.0) > 0.5) continue;
    ++bars;
    const double change =
        std::abs(finer.at(name).at("value").get<double>() - response.at("value").get<double>());
    EXPECT_GE(error.at("step"), change) << name;
    EXPECT_LE(error.at("step"), 4.0 * change) << name;
    EXPECT_NEAR(error.at("total"),
                error.at("step").get<double>() + error.at("elements").get<double>(),
                1e-9 * error.at("total").get<double>())
        << name;
  }
  EXPECT_GE(bars, 5);
  EXPECT_EQ(table.text(table.row_of("crank_and_rod"), "error"), "exact");
}

/// The mass is known exactly: its least value is as uncertain as the limits that decide, by their
/// multipliers. The sum is judged as one value: not by the sum of the bars, but by bars of its own.
TEST(ReadBackErrors, OfAnOptimumAreAboutThoseOfItsLimitsTimesTheirPrices) {
  const Report report = run({"optimize", file, "--verbose"});
  const json& objective = report.document.at("objective");
  double sum = 0.0;
  const std::map<std::string, std::string> responses = {{"crank_strength", "crank_stress"},
                                                        {"rod_strength", "rod_stress"},
                                                        {"rod_stiffness", "rod_bow"},
                                                        {"crank_stiffness", "crank_tip"}};
  for (const auto& [name, constraint] : report.document.at("constraints").items()) {
    const json& error = report.document.at("responses").at(responses.at(name)).at("error");
    const double multiplier = constraint.at("multiplier");
    if (multiplier != 0.0) sum += multiplier * error.at("total").get<double>();
  }
  ASSERT_GT(sum, 0.0);
  const double value = objective.at("value"), total = objective.at("error").at("total");
  EXPECT_GT(total, sum / 4.0);
  EXPECT_LT(total, 4.0 * sum);
  const std::string text = unwrapped(report.text);
  const auto behind = [&](const std::string& words) {
    const std::size_t at = text.find(words);
    EXPECT_NE(at, std::string::npos) << words << " in\n" << text;
    return at == std::string::npos ? "nan" : text.substr(at + words.size(), 24);
  };
  expect_shown(behind("known to ± "), "kg", total);
  const std::string known = behind("known to ± ");
  expect_shown(known.substr(known.find('(') + 1), "1", 100.0 * total / value);
  expect_shown(behind("steps and elements: to ± "), "1", 100.0 * total / value);
}

// Prices, read back.

/// "bodies/crank/to/0 (+2)" is "/scene/bodies/crank/to/0" of the document.
const json& price_of(const json& prices, std::string name) {
  name = "/" + name.substr(0, name.find(" (+"));
  return prices.at(prices.contains(name) ? name : "/scene" + name);
}

void expect_signed(const std::string& shown, const std::string& unit, double si) {
  EXPECT_TRUE(shown.starts_with(si < 0.0 ? "−" : "+")) << shown;
  expect_shown(shown.starts_with("+") ? shown.substr(1) : shown, unit, si);
}

/// In units of the table: a price per millimetre is a thousandth of that per metre.
TEST(ReadBackPrices, AreThoseOfTheDocumentInUnitsOfTheUser) {
  const Report report = run({"prices", file});
  const TextTable table(report.text, "number");
  const json& prices = report.document.at("prices");
  const double mass = report.document.at("objective").at("value");
  std::set<std::string> units;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const json& price = price_of(prices, table.text(row, "number"));
    const std::string unit = table.text(row, "unit");
    const double value = price.at("value"), per_unit = price.at("per_unit");
    if (unit == "mm" || unit == "MPa" || unit == "ms" || unit == "rad/s" || unit == "kg") {
      units.insert(unit);
      if (value != 0.0) expect_shown(table.text(row, "value"), unit, value);
      expect_signed(table.text(row, "kg/unit"), unit == "rad/s" ? "kg" : "kg/" + unit, per_unit);
    }
    if (value == 0.0) continue;
    expect_signed(table.text(row, "kg at +1 %"), "kg", 0.01 * value * per_unit);
    expect_signed(table.text(row, "at +1 %"), "1", value * per_unit / mass);
  }
  EXPECT_GE(units.size(), 4u);
}

// Frequencies, which documents have in radians a second and people read in hertz.

/// A round cantilever of 0.8 m that is clamped; its mass against its lowest natural frequency.
const char* const cantilever = R"({"name": "cantilever", "scene": {
    "bodies": {"arm": {"type": "beam", "from": [0, 0, 0], "to": ["800 mm", 0, 0], "material": "steel",
                       "section": {"type": "circle", "diameter": {"variable": "d"}}, "elements": 6}},
    "joints": {"clamp": {"type": "fixed", "bodies": ["ground", "arm"], "at": [0, 0, 0]}}},
  "simulation": {"end_time": "1 ms", "step": "1 ms"}, "effects": {"rotary_inertia": "off"},
  "variables": {"d": {"start": "40 mm", "lower": "10 mm", "upper": "60 mm"}},
  "responses": {"mass": {"type": "mass", "bodies": ["arm"]}, "pitch": {"type": "frequency"}},
  "objective": {"minimize": "mass"},
  "constraints": {"tuned": {"response": "pitch", "lower": "40 Hz"}},
  "pareto": {"constraint": "tuned", "from": "30 Hz", "to": "50 Hz", "points": 2},
  "uncertainty": {"parameters": {"d": {"deviation": "0.1 mm"}}}})";

/// Radians a second in documents, hertz in limits and tables: f = 3.516/(2π L²) (d/4) √(E/ρ).
class ReadBackFrequency : public testing::Test {
 protected:
  ReadBackFrequency() { std::ofstream(folder_.path() / "cantilever.json") << cantilever; }

  std::pair<std::string, json> run(const std::string& command,
                                   const std::vector<std::string>& more = {}) const {
    const ProgramRun run =
        exits(0, folder_.run(joined({command, "cantilever.json", "-o", command}, more)));
    return {run.out, read_json(folder_.path() / command / "result.json")};
  }
  static double hertz_of(double diameter) {
    return 3.516015268500151 / (2 * M_PI * 0.64) * diameter / 4 * std::sqrt(210e9 / 7850.0);
  }

  ProgramFolder folder_;
};

TEST_F(ReadBackFrequency, IsShownInHertz) {
  const auto [text, document] = run("simulate");
  const TextTable table(text, "response"), limits(text, "constraint");
  const double expected = hertz_of(0.040);
  EXPECT_NEAR(document.at("responses").at("pitch").at("value"), 2 * M_PI * expected,
              1e-4 * 2 * M_PI * expected);
  EXPECT_EQ(table.text(table.row_of("pitch"), "unit"), "Hz");
  EXPECT_NEAR(table.number(table.row_of("pitch"), "value"), expected, 1e-3 * expected);
  EXPECT_NEAR(document.at("constraints").at("tuned").at("limit"), 2 * M_PI * 40, 1e-9);
  EXPECT_EQ(limits.text(0, "unit"), "Hz");
  EXPECT_THAT(limits.text(0, "limit"), StartsWith("≥"));
  expect_shown(limits.text(0, "limit"), "Hz", 2 * M_PI * 40);
  expect_shown(limits.text(0, "value"), "Hz", document.at("responses").at("pitch").at("value"));
  // More than the limit asks for: 40 Hz of it are used.
  expect_shown(limits.text(0, "used"), "1", 100 * 40 / expected);
  EXPECT_THAT(text, ContainsRegex("tuned .* kept\n"));
}

TEST_F(ReadBackFrequency, LimitsAnOptimumInHertz) {
  const auto [text, document] = run("optimize", {"--verbose"});
  const double diameter = 0.040 * 40 / hertz_of(0.040);
  EXPECT_NEAR(document.at("variables").at("d").at("value"), diameter, 1e-4 * diameter);
  const TextTable table(text, "constraint");
  expect_shown(table.text(0, "limit"), "Hz", 2 * M_PI * 40);
  expect_shown(table.text(0, "value"), "Hz", document.at("constraints").at("tuned").at("value"));
  // The mass goes with f²: m' = 2 m/f, in kg/(rad/s) and kg/Hz; one percent costs two.
  const double mass = 7850 * M_PI / 4 * diameter * diameter * 0.8;
  EXPECT_NEAR(document.at("objective").at("value"), mass, 2e-4 * mass);
  EXPECT_NEAR(document.at("constraints").at("tuned").at("multiplier"), -2 * mass / (2 * M_PI * 40),
              1e-3 * mass / (M_PI * 40));
  EXPECT_NEAR(table.number(0, "multiplier [kg/unit]"), -2 * mass / 40, 2e-3 * 2 * mass / 40);
  EXPECT_NEAR(table.number(0, "at +1 % limit"), 2.0, 0.011);
  EXPECT_THAT(table.text(0, "at +1 % limit"), StartsWith("+"));
}

/// A margin of two deviations of 0.1 mm: d − 0.2 mm is in tune. Of an upper limit it has the other
/// sign: at most 40 Hz, from which the mass is kept by a limit of its own.
TEST_F(ReadBackFrequency, KeepsMarginsWithTheSignOfTheirSide) {
  const auto optimum = [&](const std::vector<std::string>& more) {
    return exits(0, folder_.run(joined(
                        {"optimize", "cantilever.json", "-o", "margin", "--overwrite"}, more)))
        .out;
  };
  const double in_tune = 40.0 * 40 / hertz_of(0.040);  // [mm]
  const TextTable lower(optimum({"--set", "/constraints/tuned/deviations=2"}), "variable");
  EXPECT_NEAR(lower.number(0, "optimum"), in_tune + 0.2, 2e-3);
  const std::string text = optimum({"--set", "/constraints/tuned/deviations=2"});
  EXPECT_EQ(TextTable(text, "constraint").text(0, "constraint"), "tuned −2 σ");
  const std::string upper = optimum(
      {"--set", R"(/constraints={"slow": {"response": "pitch", "upper": "40 Hz", "deviations": 3},
                                 "heavy": {"response": "mass", "lower": "3 kg"}})",
       "--set", R"(/pareto={"constraint": "heavy", "from": "3 kg", "to": "4 kg"})"});
  const TextTable limits(upper, "constraint");
  EXPECT_EQ(limits.text(0, "constraint"), "slow +3 σ");
  EXPECT_EQ(limits.text(1, "constraint"), "heavy");
}

/// A limit is kept as exactly as a verified optimum keeps it: to 1e-4 of it.
TEST_F(ReadBackFrequency, SaysWhichLimitsAreBroken) {
  const double hertz =
      run("simulate").second.at("responses").at("pitch").at("value").get<double>() / (2 * M_PI);
  const auto is_kept = [&](const char* side, double limit) {
    const ProgramRun run = folder_.run(
        {"simulate", "cantilever.json", "--json", "-o", "kept", "--overwrite", "--set",
         fmt::format(R"(/constraints/tuned={{"response": "pitch", "{}": "{:.12g} Hz"}})", side,
                     limit)});
    return run.document().at("constraints").at("tuned").at("kept").get<bool>();
  };
  EXPECT_TRUE(is_kept("lower", hertz * (1 + 0.9e-4)));
  EXPECT_FALSE(is_kept("lower", hertz * (1 + 1.1e-4)));
  EXPECT_TRUE(is_kept("upper", hertz * (1 - 0.9e-4)));
  EXPECT_FALSE(is_kept("upper", hertz * (1 - 1.1e-4)));
}

/// Of two limits the nearer one is shown: 45.2 Hz between 40 and 47, and between 44 and 60.
TEST_F(ReadBackFrequency, IsShownAgainstTheNearerOfTwoLimits) {
  const auto expect_limit = [&](double lower, double upper, bool is_upper) {
    const ProgramRun run = exits(
        0,
        folder_.run(
            {"simulate", "cantilever.json", "-o", "two", "--overwrite", "--set",
             fmt::format(
                 R"(/constraints/tuned={{"response": "pitch", "lower": "{} Hz", "upper": "{} Hz"}})",
                 lower, upper),
             "--set", R"(/constraints/heavy={"response": "mass", "lower": 1})", "--set",
             "/pareto/constraint=heavy", "--set", "/pareto/from=1 kg", "--set",
             "/pareto/to=2 kg"}));
    const json tuned = folder_.result("two").at("constraints").at("tuned");
    const double expected = 2 * M_PI * (is_upper ? upper : lower);
    EXPECT_EQ(tuned.at("side"), is_upper ? "upper" : "lower");
    EXPECT_NEAR(tuned.at("limit"), expected, 1e-9);
    const TextTable table(run.out, "constraint");
    const std::string shown = table.text(table.row_of("tuned"), "limit");
    EXPECT_TRUE(shown.starts_with(is_upper ? "≤" : "≥")) << shown;
    expect_shown(shown, "Hz", expected);
  };
  expect_limit(40, 47, true);
  expect_limit(44, 60, false);
}

/// Lower mass asks for 35.4 mm, less deflection for all that is allowed.
TEST_F(ReadBackFrequency, MarksVariablesAtTheirBounds) {
  const auto report = [&](const std::vector<std::string>& more) {
    return folder_.run(joined({"optimize", "cantilever.json", "-o", "bound", "--overwrite"}, more))
        .out;
  };
  EXPECT_THAT(report({}), ContainsRegex("\n  d .* mm *\n"));
  EXPECT_THAT(report({"--set", "/variables/d/lower=38 mm"}),
              ContainsRegex("\n  d .* mm +at its lower bound\n"));
  EXPECT_THAT(
      report(
          {"--set", R"(/scene/loads={"f": {"type": "force", "body": "arm",
                                 "at": [0.8, 0, 0], "direction": [0, 1, 0], "value": 1}})",
           "--set", "/simulation/initial_state=quasi-static", "--set",
           R"(/responses/tip={"type": "deflection", "body": "arm", "at": 1, "over_time": "max-abs"})",
           "--set", "/objective/minimize=tip"}),
      ContainsRegex("\n  d .* mm +at its upper bound\n"));
  EXPECT_THAT(report({"--set", R"(/scene/materials/iron={"young": 2.1e11, "poisson": 0.3,
                                   "density": {"variable": "rho"}})",
                      "--set", "/scene/bodies/arm/material=iron", "--set",
                      R"(/variables/rho={"start": 7850, "lower": 7850, "upper": 7850})"}),
              ContainsRegex("\n  rho .* fixed\n"));
}

/// The history of a magnitude is one of magnitudes, of whatever sign the largest is: a press of
/// 1 kN has F/A = −0.796 MPa everywhere.
TEST_F(ReadBackFrequency, ComesWithHistoriesOfMagnitudes) {
  const ProgramRun run = exits(
      0,
      folder_.run(
          {"simulate", "cantilever.json", "-o", "press", "--set",
           R"(/scene/loads={"f": {"type": "force", "body": "arm", "at": [0.8, 0, 0],
                              "direction": [-1, 0, 0], "value": 1000}})",
           "--set", "/simulation/initial_state=quasi-static", "--set", "/scene/gravity=[0, 0, 0]",
           "--set",
           R"(/responses/largest={"type": "stress", "part": "axial", "body": "arm", "over_time": "max-abs"})",
           "--set",
           R"(/responses/highest={"type": "stress", "part": "axial", "body": "arm", "over_time": "max"})"}));
  const CsvRows rows = read_csv(folder_.path() / "press/trajectory.csv");
  const double stress = 1000 / (M_PI / 4 * 0.04 * 0.04);
  for (std::size_t column = 0; column < rows[0].size(); ++column) {
    const double sign = rows[0][column] == "largest" ? 1.0 : -1.0;
    if (rows[0][column] != "largest" && rows[0][column] != "highest") continue;
    for (std::size_t row = 1; row < rows.size(); ++row) {
      EXPECT_NEAR(std::stod(rows[row].at(column)), sign * stress, 1e-3 * stress) << rows[0][column];
    }
  }
  EXPECT_EQ(rows[0].size(), 1 + 2 * 2u);  // with the bands of both
}

TEST_F(ReadBackFrequency, VariesAlongAFrontInHertz) {
  const auto [text, document] = run("pareto");
  const TextTable table(text, "limit [Hz]");
  ASSERT_EQ(table.rows(), 2u);
  const CsvRows rows = read_csv(folder_.path() / "pareto/pareto.csv");
  const auto limit_column = static_cast<std::size_t>(
      std::find(rows[0].begin(), rows[0].end(), "limit") - rows[0].begin());
  const double hertz[] = {30, 50};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(document.at("points").at(i).at("limit"), 2 * M_PI * hertz[i], 1e-9);
    EXPECT_NEAR(std::stod(rows.at(i + 1).at(limit_column)), 2 * M_PI * hertz[i], 1e-9);
    expect_shown(table.text(i, "limit [Hz]"), "Hz", 2 * M_PI * hertz[i]);
    EXPECT_NEAR(table.number(i, "pitch [Hz]"), hertz[i], 2e-4 * hertz[i]);
    EXPECT_NEAR(table.number(i, "d [mm]"), 40.0 * hertz[i] / hertz_of(0.040), 1e-2);
  }
}

TEST_F(ReadBackFrequency, ScattersInHertz) {
  const auto [text, document] = run("uncertainty");
  const TextTable table(text, "response");
  const std::size_t row = table.row_of("pitch");
  EXPECT_EQ(table.text(row, "unit"), "Hz");
  EXPECT_NEAR(document.at("responses").at("pitch").at("deviation"), 2 * M_PI * hertz_of(0.1e-3),
              1e-3 * 2 * M_PI * hertz_of(0.1e-3));
  EXPECT_NEAR(table.number(row, "deviation"), hertz_of(0.1e-3), 2e-3 * hertz_of(0.1e-3));
  EXPECT_NEAR(table.number(row, "bounds ±"), 3 * hertz_of(0.1e-3), 6e-3 * hertz_of(0.1e-3));
}

TEST_F(ReadBackFrequency, HasItsGradientInHertzAUnit) {
  const std::vector<std::string> words = {"gradient", "cantilever.json", "--method", "direct"};
  const std::string text = folder_.run(words).out;
  const json document = folder_.run(joined(words, {"--json"})).document();
  const TextTable table(text, "response");
  const std::size_t row = table.row_of("pitch");
  EXPECT_EQ(table.text(row, "unit"), "Hz/mm");
  const json& gradients = document.at("responses").at("pitch").at("gradients");
  const double expected = hertz_of(1.0);  // [Hz/m]
  for (const auto& [method, gradient] : gradients.items()) {
    EXPECT_NEAR(gradient.at("d"), 2 * M_PI * expected, 1e-3 * 2 * M_PI * expected) << method;
    EXPECT_NEAR(table.number(row, method), 1e-3 * expected, 1e-6 * expected) << method;
  }
}

}  // namespace
}  // namespace pleuel::test::readback_test
