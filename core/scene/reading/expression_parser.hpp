#pragma once

#include <string>
#include <vector>

#include "core/scene/reading/expression_builder.hpp"

/// Reads formulas such as "2*width + 1 mm".
namespace pleuel {

/// The text has numbers, which their unit may follow ("80 mm"), names (in single quotes where they
/// are no words: 'tip deflection'), pi, + − * / ^, brackets, and functions. A word behind a number is
/// a unit, never a product.
/// @param text  that may begin with "="
/// @throws ExpressionError
ReadExpression read_expression(const std::string& text, const std::vector<Symbol>& symbols);

}  // namespace pleuel
