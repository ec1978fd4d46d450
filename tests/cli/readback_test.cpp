#include "tests/cli/readback.hpp"

#include <set>

namespace pleuel::test::readback_test {
namespace {

// Simulations, gradients, optima, and names in CSV files, read back.

using ReadBack = InProgramFolder;

/// Beside each history the half-width of its band; at the peak about that of the response's bar.
TEST_F(ReadBack, OfBandsAroundHistories) {
  const Report report = report_of("simulate");
  for (const std::string name : {"rod_bow", "crank_tip"}) {
    const std::vector<double> history = report.column("trajectory.csv", name);
    const std::vector<double> band = report.column("trajectory.csv", name + ":error");
    std::size_t peak = 0;
    for (std::size_t k = 0; k < history.size(); ++k) {
      EXPECT_GE(band[k], 0.0);
      if (std::abs(history[k]) > std::abs(history[peak])) peak = k;
    }
    const double bar = number(report.document, "responses/" + name + "/error/total");
    EXPECT_GT(band[peak], 0.2 * bar) << name;
    EXPECT_LT(band[peak], 20 * bar) << name;
  }
}

/// The end of the rod is held on the x axis: what is left beside it is round-off.
TEST_F(ReadBack, OfRoundOffIsZero) {
  const Report report = report_of(
      "simulate",
      R"(--no-report --set '/responses/beside={"type": "position", "body": "rod", "at": 1, )"
      R"("direction": "y", "over_time": "max-abs"}')");
  EXPECT_GT(number(report.document, "responses/beside/value"), 0.0);
  const TextTable table(report.text, "response");
  EXPECT_EQ(table.text("beside", "value"), "0");
  EXPECT_NE(table.text("rod_bow", "value"), "0");
}

TEST_F(ReadBack, OfSimulate) {
  const Report report = report_of("simulate");
  const TextTable table(report.text, "response");
  const json& responses = report.document.at("responses");
  ASSERT_EQ(table.rows(), responses.size());
  for (const auto& [name, response] : responses.items()) {
    table.expect(name, "value", response.at("value"));
  }
  EXPECT_EQ(table.text("rod_stress", "unit"), "MPa");
  EXPECT_EQ(table.text("rod_bow", "unit"), "mm");
  // The start breaks the limit on the stress of the crank, 245 of 200 MPa, and keeps the others.
  const TextTable limits(report.text, "constraint");
  const json& constraints = report.document.at("constraints");
  ASSERT_EQ(limits.rows(), 4u);
  for (const auto& [name, constraint] : constraints.items()) {
    const double of_limit = constraint.at("limit"), of_value = constraint.at("value");
    limits.expect(name, "value", of_value);
    limits.expect(name, "limit", of_limit);
    limits.expect(name, "used", "1", 100 * of_value / of_limit);
    limits.expect(name, "margin", of_limit - of_value);
    EXPECT_EQ(constraint.at("kept"), name != "crank_strength") << name;
  }
  EXPECT_EQ(at(constraints, "crank_strength/value"), at(responses, "crank_stress/value"));
  EXPECT_THAT(report.text, ContainsRegex("crank_strength .* BROKEN\n"));
  EXPECT_THAT(report.text, ContainsRegex("rod_strength .* kept\n"));
  const auto column = [&](const char* name) { return report.column("trajectory.csv", name); };
  // Peaks lie between the instants: of second order in the step, here up to 1e-3.
  for (const char* name : {"rod_stress", "rod_bow", "torque_peak"}) {
    EXPECT_NEAR(largest(column(name)) / number(responses.at(name), "value"), 1.0, 3e-3) << name;
  }
  EXPECT_EQ(column("slider_end").back(), number(responses, "slider_end/value"));
  const std::vector<double> time = column("time");
  EXPECT_EQ(time.size(), 101u);  // 20 ms in steps of 0.2 ms, and the start
  for (std::size_t i = 0; i < time.size(); ++i) EXPECT_NEAR(time[i], 2e-4 * double(i), 1e-15);
  // All responses of the file but the mass, and bands.
  EXPECT_EQ(report.files.at("trajectory.csv").front().size(), 1u + 2 * 7u);
}

/// Units of a derivative are those of its response by those of its variable.
TEST_F(ReadBack, OfGradient) {
  const Report report =
      report_of("gradient", "--histories --method direct --method central-difference --step 1e-3");
  const TextTable table(report.text, "response");
  const json& responses = report.document.at("responses");
  ASSERT_EQ(table.rows(), 2 * responses.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const json& gradients = responses.at(table.text(row, "response")).at("gradients");
    std::vector<double> values;
    for (const char* method : {"direct", "central-difference"}) {
      values.push_back(gradients.at(method).at(table.text(row, "variable")));
      table.expect(row, method, table.text(row, "unit"), values.back());
    }
    const double spread = std::abs(values[0] - values[1]) / largest(values);
    table.expect(row, "relative difference", "1", spread);
  }
  EXPECT_EQ(table.text("rod_stress", "unit"), "MPa/mm");
  // A final value has the derivative of its history's end.
  const CsvRows& histories = report.files.at("gradients.csv");
  EXPECT_EQ(histories.front().front(), "time");
  EXPECT_EQ(histories.size(), report.files.at("trajectory.csv").size());
  EXPECT_EQ(numbers(histories, "slider_end").back(), number(responses, "slider_end/value"));
  for (const std::string variable : {"crank_diameter", "rod_diameter"}) {
    const double expected = number(responses, "slider_end/gradients/direct/" + variable);
    EXPECT_NEAR(numbers(histories, "slider_end:" + variable).back(), expected,
                1e-9 * std::abs(expected))
        << variable;
  }
}

class ReadBackOptimum : public testing::Test {
 protected:
  const Report report_ = report_of("optimize", "--verbose");
  const json& document_ = report_.document;

