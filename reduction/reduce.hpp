#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/body_constants.hpp"
#include "reduction/component_modes.hpp"
#include "reduction/line_stiffening.hpp"

/// From the finite-element model of a solid to the invariants that a mechanism knows it by.
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

struct ReducedBody {
  InvariantsFile file;
  Eigen::VectorXd frequencies;      ///< of the modes with held interfaces [rad/s]
  double next_frequency = 0.0;      ///< of the first mode that is left out [rad/s]
  double asymmetry = 0.0;           ///< of the mesh about the plane, relative
  double volume = 0.0;              ///< of the mesh [m³]
  Eigen::Vector3d extent;           ///< of the box around it [m]
  std::vector<std::string> doubts;  ///< what speaks against the model, in words
};

/// @throws InputError      if the model is not that of an elastic body
/// @throws SimulationError if its equations cannot be solved
ReducedBody reduce(const ReductionModel& model);

/// Reads a model file (docs/reduction.md) and the files that it names.
/// @throws InputError
ReductionModel read_reduction_model(const std::string& path);

}  // namespace pleuel
