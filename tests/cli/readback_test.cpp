#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/cli/program.hpp"
#include "tests/cli/text_table.hpp"

/// What people read: every number of tables and CSV files is read back and compared with the
/// document, in millimetres and megapascals. Units are converted by factors of the test.
namespace pleuel::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// One run of a command, with all that it leaves.
struct Report {
  std::string text;
  json document;
  std::map<std::string, CsvRows> files;

  /// The numbers of a column; empty cells are NaN.
  std::vector<double> column(const std::string& file, const std::string& title) const {
    const CsvRows& rows = files.at(file);
    const auto found = std::find(rows[0].begin(), rows[0].end(), title);
    EXPECT_NE(found, rows[0].end()) << file << " has no column " << title;
    std::vector<double> numbers;
    if (found == rows[0].end()) return numbers;
    const auto i = static_cast<std::size_t>(found - rows[0].begin());
    for (std::size_t row = 1; row < rows.size(); ++row) {
      EXPECT_EQ(rows[row].size(), rows[0].size());
      numbers.push_back(rows[row][i].empty() ? std::nan("") : std::stod(rows[row][i]));
    }
    return numbers;
  }
};

Report run(const std::vector<std::string>& words, int exit_code = 0) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), joined(joined(words, {"-o", "run"}), quick()));
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  Report report;
  report.text = run.out;
  report.document = json::parse(read_file(folder.path() / "run/result.json"), nullptr, false);
  for (const auto& entry : fs::directory_iterator(folder.path() / "run")) {
    if (entry.path().extension() != ".csv") continue;
    report.files[entry.path().filename().string()] = read_csv(entry.path());
  }
  return report;
}

const std::string file = problem("slider_crank_round");

/// A number of a table against one of the document [SI].
void expect_shown(const std::string& shown, const std::string& unit, double si) {
  const double value = number_in(shown) * si_of(unit);
  EXPECT_NEAR(value, si, 1.001 * resolution_of(shown) * si_of(unit) + 1e-12 * std::abs(si))
      << shown << " " << unit;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
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
  const Report report_ = run({"optimize", file});
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
    expect_shown(table.text(row, "objective at +1 % limit"), "1",
                 -multiplier * 0.01 * limit / objective * 100);
  }
  EXPECT_GE(active, 1);
}

