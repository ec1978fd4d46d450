#pragma once

#include <map>

#include "cli/text/json.hpp"
#include "cli/text/table.hpp"
#include "core/scene/shown_unit.hpp"

/// Tables of the terminal that are made from what result.json says: a table is a list of columns.
namespace pleuel {

/// What a cell shows of an entry of a document and of its name.
using CellText = std::function<std::string(const std::string& name, const Json& entry)>;

/// How a number is shown.
using NumberText = std::function<std::string(double)>;

struct DocumentColumn {
  std::string title;
  CellText text;
  Table::Align align = Table::Align::right;
};

/// Units in which the problem file writes its numbers, by name: the document has SI.
using NamedUnits = std::map<std::string, ShownUnit>;
NamedUnits units_of_variables(const ProblemFile& problem);
NamedUnits units_of_responses(const ProblemFile& problem);
NamedUnits units_of_limits(const ProblemFile& problem);

/// The number at a place (JSON pointer) of an entry; none where there is no number.
std::optional<double> number_at(const Json& entry, const std::string& place);
/// The text at a place; empty where there is none.
std::string text_at(const Json& entry, const std::string& place);

/// The place of a member that may be called as it likes.
std::string place_in(const std::string& group, const std::string& name);

/// Five significant digits, or so many.
NumberText significant_digits(int digits = 5);
std::string whole_number(double number);

/// The name of an entry.
DocumentColumn name_column(const std::string& title);
DocumentColumn text_column(const std::string& title, const std::string& place);
/// What is no number is shown as "–".
DocumentColumn number_column(const std::string& title, const std::string& place,
                             NumberText text = significant_digits());
/// The same in the unit of the entry's name.
DocumentColumn shown_column(const std::string& title, const std::string& place,
                            const NamedUnits& units, NumberText text = significant_digits());
DocumentColumn unit_column(const NamedUnits& units);
/// The same number of all entries in one unit, which stands behind the title: "mass [kg]".
DocumentColumn column_in(const ShownUnit& unit, const std::string& title, const std::string& place,
                         int digits = 5);
/// "≤ 120" of an entry with "limit" and "side".
DocumentColumn limit_column(const NamedUnits& units);

/// @param rows     {NAME: entry} or [entry]; the name of an entry of a list is its member "name"
/// @param keys     so many of the first columns tell the rows apart
Table table_of(const Json& rows, const std::vector<DocumentColumn>& columns, std::size_t keys = 1);

}  // namespace pleuel
