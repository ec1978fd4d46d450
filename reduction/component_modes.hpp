#pragma once

#include <string>
#include <vector>

#include "reduction/interface.hpp"

namespace pleuel {

/// Which modes of the body with all its interfaces held are coordinates.
struct ModeCount {
  int number = 0;          ///< the lowest ones
  double frequency = 0.0;  ///< if positive instead: all below it [rad/s]
  int generations = 0;     ///< if positive instead: no modes, but so many of inertia_responses()
};

/// Displacements of all nodes per coordinate: u = shape q.
struct ComponentModes {
  Eigen::MatrixXd shape;           ///< 3 nodes × n
  std::vector<std::string> names;  ///< of the coordinates
  Eigen::VectorXd frequencies;     ///< of the modes with held interfaces [rad/s]
  double next_frequency = 0.0;     ///< of the first mode that is left out [rad/s]
};

/// Craig & Bampton 1968: what the body does statically when an interface moves by one of its six
/// coordinates and all others are held, and the lowest modes with all of them held, which are scaled to a
/// modal mass of one. The first interface is clamped: the body frame moves with it.
///
/// Rigid interfaces are eliminated, u = T [q_rigid; u_free]; the mean motion of others is prescribed by
/// Lagrange multipliers: [K_ff Aᵀ; A 0].
///
/// @throws InputError if interfaces share nodes, or a part of the body can move though all are held
ComponentModes component_modes(const SolidMatrices& matrices, const Eigen::Matrix3Xd& positions,
                               const std::vector<InterfaceSet>& interfaces, const ModeCount& modes);

}  // namespace pleuel
