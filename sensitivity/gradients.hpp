#pragma once

#include <string>
#include <vector>

#include "core/response/response.hpp"

namespace pleuel {

enum class GradientMethod { direct, forward_difference, central_difference };

/// "direct", "forward-difference", "central-difference".
std::string to_string(GradientMethod method);

/// @throws InputError for an unknown name; the message lists the names there are.
GradientMethod gradient_method(const std::string& name);

struct GradientOptions {
  /// Relative step of finite differences, Δx = step · |x|.
  double difference_step = 1e-5;
};

/// Gradients of all responses, responses × variables; unit of entry (i, j) = unit of response i /
/// unit of variable j [SI].
/// @param analysis  of the problem at x
/// @throws SimulationError
Eigen::MatrixXd gradients(const ProblemFile& problem, const Eigen::VectorXd& x, Analysis& analysis,
                          GradientMethod method, const GradientOptions& options = {});

/// By direct differentiation, from the analysis alone.
Eigen::MatrixXd direct_gradients(Analysis& analysis);

/// Something whose gradient is asked for: Σ weight · (channel at step) of a response's signal, or a
/// response that is constant in time (no samples).
struct SampledValue {
  std::size_t response;
  std::vector<Sample> samples;
};

/// Gradients of several sampled values by one run of direct differentiation, values × variables.
Eigen::MatrixXd direct_gradients(Analysis& analysis, const std::vector<SampledValue>& values);

}  // namespace pleuel
