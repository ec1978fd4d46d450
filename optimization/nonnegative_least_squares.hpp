#pragma once

#include <Eigen/Core>

namespace pleuel {

/// argmin ‖A z − b‖₂ over z ≥ 0 by the active-set method of Lawson & Hanson 1974, ch. 23. Columns
/// may be dependent or zero; their lengths do not matter.
/// @param matrix  A, rows × unknowns.
/// @param right   b, size = rows.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& matrix,
                                          const Eigen::VectorXd& right);

}  // namespace pleuel
