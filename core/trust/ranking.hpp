#pragma once

#include <vector>

#include "core/trust/finding.hpp"

namespace pleuel {

/// Sorts findings by class, within a class the serious ones first: so the cause is told before what
/// follows from it.
void rank_findings(std::vector<Finding>& findings);

/// How many of ranked findings follow from those before them: those of lower classes than the highest
/// one with a serious finding, or with numbers that lack a unit.
int count_consequences(const std::vector<Finding>& findings);

}  // namespace pleuel
