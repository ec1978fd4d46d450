#include "core/base/diameter.hpp"

#include <algorithm>
#include <utility>

namespace pleuel {

double diameter(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 2) return 0.0;
  Eigen::Vector3d lower = points.front(), upper = points.front();
  for (const Eigen::Vector3d& point : points) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  const Eigen::Vector3d middle = 0.5 * (lower + upper);
  std::vector<std::pair<double, const Eigen::Vector3d*>> outwards;
  for (const Eigen::Vector3d& point : points) {
    outwards.emplace_back((point - middle).norm(), &point);
  }
  std::ranges::sort(outwards,
                    [](const auto& one, const auto& other) { return one.first > other.first; });
  // A pair at distances r and s from the middle is at most r + s apart; beyond rounding.
  constexpr double rounding = 1.0 + 1e-12;
  double largest = 0.0;
  for (std::size_t i = 0; i < outwards.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if ((outwards[i].first + outwards[k].first) * rounding < largest) break;
      largest = std::max(largest, (*outwards[i].second - *outwards[k].second).norm());
    }
    if ((outwards[i].first + outwards.front().first) * rounding < largest) break;
  }
  return largest;
}

}  // namespace pleuel