  std::vector<double> history(const std::string& title) const {
    return report_.column("history.csv", title);
  }
};

TEST_F(ReadBackOptimum, VariablesAndObjective) {
  const TextTable table(report_.text, "variable");
  ASSERT_EQ(table.rows(), document_.at("variables").size());
  for (const auto& [name, variable] : document_.at("variables").items()) {
    EXPECT_EQ(table.text(name, "unit"), "mm");
    table.expect(name, "optimum", "mm", variable.at("value"));
    for (const char* key : {"start", "lower", "upper"}) {
      table.expect(name, key, "mm", variable.at(key));
    }
  }
  const json& objective = document_.at("objective");
  const std::size_t begin = report_.text.find("\ncrank_and_rod: ") + 1;
  const std::string line = report_.text.substr(begin, report_.text.find('\n', begin) - begin);
  const std::string start = line.substr(line.find(':')), end = line.substr(line.find("→"));
  expect_shown(start.substr(0, start.find("→")), "kg", objective.at("start"));
  expect_shown(end.substr(0, end.find("kg")), "kg", objective.at("value"));
  const double change = number(objective, "value") / number(objective, "start") - 1;
  expect_shown(line.substr(line.find('(')), "1", 100 * change);
}

TEST_F(ReadBackOptimum, Constraints) {
  const TextTable table(report_.text, "constraint");
  const double objective = number(document_, "objective/value");
  ASSERT_EQ(table.rows(), document_.at("constraints").size());
  int active = 0;
  for (const auto& [name, constraint] : document_.at("constraints").items()) {
    const std::string unit = table.text(name, "unit");
    EXPECT_EQ(unit, constraint.at("unit") == "Pa" ? "MPa" : "mm");
    const double value = constraint.at("value"), limit = constraint.at("limit");
    const double multiplier = constraint.at("multiplier");
    table.expect(name, "value", value);
    table.expect(name, "limit", limit);
    EXPECT_THAT(table.text(name, "limit"), StartsWith("≤"));
    table.expect(name, "used", "1", 100 * value / limit);
    EXPECT_NEAR(number(constraint, "utilisation"), value / limit, 1e-12);
    if (multiplier == 0.0) {
      EXPECT_EQ(table.text(name, "multiplier [kg/unit]"), "0");
      EXPECT_EQ(table.text(name, "at +1 % limit"), "–");
      continue;
    }
    ++active;
    EXPECT_GT(multiplier, 0.0);
    table.expect(name, "multiplier [kg/unit]", "kg/" + unit, multiplier);
    // More room makes the best design lighter.
    table.expect(name, "at +1 % limit", "1", -multiplier * 0.01 * limit / objective * 100);
  }
  EXPECT_GE(active, 1);
}

/// A lower limit: raising it costs.
TEST_F(ReadBack, OfALowerLimit) {
  const Report report = report_of(
      "optimize",
      R"(--verbose --set '/constraints={"least": {"response": "crank_and_rod", "lower": "1000 g"}}' )"
      R"(--set '/pareto={"constraint": "least", "from": "1 kg", "to": "2 kg"}')");
  const TextTable table(report.text, "constraint");
  EXPECT_THAT(table.text(0, "limit"), StartsWith("≥"));
  table.expect("least", "limit", 1.0);
  const json constraint = at(report.document, "constraints/least");
  EXPECT_EQ(constraint.at("side"), "lower");
  // The mass is its own limit: a multiplier of −1, and one percent more costs one percent.
  EXPECT_NEAR(number(constraint, "multiplier"), -1.0, 1e-4);
  EXPECT_EQ(table.text(0, "at +1 % limit"), "+1.00 %");
  const double value = constraint.at("value");
  EXPECT_NEAR(number(constraint, "utilisation"), 1.0 / value, 1e-9);
  table.expect(0, "used", "1", 100.0 / value);
}

TEST_F(ReadBackOptimum, History) {
  const std::vector<double> objective = history("objective"), step = history("step"),
                            violation = history("max_violation"), count = history("evaluation"),
                            crank = history("variable:crank_diameter"),
                            rod = history("variable:rod_diameter");
  ASSERT_EQ(objective.size(), document_.at("evaluations").get<std::size_t>());
  const std::vector<std::pair<std::vector<double>, double>> limits = {
      {history("constraint:crank_strength"), 200e6},
      {history("constraint:rod_strength"), 200e6},
      {history("constraint:rod_stiffness"), 0.2e-3},
      {history("constraint:crank_stiffness"), 0.5e-3}};
  for (std::size_t i = 0; i < objective.size(); ++i) {
    EXPECT_EQ(count[i], double(i + 1));
    // ρ π d² L / 4 of both, 7850 kg/m³, 120 and 180 mm.
    const double mass = 7850 * M_PI / 4 * (0.12 * crank[i] * crank[i] + 0.18 * rod[i] * rod[i]);
    EXPECT_NEAR(objective[i], mass, 1e-12);
    double worst = 0.0;
    for (const auto& [values, limit] : limits) worst = std::max(worst, values[i] / limit - 1);
    EXPECT_NEAR(violation[i], worst, 1e-12);
    if (i == 0) continue;
    // Variables are scaled by their start, 30 mm.
    const double change =
        std::max(std::abs(crank[i] - crank[i - 1]), std::abs(rod[i] - rod[i - 1]));
    EXPECT_NEAR(step[i], change / 0.03, 1e-12);
  }
  EXPECT_THAT(objective, testing::Contains(number(document_, "objective/value")));
}

/// The lines while it works, in the unit of the objective.
TEST_F(ReadBackOptimum, Iterations) {
  const TextTable table(report_.text, "iteration");
  const std::vector<double> iterations = history("iteration");
  std::size_t shown = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string first = table.text(row, "iteration");
    if (first == "polish" || first == "audit") continue;  // what the evaluations from here are for
    ++shown;
    EXPECT_EQ(first, fmt::format("{}", shown));
    const auto found = std::ranges::find(iterations, double(shown));
    ASSERT_NE(found, iterations.end());
    const auto i = static_cast<std::size_t>(found - iterations.begin());
    table.expect(row, "objective [kg]", "kg", history("objective")[i]);
    table.expect(row, "max violation", "1", history("max_violation")[i]);
  }
  EXPECT_EQ(shown, document_.at("iterations").get<std::size_t>());
  // The answer is proven by designs beside it, which are no iterations.
  EXPECT_EQ(table.row_of("audit"), shown);
  EXPECT_THAT(
      unwrapped(report_.text),
      HasSubstr(fmt::format(
          "{}: {} evaluations, {} with gradients ({}), {} restarts",
          document_.at("backend").get<std::string>(), number(document_, "evaluations"),
          number(document_, "gradient_evaluations"),
          at(document_, "gradients/method").get<std::string>(), number(document_, "restarts"))));
  EXPECT_NE(document_.at("evaluations"), document_.at("gradient_evaluations"));
}

/// The largest step since the line before, in variables over their start.
TEST_F(ReadBackOptimum, StepsOfIterations) {
  const TextTable table(report_.text, "iteration");
  const std::vector<std::string> purposes = column(report_.files.at("history.csv"), "purpose");
  const std::vector<double> steps = history("step"), iterations = history("iteration");
  double largest = 0.0;
  int shown = 0;
  std::size_t line = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i > 0 && purposes[i] != purposes[i - 1]) largest = 0.0;
    largest = std::max(largest, steps[i]);
    if (purposes[i] == "audit" || int(iterations[i]) <= shown) continue;
    while (table.text(line, "iteration") != fmt::format("{}", int(iterations[i]))) {
      ASSERT_LT(++line, table.rows());
    }
    table.expect(line, "step", "1", largest);
    shown = int(iterations[i]);
    largest = 0.0;
  }
  EXPECT_GT(shown, 2);
}

