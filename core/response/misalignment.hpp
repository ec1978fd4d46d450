#pragma once

#include <string>
#include <vector>

#include "core/model/model.hpp"

namespace pleuel {

/// Joints that hold the same motion almost twice.
struct Misalignment {
  std::vector<std::string> joints;  ///< their names, in the order of the file
  std::vector<std::string> bodies;  ///< that the blocked motion would move
  double size = 0.0;                ///< [rad], or of the mechanism's size

  /// "the joints … are out of line by …": what, where and what to do about it.
  std::string text() const;
};

/// By nearly_redundant_constraints(); one entry for each set of joints, the smallest misalignment.
std::vector<Misalignment> find_misalignments(const Model& model, const State& state,
                                             double largest);

}  // namespace pleuel
