#pragma once

#include <array>

#include "core/frame/body_frame.hpp"

namespace pleuel {

/// Most coordinates that a marker has: frame and elastic ones.
inline constexpr int max_marker_size = 6 + 6;
static_assert(max_marker_size == wide_slots, "tangents of a marker take one group of directions");

/// A place on a body: the frame, and the elastic coordinates that displace and turn it.
struct Marker {
  BodyFrame frame;
  /// Indices in q of the local displacements u v w and rotations θx θy θz; −1 where they are zero.
  std::array<int, 6> elastic = {-1, -1, -1, -1, -1, -1};

  /// Whether it has an elastic rotation.
  bool has_elastic_rotation() const {
    return elastic[3] >= 0 || elastic[4] >= 0 || elastic[5] >= 0;
  }
};

}  // namespace pleuel