TEST_F(ReadBack, OfCheck) {
  const std::string line = "check $crank --jobs 1 $quick";
  const std::string text = run(line).out;
  const json checked = document(line);
  const TextTable table(text, "response"), variables(text, "variable"), bodies(text, "body");
  for (const auto& [name, response] : checked.at("responses").items()) {
    const json& derivatives = response.at("derivatives");
    table.expect(name, "value", response.at("value"));
    EXPECT_THAT(table.text(name, "derivative"), StartsWith("agrees"));
    for (const auto& [title, key] :
         {std::pair{"derivative", "error"}, {"adjoint", "adjoint_error"}}) {
      if (derivatives.at(key) > 0) table.expect(name, title, "1", derivatives.at(key));
    }
    table.expect(name, "noise", "1", derivatives.at("noise"));
    // So many decimal digits of them are right, and no more: all of a number of 64 bits are 15.
    const json& digits = derivatives.at("digits");
    for (const auto& [of, key] : {std::pair{"value", "noise"}, {"gradient", "error"}}) {
      const int right = digits.at(of);
      EXPECT_LE(number(derivatives, key), std::pow(10.0, -right)) << name << ", " << of;
      if (right == 15) continue;
      EXPECT_GT(number(derivatives, key), std::pow(10.0, -right - 1)) << name << ", " << of;
    }
    EXPECT_EQ(table.text(name, "digits"),
              fmt::format("{} / {}", number(digits, "value"), number(digits, "gradient")));
  }
  for (const auto& [name, variable] : checked.at("variables").items()) {
    for (const char* key : {"start", "lower", "upper"}) {
      variables.expect(name, key, "mm", variable.at(key));
    }
  }
  for (const json& body : checked.at("bodies")) {
    bodies.expect(body.at("name").get<std::string>(), "mass [kg]", "kg", body.at("mass"));
  }
}

