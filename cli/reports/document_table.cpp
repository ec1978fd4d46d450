#include "cli/reports/document_table.hpp"

#include <utility>

#include <fmt/format.h>

#include "core/base/number_text.hpp"

namespace pleuel {

namespace {

const Json* find_at(const Json& entry, const std::string& place) {
  const Json::json_pointer pointer(place);
  return entry.contains(pointer) ? &entry.at(pointer) : nullptr;
}

std::string number_or_dash(const Json& entry, const std::string& place, const NumberText& text,
                           double factor = 1.0) {
  const std::optional<double> number = number_at(entry, place);
  return number ? text(*number / factor) : "–";
}

}  // namespace

NamedUnits units_of_variables(const ProblemFile& problem) {
  const std::vector<ShownUnit> all = variable_units(problem);
  NamedUnits units;
  for (std::size_t i = 0; i < all.size(); ++i) units[problem.variables[i].name] = all[i];
  return units;
}

NamedUnits units_of_responses(const ProblemFile& problem) {
  NamedUnits units;
  for (const ResponseSettings& one : problem.responses) units[one.name] = unit_of(one);
  return units;
}

NamedUnits units_of_limits(const ProblemFile& problem) {
  NamedUnits units;
  for (const auto& one : problem.constraints) units[one.name] = unit_of(problem, one);
  return units;
}

std::optional<double> number_at(const Json& entry, const std::string& place) {
  const Json* found = find_at(entry, place);
  return found && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::string text_at(const Json& entry, const std::string& place) {
  const Json* found = find_at(entry, place);
  return found && found->is_string() ? found->get<std::string>() : "";
}

std::string place_in(const std::string& group, const std::string& name) {
  return (Json::json_pointer(group) / name).to_string();
}

NumberText significant_digits(int digits) {
  return [digits](double number) { return significant(number, digits); };
}

std::string whole_number(double number) {
  return fmt::format("{:.0f}", number);
}

DocumentColumn name_column(const std::string& title) {
  return {title, [](const std::string& name, const Json&) { return name; }, Table::Align::left};
}

DocumentColumn text_column(const std::string& title, const std::string& place) {
  return {title, [place](const std::string&, const Json& entry) { return text_at(entry, place); },
          Table::Align::left};
}

DocumentColumn number_column(const std::string& title, const std::string& place, NumberText text) {
  return {title, [place, text = std::move(text)](const std::string&, const Json& entry) {
            return number_or_dash(entry, place, text);
          }};
}

DocumentColumn shown_column(const std::string& title, const std::string& place,
                            const NamedUnits& units, NumberText text) {
  return {title,
          [place, units, text = std::move(text)](const std::string& name, const Json& entry) {
            return number_or_dash(entry, place, text, units.at(name).factor);
          }};
}

DocumentColumn unit_column(const NamedUnits& units) {
  return {"unit", [units](const std::string& name, const Json&) { return units.at(name).name; },
          Table::Align::left};
}

DocumentColumn column_in(const ShownUnit& unit, const std::string& title, const std::string& place,
                         int digits) {
  return number_column(
      fmt::format("{} [{}]", title, unit.name), place,
      [unit, digits](double number) { return significant(unit.shown(number), digits); });
}

DocumentColumn limit_column(const NamedUnits& units) {
  return {"limit", [units](const std::string& name, const Json& entry) {
            const std::string sign = entry.at("side") == "upper" ? "≤ " : "≥ ";
            return sign + significant(units.at(name).shown(entry.at("limit").get<double>()));
          }};
}

Table table_of(const Json& rows, const std::vector<DocumentColumn>& columns, std::size_t keys) {
  std::vector<Table::Column> titles;
  for (const DocumentColumn& column : columns) titles.push_back({column.title, column.align});
  Table table(std::move(titles), keys);
  for (const auto& [key, entry] : rows.items()) {
    const std::string name = rows.is_array() ? text_at(entry, "/name") : key;
    std::vector<std::string> cells;
    for (const DocumentColumn& column : columns) cells.push_back(column.text(name, entry));
    table.add_row(std::move(cells));
  }
  return table;
}

}  // namespace pleuel
