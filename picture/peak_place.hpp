#pragma once

#include <optional>
#include <string>

#include "core/model/model.hpp"

namespace pleuel {

/// Where along a beam something is, 0 … 1, of which a signal says the place in words: "node 2.5, y
/// = …" (elements are counted through all frames of the beam) or "at 0.25 of the length". Nothing
/// for other places and other bodies.
std::optional<double> share_of_place(const Model& model, const std::string& body,
                                     const std::string& place);

}  // namespace pleuel
