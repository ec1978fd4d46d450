#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/base/sparse_rows.hpp"
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
/// zero. Of large parts of a mechanism with many of them some that are generic.
Eigen::MatrixXd free_motions(const Mechanism& mechanism, const State& state);

/// The same of a part of a mechanism while the rest is held.
class FreeMotions {
 public:
  FreeMotions(const Mechanism& mechanism, const State& state);

  /// @param coordinates  of the part
  Eigen::Index count(const std::vector<int>& coordinates) const;
  /// All of them if they are few, else some that are generic: what moves at all, moves in these.
  Eigen::MatrixXd some(const std::vector<int>& coordinates) const;
  /// Those of all rigid motion.
  const std::vector<int>& rigid() const { return rigid_; }

 private:
  SparseRows rows_of(const std::vector<int>& coordinates) const;

  std::vector<int> rigid_;
  Eigen::SparseMatrix<double> jacobian_;  ///< a column a coordinate, also of elastic ones: zero
};

/// A position near by that is no special one: some way along a free motion of no meaning, with the
/// constraints closed by rigid motion. The state itself where that fails.
State generic_position(const Mechanism& mechanism, const State& state);

}  // namespace pleuel
