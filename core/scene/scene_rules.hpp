#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/scene/scene.hpp"

/// What formulas of a scene must keep at every design.
namespace pleuel {

/// What makes a scene impossible at a design that its variables' bounds allow: `/scene/bodies/rod/
/// section/width must be positive [m], is -0.003` of a formula that leaves its range (beyond a
/// millionth of its value at the start), or `/scene/loads/tip/at must stay at the share 1 of …` of
/// points that are formulas and leave the body that they belong to.
/// @param start  decides at which share of a beam a point is
std::optional<std::string> find_impossible(const Scene& scene, const Design<double>& start,
                                           const Design<double>& design);

/// Why nobody knows what a variable changes, as the end of a sentence that begins with its name: a
/// point of an elastic beam, between its ends, would move along it, where the model keeps its share
/// of the length. Bounds refuse such variables where they are free; this is asked where one with
/// equal bounds scatters, is priced, or is differentiated.
/// @param change  of the variable, that any tolerance of places tells from rounding; 0: some
std::optional<std::string> find_point_moved_along(const Scene& scene, const Design<double>& start,
                                                  std::size_t variable, double change = 0.0);

}  // namespace pleuel