/// Values of the responses at the start and at the end are those of simulations.
TEST_F(ReadBack, OfTheResponsesOfAnOptimum) {
  run("optimize $crank $quick -o best");
  const json responses = result("best").at("responses");
  const json start = document("simulate $crank $quick").at("responses");
  const json end = document("simulate $crank $quick --design best/result.json").at("responses");
  ASSERT_EQ(responses.size(), start.size());
  for (const auto& [name, response] : responses.items()) {
    EXPECT_EQ(response.at("start"), start.at(name).at("value")) << name;
    EXPECT_EQ(response.at("value"), end.at(name).at("value")) << name;
    EXPECT_EQ(response.at("unit"), start.at(name).at("unit")) << name;
  }
}

/// Commas, quotes and line breaks stay in their cell; what a spreadsheet would run does not.
TEST_F(ReadBack, OfNamesThatCsvCannotHoldAsTheyAre) {
  json document = read_problem("slider_crank_round");
  document["responses"] = json::object();
  const std::string quoted = "a \"quoted\", name";
  for (const std::string& name : {quoted, std::string("=1+1"), std::string("+1"), std::string("-1"),
                                  std::string("@SUM(A1)")}) {
    document["responses"][name] = {
        {"type", "position"}, {"body", "slider"}, {"direction", "x"}, {"over_time", "final"}};
  }
  for (const char* block : {"objective", "constraints", "pareto", "accuracy"}) {
    document.erase(block);
  }
  folder_.write("named.json", document);
  run("simulate named.json $quick -o run");
  EXPECT_THAT(folder_.text("run/trajectory.csv"), HasSubstr("\"a \"\"quoted\"\", name\""));
  const CsvRows rows = folder_.csv("run/trajectory.csv");
  EXPECT_THAT(rows.front(), testing::IsSupersetOf({"time", quoted.c_str(), "'=1+1", "'+1", "'-1",
                                                   "'@SUM(A1)", "'=1+1:error"}));
  EXPECT_EQ(rows[1].front(), "0");  // numbers stay numbers
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
    ASSERT_THAT(shown, StartsWith("± "));
    expect_shown(shown.substr(shown.find(' ')), unit, error.at("total"));
  }
}

