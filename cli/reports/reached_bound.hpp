#pragma once

#include "core/scene/problem_file.hpp"

namespace pleuel {

enum class ReachedBound { none, lower, upper, both };

/// The bound at which a variable is, to a millionth of its range, or, where a bound is far away, of
/// that bound and the start; both where they are equal.
ReachedBound reached_bound(const DesignVariable& variable, double value);

/// "lower", "upper", "both", or "" where it is at none.
const char* to_string(ReachedBound reached);

}  // namespace pleuel
