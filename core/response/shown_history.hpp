#pragma once

#include "core/response/response.hpp"

namespace pleuel {

/// One curve for a history of several channels, such as the places of a stress: the largest of them
/// at each instant; of those that are reduced by their magnitude, the largest magnitude.
/// @param history  channels × instants
Eigen::VectorXd shown_history(const Response& response, const Eigen::MatrixXd& history);

}  // namespace pleuel
