#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reduction/component_modes.hpp"
#include "reduction/line_stiffening.hpp"

/// What a body is reduced from, and to what.
namespace pleuel {

struct StressChoice {
  std::vector<int> nodes;
  int most = 0;  ///< only those that can be largest, so many at most; 0: all
  double strength = 0.0;
};

/// What a model file asks for, in SI units, its files read.
struct ReductionModel {
  std::string body, description;
  SolidMesh mesh;
  SolidMatrices matrices;
  std::vector<InterfaceSet> interfaces;  ///< the first one holds the body frame
  std::vector<InterfaceSet> places;      ///< others that loads act on and responses look at
  ModeCount modes;
  double damping = 0.0;  ///< D = damping · K [s]
  std::optional<StressChoice> stress;
  std::optional<StiffeningLine> stiffening;
  /// Normal (0, 1, 2: x, y, z) of a plane of symmetry through the origin that the motion stays in.
  std::optional<int> plane;
};

/// Reads a model file (docs/reduction.md) and the files that it names.
/// @throws InputError
ReductionModel read_reduction_model(const std::string& path);

}  // namespace pleuel
