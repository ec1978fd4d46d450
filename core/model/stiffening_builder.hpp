#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Geometric stiffening of a body that has it.
/// @param coordinates  of the whole system
std::unique_ptr<Term> make_stiffening(const BodyModel& body, int coordinates);

}  // namespace pleuel
