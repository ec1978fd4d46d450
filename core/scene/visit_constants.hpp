#pragma once

#include <cstddef>

#include "core/base/strengths.hpp"

namespace pleuel {

/// Visits the numbers of two sets of constants of the same arrangement, block by block: numbers,
/// small matrices, sparse matrices. What one block adds is visited in all that is done with constants.
template <class First, class Second, class Visit>
void visit_constants(First& a, Second& b, const Visit& visit) {
  visit(a.mass, b.mass);
  visit(a.first_moment, b.first_moment);
  visit(a.second_moment, b.second_moment);
  visit(a.shape, b.shape);
  visit(a.mixed, b.mixed);
  for (std::size_t i = 0; i < a.moments.size(); ++i) visit(a.moments[i], b.moments[i]);
  visit(a.mass_matrix, b.mass_matrix);
  visit(a.stiffness, b.stiffness);
  visit(a.damping, b.damping);
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    visit(a.places[i].position, b.places[i].position);
    visit(a.places[i].displacement, b.places[i].displacement);
    visit(a.places[i].rotation, b.places[i].rotation);
  }
  if (a.stress) {
    for (const auto& [word, member] : strength_members<double>) {
      visit(a.stress->strengths.*member, b.stress->strengths.*member);
    }
    visit(a.stress->of_coordinates, b.stress->of_coordinates);
    visit(a.stress->of_accelerations, b.stress->of_accelerations);
    visit(a.stress->of_stretching, b.stress->of_stretching);
  }
  if (!a.stretching) return;
  visit(a.stretching->damping, b.stretching->damping);
  visit(a.stretching->displacements, b.stretching->displacements);
  for (std::size_t i = 0; i < a.stretching->elements.size(); ++i) {
    visit(a.stretching->elements[i].axial_stiffness, b.stretching->elements[i].axial_stiffness);
    visit(a.stretching->elements[i].slopes, b.stretching->elements[i].slopes);
  }
}

}  // namespace pleuel
