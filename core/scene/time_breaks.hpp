#pragma once

#include <vector>

#include "core/base/expression.hpp"
#include "core/base/time_integration.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// The instants at which something that acts is not smooth [s], in any order: where the value of a
/// load jumps or has a kink, or the acceleration of a drive. They are those of points of laws, and
/// of formulas where what min, max and abs compare depends on time only, so that they are the same
/// for all designs. Points of a table that are closer than four steps count as samples of something
/// smooth, unless their values jump.
std::vector<double> time_breaks(const Scene& scene, const TimeIntegration& integration);

/// The times up to the end at which a law may turn sharply [s], ascending: its points in every
/// period, and kinks of formulas. None of what is a function of the state.
std::vector<double> sharp_times(const TimeFunction& function, double end_time);

/// The times from 0 to the end at which min, max or abs in an expression change sides [s],
/// ascending: what they compare depends on time only, so that the times are those of all designs.
/// Found by `samples` equal steps and bisection: sides that change twice within a step are not seen.
std::vector<double> kinks_in_time(const Expression& expression, double end_time, int samples);

}  // namespace pleuel