/// A lower limit: raising it costs.
TEST(ReadBack, OfALowerLimit) {
  const Report report =
      run({"optimize", file, "--set",
           R"(/constraints={"least": {"response": "crank_and_rod", "lower": "1000 g"}})", "--set",
           R"(/pareto={"constraint": "least", "from": "1 kg", "to": "2 kg"})"});
  const TextTable table(report.text, "constraint");
  EXPECT_THAT(table.text(0, "limit"), testing::StartsWith("≥"));
  expect_shown(table.text(0, "limit"), table.text(0, "unit"), 1.0);
  const json& constraint = report.document.at("constraints").at("least");
  EXPECT_EQ(constraint.at("side"), "lower");
  // The mass is its own limit: a multiplier of −1, and one percent more costs one percent.
  EXPECT_NEAR(constraint.at("multiplier"), -1.0, 1e-4);
  EXPECT_EQ(table.text(0, "objective at +1 % limit"), "+1.00 %");
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

TEST(ReadBack, OfPareto) {
  const Report report = run({"pareto", file, "--set", "/pareto/points=3"});
  const TextTable table(report.text, "limit [mm]");
  const json& points = report.document.at("points");
  ASSERT_EQ(table.rows(), 3u);
  const auto column = [&](const char* title) { return report.column("pareto.csv", title); };
  for (std::size_t i = 0; i < 3; ++i) {
    const json& point = points.at(i);
    const double limit = point.at("limit"), multiplier = point.at("multiplier");
    EXPECT_NEAR(limit, (0.1 + 0.15 * double(i)) * 1e-3, 1e-12);
    const double bow = point.at("objectives").at("rod_bow");
    const double mass = point.at("objectives").at("crank_and_rod");
    EXPECT_LT(bow, 0.5e-3);  // [m]
    EXPECT_GT(mass, 0.1);    // [kg]
    expect_shown(table.text(i, "limit [mm]"), "mm", limit);
    expect_shown(table.text(i, "rod_bow [mm]"), "mm", bow);
    expect_shown(table.text(i, "crank_and_rod [kg]"), "kg", mass);
    expect_shown(table.text(i, "multiplier [kg/mm]"), "kg/mm", multiplier);
    EXPECT_EQ(table.text(i, "status"), point.at("status"));
    EXPECT_EQ(report.files.at("pareto.csv")[i + 1][0], point.at("status"));
    EXPECT_EQ(column("limit")[i], limit);
    EXPECT_EQ(column("objective")[i], mass);
    EXPECT_EQ(column("limited")[i], bow);
    EXPECT_EQ(column("multiplier")[i], multiplier);
    for (const auto& [name, value] : point.at("variables").items()) {
      expect_shown(table.text(i, name + " [mm]"), "mm", value);
      EXPECT_EQ(column(("variable:" + name).c_str())[i], value);
    }
    for (const char* key : {"kkt_residual", "evaluations", "seconds"}) {
      EXPECT_EQ(column(key)[i], point.at(key)) << key;
    }
  }
}

TEST(ReadBack, OfAccuracy) {
  const Report report = run({"accuracy", file, "--set",
                             R"(/accuracy={"steps": ["0.4 ms", "0.2 ms"], "elements": [2, 4]})"});
  const TextTable table(report.text, "step [ms]");
  const json& runs = report.document.at("runs");
  ASSERT_EQ(table.rows(), runs.size());
  int bounds = 0;
  const auto expect_worst = [&](const std::string& shown, const json& errors, const json& least) {
    double most = 0.0;
    std::string name;
    for (const auto& [response, error] : errors.items()) {
      if (error > most) name = response;
      most = std::max(most, error.get<double>());
    }
    expect_shown(shown, "1", most);
    EXPECT_THAT(shown, testing::EndsWith(" " + name));
    // No run is known better than the reference is: then its error stands there, as a bound.
    const bool is_bound = most > 0.0 && most <= least.at(name).get<double>();
    EXPECT_EQ(shown.starts_with("≤ "), is_bound) << shown;
    bounds += is_bound ? 1 : 0;
  };
  const json& reference = report.document.at("reference");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const json& study_run = runs.at(i);
    expect_shown(table.text(i, "step [ms]"), "ms", study_run.at("settings").at("step"));
    EXPECT_EQ(table.number(i, "elements"), study_run.at("settings").at("elements"));
    expect_worst(table.text(i, "largest error"), study_run.at("errors"), reference.at("errors"));
    expect_worst(table.text(i, "of a gradient"), study_run.at("gradient_errors"),
                 reference.at("gradient_errors"));
    expect_shown(table.text(i, "simulation [ms]"), "ms", study_run.at("simulation_seconds"));
    expect_shown(table.text(i, "gradient [ms]"), "ms", study_run.at("gradient_seconds"));
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

/// Deviations and bounds are made again from gradients of another command.
TEST(ReadBack, OfUncertainty) {
  const Report report = run({"uncertainty", file, "--set",
                             R"(/uncertainty={"parameters": {"rod_diameter":
                                  {"deviation": "0.1 mm"}, "crank_diameter":
                                  {"interval": "0.2 mm"}}, "samples": 8})"});
  const json gradients =
      run({"gradient", file, "--histories", "--method", "direct"}).document.at("responses");
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
    const std::size_t row = table.row_of(name);
    const std::string unit = table.text(row, "unit");
    expect_shown(table.text(row, "value"), unit, value);
    expect_shown(table.text(row, "deviation"), unit, response.at("deviation"));
    expect_shown(table.text(row, "bounds ±"), unit, bound);
    const json& sampled = response.at("sampled");
    expect_shown(table.text(row, "sampled mean"), unit, sampled.at("mean"));
    expect_shown(table.text(row, "sampled deviation"), unit, sampled.at("deviation"));
    expect_shown(table.text(row, "lowest"), unit, sampled.at("lowest"));
    expect_shown(table.text(row, "highest"), unit, sampled.at("highest"));
    const bool is_rod = parts[0] * parts[0] > parts[1] * parts[1];
    EXPECT_THAT(table.text(row, "from"),
                testing::StartsWith(is_rod ? "rod_diameter " : "crank_diameter "));
    const double share = response.at("shares").at(is_rod ? "rod_diameter" : "crank_diameter");
    EXPECT_NEAR(number_in(table.text(row, "from").substr(is_rod ? 13 : 15)), 100 * share, 0.5);
    // The other one, too, if it is half a percent or more.
    EXPECT_EQ(table.text(row, "from").find(is_rod ? "crank_diameter " : "rod_diameter ") !=
                  std::string::npos,
              1 - share >= 0.005)
        << table.text(row, "from");
  }
  for (const auto& [name, parameter] : report.document.at("parameters").items()) {
    const std::size_t row = parameters.row_of(name);
    expect_shown(parameters.text(row, "value"), "mm", parameter.at("value"));
    expect_shown(parameters.text(row, "deviation"), "mm", parameter.at("deviation"));
    expect_shown(parameters.text(row, "half width"), "mm", parameter.at("interval"));
    EXPECT_EQ(parameters.text(row, "unit"), "mm");
  }
  EXPECT_EQ(parameters.text(parameters.row_of("rod_diameter"), "sampled as"), "normal");
  EXPECT_EQ(parameters.text(parameters.row_of("crank_diameter"), "sampled as"), "uniform");
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

TEST(ReadBack, OfStability) {
  const Report report = run({"stability", file});
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
    expect_shown(table.text(i, "time"), "s", study_run.at("seconds"));
    EXPECT_EQ(report.column("stability.csv", "seconds")[i], study_run.at("seconds"));
  }
}

