#include "core/response/shown_history.hpp"

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// Whether the number is made from the side with the larger magnitude.
bool is_signed_largest(const Response& response) {
  return response.history()->among == AmongChannels::largest_magnitude &&
         !response.is_peak_over_time();
}

Eigen::VectorXd largest_magnitudes(const Eigen::MatrixXd& history) {
  Eigen::VectorXd shown(history.cols());
  for (Eigen::Index i = 0; i < history.cols(); ++i) {
    Eigen::Index channel = 0;
    history.col(i).cwiseAbs().maxCoeff(&channel);
    shown(i) = history(channel, i);
  }
  return shown;
}

}  // namespace

Eigen::VectorXd shown_history(const Response& response, const Eigen::MatrixXd& history) {
  if (response.is_fatigue()) {  // over the first of both strengths, which is every other row
    const auto amplitudes = history(Eigen::seqN(0, history.rows() / 2, 2), Eigen::all);
    return amplitudes.cwiseAbs().colwise().maxCoeff().transpose();
  }
  if (is_signed_largest(response) && history.rows() > 1) return largest_magnitudes(history);
  const bool by_magnitude = response.is_reduced_by(OverTime::max_abs) && history.rows() > 1;
  if (by_magnitude) return history.cwiseAbs().colwise().maxCoeff().transpose();
  return history.colwise().maxCoeff().transpose();
}

}  // namespace pleuel