/// What the step leaves in a value is what an eighth of it changes; bars have some reserve.
TEST_F(ReadBack, OfErrorsOfSimulateAreThoseOfTheirResponse) {
  const Report report = report_of("simulate");
  const json finer = document(
                         "simulate $crank $quick --set '/simulation/step=0.025 ms' "
                         "--set /simulation/resolution_check=false")
                         .at("responses");
  const TextTable table(report.text, "response");
  int bars = 0;
  for (const auto& [name, response] : report.document.at("responses").items()) {
    const json& error = response.at("error");
    expect_bar(table.text(name, "error"), table.text(name, "unit"), error);
    if (std::abs(error.value("order", 0.0) - 2.0) > 0.5) continue;
    ++bars;
    const double change = std::abs(number(finer.at(name), "value") - number(response, "value"));
    EXPECT_GE(number(error, "step"), change) << name;
    EXPECT_LE(number(error, "step"), 4.0 * change) << name;
    const double total = number(error, "total");
    EXPECT_NEAR(total, number(error, "step") + number(error, "elements"), 1e-9 * total) << name;
  }
  EXPECT_GE(bars, 5);
  EXPECT_EQ(table.text("crank_and_rod", "error"), "exact");
}

/// The mass is known exactly: its least value is as uncertain as the limits that decide, by their
/// multipliers. The sum is judged as one value: not by the sum of the bars, but by bars of its own.
TEST_F(ReadBackOptimum, ErrorsAreAboutThoseOfItsLimitsTimesTheirPrices) {
  double sum = 0.0;
  for (const auto& [limit, response] :
       {std::pair<std::string, std::string>{"crank_strength", "crank_stress"},
        {"rod_strength", "rod_stress"},
        {"rod_stiffness", "rod_bow"},
        {"crank_stiffness", "crank_tip"}}) {
    const double multiplier = number(document_, "constraints/" + limit + "/multiplier");
    if (multiplier == 0.0) continue;
    sum += multiplier * number(document_, "responses/" + response + "/error/total");
  }
  ASSERT_GT(sum, 0.0);
  const double value = number(document_, "objective/value");
  const double total = number(document_, "objective/error/total");
  EXPECT_GT(total, sum / 4.0);
  EXPECT_LT(total, 4.0 * sum);
  const std::string known = behind(report_.text, "known to ± ");
  expect_shown(known, "kg", total);
  expect_shown(known.substr(known.find('(') + 1), "1", 100.0 * total / value);
  expect_shown(behind(report_.text, "steps and elements: to ± "), "1", 100.0 * total / value);
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
TEST_F(ReadBack, OfPricesAreThoseOfTheDocumentInUnitsOfTheUser) {
  const Report report = report_of("prices");
  const TextTable table(report.text, "number");
  const double mass = number(report.document, "objective/value");
  std::set<std::string> units;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const json& price = price_of(report.document.at("prices"), table.text(row, "number"));
    const std::string unit = table.text(row, "unit");
    const double value = price.at("value"), per_unit = price.at("per_unit");
    if (unit == "mm" || unit == "MPa" || unit == "ms" || unit == "rad/s" || unit == "kg") {
      units.insert(unit);
      if (value != 0.0) table.expect(row, "value", unit, value);
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
class ReadBackFrequency : public InProgramFolder {
 protected:
  ReadBackFrequency() { folder_.write("cantilever.json", cantilever); }

  /// What a command says; its document is result().
  std::string said(const std::string& command, const std::string& options = "",
                   int exit_code = 0) const {
    return run(command + " cantilever.json -o run --overwrite " + options, exit_code).out;
  }
  static double hertz_of(double diameter) {
    return 3.516015268500151 / (2 * M_PI * 0.64) * diameter / 4 * std::sqrt(210e9 / 7850.0);
  }
};

TEST_F(ReadBackFrequency, IsShownInHertz) {
  const std::string text = said("simulate");
  const TextTable table(text, "response"), limits(text, "constraint");
  const double expected = hertz_of(0.040), pitch = number(result(), "responses/pitch/value");
  EXPECT_NEAR(pitch, 2 * M_PI * expected, 1e-4 * 2 * M_PI * expected);
  EXPECT_EQ(table.text("pitch", "unit"), "Hz");
  EXPECT_NEAR(table.number("pitch", "value"), expected, 1e-3 * expected);
  EXPECT_NEAR(number(result(), "constraints/tuned/limit"), 2 * M_PI * 40, 1e-9);
  EXPECT_EQ(limits.text(0, "unit"), "Hz");
  EXPECT_THAT(limits.text(0, "limit"), StartsWith("≥"));
  limits.expect(0, "limit", "Hz", 2 * M_PI * 40);
  limits.expect(0, "value", "Hz", pitch);
  // More than the limit asks for: 40 Hz of it are used.
  limits.expect(0, "used", "1", 100 * 40 / expected);
  EXPECT_THAT(text, ContainsRegex("tuned .* kept\n"));
}

TEST_F(ReadBackFrequency, LimitsAnOptimumInHertz) {
  const TextTable table(said("optimize", "--verbose"), "constraint");
  const double diameter = 0.040 * 40 / hertz_of(0.040);
  EXPECT_NEAR(number(result(), "variables/d/value"), diameter, 1e-4 * diameter);
  const json tuned = at(result(), "constraints/tuned");
  table.expect(0, "limit", "Hz", 2 * M_PI * 40);
  table.expect(0, "value", "Hz", tuned.at("value"));
  // The mass goes with f²: m' = 2 m/f, in kg/(rad/s) and kg/Hz; one percent costs two.
  const double mass = 7850 * M_PI / 4 * diameter * diameter * 0.8;
  EXPECT_NEAR(number(result(), "objective/value"), mass, 2e-4 * mass);
  EXPECT_NEAR(number(tuned, "multiplier"), -2 * mass / (2 * M_PI * 40), 1e-3 * mass / (M_PI * 40));
  EXPECT_NEAR(table.number(0, "multiplier [kg/unit]"), -2 * mass / 40, 2e-3 * 2 * mass / 40);
  EXPECT_NEAR(table.number(0, "at +1 % limit"), 2.0, 0.011);
  EXPECT_THAT(table.text(0, "at +1 % limit"), StartsWith("+"));
}

/// A margin of two deviations of 0.1 mm: d − 0.2 mm is in tune. Of an upper limit it has the other
/// sign: at most 40 Hz, from which the mass is kept by a limit of its own.
TEST_F(ReadBackFrequency, KeepsMarginsWithTheSignOfTheirSide) {
  const double in_tune = 40.0 * 40 / hertz_of(0.040);  // [mm]
  const std::string lower = said("optimize", "--set /constraints/tuned/deviations=2");
  EXPECT_NEAR(TextTable(lower, "variable").number(0, "optimum"), in_tune + 0.2, 2e-3);
  EXPECT_EQ(TextTable(lower, "constraint").text(0, "constraint"), "tuned −2 σ");
  const TextTable limits(
      said("optimize",
           R"(--set '/constraints={"slow": {"response": "pitch", "upper": "40 Hz", "deviations": 3},
                              "heavy": {"response": "mass", "lower": "3 kg"}}' )"
           R"(--set '/pareto={"constraint": "heavy", "from": "3 kg", "to": "4 kg"}')"),
      "constraint");
  EXPECT_EQ(limits.text(0, "constraint"), "slow +3 σ");
  EXPECT_EQ(limits.text(1, "constraint"), "heavy");
}

/// A limit is kept as exactly as a verified optimum keeps it: to 1e-4 of it.
TEST_F(ReadBackFrequency, SaysWhichLimitsAreBroken) {
  said("simulate");
  const double hertz = number(result(), "responses/pitch/value") / (2 * M_PI);
  for (const auto& [side, factor, is_kept] : {std::tuple{"lower", 1 + 0.9e-4, true},
                                              {"lower", 1 + 1.1e-4, false},
                                              {"upper", 1 - 0.9e-4, true},
                                              {"upper", 1 - 1.1e-4, false}}) {
    said("simulate", fmt::format("--set '/constraints/tuned={{\"response\": \"pitch\", "
                                 "\"{}\": \"{:.12g} Hz\"}}'",
                                 side, hertz * factor));
    EXPECT_EQ(at(result(), "constraints/tuned/kept"), is_kept) << side << factor;
  }
}

/// Of two limits the nearer one is shown: 45.2 Hz between 40 and 47, and between 44 and 60.
TEST_F(ReadBackFrequency, IsShownAgainstTheNearerOfTwoLimits) {
  for (const auto& [lower, upper, is_upper] : {std::tuple{40, 47, true}, {44, 60, false}}) {
    const TextTable table(
        said(
            "simulate",
            fmt::format(
                R"(--set '/constraints/tuned={{"response": "pitch", "lower": "{} Hz", "upper": "{} Hz"}}' )"
                R"(--set '/constraints/heavy={{"response": "mass", "lower": 1}}' )"
                R"(--set '/pareto={{"constraint": "heavy", "from": "1 kg", "to": "2 kg"}}')",
                lower, upper)),
        "constraint");
    const json tuned = at(result(), "constraints/tuned");
    const double expected = 2 * M_PI * (is_upper ? upper : lower);
    EXPECT_EQ(tuned.at("side"), is_upper ? "upper" : "lower");
    EXPECT_NEAR(number(tuned, "limit"), expected, 1e-9);
    EXPECT_THAT(table.text("tuned", "limit"), StartsWith(is_upper ? "≤" : "≥"));
    table.expect("tuned", "limit", "Hz", expected);
  }
}

/// Lower mass asks for 35.4 mm, less deflection for all that is allowed.
TEST_F(ReadBackFrequency, MarksVariablesAtTheirBounds) {
  const std::string least_deflection =
      R"(--set '/scene/loads={"f": {"type": "force", "body": "arm",
                              "at": [0.8, 0, 0], "direction": [0, 1, 0], "value": 1}}' )"
      R"(--set '/responses/tip={"type": "deflection", "body": "arm", "at": 1, "over_time": "max-abs"}' )"
      R"(--set /simulation/initial_state=quasi-static --set /objective/minimize=tip)";
  const std::string fixed_density =
      R"(--set '/scene/materials/iron={"young": 2.1e11, "poisson": 0.3,
                                       "density": {"variable": "rho"}}' )"
      R"(--set '/variables/rho={"start": 7850, "lower": 7850, "upper": 7850}' )"
      R"(--set /scene/bodies/arm/material=iron)";
  for (const auto& [options, line] : std::vector<std::pair<std::string, std::string>>{
           {"", "d .* mm *"},
           {"--set '/variables/d/lower=38 mm'", "d .* mm +at its lower bound"},
           {least_deflection, "d .* mm +at its upper bound"},
           {fixed_density, "rho .* fixed"}}) {
    EXPECT_THAT(said("optimize", options), ContainsRegex("\n  " + line + "\n")) << options;
  }
}

