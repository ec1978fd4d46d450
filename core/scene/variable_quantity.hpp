#pragma once

#include "core/scene/problem_file.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// What a design variable measures: the quantity of the first number of the scene that is bound to
/// it; else that of the other variables of its linear constraint; else a pure number.
Quantity variable_quantity(const ProblemFile& problem, int variable);

}  // namespace pleuel
