#pragma once

#include <array>

#include "core/frame/body_frame.hpp"

namespace pleuel {

/// A place on a body: the frame, and the elastic coordinates that displace and turn it.
struct Marker {
  BodyFrame frame;
  /// Indices in q of the local displacements u v w and rotations θx θy θz; −1 where they are zero.
  std::array<int, 6> elastic = {-1, -1, -1, -1, -1, -1};
};

}  // namespace pleuel
