#include "studies/pareto_knee.hpp"

#include <numbers>

namespace pleuel {

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
