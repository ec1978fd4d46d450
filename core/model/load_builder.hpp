#pragma once

#include <memory>

#include "core/model/attachment.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// A load or force element of the scene as a term of the system.
/// @param coordinates  of the whole system
std::unique_ptr<Term> make_load_term(const Load& load, const std::vector<BodyModel>& bodies,
                                     const BuildContext& context, int coordinates);

}  // namespace pleuel
