#pragma once

#include <functional>
#include <vector>

#include "core/response/response.hpp"

namespace pleuel {

/// How direct differentiation and central differences agree for one response.
struct DerivativeCheck {
  double error =
      0.0;  ///< the smallest over all steps, relative: see gradient_error() of relative_error.hpp
  double step = 0.0;  ///< relative step of the differences where that was
};

/// Compares direct_gradients() with central differences of several steps; stops as soon as all
/// responses agree to 1e-8.
/// @param see_step  called before the differences of a step are computed
std::vector<DerivativeCheck> check_derivatives(const ProblemFile& problem, const Eigen::VectorXd& x,
                                               Analysis& analysis,
                                               const std::function<void(double step)>& see_step);

}  // namespace pleuel
