#include "studies/pareto_point.hpp"

#include <algorithm>

namespace pleuel {

Goals goals_of(const ParetoPoint& point, GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  return {point.result.evaluation.objective, sign * point.limited_value};
}

bool ParetoPoint::keeps_limits() const {
  if (result.max_violation > Tolerances().violation) return false;
  return result.status == Status::verified || result.status == Status::unresolved ||
         result.status == Status::stalled;
}

void mark_dominated(std::vector<ParetoPoint>& points, GoodSide side) {
  std::vector<Goals> goals;
  for (const ParetoPoint& point : points) {
    if (point.keeps_limits()) goals.push_back(goals_of(point, side));
  }
  const FrontScale scale(goals);
  for (ParetoPoint& point : points) {
    if (!point.keeps_limits()) continue;
    point.is_dominated = std::any_of(points.begin(), points.end(), [&](const ParetoPoint& other) {
      const Limits limits = other.limit == point.limit ? Limits::same : Limits::different;
      return other.keeps_limits() &&
             scale.dominates(goals_of(other, side), goals_of(point, side), limits);
    });
  }
}

}  // namespace pleuel
