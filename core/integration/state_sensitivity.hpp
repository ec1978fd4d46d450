#pragma once

#include <Eigen/Core>

namespace pleuel {

/// With respect to what: the design variables, or anything that acts through the state before only.
enum class DerivativesOf { design, old_state };

/// Derivatives of one instant (one column for each variable).
struct StateSensitivity {
  Eigen::MatrixXd q, v, a;  ///< n × variables
  Eigen::MatrixXd w;        ///< of the scheme's algorithmic acceleration, n × variables
  Eigen::MatrixXd lambda;   ///< m × variables
};

}  // namespace pleuel
