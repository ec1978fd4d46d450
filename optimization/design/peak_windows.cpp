#include "optimization/design/peak_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/error.hpp"
#include "core/response/body_frequency.hpp"
#include "core/response/peak_place.hpp"
#include "core/response/value_over_cases.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/response_parts.hpp"
#include "optimization/design/peak_rows.hpp"
#include "optimization/linear_choice.hpp"
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
      Analysis& analysis = problem.load_case(c).analysis_at(x, Request::values_and_gradients);
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
    if (const auto response = one.response_of({.constraint = i})) add(*response);
  }
  for (std::size_t i = 0; i < file.constraints.size(); ++i) {
    if (is_of_several(case_of_constraint(file, i))) add_over_cases(*design.response_of(i));
  }
  return responses;
}

namespace {

/// Relative difference of frequencies that meet, as far as a search that stalls comes to the kink.
constexpr double meeting = 1e-3;

/// The natural frequency of a mode of what a response looks at [rad/s]; none if there is no such
/// mode.
std::optional<double> frequency_of_mode(const Analysis& analysis, const ModeResponse& response,
                                        int number) {
  if (number < 0) return std::nullopt;
  if (response.body.empty()) {
    const Eigen::VectorXd& all = analysis.mechanism_frequencies;
    return number < all.size() ? std::optional(all(number)) : std::nullopt;
  }
  const Model& model = model_of_modes(analysis);
  const BodyModel& body = model.body(response.body);
  if (number >= body.elastic_size()) return std::nullopt;
  return std::sqrt(body_mode(body, {number}).square);
}

bool meets_another(const Analysis& analysis, const ResponseSettings& response) {
  const auto* one = response.as<ModeResponse>();
  if (one == nullptr || one->mode.counts_damping() || one->mode.axis) return false;
  const double shown = *frequency_of_mode(analysis, *one, one->mode.number);
  return std::ranges::any_of(std::array{-1, 1}, [&](int step) {
    const auto other = frequency_of_mode(analysis, *one, one->mode.number + step);
    return other && std::abs(*other - shown) <= meeting * std::abs(shown);
  });
}

}  // namespace

std::string tying_peaks(DesignProblem& design, const Eigen::VectorXd& x) {
  std::vector<std::string> texts;
  try {
    for (std::size_t c = 0; c < design.case_count(); ++c) {
      DesignCase& one = design.load_case(c);
      const std::vector<std::size_t> optimized = optimized_responses(design, c);
      Analysis& analysis = one.analysis_at(x, Request::values_and_gradients);
      std::optional<std::size_t> told;
      for (const Kink& kink : find_kinks(analysis, one.file().variables)) {
        if (kink.response == told || std::ranges::count(optimized, kink.response) == 0) continue;
        told = kink.response;
        const std::size_t joined = joined_response(design.file(), {c, kink.response});
        texts.push_back(fmt::format(
            "{} ({}; gradients differ by {:.3g} %)", design.file().responses[joined].name,
            describe_tie(kink.tie, analysis.responses[kink.response]), 100.0 * kink.difference));
      }
    }
  } catch (const SimulationError&) {
    return "";
  }
  return texts.empty() ? "" : fmt::format("two peaks tie in {}", fmt::join(texts, " and in "));
}

std::string advise_on_meeting_frequencies(DesignProblem& design, const Eigen::VectorXd& x) {
  std::vector<std::string> names;
  try {
    for (std::size_t c = 0; c < design.case_count(); ++c) {
      DesignCase& one = design.load_case(c);
      for (const std::size_t response : optimized_responses(design, c)) {
        const ResponseSettings& settings = one.file().responses[response];
        if (!meets_another(one.analysis_at(x), settings)) continue;
        if (std::ranges::find(names, settings.name) == names.end()) names.push_back(settings.name);
      }
    }
  } catch (const SimulationError&) {
    return {};
  }
  if (names.empty()) return {};
  return fmt::format(
      "{} coincide{} with the frequency of another mode, which makes a kink: ask for the lowest "
      "mode "
      "along each axis instead (\"direction\" \"y\", and \"z\") and limit each, or their min()",
      fmt::join(names, " and "), names.size() == 1 ? "s" : "");
}

}  // namespace pleuel
