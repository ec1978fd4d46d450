#pragma once

#include <vector>

#include "core/base/expression.hpp"

namespace pleuel {

/// The times from 0 to the end at which min, max or abs in an expression change sides [s],
/// ascending: what they compare depends on time only, so that the times are those of all designs.
/// Found by `samples` equal steps and bisection: sides that change twice within a step are not seen.
std::vector<double> kinks_in_time(const Expression& expression, double end_time, int samples);

}  // namespace pleuel
