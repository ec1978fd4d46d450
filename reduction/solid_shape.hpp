#pragma once

namespace pleuel {

/// Solid finite elements whose shapes are known (element_shape.hpp), by their names in CalculiX.
enum class SolidShape { tetrahedron4, tetrahedron10, hexahedron8, hexahedron20 };

}  // namespace pleuel
