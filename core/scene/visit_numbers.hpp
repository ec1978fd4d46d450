#pragma once

#include <functional>

#include "core/scene/scene.hpp"

/// Every number of a scene that may be bound to a design variable, with what it measures: those of
/// the tables of keys (grammar/tables.hpp), and lists of numbers. Structs with such lists are taken
/// apart by all their members: one that is added does not compile before it is looked at here, where
/// a number that is left out would have no derivatives.
namespace pleuel {

using NumberVisit = std::function<void(const Number&, const Quantity&)>;

void visit_numbers(const Section& section, const NumberVisit& visit);
void visit_numbers(const Material& material, const NumberVisit& visit);
void visit_numbers(const Body& body, const NumberVisit& visit);
void visit_numbers(const Joint& joint, const NumberVisit& visit);
void visit_numbers(const Load& load, const NumberVisit& visit);
void visit_numbers(const Scene& scene, const NumberVisit& visit);

/// @param value  what the function itself measures
void visit_numbers(const TimeFunction& function, const Quantity& value, const NumberVisit& visit);

inline Quantity driven_quantity(DrivenCoordinate coordinate) {
  return coordinate == DrivenCoordinate::angle ? quantities::angle : quantities::length;
}

}  // namespace pleuel
