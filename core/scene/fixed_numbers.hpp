#pragma once

#include "core/scene/scene.hpp"

namespace pleuel {

/// The scene with every number as it is at a design: nothing of it depends on the variables any more, so
/// that a model of it has no derivatives.
Scene with_fixed_numbers(Scene scene, const Design<double>& design);

}  // namespace pleuel
