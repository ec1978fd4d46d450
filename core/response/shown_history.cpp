#include "core/response/shown_history.hpp"

namespace pleuel {

Eigen::VectorXd shown_history(const Response& response, const Eigen::MatrixXd& history) {
  if (response.is_fatigue()) {  // over the first of both strengths, which is every other row
    const auto amplitudes = history(Eigen::seqN(0, history.rows() / 2, 2), Eigen::all);
    return amplitudes.cwiseAbs().colwise().maxCoeff().transpose();
  }
  const bool by_magnitude = response.is_reduced_by(OverTime::max_abs) && history.rows() > 1;
  if (by_magnitude) return history.cwiseAbs().colwise().maxCoeff().transpose();
  return history.colwise().maxCoeff().transpose();
}

}  // namespace pleuel
