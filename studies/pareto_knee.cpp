#include "studies/pareto_knee.hpp"

#include <cmath>
#include <numbers>

namespace pleuel {

namespace {

constexpr double straight = 0.05;  ///< distance from the line, both goals over their ranges

/// Both goals so that small is good.
struct Goals {
  double objective, limited;
};

Goals goals_of(const ParetoPoint& point, GoodSide side) {
  const double sign = side == GoodSide::low ? 1.0 : -1.0;
  return {point.result.evaluation.objective, sign * point.limited_value};
}

}  // namespace

std::optional<std::size_t> find_knee(const std::vector<ParetoPoint>& points, GoodSide side) {
  std::vector<std::size_t> counted;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].keeps_limits() && !points[i].is_dominated) counted.push_back(i);
  }
  if (counted.size() < 3) return std::nullopt;
  const Goals first = goals_of(points[counted.front()], side);
  const Goals last = goals_of(points[counted.back()], side);
  const double objectives = last.objective - first.objective;
  const double limits = last.limited - first.limited;
  if (objectives * limits >= 0.0) return std::nullopt;  // nothing is traded
  std::optional<std::size_t> knee;
  double furthest = straight;
  for (const std::size_t i : counted) {
    const Goals at = goals_of(points[i], side);
    // 0 at the end where a goal is small, 1 at the other.
    const double u =
        (at.objective - std::min(first.objective, last.objective)) / std::abs(objectives);
    const double v = (at.limited - std::min(first.limited, last.limited)) / std::abs(limits);
    const double distance = (1.0 - u - v) / std::numbers::sqrt2;
    if (distance <= furthest) continue;
    furthest = distance;
    knee = i;
  }
  return knee;
}

}  // namespace pleuel
