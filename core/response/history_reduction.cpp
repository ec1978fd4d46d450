#include "core/response/history_reduction.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/fatigue.hpp"

namespace pleuel {

namespace {

Reduction reduce_fatigue(const FatigueRule& rule, const Trajectory& trajectory,
                         const Eigen::MatrixXd& history, const StepRange& range,
                         const BrokenInstants& breaks) {
  const Eigen::VectorXd& time = trajectory.time;
  if (!rule.damage_exponent) return reduce_cycle(rule.criterion, time, history, range, breaks);
  return reduce_damage(rule.criterion, *rule.damage_exponent, time, history, range, breaks,
                       ends_of(range, trajectory));
}

}  // namespace

Eigen::MatrixXd mapped_history(const Response& response, const Eigen::VectorXd& time,
                               Eigen::MatrixXd observed) {
  const auto& map = response.history()->map;
  return map ? map->apply(time, response.steps(time), observed) : std::move(observed);
}

Reduction reduce_history(const Response& response, const Trajectory& trajectory,
                         const Eigen::MatrixXd& history, const BrokenInstants& breaks) {
  const ResponseHistory& how = *response.history();
  const Eigen::VectorXd& time = trajectory.time;
  const StepRange range = response.steps(time);
  if (!how.fatigue) return reduce(how.over_time, time, history, range, breaks, how.among);
  Reduction reduction = reduce_fatigue(*how.fatigue, trajectory, history, range, breaks);
  if (std::isfinite(reduction.value)) return reduction;
  throw SimulationError(
      fmt::format("the response \"{}\" has no finite value: a mean stress reaches the strength "
                  "of the material, beyond which it bears no cycle",
                  response.name));
}

std::vector<Reduction> reduce_history_windows(const Response& response,
                                              const Trajectory& trajectory,
                                              const Eigen::MatrixXd& history, int windows,
                                              const BrokenInstants& breaks) {
  if (response.is_fatigue()) return {reduce_history(response, trajectory, history, breaks)};
  const Eigen::VectorXd& time = trajectory.time;
  return reduce_windows(response.history()->over_time, time, history, windows, response.steps(time),
                        breaks);
}

std::vector<Sample> observed_samples(const Response& response, const Eigen::VectorXd& time,
                                     const std::vector<Sample>& samples) {
  const ResponseHistory* history = response.history();
  if (!history || !history->map || samples.empty()) return samples;
  std::vector<Sample> observed;
  const StepRange range = response.steps(time);
  for (const Sample& sample : samples) history->map->add_observed(time, range, sample, observed);
  return observed;
}

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
