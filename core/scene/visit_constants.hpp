#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/base/strengths.hpp"

/// The blocks of the constants of a body: the only list of them. What one block adds is visited in
/// all that is done with constants.
namespace pleuel {

/// Which indices of a block count elastic coordinates.
enum class ByCoordinates { none, columns, both };

/// A block of numbers: a number, a small matrix, a sparse matrix.
struct ConstantsBlock {
  std::string_view word;  ///< in files
  ByCoordinates indices = ByCoordinates::none;
  bool may_be_missing = false;  ///< in files; of derivatives all may
};

/// In the order of moment_pairs.
inline constexpr std::array<std::string_view, 6> moment_words = {
    "moment_xx", "moment_yy", "moment_zz", "moment_xy", "moment_yz", "moment_xz"};

// Each calls visit(block, numbers...) with the numbers of some objects of the same arrangement.

template <class Visit, class... Constants>
void visit_invariants(const Visit& visit, Constants&... of) {
  using enum ByCoordinates;
  visit(ConstantsBlock{"mass"}, of.mass...);
  visit(ConstantsBlock{"first_moment"}, of.first_moment...);
  visit(ConstantsBlock{"second_moment"}, of.second_moment...);
  visit(ConstantsBlock{"shape", columns}, of.shape...);
  visit(ConstantsBlock{"mixed", columns}, of.mixed...);
  for (std::size_t i = 0; i < moment_words.size(); ++i) {
    visit(ConstantsBlock{moment_words[i], both, true}, of.moments[i]...);
  }
  visit(ConstantsBlock{"mass_matrix", both}, of.mass_matrix...);
  visit(ConstantsBlock{"stiffness", both}, of.stiffness...);
  visit(ConstantsBlock{"damping", both, true}, of.damping...);
}

template <class Visit, class... Places>
void visit_place(const Visit& visit, Places&... of) {
  visit(ConstantsBlock{"position"}, of.position...);
  visit(ConstantsBlock{"displacement", ByCoordinates::columns, true}, of.displacement...);
  visit(ConstantsBlock{"rotation", ByCoordinates::columns, true}, of.rotation...);
}

template <class Visit, class... Recoveries>
void visit_stress(const Visit& visit, Recoveries&... of) {
  for (const auto& [word, member] : strength_members<double>) {
    visit(ConstantsBlock{word, ByCoordinates::none, true}, (of.strengths.*member)...);
  }
  visit(ConstantsBlock{"of_coordinates", ByCoordinates::columns, true}, of.of_coordinates...);
  visit(ConstantsBlock{"of_accelerations", ByCoordinates::none, true}, of.of_accelerations...);
  visit(ConstantsBlock{"of_stretching", ByCoordinates::none, true}, of.of_stretching...);
}

template <class Visit, class... Stretchings>
void visit_stretching(const Visit& visit, Stretchings&... of) {
  visit(ConstantsBlock{"damping", ByCoordinates::none, true}, of.damping...);
  visit(ConstantsBlock{"displacements", ByCoordinates::columns}, of.displacements...);
}

template <class Visit, class... Elements>
void visit_element(const Visit& visit, Elements&... of) {
  visit(ConstantsBlock{"axial_stiffness"}, of.axial_stiffness...);
  visit(ConstantsBlock{"slopes"}, of.slopes...);
}

/// All of them.
template <class Visit, class First, class... Others>
void visit_constants(const Visit& visit, First& first, Others&... others) {
  visit_invariants(visit, first, others...);
  for (std::size_t i = 0; i < first.places.size(); ++i) {
    visit_place(visit, first.places[i], others.places[i]...);
  }
  if (first.stress) visit_stress(visit, *first.stress, *others.stress...);
  if (!first.stretching) return;
  visit_stretching(visit, *first.stretching, *others.stretching...);
  for (std::size_t i = 0; i < first.stretching->elements.size(); ++i) {
    visit_element(visit, first.stretching->elements[i], others.stretching->elements[i]...);
  }
}

}  // namespace pleuel
