#include "cli/reports/starts_report.hpp"

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

std::string indices_text(const std::vector<std::size_t>& starts) {
  std::vector<std::size_t> numbers;
  for (const std::size_t start : starts) numbers.push_back(start + 1);
  return fmt::format("{}", fmt::join(numbers, ", "));
}

}  // namespace

std::string starts_text(const ProblemFile& problem, const MultiStart& all) {
  if (all.runs.size() <= 1 || all.optima.empty()) return "";
  const ShownUnit unit = unit_of(find_response(problem, problem.objective->response));
  const std::vector<ShownUnit> units = variable_units(problem);
  std::vector<Table::Column> columns = {
      fmt::format("{} [{}]", problem.objective->response, unit.name), "found"};
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    columns.push_back(fmt::format("{} [{}]", problem.variables[i].name, units[i].name));
  }
  columns.push_back(left_aligned("from starts"));
  Table table(std::move(columns), 2);
  for (const LocalOptimum& one : all.optima) {
    std::vector<std::string> cells = {
        significant(unit.shown(problem.objective->sign() * one.objective)),
        fmt::format("{}", one.starts.size())};
    for (std::size_t i = 0; i < units.size(); ++i) {
      cells.push_back(significant(units[i].shown(one.x(i))));
    }
    cells.push_back(indices_text(one.starts));
    table.add_row(std::move(cells));
  }
  return "\n" + table.text();
}

Json starts_document(const ProblemFile& problem, const MultiStart& all) {
  const double sign = problem.objective->sign();
  const auto optimum_entry = [&](const LocalOptimum& one) {
    return Json{{"objective", sign * one.objective},
                {"found", one.starts.size()},
                {"variables", by_name(problem.variables, one.x)}};
  };
  const auto run_entry = [&](const StartRun& one) {
    Json run = {{"start", by_name(problem.variables, one.start)},
                {"status", to_string(one.status)},
                {"objective", sign * one.objective},
                {"max_violation", one.max_violation},
                {"evaluations", one.evaluations}};
    if (one.optimum) run["optimum"] = *one.optimum;
    return run;
  };
  return {{"optima", list_of(all.optima, optimum_entry)}, {"runs", list_of(all.runs, run_entry)}};
}

}  // namespace pleuel
