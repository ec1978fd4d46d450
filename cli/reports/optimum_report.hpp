#pragma once

#include "cli/reports/optimum_document.hpp"
#include "cli/text/json.hpp"

namespace pleuel {

/// What the last design of a run is called: "optimum", or "end" where nothing is proven of it.
/// @param status  as in result.json
std::string name_of_end(const std::string& status);

/// The result of `optimize` for people: verdict, objective, dimensions, limits, what speaks against it.
/// @param document    the same as optimum_document() has it
/// @param is_verbose  with the audit and the prices of limits
std::string optimum_report(const Optimum& optimum, const Json& document, bool is_verbose);

}  // namespace pleuel
