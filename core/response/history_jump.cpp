#include "core/response/history_jump.hpp"

#include <cmath>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

bool jumps_beside(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, Eigen::Index channel,
                  Eigen::Index step) {
  // Of the change of slope at the instant.
  constexpr double opposite = 0.8, calm = 0.5, hidden = 0.25;
  const Eigen::Index last = time.size() - 1;
  const auto slope = [&](Eigen::Index k) {
    return (values(channel, k) - values(channel, k - 1)) / (time(k) - time(k - 1));
  };
  const auto is_known = [&](Eigen::Index k) { return k >= 1 && k < last; };
  const auto change = [&](Eigen::Index k) { return slope(k + 1) - slope(k); };
  if (!is_known(step)) return false;
  const double here = change(step), size = std::abs(here);
  const auto is_opposite = [&](double sum) {
    return here * sum < 0.0 && std::abs(sum) > opposite * size;
  };
  for (const Eigen::Index side : {-1, 1}) {
    const Eigen::Index one = step + side, two = one + side, three = two + side;
    if (!is_known(one)) continue;
    const bool is_beside_end = step - side == 0 || step - side == last;
    if (is_beside_end && std::abs(change(one)) < hidden * size) return true;
    if (!is_known(two)) continue;
    if (is_opposite(change(one)) && std::abs(change(two)) < calm * size) return true;
    if (!is_known(three)) continue;
    const bool is_calm = std::abs(change(three)) < calm * size;
    if (is_opposite(change(one) + change(two)) && is_calm) return true;
  }
  return false;
}

}  // namespace pleuel
