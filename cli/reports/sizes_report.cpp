#include "cli/reports/sizes_report.hpp"

#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

namespace {

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
