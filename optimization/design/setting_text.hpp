#pragma once

#include <string>

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// What may differ between the simulations of one optimization, as text from which doubles read back
/// exactly: steps, tolerances, elements, modes, effects that are left out, the design for which the
/// model decides, the method of gradients, the objective, and the responses that are limited. How far
/// they are limited is not part of it, as no evaluation depends on that.
std::string setting_text(const ProblemFile& file);

}  // namespace pleuel
