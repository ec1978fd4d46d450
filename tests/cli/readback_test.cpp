#include "tests/cli/readback.hpp"

#include <fstream>

#include <fmt/format.h>

/// Simulations, gradients, optima, and names in CSV files, read back.
namespace pleuel::test::readback_test {
namespace {

using nlohmann::json;

/// Beside each history the half-width of its band; at the peak about that of the response's bar.
TEST(ReadBack, OfBandsAroundHistories) {
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
TEST(ReadBack, OfRoundOffIsZero) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(),
      joined({"simulate", problem("slider_crank_round"), "-o", "run", "--no-report", "--set",
              R"(/responses/beside={"type": "position", "body": "rod", "at": 1, "direction": "y",
                                    "over_time": "max-abs"})"},
             quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json document = json::parse(read_file(folder.path() / "run/result.json"));
  EXPECT_GT(document.at("responses").at("beside").at("value"), 0.0);
  const TextTable table(run.out, "response");
  EXPECT_EQ(table.text(table.row_of("beside"), "value"), "0");
  EXPECT_NE(table.text(table.row_of("rod_bow"), "value"), "0");
}

TEST(ReadBack, OfSimulate) {
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
  EXPECT_THAT(report.text, testing::ContainsRegex("crank_strength .* BROKEN\n"));
  EXPECT_THAT(report.text, testing::ContainsRegex("rod_strength .* kept\n"));
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
TEST(ReadBack, OfGradient) {
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
    expect_shown(table.text(row, "largest difference"), "1", spread);
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
    EXPECT_THAT(table.text(row, "limit"), testing::StartsWith("≤"));
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
TEST(ReadBack, OfALowerLimit) {
  const Report report =
      run({"optimize", file, "--verbose", "--set",
           R"(/constraints={"least": {"response": "crank_and_rod", "lower": "1000 g"}})", "--set",
           R"(/pareto={"constraint": "least", "from": "1 kg", "to": "2 kg"})"});
  const TextTable table(report.text, "constraint");
  EXPECT_THAT(table.text(0, "limit"), testing::StartsWith("≥"));
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

TEST(ReadBack, OfCheck) {
  const TemporaryFolder folder;
  const auto checked = [&](const std::vector<std::string>& more) {
    return run_program(folder.path(),
                       joined(joined({"check", file, "--jobs", "1"}, quick()), more));
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
    EXPECT_THAT(table.text(row, "derivative"), testing::StartsWith("agrees"));
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
TEST(ReadBack, OfTheResponsesOfAnOptimum) {
  const TemporaryFolder folder;
  const ProgramRun optimum =
      run_program(folder.path(), joined({"optimize", file, "-o", "best"}, quick()));
  const json responses = json::parse(read_file(folder.path() / "best/result.json")).at("responses");
  const auto simulated = [&](const std::vector<std::string>& design) {
    return run_program(folder.path(), joined(joined({"simulate", file, "--json"}, quick()), design))
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
TEST(ReadBack, OfNamesThatCsvCannotHoldAsTheyAre) {
  auto document = json::parse(read_file(file));
  json responses;
  const std::vector<std::string> names = {"a \"quoted\", name", "=1+1", "+1", "-1", "@SUM(A1)"};
  for (const std::string& name : names) {
    responses[name] = {
        {"type", "position"}, {"body", "slider"}, {"direction", "x"}, {"over_time", "final"}};
  }
  document["responses"] = responses;
  for (const char* block : {"objective", "constraints", "pareto", "accuracy"})
    document.erase(block);
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "named.json") << document;
  const ProgramRun run =
      run_program(folder.path(), joined({"simulate", "named.json", "-o", "run"}, quick()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string text = read_file(folder.path() / "run/trajectory.csv");
  EXPECT_THAT(text, testing::HasSubstr("\"a \"\"quoted\"\", name\""));
  EXPECT_THAT(parse_csv(text).front(),
              testing::IsSupersetOf({std::string("time"), names[0], std::string("'=1+1"),
                                     std::string("'+1"), std::string("'-1"),
                                     std::string("'@SUM(A1)"), std::string("'=1+1:error")}));
  // Numbers stay numbers.
  EXPECT_EQ(parse_csv(text)[1].front(), "0");
}

TEST_F(ReadBackOptimum, Effort) {
  EXPECT_THAT(
      unwrapped(report_.text),
      testing::HasSubstr(fmt::format("{}: {} evaluations, {} with gradients ({}), {} restarts",
                                     document_.at("backend").get<std::string>(),
                                     document_.at("evaluations").get<int>(),
                                     document_.at("gradient_evaluations").get<int>(),
                                     document_.at("gradients").at("method").get<std::string>(),
                                     document_.at("restarts").get<int>())));
  EXPECT_NE(document_.at("evaluations"), document_.at("gradient_evaluations"));
}

}  // namespace
}  // namespace pleuel::test::readback_test
