#include "core/response/whole_turns.hpp"

#include <cmath>
#include <numbers>

#include "core/base/eager_matrices.hpp"
namespace pleuel {

bool is_counted_angle(const ResponseSettings& response) {
  const auto* turning = response.as<TurningResponse>();
  if (turning != nullptr) return turning->derivative == TimeDerivative::none;
  const auto* motion = response.as<JointMotionResponse>();
  return motion != nullptr && motion->derivative == TimeDerivative::none &&
         motion->coordinate == DrivenCoordinate::angle;
}

void count_turns(Eigen::MatrixXd& history) {
  constexpr double turn = 2.0 * std::numbers::pi;
  double added = 0.0;
  for (Eigen::Index step = 1; step < history.cols(); ++step) {
    const double before = history(0, step - 1);
    history(0, step) += added;
    const double turns = std::round((history(0, step) - before) / turn);
    history(0, step) -= turn * turns;
    added -= turn * turns;
  }
}

}  // namespace pleuel
