#include "core/response/history_jump.hpp"

#include <cmath>

namespace pleuel {

bool jumps_beside(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, Eigen::Index channel,
                  Eigen::Index step) {
  constexpr double opposite = 0.8;  // of the change of slope at the instant
  constexpr double little = 0.25;   // of it is left beside a jump that an end of the history hides
  const Eigen::Index last = time.size() - 1;
  const auto slope = [&](Eigen::Index k) {
    return (values(channel, k) - values(channel, k - 1)) / (time(k) - time(k - 1));
  };
  const auto change = [&](Eigen::Index k) {
    return k < 1 || k >= last ? 0.0 : slope(k + 1) - slope(k);
  };
  const double here = change(step), least = opposite * std::abs(here);
  const auto is_opposite = [&](double sum) { return here * sum < 0.0 && std::abs(sum) > least; };
  for (const Eigen::Index side : {-1, 1}) {
    const double next = change(step + side);
    const bool is_beside_end = step - side == 0 || step - side == last;
    const bool is_known = step + side >= 1 && step + side < last;
    if (is_beside_end && is_known && std::abs(next) < little * std::abs(here)) return true;
    if (is_opposite(next) || is_opposite(next + change(step + 2 * side))) return true;
  }
  return false;
}

}  // namespace pleuel
