#pragma once

#include <string>

#include "cli/json.hpp"
#include "core/response/response.hpp"

/// Maxima that two peaks share: there the response has a kink, and gradients follow one peak only.
namespace pleuel {

/// "two peaks within 0.02 %: at 0.0848 s (element 1) and at 0.0534 s (element 1)"
/// @param response  one whose reduction has a tie
std::string describe_tie(const Analysis& analysis, std::size_t response);

/// {"times": [s, s], "places": ["…", "…"], "gap": relative}
Json tie_document(const Analysis& analysis, std::size_t response);

/// A line for each tie, or nothing.
std::string ties_text(const Analysis& analysis);

}  // namespace pleuel
