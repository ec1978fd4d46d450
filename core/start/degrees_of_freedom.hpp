#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// How rigid motion is held: the coordinates of frames and point masses against the constraints
/// that act on them while bodies do not deform.
struct DegreesOfFreedom {
  int coordinates = 0;  ///< of rigid motion
  int constraints = 0;  ///< rows of Φ that are independent for rigid motion
  int blocked = 0;      ///< drives among them that move nothing rigid; see blocked_drives()

  int free() const { return coordinates - constraints; }
};

/// At a state: in a singular position, such as a dead centre, fewer constraints are independent.
/// By a rank-revealing decomposition of Φ_q (core/base/sparse_rows.hpp): for descriptions, not for loops.
DegreesOfFreedom rigid_degrees_of_freedom(const Mechanism& mechanism, const State& state);

/// How many drives joints or other drives hold already: what these move, bodies have to bend for.
/// Counted where the file places the mechanism, if its constraints meet there, else at the state:
/// the rows of Φ_q that drives add to those of joints without being independent of them. Rows that
/// are out of line by less than 1e-4 count as dependent.
/// @param drives  multipliers of drives
int blocked_drives(const Mechanism& mechanism, const State& state, const std::vector<int>& drives);

/// The rigid motions that constraints and drives leave free, as velocities: n × free(), columns
/// orthonormal in coordinates over their scale (which is how they are given). Elastic rows are
/// zero.
Eigen::MatrixXd free_motions(const Mechanism& mechanism, const State& state);

/// A position near by that is no special one: some way along a free motion of no meaning, with the
/// constraints closed by rigid motion. The state itself where that fails.
State generic_position(const Mechanism& mechanism, const State& state);

}  // namespace pleuel
