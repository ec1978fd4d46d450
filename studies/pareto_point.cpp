#include "studies/pareto_point.hpp"

#include <algorithm>
#include <cmath>

#include "studies/front_ends.hpp"

namespace pleuel {

namespace {

bool dominates(const ParetoPoint& one, const ParetoPoint& other, GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  const double gain = other.result.evaluation.objective - one.result.evaluation.objective;
  const double limited_gain = sign * (other.limited_value - one.limited_value);
  const double least = optimum_resolution * std::abs(one.result.evaluation.objective);
  const double least_limited = optimum_resolution * std::abs(one.limited_value);
  return gain >= -least && limited_gain >= -least_limited &&
         (gain > least || limited_gain > least_limited);
}

}  // namespace

bool ParetoPoint::keeps_limits() const {
  if (result.max_violation > Tolerances().violation) return false;
  return result.status == Status::verified || result.status == Status::unresolved ||
         result.status == Status::stalled;
}

void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side) {
  for (ParetoPoint& point : points) {
    if (!point.keeps_limits()) continue;
    point.is_dominated = std::any_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
      return other.keeps_limits() && dominates(other, point, side);
    });
  }
}

}  // namespace pleuel
