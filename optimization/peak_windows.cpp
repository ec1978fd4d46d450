#include "optimization/peak_windows.hpp"

#include <algorithm>
#include <cmath>

#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// Peaks further below the highest do not decide.
constexpr double near_the_highest = 1e-2;
/// Gradients that differ by less move alike.
constexpr double alike = 1e-2;

/// The two heights of each tie within a window, one after the other.
void add_ties(const Analysis& analysis, std::size_t response, int windows,
              std::vector<SampledValue>& values) {
  const std::vector<Reduction> peaks = peaks_of_windows(analysis, response, windows);
  const double highest = analysis.reductions[response].value;
  for (const Reduction& peak : peaks) {
    if (std::abs(peak.value - highest) > near_the_highest * std::abs(highest)) continue;
    for (const PeakTie& tie : peak.ties) {
      if (tie.time == tie.other_time) continue;
      values.push_back({response, peak.samples});
      values.push_back({response, tie.other_samples});
    }
  }
}

bool have_kinks(const DesignProblem& problem, Analysis& analysis, int windows) {
  std::vector<SampledValue> values;
  for (const std::size_t response : optimized_responses(problem)) {
    if (has_peaks(problem.file().responses[response])) {
      add_ties(analysis, response, windows, values);
    }
  }
  if (values.empty()) return false;
  const Eigen::MatrixXd gradients =
      sampled_gradients(analysis, values, choose_method(analysis, values).method);
  for (Eigen::Index row = 0; row < gradients.rows(); row += 2) {
    const double difference = (gradients.row(row + 1) - gradients.row(row)).norm();
    if (difference > alike * gradients.row(row).norm()) return true;
  }
  return false;
}

}  // namespace

bool has_peaks(const ResponseSettings& response) {
  const bool is_constant =
      response.type == ResponseType::mass || response.type == ResponseType::frequency;
  return !is_constant && is_peak(response.over_time);
}

std::vector<Reduction> peaks_of_windows(const Analysis& analysis, std::size_t response,
                                        int windows) {
  const Response& observed = analysis.responses[response];
  const Eigen::VectorXd& time = analysis.trajectory.time;
  return reduce_windows(observed.history()->over_time, time, analysis.histories[response], windows,
                        observed.steps(time), analysis.breaks);
}

int windows_that_part_peaks(DesignProblem& problem, const Eigen::VectorXd& x, int fewest,
                            int most) {
  try {
    Analysis& analysis = problem.analysis_at(x);
    int windows = fewest;
    while (windows < most && have_kinks(problem, analysis, windows)) windows *= 2;
    return windows;
  } catch (const SimulationError&) {
    return fewest;
  }
}

std::vector<std::size_t> optimized_responses(const DesignProblem& problem) {
  std::vector<std::size_t> responses = {*problem.response_of({})};
  for (std::size_t i = 0; i < problem.constraints().size(); ++i) {
    if (const auto response = problem.response_of({i, std::nullopt})) {
      responses.push_back(*response);
    }
  }
  return responses;
}

}  // namespace pleuel