/// The history of a magnitude is one of magnitudes, of whatever sign the largest is: a press of
/// 1 kN has F/A = −0.796 MPa everywhere.
TEST_F(ReadBackFrequency, ComesWithHistoriesOfMagnitudes) {
  said(
      "simulate",
      R"(--set '/scene/loads={"f": {"type": "force", "body": "arm", "at": [0.8, 0, 0],
                                     "direction": [-1, 0, 0], "value": 1000}}' )"
      R"(--set /simulation/initial_state=quasi-static --set '/scene/gravity=[0, 0, 0]' )"
      R"(--set '/responses/largest={"type": "stress", "part": "axial", "body": "arm", "over_time": "max-abs"}' )"
      R"(--set '/responses/highest={"type": "stress", "part": "axial", "body": "arm", "over_time": "max"}')");
  const CsvRows rows = folder_.csv("run/trajectory.csv");
  const double stress = 1000 / (M_PI / 4 * 0.04 * 0.04);
  for (const auto& [name, expected] : {std::pair{"largest", stress}, {"highest", -stress}}) {
    EXPECT_THAT(numbers(rows, name), Each(testing::DoubleNear(expected, 1e-3 * stress))) << name;
  }
  EXPECT_EQ(rows[0].size(), 1 + 2 * 2u);  // with the bands of both
}

