#pragma once

#include <functional>

#include "core/response/analysis.hpp"

namespace pleuel {

/// Numbers that are made from an analysis, by default the values of all responses; called from
/// several threads.
using ValuesOf = std::function<Eigen::VectorXd(const Analysis&)>;

/// Gradients by simulating anew, numbers × variables; Δx_j = step · |x_j| (step itself where
/// x_j = 0). So many simulations at a time as there are threads.
Eigen::MatrixXd forward_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    const Analysis& at_x, double step, int threads = 1,
                                    const ValuesOf& values = values_of);
Eigen::MatrixXd central_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    double step, int threads = 1,
                                    const ValuesOf& values = values_of);

}  // namespace pleuel
