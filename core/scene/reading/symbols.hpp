#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "core/scene/reading/expression_parser.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// Whether the value is a text that begins with "=": a formula where a number could stand.
bool is_formula(const JsonNode& node);

/// The unit in the first of the texts that has one; empty if none does. Formulas have none.
std::string written_unit(std::initializer_list<JsonNode> nodes);

/// The end of a message about a text that is no number: `; a formula begins with "=": …` with the
/// column of its first sign, where the text looks like one; else empty.
std::string formula_hint(const std::string& text, const std::vector<Symbol>& symbols);

/// A formula of the document, or another text that is one. @throws InputError with its column
ReadExpression read_formula(const JsonNode& node, const std::vector<Symbol>& symbols,
                            const UnitSystem& units);

/// The names that all formulas of a document may use: its constants (which may be formulas of
/// constants before them) and its design variables. A design variable has the unit that its
/// "start" (or else a bound) is written with.
/// @throws InputError
std::vector<Symbol> read_symbols(const JsonNode& root, const UnitSystem& units);

}  // namespace pleuel
