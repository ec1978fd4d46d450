#pragma once

#include <functional>

#include "core/response/analysis.hpp"

namespace pleuel {

/// Numbers that are made from an analysis, by default the values of all responses; called from
/// several threads.
using ValuesOf = std::function<Eigen::VectorXd(const Analysis&)>;

/// What steps of a variable are relative to: |x|, but at least a hundredth of the range between its
/// bounds, since a value near 0 says nothing of how far it may go. 1 if it is fixed at 0.
double step_scale(const DesignVariable& variable, double x);
Eigen::VectorXd step_scales(const std::vector<DesignVariable>& variables, const Eigen::VectorXd& x);

/// Gradients by simulating anew, numbers × variables; Δx_j = step · step_scale(). So many
/// simulations at a time as there are threads.
Eigen::MatrixXd forward_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    const Analysis& at_x, double step, int threads = 1,
                                    const ValuesOf& values = values_of);
Eigen::MatrixXd central_differences(const ProblemFile& problem, const Eigen::VectorXd& x,
                                    double step, int threads = 1,
                                    const ValuesOf& values = values_of);

}  // namespace pleuel
