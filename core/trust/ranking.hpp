#pragma once

#include <vector>

#include "core/trust/doubt.hpp"

namespace pleuel {

/// Sorts doubts by class, within a class the serious ones first: so the cause is told before what
/// follows from it.
void rank_doubts(std::vector<Doubt>& doubts);

/// How many of ranked doubts follow from those before them: those of lower classes than the highest
/// one with a serious doubt, or with numbers that lack a unit.
int count_consequences(const std::vector<Doubt>& doubts);

}  // namespace pleuel
