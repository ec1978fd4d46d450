#pragma once

#include <string>

#include "cli/optimum.hpp"

namespace pleuel {

/// The result of `optimize` for people: status, objective, variables, constraints, evidence.
std::string optimum_report(const Optimum& optimum);

}  // namespace pleuel
