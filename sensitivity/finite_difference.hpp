#pragma once

#include "core/response/response.hpp"

namespace pleuel {

/// Gradients by simulating anew, responses × variables; Δx_j = step · |x_j| (step itself where
/// x_j = 0). So many simulations at a time as there are threads.
Eigen::MatrixXd forward_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    const Analysis& at_x, double step, int threads = 1);
Eigen::MatrixXd central_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    double step, int threads = 1);

}  // namespace pleuel
