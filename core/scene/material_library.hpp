#pragma once

#include <vector>

#include "core/scene/scene.hpp"

namespace pleuel {

/// Materials that a problem file can name without declaring them: elastic constants and densities
/// at room temperature, and the strength that the standard or the data sheet guarantees (yield or
/// 0.2 % proof stress). A material of the same name in the file takes precedence.
std::vector<Material> material_library();

}  // namespace pleuel
