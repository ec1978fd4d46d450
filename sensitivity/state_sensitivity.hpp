#pragma once

#include <Eigen/Core>

namespace pleuel {

/// Derivatives of one instant with respect to the design variables (one column each).
struct StateSensitivity {
  Eigen::MatrixXd q, v, a;  ///< n × variables
  Eigen::MatrixXd w;        ///< of the scheme's algorithmic acceleration, n × variables
  Eigen::MatrixXd lambda;   ///< m × variables
};

}  // namespace pleuel
