#pragma once

#include <string>

#include "sensitivity/sampled_gradients.hpp"

namespace pleuel {

/// Which of the two exact methods is cheaper here, and why: a sentence.
struct MethodChoice {
  ExactMethod method;
  std::string reason;
};

/// How many of the values depend on the motion: an adjoint each.
int values_of_motion(const Analysis& analysis, const std::vector<SampledValue>& values);

/// By the numbers of variables and of values that depend on the motion, and where those do not
/// settle it by the time that both take for a short stretch of the trajectory, with simulating it
/// again where the memory does not hold its states. Direct differentiation, unless the adjoint is
/// clearly faster.
MethodChoice choose_method(Analysis& analysis, const std::vector<SampledValue>& values);

/// Of two measured times [s].
ExactMethod cheaper_method(double direct, double adjoint);

}  // namespace pleuel
