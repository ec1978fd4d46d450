#pragma once

#include <string>

#include "cli/reports/optimum.hpp"

namespace pleuel {

/// The result of `optimize` for people: status, objective, variables, constraints, evidence.
std::string optimum_report(const Optimum& optimum);

}  // namespace pleuel
