#pragma once

#include "core/scene/body_constants.hpp"
#include "reduction/interface.hpp"

namespace pleuel {

/// A slender body between two interfaces, in equal parts.
struct StiffeningLine {
  InterfaceSet begin, end;
  int elements = 12;
  double damping = 0.0;  ///< β of the axial force [s]
};

/// Geometric stiffening lumped on the line between two interfaces (docs/invariants.md): its stations are
/// cross-sections, whose mean displacements are those of the nodes around them; κ is the axial stiffness
/// of the part between two stations, N/Δu under an axial force N on the far end. Between stations the
/// slope is constant: Ĝ = (1/l) [1 −1; −1 1] across the line.
/// @param stiffness  of the coordinates, n × n
/// @throws InputError if there are no nodes around a station, or the part does not stretch
Stretching line_stiffening(const StiffeningLine& line, const Eigen::Matrix3Xd& positions,
                           const Eigen::MatrixXd& shape, const Eigen::MatrixXd& stiffness);

}  // namespace pleuel
