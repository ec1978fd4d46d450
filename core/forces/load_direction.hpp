#pragma once

namespace pleuel {

/// What the direction of a force or torque is attached to.
enum class LoadDirection {
  space,  ///< keeps its global direction
  body    ///< follows the marker: frame and elastic rotation
};

}  // namespace pleuel
