#include <filesystem>
#include <utility>
#include <vector>

#include "cli/commands/commands.hpp"
#include "cli/files/vtk_series.hpp"
#include "core/base/plain_file_name.hpp"

/// What a record of evaluations holds, as tables for other programs.
namespace pleuel {

namespace {

/// Names of what vectors of the record stand for.
struct Names {
  std::vector<std::string> variables, constraints;
};

Names names_in(const RunDatabase& database) {
  const auto list = [&](const char* name) {
    return Json::parse(database.description(name).value_or("[]")).get<std::vector<std::string>>();
  };
  return {list("variables"), list("constraints")};
}

/// The constraints that a front between responses adds to those of the file stand behind them.
void name_limits_of_front(const RunDatabase& database, Names& names) {
  Eigen::Index most = 0;
  database.read_evaluations([&](const NumberedEvaluation& one) {
    if (one.key.rows == "constraints") {
      most = std::max(most, one.stored.evaluation.constraints.size());
    }
  });
  for (Eigen::Index i = std::ssize(names.constraints), number = 1; i < most; ++i, ++number) {
    names.constraints.push_back(number == 1 ? "limit of the front"
                                            : fmt::format("limit {} of the front", number));
  }
}

/// evaluations.csv: a line for each evaluation. Of rows that are not the constraints there are no
/// values.
CsvFile::Row titles_of(const Names& names) {
  CsvFile::Row titles = {"evaluation", "ended",   "seconds", "setting",
                         "rows",       "request", "method",  "objective"};
  for (const std::string& name : names.constraints) titles.push_back("constraint:" + name);
  for (const std::string& name : names.variables) titles.push_back("variable:" + name);
  titles.push_back("failure");
  return titles;
}

CsvFile::Row row_of(const NumberedEvaluation& one, const Names& names) {
  const Evaluation& evaluation = one.stored.evaluation;
  const bool has_values = one.stored.failure.empty();
  const bool has_constraints = has_values && one.key.rows == "constraints";
  CsvFile::Row row = {one.number,   one.ended,   one.stored.seconds, one.key.setting,
                      one.key.rows, one.request, one.stored.method};
  row.push_back(has_values ? Json(evaluation.objective) : Json());
  for (Eigen::Index i = 0; i < std::ssize(names.constraints); ++i) {
    const bool has_it = has_constraints && i < evaluation.constraints.size();
    row.push_back(has_it ? Json(evaluation.constraints(i)) : Json());
  }
  row.insert(row.end(), one.key.x.begin(), one.key.x.end());
  row.push_back(one.stored.failure);
  return row;
}

/// evaluation_gradients.csv: a line for each derivative.
void add_gradients(const NumberedEvaluation& one, const Names& names, CsvFile& csv) {
  const Evaluation& evaluation = one.stored.evaluation;
  if (!evaluation.has_gradients()) return;
  const auto add = [&](const std::string& of, const Eigen::VectorXd& derivatives) {
    for (Eigen::Index j = 0; j < derivatives.size(); ++j) {
      csv.add({one.number, of, names.variables.at(j), derivatives(j)});
    }
  };
  add("objective", evaluation.objective_gradient);
  if (one.key.rows != "constraints") return;
  for (Eigen::Index i = 0; i < evaluation.constraint_jacobian.rows(); ++i) {
    add("constraint:" + names.constraints.at(i), evaluation.constraint_jacobian.row(i));
  }
}

void export_evaluations(const fs::path& file, const fs::path& target, Outcome& outcome) {
  int count = 0;
  try {
    const RunDatabase database(file);
    Names names = names_in(database);
    name_limits_of_front(database, names);
    CsvFile evaluations({target / "evaluations.csv", &outcome.unwritten}, titles_of(names));
    CsvFile gradients({target / "evaluation_gradients.csv", &outcome.unwritten},
                      {"evaluation", "of", "variable", "derivative"});
    database.read_evaluations([&](const NumberedEvaluation& one) {
      evaluations.add(row_of(one, names));
      add_gradients(one, names, gradients);
      ++count;
    });
  } catch (const DatabaseError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  for (const char* name : {"evaluations.csv", "evaluation_gradients.csv"}) {
    outcome.document["files"].push_back((target / name).string());
  }
  outcome.text +=
      fmt::format("{} evaluations written to {}: evaluations.csv, evaluation_gradients.csv\n",
                  count, target.string());
}

/// "start-heavy": of a load case; "start" without cases.
std::string series_name(const std::string& design, const std::string& load_case) {
  return load_case.empty() ? design : design + "-" + plain_file_name(load_case);
}

/// Of an optimization, which has a design at its start and at its end: of the load case that decides.
void export_motion(const OlderRun& run, const fs::path& target, Outcome& outcome) {
  constexpr int most_instants = 120;
  if (run.command() != "optimize" || !run.result.is_object()) {
    throw InputError(fmt::format("--vtk: {} is not the folder of an optimization with a result",
                                 run.folder.string()));
  }
  const ProblemFile problem = problem_of(run);
  fs::create_directories(target / "vtk");
  for (const auto& [name, key] : {std::pair{"start", "start"}, std::pair{"optimum", "value"}}) {
    const auto x = design_in(run.result, problem, key);
    if (!x) continue;
    const std::string shown = series_name(name, problem.load_case);
    const auto analysis = analyze(problem, *x, values_only);
    const int instants = write_vtk_series(target / "vtk", shown, problem, *x, *analysis,
                                          most_instants, outcome.unwritten);
    const fs::path series = target / "vtk" / (shown + ".pvd");
    outcome.document["files"].push_back(series.string());
    outcome.text += fmt::format(
        "{} instants{} written to {}\n", instants,
        problem.load_case.empty() ? "" : fmt::format(" of the case \"{}\"", problem.load_case),
        series.string());
  }
}

}  // namespace

Outcome run_export(const Arguments& arguments) {
  const OlderRun run = read_older_run(arguments.file);
  const fs::path file = run.folder / database_name;
  if (!fs::is_regular_file(file)) {
    throw InputError(
        fmt::format("{}: there is no such file: `optimize` and `pareto` write one", file.string()));
  }
  const fs::path target = arguments.output.value_or(run.folder);
  fs::create_directories(target);
  Outcome outcome;
  export_evaluations(file, target, outcome);
  if (arguments.wants_vtk) export_motion(run, target, outcome);
  return outcome;
}

}  // namespace pleuel
