#pragma once

#include <string>
#include <vector>

#include "core/response/analysis.hpp"

namespace pleuel {

/// Something whose gradient is asked for: Σ weight · (channel at step) of a response's history, or a
/// response that is constant in time or an expression (no samples).
struct SampledValue {
  std::size_t response;
  std::vector<Sample> samples;
  /// Of an expression: what takes the place of some of the values that it is made from.
  std::vector<SampledValue> replaced = {};
};

/// All responses of an analysis as such values, in their order.
std::vector<SampledValue> response_values(const Analysis& analysis);

/// The last step that a value depends on; −1 if it does not depend on the motion.
int last_step(const Analysis& analysis, const SampledValue& value);

/// Methods that differentiate the discrete scheme; their gradients agree up to round-off.
enum class ExactMethod {
  direct,  ///< cost grows with the number of variables (direct.hpp)
  adjoint  ///< cost grows with the number of values that depend on the motion (adjoint.hpp)
};

/// "direct", "adjoint".
std::string to_string(ExactMethod method);

/// Gradients of several sampled values by one run, values × variables [SI].
/// @throws SimulationError
Eigen::MatrixXd sampled_gradients(Analysis& analysis, const std::vector<SampledValue>& values,
                                  ExactMethod method);

/// The same where samples are those of what signals observe: they differ where a response has a
/// HistoryMap.
Eigen::MatrixXd observed_gradients(Analysis& analysis, const std::vector<SampledValue>& values,
                                   ExactMethod method);

}  // namespace pleuel