TEST_F(ReadBackFrequency, VariesAlongAFrontInHertz) {
  const TextTable table(said("pareto"), "limit [Hz]");
  ASSERT_EQ(table.rows(), 2u);
  const std::vector<double> limits = numbers(folder_.csv("run/pareto.csv"), "limit");
  const double hertz[] = {30, 50};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(number(result().at("points").at(i), "limit"), 2 * M_PI * hertz[i], 1e-9);
    EXPECT_NEAR(limits[i], 2 * M_PI * hertz[i], 1e-9);
    table.expect(i, "limit [Hz]", "Hz", 2 * M_PI * hertz[i]);
    EXPECT_NEAR(table.number(i, "pitch [Hz]"), hertz[i], 2e-4 * hertz[i]);
    EXPECT_NEAR(table.number(i, "d [mm]"), 40.0 * hertz[i] / hertz_of(0.040), 1e-2);
  }
}

TEST_F(ReadBackFrequency, ScattersInHertz) {
  const TextTable table(said("uncertainty"), "response");
  const double hertz = hertz_of(0.1e-3);
  EXPECT_EQ(table.text("pitch", "unit"), "Hz");
  EXPECT_NEAR(number(result(), "responses/pitch/deviation"), 2 * M_PI * hertz,
              1e-3 * 2 * M_PI * hertz);
  EXPECT_NEAR(table.number("pitch", "deviation"), hertz, 2e-3 * hertz);
  EXPECT_NEAR(table.number("pitch", "bounds ±"), 3 * hertz, 6e-3 * hertz);
}

TEST_F(ReadBackFrequency, HasItsGradientInHertzAUnit) {
  const TextTable table(said("gradient", "--method direct"), "response");
  EXPECT_EQ(table.text("pitch", "unit"), "Hz/mm");
  const double expected = hertz_of(1.0);  // [Hz/m]
  EXPECT_NEAR(number(result(), "responses/pitch/gradients/direct/d"), 2 * M_PI * expected,
              1e-3 * 2 * M_PI * expected);
  EXPECT_NEAR(table.number("pitch", "direct"), 1e-3 * expected, 1e-6 * expected);
}

}  // namespace
}  // namespace pleuel::test::readback_test
