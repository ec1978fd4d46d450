#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/cli/program.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::optimize_test {
namespace {

std::vector<std::string> quick_optimization(const std::vector<std::string>& more) {
  return joined(joined({"optimize", problem("slider_crank_round")}, quick()), more);
}

using Optimize = InProgramFolder;

TEST_F(Optimize, GivesADocumentWithTheDocumentedKeys) {
  const ProgramRun run = folder_.run(quick_optimization({"--json"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json document = run.document();
  for (const char* key :
       {"status", "message", "backend", "objective", "variables", "constraints", "kkt_residual",
        "max_violation", "evaluations", "gradient_evaluations", "iterations", "seconds"}) {
    EXPECT_TRUE(document.contains(key)) << key;
  }
  EXPECT_EQ(document.at("status"), "verified");
  EXPECT_EQ(document.at("objective").at("unit"), "kg");
  EXPECT_LT(document.at("objective").at("value"), document.at("objective").at("start"));
  for (const auto& [name, constraint] : document.at("constraints").items()) {
    // The limits hold to the tolerance of the verdict.
    EXPECT_LE(constraint.at("value"), constraint.at("limit").get<double>() * (1 + 1e-4)) << name;
    EXPECT_TRUE(constraint.contains("multiplier")) << name;
  }
  for (const auto& [name, variable] : document.at("variables").items()) {
    EXPECT_EQ(variable.at("unit"), "m") << name;
    EXPECT_GE(variable.at("value"), variable.at("lower")) << name;
    EXPECT_LE(variable.at("value"), variable.at("upper")) << name;
  }
}

/// A screen of 80 columns and 40 lines has the whole answer; --verbose has the audit, too.
TEST_F(Optimize, FitsAScreen) {
  const std::vector<std::string> words = {"optimize", problem("slider_crank"), "--set",
                                          "/simulation/step=0.2 ms"};
  ::setenv("COLUMNS", "80", 1);
  const ProgramRun run = folder_.run(joined(words, {"-o", "one"}));
  ::unsetenv("COLUMNS");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(run.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto is_first = [](char c) { return (c & 0xC0) != 0x80; };  // of a UTF-8 character
    EXPECT_LE(std::count_if(line.begin(), line.end(), is_first), 80) << line;
  }
  EXPECT_LE(count, 40);
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("\nVERIFIED: every limit holds; "), Not(HasSubstr("Audit: "))));
  const ProgramRun verbose = folder_.run(joined(words, {"--verbose", "-o", "two"}));
  EXPECT_THAT(verbose.out, AllOf(HasSubstr("\nAudit: a local optimum: "),
                                 HasSubstr("at +1 % limit"), HasSubstr("\nDrive bearing: ")));
}

/// Whatever makes the gradients, the optimum is the same: within the tolerance of the optimizer.
TEST_F(Optimize, MayUseAnyGradients) {
  const auto optimum = [&](const std::vector<std::string>& more) {
    const ProgramRun run = folder_.run(quick_optimization(joined({"--json"}, more)));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.document();
  };
  const nlohmann::json chosen = optimum({});
  EXPECT_EQ(chosen.at("gradients").at("method"), "direct");
  for (const std::string method : {"adjoint", "central-difference"}) {
    const nlohmann::json document = optimum({"--method", method});
    EXPECT_EQ(document.at("gradients").at("method"), method);
    EXPECT_EQ(document.at("gradients").at("reason"), "asked for");
    const double expected = chosen.at("objective").at("value");
    EXPECT_NEAR(document.at("objective").at("value"), expected, 1e-5 * expected) << method;
  }
  EXPECT_EQ(
      optimum({"--set", R"(/sensitivity={"method": "adjoint"})"}).at("gradients").at("method"),
      "adjoint");
}

/// The words of the line of a table that begins with this name.
std::vector<std::string> table_row(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    if (words.size() > 1 && words.front() == name) return words;
  }
  ADD_FAILURE() << "no line of " << name << " in\n" << text;
  return std::vector<std::string>(16, "nan");
}

/// A number of a table, with five digits (prices: three), against the document.
void expect_number_shown(const std::string& word, double value, double digits = 1e-4) {
  EXPECT_NEAR(std::stod(word), value, digits * std::abs(value)) << word;
}

/// The document in SI, the tables in mm and MPa.
TEST_F(Optimize, ShowsTheNumbersOfItsDocumentInUnitsOfTheUser) {
  const ProgramRun run = folder_.run(quick_optimization({"-o", "run", "--verbose"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto document = folder_.result("run");
  EXPECT_THAT(run.out, HasSubstr("VERIFIED"));
  for (const auto& [name, variable] : document.at("variables").items()) {
    const auto row = table_row(run.out, name);  // name, start, optimum, lower, upper, unit
    expect_number_shown(row.at(1), 1e3 * variable.at("start").get<double>());
    expect_number_shown(row.at(2), 1e3 * variable.at("value").get<double>());
    expect_number_shown(row.at(3), 1e3 * variable.at("lower").get<double>());
    expect_number_shown(row.at(4), 1e3 * variable.at("upper").get<double>());
    EXPECT_EQ(row.at(5), "mm");
  }
  const double objective = document.at("objective").at("value");
  int priced = 0;
  for (const auto& [name, constraint] : document.at("constraints").items()) {
    // name, value, ≤, limit, unit, used, %, multiplier, sign and percent, %
    const auto row = table_row(run.out, name);
    const bool is_stress = constraint.at("unit") == "Pa";
    const double unit = is_stress ? 1e6 : 1e-3;
    const double value = constraint.at("value"), limit = constraint.at("limit");
    const double price = constraint.at("multiplier");
    expect_number_shown(row.at(1), value / unit);
    EXPECT_EQ(row.at(2), "≤");
    expect_number_shown(row.at(3), limit / unit);
    EXPECT_EQ(row.at(4), is_stress ? "MPa" : "mm");
    EXPECT_NEAR(std::stod(row.at(5)), 100.0 * value / limit, 0.05 + 1e-9);
    if (price == 0.0) {
      EXPECT_EQ(row.at(7), "0") << name;
      EXPECT_EQ(row.at(8), "–") << name;
      continue;
    }
    ++priced;
    expect_number_shown(row.at(7), price * unit, 5e-3);
    // More room for stress or deflection saves mass: the sign is minus.
    EXPECT_THAT(row.at(8), StartsWith("−"));
    EXPECT_NEAR(std::stod(row.at(8).substr(std::string("−").size())), price * limit / objective,
                0.0051)
        << "percent of the objective at one more percent of the limit";
  }
  EXPECT_GT(priced, 0);
}

/// Iterations are those of the backend, designs of the audit are none.
TEST_F(Optimize, TellsStepsFromTheAuditInItsHistory) {
  const ProgramRun run = folder_.run(quick_optimization({"-o", "run"}));
  const auto rows = read_csv(folder_.path() / "run/history.csv");
  const auto& titles = rows.front();
  const auto column = [&](const std::string& title) {
    return static_cast<std::size_t>(std::find(titles.begin(), titles.end(), title) -
                                    titles.begin());
  };
  int last = 0, audits = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const int iteration = std::stoi(rows[k].at(column("iteration")));
    const std::string purpose = rows[k].at(column("purpose"));
    if (purpose == "audit") {
      ++audits;
      EXPECT_EQ(iteration, last) << k;
    }
    last = iteration;
  }
  EXPECT_GE(audits, 6);
  EXPECT_THAT(run.out, HasSubstr("audit"));
  EXPECT_THAT(run.out, Not(HasSubstr(fmt::format("\n  {:>9}  ", last + 1))));
}

TEST_F(Optimize, StartsInItsTablesWhereTheRunBegan) {
  std::ofstream(folder_.path() / "design.json")
      << R"({"variables": {"crank_diameter": {"value": 0.025}, "rod_diameter": {"value": 0.020}}})";
  const ProgramRun run = folder_.run(quick_optimization(
      {"-o", "run", "--design", "design.json", "--set", "/optimizer/max_iterations=1"}));
  const auto document = folder_.result("run");
  EXPECT_EQ(document.at("variables").at("crank_diameter").at("start"), 0.025) << run.err;
  EXPECT_EQ(document.at("variables").at("rod_diameter").at("start"), 0.020);
  expect_number_shown(table_row(run.out, "crank_diameter").at(1), 25.0);
  expect_number_shown(table_row(run.out, "rod_diameter").at(1), 20.0);
}

TEST_F(Optimize, CannotVerifyWhatNoDesignCanKeep) {
  const ProgramRun run =
      folder_.run(quick_optimization({"--json", "--set", "/constraints/rod_stiffness/upper=1e-9 mm",
                                      "--set", "/optimizer/max_iterations=10"}));
  EXPECT_EQ(run.exit_code, 4) << run.err;
  const nlohmann::json document = run.document();
  EXPECT_EQ(document.at("status"), "infeasible");
  const std::string message = document.at("message");
  EXPECT_THAT(message, HasSubstr("rod_stiffness ≤ 1e-09 mm cannot be kept"));
  EXPECT_THAT(message, HasSubstr("One change would do: rod_stiffness ≤ 0.00"));
  EXPECT_TRUE(document.at("least_violation").at("proven"));
  EXPECT_THAT(message, Not(HasSubstr("between")));
  for (const auto& [name, constraint] : document.at("constraints").items()) {
    EXPECT_FALSE(constraint.contains("multiplier")) << name << ": a price where none can be";
  }
  const auto rows = read_csv(folder_.path() / "runs/slider_crank_round-optimize/history.csv");
  const auto column = std::find(rows.front().begin(), rows.front().end(), "max_violation");
  double least = document.at("max_violation");
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const std::string& cell = rows[k].at(std::size_t(column - rows.front().begin()));
    if (!cell.empty()) least = std::min(least, std::stod(cell));
  }
  EXPECT_NEAR(document.at("max_violation"), least, 1e-12 * least);
}

TEST_F(Optimize, WithoutTimeToFinishItIsNotVerified) {
  const ProgramRun run = folder_.run(quick_optimization({"--set", "/optimizer/max_iterations=2"}));
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(run.out, HasSubstr("NOT VERIFIED"));
}

/// Coarser steps have room, half of them do not.
TEST_F(Optimize, NamesTheRunThatWouldTellItsErrors) {
  const ProgramRun run =
      folder_.run({"optimize", problem("slider_crank_round"), "--set", "/simulation/step=0.4 ms",
                   "--set", R"(/sensitivity={"memory": "60 kB"})", "--no-report"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(unwrapped(run.out),
              AllOf(HasSubstr("A run that would tell failed: /sensitivity/memory is too little"),
                    Not(HasSubstr("nan"))));
}

TEST_F(Optimize, AStartThatCannotBeSimulatedIsASimulationFailure) {
  const ProgramRun run =
      folder_.run(quick_optimization({"--json", "--set", "/simulation/max_newton_iterations=1"}));
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_EQ(run.document().at("status"), "failed");
}

/// Rubber at 30 rad/s bends too far for linear elasticity, wherever one iteration leads.
TEST_F(Optimize, SaysWhereLinearElasticityIsLeft) {
  const ProgramRun run = folder_.run({"optimize", problem("hard/soft_rod"), "--set",
                                      "/scene/joints/bearing/drive/speed=30 rad/s", "--set",
                                      R"(/objective={"minimize": "rod_bow"})", "--set",
                                      R"(/optimizer={"max_iterations": 1})"});
  EXPECT_THAT(unwrapped(run.out), HasSubstr("too far for linear elasticity"));
  const auto result = read_json(folder_.path() / "runs/soft_rod-optimize/result.json");
  EXPECT_GT(result.at("monitors").at("elastic_rotation"), 0.2);
  EXPECT_THAT(folder_.run(quick_optimization({})).out, Not(HasSubstr("linear elasticity")));
}

TEST_F(Optimize, BackendOfTheCommandLineWinsOverThatOfTheFile) {
  const ProgramRun run = folder_.run(quick_optimization({"--json", "--backend", "ipopt"}));
  EXPECT_EQ(run.document().at("backend"), "ipopt");
  EXPECT_EQ(run.document().at("status"), "verified");
}

}  // namespace
}  // namespace pleuel::test::optimize_test
