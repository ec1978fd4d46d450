#pragma once

#include <initializer_list>
#include <set>

#include "core/base/error.hpp"
#include "core/scene/reading/expression_parser.hpp"
#include "core/scene/reading/json_node.hpp"

namespace pleuel {

/// What is read has to do with several load cases: a document of one case leaves it out.
class NamesCases : public InputError {
 public:
  /// @param formula  that names them
  NamesCases(const std::string& message, std::string formula)
      : InputError(message), formula_(std::move(formula)) {}
  const std::string& formula() const { return formula_; }

 private:
  std::string formula_;
};

/// Whether the value is a text that begins with "=": a formula where a number could stand.
bool is_formula(const JsonNode& node);

/// The unit in the first of the texts that has one; empty if none does. Formulas have none.
std::string written_unit(std::initializer_list<JsonNode> nodes);

/// The end of a message about a text that is no number: `; a formula begins with "=": …` with the
/// column of its first sign, where the text looks like one; else empty.
std::string formula_hint(const std::string& text, const std::vector<Symbol>& symbols);

/// A formula of the document, or another text that is one.
/// @throws InputError with its column; NamesCases, which is one, where that is its only mistake
ReadExpression read_formula(const JsonNode& node, const std::vector<Symbol>& symbols);

/// The names that all formulas of a document may use: its constants (which may be formulas of
/// constants before them) and its design variables. A design variable has the unit that its
/// "start" (or else a bound) is written with.
/// @throws InputError
std::vector<Symbol> read_symbols(const JsonNode& root);

/// Names of the constants that do not stand for the same in all documents.
std::set<std::string> differing_constants(const std::vector<std::vector<Symbol>>& documents);

}  // namespace pleuel
