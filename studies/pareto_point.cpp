#include "studies/pareto_point.hpp"

#include <algorithm>
#include <numbers>

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

namespace {

constexpr double straight = 0.05;  ///< distance from the line, both goals over their ranges

}  // namespace

std::optional<std::size_t> find_knee(const std::vector<ParetoPoint>& points, GoodSide side) {
  std::vector<std::size_t> counted;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].keeps_limits() && !points[i].is_dominated) counted.push_back(i);
  }
  if (counted.size() < 3) return std::nullopt;
  std::vector<Goals> goals;
  for (const std::size_t i : counted) goals.push_back(goals_of(points[i], side));
  const FrontScale scale(goals);
  if (!scale.is_traded()) return std::nullopt;
  std::optional<std::size_t> knee;
  double furthest = straight;
  for (std::size_t k = 0; k < counted.size(); ++k) {
    // 0 at the end where a goal is small, 1 at the other.
    const double u = (goals[k][0] - scale.objective().low) * scale.objective().per_range();
    const double v = (goals[k][1] - scale.limited().low) * scale.limited().per_range();
    const double distance = (1.0 - u - v) / std::numbers::sqrt2;
    if (distance <= furthest) continue;
    furthest = distance;
    knee = counted[k];
  }
  return knee;
}

}  // namespace pleuel
