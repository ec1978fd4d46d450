#pragma once

#include "core/trust/finding.hpp"
#include "core/trust/trusted_run.hpp"

namespace pleuel {

/// Loads and drives that change faster than the steps can follow: what acts between two instants is
/// not seen, however well energy is balanced. And drives whose speed jumps.
std::vector<Finding> check_fast_laws(const TrustedRun& run);

/// The same of the start design before a simulation, whose equal steps the file says; nothing where
/// steps follow an error.
std::vector<Finding> check_fast_laws_before(const ProblemFile& problem);

}  // namespace pleuel
