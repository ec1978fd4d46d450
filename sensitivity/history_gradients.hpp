#pragma once

#include "core/response/analysis.hpp"

namespace pleuel {

/// The history of a response at the place where its value is taken (that of a peak, of several
/// places), with its derivatives at every instant.
struct HistoryGradients {
  std::size_t response;
  int place;                  ///< row of the history
  Eigen::VectorXd values;     ///< one an instant [SI]
  Eigen::MatrixXd gradients;  ///< instants × variables [SI]
};

/// Of all responses that have a history, by one run of direct differentiation.
/// @throws SimulationError
std::vector<HistoryGradients> history_gradients(Analysis& analysis);

/// Derivatives of values and histories by the same run.
struct ResponseDerivatives {
  Eigen::MatrixXd values;  ///< responses × variables [SI]
  std::vector<HistoryGradients> histories;
};

/// @throws SimulationError
ResponseDerivatives response_derivatives(Analysis& analysis);

}  // namespace pleuel
