#pragma once

#include <optional>
#include <vector>

#include "studies/pareto_point.hpp"

namespace pleuel {

/// The knee of a front: the point that is furthest from the straight line between the ends, towards
/// what is good in both goals, each divided by its range (Das 1999, Structural Optimization 18,
/// 107–115). With the ends at (0, 1) and (1, 0) that is the largest (1 − u − v)/√2. On either side of
/// it a little more of one goal costs more and more of the other.
///
/// Counted are points within their limits that no other dominates.
/// @param points  in the order of limits, marked by mark_dominated()
/// @returns the index of the point; none where less than three count, or where all are within 5 % of
///          the line: such a front is traded at one price
std::optional<std::size_t> find_knee(const std::vector<ParetoPoint>& points, GoodSide side);

}  // namespace pleuel
