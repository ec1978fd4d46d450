#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/strengths.hpp"
#include "reduction/component_modes.hpp"
#include "reduction/line_stiffening.hpp"

/// What a body is reduced from, and to what.
namespace pleuel {

struct NodeGroup {
  std::string name;  ///< that responses give it; empty: none
  std::vector<int> nodes;
};

struct StressChoice {
  std::vector<NodeGroup> groups;
  int most = 0;  ///< of each only those that can be largest, so many at most; 0: all
  Strengths<double> strengths;
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
  int surface = 0;  ///< points of it at most, for pictures; 0: none
  /// Normal (0, 1, 2: x, y, z) of a plane of symmetry through the origin that the motion stays in.
  std::optional<int> plane;
};

/// Reads a model file (docs/reduction.md) and the files that it names.
/// @throws InputError
ReductionModel read_reduction_model(const std::string& path);

}  // namespace pleuel
