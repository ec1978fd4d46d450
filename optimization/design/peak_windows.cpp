#include "optimization/design/peak_windows.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/response/value_over_cases.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"
#include "optimization/design/peak_rows.hpp"
#include "sensitivity/finite_difference.hpp"
#include "sensitivity/kinks.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// Peaks further below the highest do not decide.
constexpr double near_the_highest = 1e-2;

/// The two heights of each tie within a window at one place, one after the other.
void add_ties(const Analysis& analysis, const ProblemFile& file, std::size_t response, int windows,
              std::vector<SampledValue>& values) {
  const PeakDivision division{windows, place_count(file, file.responses[response])};
  const std::vector<Reduction> peaks = divided_peaks(analysis, file, response, division);
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

bool have_kinks(const DesignProblem& design, std::size_t load_case, Analysis& analysis,
                int windows) {
  const ProblemFile& file = design.load_case(load_case).file();
  std::vector<SampledValue> values;
  for (const std::size_t response : optimized_responses(design, load_case)) {
    if (has_peaks(file.responses[response])) {
      add_ties(analysis, file, response, windows, values);
    }
  }
  if (values.empty()) return false;
  const Eigen::MatrixXd gradients =
      sampled_gradients(analysis, values, choose_method(analysis, values).method);
  const Eigen::VectorXd scales = step_scales(file.variables, analysis.x);
  for (Eigen::Index row = 0; row < gradients.rows(); row += 2) {
    const double difference =
        gradient_difference(gradients.row(row), gradients.row(row + 1), scales);
    if (difference > least_kink) return true;
  }
  return false;
}

}  // namespace

int windows_that_part_peaks(DesignProblem& problem, const Eigen::VectorXd& x, int fewest,
                            int most) {
  try {
    int windows = fewest;
    for (std::size_t c = 0; c < problem.case_count(); ++c) {
      Analysis& analysis = problem.load_case(c).analysis_at(x);
      while (windows < most && have_kinks(problem, c, analysis, windows)) windows *= 2;
    }
    return windows;
  } catch (const SimulationError&) {
    return fewest;
  }
}

std::vector<std::size_t> optimized_responses(const DesignProblem& design, std::size_t load_case) {
  const DesignCase& one = design.load_case(load_case);
  const ProblemFile& file = design.file();
  std::vector<std::size_t> responses;
  const auto add = [&](std::size_t response) {
    for (const std::size_t part : parts_of(one.file(), response)) responses.push_back(part);
  };
  const auto add_over_cases = [&](std::size_t response) {
    for (const std::size_t part : parts_in_cases(file, response)) {
      const OfCase of_case = case_of_response(file, part);
      if (of_case.load_case == load_case) add(of_case.index);
    }
  };
  if (one.has_objective()) {
    add(*one.response_of({}));
  } else {
    add_over_cases(design.objective_response());
  }
  for (std::size_t i = 0; i < one.file().constraints.size(); ++i) {
    if (const auto response = one.response_of({i})) add(*response);
  }
  for (std::size_t i = 0; i < file.constraints.size(); ++i) {
    if (is_of_several(case_of_constraint(file, i))) add_over_cases(*design.response_of(i));
  }
  return responses;
}

}  // namespace pleuel
