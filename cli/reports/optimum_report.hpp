#pragma once

#include <string>

#include "cli/reports/optimum.hpp"

namespace pleuel {

/// What the last design of a run is called: "optimum", or "end" where nothing is proven of it.
/// @param status  as in result.json
std::string name_of_end(const std::string& status);

/// The result of `optimize` for people: status, objective, variables, constraints, evidence.
std::string optimum_report(const Optimum& optimum);

}  // namespace pleuel
