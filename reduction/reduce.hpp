#pragma once

#include <string>
#include <vector>

#include "core/scene/body_constants.hpp"
#include "reduction/model_reader.hpp"

/// From the finite-element model of a solid to the invariants that a mechanism knows it by.
namespace pleuel {

struct ReducedBody {
  InvariantsFile file;
  Eigen::VectorXd frequencies;        ///< of the modes with held interfaces [rad/s]
  double next_frequency = 0.0;        ///< of the first mode that is left out [rad/s]
  double asymmetry = 0.0;             ///< of the mesh about the plane, relative
  double volume = 0.0;                ///< of the mesh [m³]
  Eigen::Vector3d extent;             ///< of the box around it [m]
  std::vector<std::string> findings;  ///< what speaks against the model, in words
};

/// @throws InputError      if the model is not that of an elastic body
/// @throws SimulationError if its equations cannot be solved
ReducedBody reduce(const ReductionModel& model);

}  // namespace pleuel
