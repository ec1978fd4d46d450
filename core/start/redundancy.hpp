#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mechanism/mechanism.hpp"

namespace pleuel {

/// Misalignment of joints [rad, or of the mechanism's size] below which they count as aligned: far
/// below what anybody means by the numbers of a file, far above their round-off.
inline constexpr double alignment_tolerance = 1e-6;

/// Constraints that follow from the others wherever the mechanism can go, as in a planar loop of
/// spatial revolutes. Candidates are the rows of Φ_q that a rank-revealing factorisation leaves over at
/// the guess (core/base/sparse_rows.hpp; pivots up to the alignment tolerance); they are
/// redundant if they still hold, up to the tolerance, after a small motion in which only the others
/// are kept. So a position in which the mechanism is merely singular is told from redundancy. What
/// drives hold altogether is moved without them, too: a drive that starts from rest moves nothing,
/// and hides joints that are out of line. The guess has to meet the constraints.
/// @param drives  multipliers of drives
/// @returns indices of multipliers, ascending
std::vector<int> redundant_constraints(Mechanism& mechanism, const std::vector<int>& drives = {});

/// A constraint that would follow from others if joints were aligned exactly.
struct NearRedundancy {
  int constraint = 0;         ///< index of its multiplier
  std::vector<int> others;    ///< those from which it nearly follows
  double misalignment = 0.0;  ///< by which it opens with the motion that it blocks [rad, –]
  Eigen::VectorXd motion;     ///< that motion: what the others leave of the row, of length one (n)
};

/// Constraints that are kept, but block a motion only because joints are slightly out of line: they
/// open with the motion that the others leave by the misalignment, in proportion. (In a position
/// that is nearly singular they open with its square.) Elastic coordinates count with the
/// mechanism's size: bodies that yield are not locked. Drives are let go.
/// @param drives   multipliers of drives
/// @param largest  misalignment that is looked for
std::vector<NearRedundancy> nearly_redundant_constraints(const Mechanism& mechanism,
                                                         const State& state,
                                                         const std::vector<int>& drives,
                                                         double largest);

}  // namespace pleuel
