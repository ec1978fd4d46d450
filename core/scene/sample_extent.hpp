#pragma once

#include "core/scene/problem_file.hpp"

namespace pleuel {

/// No sample of an uncertain parameter is farther from its value than this: six deviations of a
/// normal distribution, the interval of a uniform one.
inline double sample_extent(const UncertainParameter& parameter) {
  return parameter.interval > 0.0 ? parameter.interval : 6.0 * parameter.deviation;
}

}  // namespace pleuel