/// The monitors are those of a simulation with that formulation.
TEST(ReadBack, OfStabilityIsThatOfSimulations) {
  const json runs = run({"stability", file}).document.at("runs");
  for (const std::string formulation : {"index-3", "stabilized-index-2", "index-1"}) {
    const json monitors = run({"simulate", file, "--set", "/simulation/formulation=" + formulation})
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

  std::pair<std::string, json> run(const std::string& command) const {
    const ProgramRun run = run_program(folder_.path(), {command, "cantilever.json", "-o", command});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return {run.out, json::parse(read_file(folder_.path() / command / "result.json"))};
  }
  static double hertz_of(double diameter) {
    return 3.516015268500151 / (2 * M_PI * 0.64) * diameter / 4 * std::sqrt(210e9 / 7850.0);
  }

  TemporaryFolder folder_;
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
  EXPECT_THAT(limits.text(0, "limit"), testing::StartsWith("≥"));
  expect_shown(limits.text(0, "limit"), "Hz", 2 * M_PI * 40);
  expect_shown(limits.text(0, "value"), "Hz", document.at("responses").at("pitch").at("value"));
  // More than the limit asks for: 40 Hz of it are used.
  expect_shown(limits.text(0, "used"), "1", 100 * 40 / expected);
  EXPECT_THAT(text, testing::ContainsRegex("tuned .* kept\n"));
}

TEST_F(ReadBackFrequency, LimitsAnOptimumInHertz) {
  const auto [text, document] = run("optimize");
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
  EXPECT_NEAR(table.number(0, "objective at +1 % limit"), 2.0, 0.011);
  EXPECT_THAT(table.text(0, "objective at +1 % limit"), testing::StartsWith("+"));
}

/// A margin of two deviations of 0.1 mm: d − 0.2 mm is in tune. Of an upper limit it has the other
/// sign: at most 40 Hz, from which the mass is kept by a limit of its own.
TEST_F(ReadBackFrequency, KeepsMarginsWithTheSignOfTheirSide) {
  const auto optimum = [&](const std::vector<std::string>& more) {
    const ProgramRun run =
        run_program(folder_.path(),
                    joined({"optimize", "cantilever.json", "-o", "margin", "--overwrite"}, more));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
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
    const ProgramRun run = run_program(
        folder_.path(),
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

/// Lower mass asks for 35.4 mm, less deflection for all that is allowed.
TEST_F(ReadBackFrequency, MarksVariablesAtTheirBounds) {
  const auto report = [&](const std::vector<std::string>& more) {
    return run_program(folder_.path(),
                       joined({"optimize", "cantilever.json", "-o", "bound", "--overwrite"}, more))
        .out;
  };
  using testing::ContainsRegex;
  EXPECT_THAT(report({}), ContainsRegex("\n  d .* mm *\n"));
  EXPECT_THAT(report({"--set", "/variables/d/lower=38 mm"}),
              ContainsRegex("\n  d .* mm +at its lower bound\n"));
  EXPECT_THAT(report({"--set", R"(/scene/loads={"f": {"type": "force", "body": "arm",
                                 "at": [0.8, 0, 0], "direction": [0, 1, 0], "value": 1}})",
                      "--set", "/simulation/initial_state=quasi-static", "--set",
                      R"(/responses/tip={"type": "deflection", "body": "arm", "at": 1,
                         "over_time": "max-abs"})",
                      "--set", "/objective/minimize=tip"}),
              ContainsRegex("\n  d .* mm +at its upper bound\n"));
  EXPECT_THAT(report({"--set", R"(/scene/materials/iron={"young": 2.1e11, "poisson": 0.3,
                                   "density": {"variable": "rho"}})",
                      "--set", "/scene/bodies/arm/material=iron", "--set",
                      R"(/variables/rho={"start": 7850, "lower": 7850, "upper": 7850})"}),
              ContainsRegex("\n  rho .* fixed\n"));
}

/// An arm that is held at an angle: the place of its tip, cos φ, against its height, sin φ ≥ limit.
/// From φ = −0.3 the optimum of a low limit is the bound at −1, that of 0.2 is on the far side,
/// where both are better: the points before are dominated.
TEST(ReadBack, OfDominatedPoints) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "arm.json") << R"({"name": "arm", "scene": {
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
    "pareto": {"constraint": "high", "from": -0.9, "to": 0.2, "points": 3}})";
  const ProgramRun text = run_program(folder.path(), {"pareto", "arm.json", "-o", "text"});
  const json points = json::parse(read_file(folder.path() / "text/result.json")).at("points");
  const TextTable table(text.out, "limit [mm]");
  ASSERT_EQ(points.size(), 3u);
  ASSERT_NEAR(points.at(2).at("objectives").at("x"), -std::sqrt(1 - 0.04), 1e-3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(points.at(i).at("dominated"), i < 2) << i;
    EXPECT_EQ(table.text(i, "status"), i < 2 ? "verified, dominated" : "verified");
  }
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
  const std::string text = run_program(folder_.path(), words).out;
  const json document = run_program(folder_.path(), joined(words, {"--json"})).document();
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
              testing::UnorderedElementsAre("time", names[0], "'=1+1", "'+1", "'-1", "'@SUM(A1)"));
  // Numbers stay numbers.
  EXPECT_EQ(parse_csv(text)[1].front(), "0");
}

}  // namespace
}  // namespace pleuel::test
