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

}  // namespace pleuel
