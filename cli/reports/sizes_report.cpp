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
  Table table({{"size", Table::Align::left},
               {"chosen", Table::Align::left},
               {"between sizes", Table::Align::left},
               {"choices"}});
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
  Json relaxed = Json::object(), chosen = Json::object();
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const DesignVariable& variable = problem.variables[i];
    if (sizes.relaxed_x.size() > 0) relaxed[variable.name] = sizes.relaxed_x(i);
    if (const auto text = size_text(variable, result.x(i))) chosen[variable.name] = *text;
  }
  Json document = {{"combinations", sizes.combinations},
                   {"tried", sizes.tried},
                   {"feasible", sizes.feasible},
                   {"exhaustive", sizes.is_exhaustive},
                   {"chosen", sizes.is_choice ? chosen : Json::object()},
                   {"relaxed",
                    {{"status", to_string(sizes.relaxed_status)},
                     {"objective", sign * sizes.relaxed_objective},
                     {"variables", relaxed}}}};
  if (sizes.is_choice) document["penalty"] = sizes.penalty(result.evaluation.objective);
  return document;
}

}  // namespace pleuel
