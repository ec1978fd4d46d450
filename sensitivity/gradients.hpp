#pragma once

#include <string>
#include <vector>

#include "sensitivity/sampled_gradients.hpp"

namespace pleuel {

enum class GradientMethod {
  automatic,  ///< direct or adjoint, whichever is cheaper (method_choice.hpp)
  direct,
  adjoint,
  forward_difference,
  central_difference
};

/// "auto", "direct", "adjoint", "forward-difference", "central-difference".
std::string to_string(GradientMethod method);

/// @throws InputError for an unknown name; the message lists the names there are.
GradientMethod gradient_method(const std::string& name);

struct GradientOptions {
  /// Relative step of finite differences, Δx = step · |x|.
  double difference_step = 1e-5;
  /// Simulations at a time, of finite differences.
  int threads = 1;
};

/// Gradients of all responses, responses × variables; unit of entry (i, j) = unit of response i /
/// unit of variable j [SI].
/// @param analysis  of the problem at x
/// @throws SimulationError
Eigen::MatrixXd gradients(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
                          GradientMethod method, const GradientOptions& options = {});

/// Those of all responses by direct differentiation, from the analysis alone.
Eigen::MatrixXd direct_gradients(Analysis& analysis);

}  // namespace pleuel
