#include "cli/reports/starts_report.hpp"

#include <cmath>

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

/// "25 mm", or between which sections: "IPE 80 + 0.31".
std::string relaxed_text(const DesignVariable& variable, const ShownUnit& unit, double value) {
  if (!is_section(variable)) {
    return significant(unit.shown(value)) + unit.suffix();
  }
  const double whole = std::floor(value);
  const std::string name = variable.choices[static_cast<std::size_t>(whole)].text;
  return value == whole ? name : fmt::format("{} + {:.2f}", name, value - whole);
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

std::optional<std::string> size_text(const DesignVariable& variable, double value) {
  for (const SizeChoice& choice : variable.choices) {
    if (choice.value == value) return choice.text;
  }
  return std::nullopt;
}

Json sizes_of(const ProblemFile& problem, const Eigen::VectorXd& x) {
  Json sizes = Json::object();
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    if (const auto size = size_text(variable, x(i))) sizes[variable.name] = *size;
  }
  return sizes;
}

bool is_section(const DesignVariable& variable) {
  if (!variable.has_choices() || !variable.unit.empty()) return false;
  for (std::size_t i = 0; i < variable.choices.size(); ++i) {
    const auto& [value, text] = variable.choices[i];
    if (value != static_cast<double>(i) || text == fmt::format("{}", i)) return false;
  }
  return true;
}

std::string sizes_text(const ProblemFile& problem, const SizeChoiceReport& sizes,
                       const Result& result) {
  if (!sizes.is_choice) return "";
  const std::vector<ShownUnit> units = variable_units(problem);
  Table table(
      {left_aligned("size"), left_aligned("chosen"), left_aligned("between sizes"), "choices"});
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    if (!variable.has_choices()) continue;
    table.add_row({variable.name, size_text(variable, result.x(i)).value_or("–"),
                   relaxed_text(variable, units[i], sizes.relaxed_x(i)),
                   fmt::format("{}", variable.choices.size())});
  }
  return "\n" + table.text();
}

Json sizes_document(const ProblemFile& problem, const SizeChoiceReport& sizes,
                    const Result& result) {
  const double sign = problem.objective->sign();
  Json document = {{"combinations", sizes.combinations},
                   {"tried", sizes.tried},
                   {"feasible", sizes.feasible},
                   {"exhaustive", sizes.is_exhaustive},
                   {"chosen", sizes.is_choice ? sizes_of(problem, result.x) : Json::object()},
                   {"relaxed",
                    {{"status", to_string(sizes.relaxed_status)},
                     {"objective", sign * sizes.relaxed_objective},
                     {"variables", by_name(problem.variables, sizes.relaxed_x)}}}};
  if (sizes.is_choice) document["penalty"] = sizes.penalty(result.evaluation.objective);
  return document;
}

}  // namespace pleuel
