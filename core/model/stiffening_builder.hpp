#pragma once

#include <memory>

#include "core/model/model.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Geometric stiffening of a body that has it.
std::unique_ptr<Term> make_stiffening(const BodyModel& body);

}  // namespace pleuel
