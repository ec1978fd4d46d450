#pragma once

#include "core/response/response.hpp"

namespace pleuel {

/// Gradients by simulating anew, responses × variables; Δx_j = step · |x_j| (step itself where
/// x_j = 0).
Eigen::MatrixXd forward_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    const Analysis& at_x, double step);
Eigen::MatrixXd central_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    double step);

}  // namespace pleuel
