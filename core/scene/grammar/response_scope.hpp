#pragma once

#include "core/scene/scene.hpp"

namespace pleuel {

/// What responses name, and the end of the simulation [s].
struct ResponseScope {
  const Scene& scene;
  double end_time = 0.0;
};

}  // namespace pleuel
