#include "core/response/whole_turns.hpp"

#include <cmath>
#include <numbers>

#include "core/base/eager_matrices.hpp"
#include "core/scene/shown_unit.hpp"

namespace pleuel {

bool is_counted_angle(const ResponseSettings& response) {
  if (response.type == ResponseType::angle) return true;
  ResponseSettings at_an_instant = response;
  at_an_instant.over_time = OverTime::final;
  return response.type == ResponseType::joint_position &&
         quantity_of(at_an_instant) == quantities::angle;
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
