#include "optimization/peak_windows.hpp"

#include <algorithm>
#include <cmath>

#include "core/response/stress_signal.hpp"
#include "core/scene/response_parts.hpp"
#include "sensitivity/method_choice.hpp"

namespace pleuel {

namespace {

/// Peaks further below the highest do not decide.
constexpr double near_the_highest = 1e-2;
/// Gradients that differ by less move alike.
constexpr double alike = 1e-2;
/// Of one segment, or of an imported body; and of all segments of a beam.
constexpr int places_of_a_part = 4, most_places = 256;

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

bool have_kinks(const DesignCase& problem, Analysis& analysis, int windows) {
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

const Body& body_of(const ProblemFile& file, const ResponseSettings& response) {
  return *std::find_if(file.scene.bodies.begin(), file.scene.bodies.end(),
                       [&](const Body& body) { return body.name == response.bodies.front(); });
}

/// Ends of the places of equal size.
std::vector<ChannelRange> equal_places(Eigen::Index channels, int places) {
  std::vector<ChannelRange> ranges;
  for (Eigen::Index i = 0; i < places; ++i) {
    const Eigen::Index first = std::min(channels * i / places, channels - 1);
    const Eigen::Index end = std::max(first + 1, channels * (i + 1) / places);
    ranges.push_back({first, end - first});
  }
  return ranges;
}

/// One place a segment; empty where the segments do not add up to the channels of the response.
std::vector<ChannelRange> places_of_segments(const Analysis& analysis,
                                             const ResponseSettings& response,
                                             Eigen::Index channels, int segments) {
  const std::vector<const BodyModel*> parts = analysis.model.parts(response.bodies.front());
  if (parts.size() != 1) return {};
  std::vector<ChannelRange> ranges;
  Eigen::Index first = 0;
  for (int segment = 0; segment < segments; ++segment) {
    const auto signal = make_stress_signal(*parts.front(), analysis.model.gravity, response.part,
                                           {segment, std::nullopt});
    ranges.push_back({first, signal->channels()});
    first += signal->channels();
  }
  const bool is_whole =
      first == channels && std::all_of(ranges.begin(), ranges.end(),
                                       [](const ChannelRange& range) { return range.count > 0; });
  return is_whole ? ranges : std::vector<ChannelRange>();
}

/// Number of segments that a response looks at; 0 if it is not of a beam.
int segments_of(const ProblemFile& file, const ResponseSettings& response) {
  const auto* beam = std::get_if<BeamBody>(&body_of(file, response).shape);
  if (beam == nullptr) return 0;
  return response.segment ? 1 : static_cast<int>(beam->segments.size());
}

void shift_channels(std::vector<Sample>& samples, Eigen::Index first) {
  for (Sample& sample : samples) sample.channel += static_cast<int>(first);
}

/// As of the whole response, where the place begins at this channel.
Reduction of_whole(Reduction peak, Eigen::Index first) {
  shift_channels(peak.samples, first);
  const auto shift = [&](PeakTie& tie) {
    tie.channel += static_cast<int>(first);
    tie.other_channel += static_cast<int>(first);
    shift_channels(tie.other_samples, first);
  };
  if (peak.tie) shift(*peak.tie);
  for (PeakTie& tie : peak.ties) shift(tie);
  return peak;
}

}  // namespace

int place_count(const ProblemFile& file, const ResponseSettings& response) {
  if (response.type != ResponseType::stress || response.station || !has_peaks(response)) return 1;
  if (response.bodies.size() > 1) {
    return std::min(places_of_a_part * static_cast<int>(response.bodies.size()), most_places);
  }
  const int segments = segments_of(file, response);
  return segments > 1 ? std::min(segments, most_places) : places_of_a_part;
}

std::vector<ChannelRange> places_of(const Analysis& analysis, const ProblemFile& file,
                                    std::size_t response, int places) {
  const Eigen::Index channels = analysis.histories[response].rows();
  const ResponseSettings& settings = file.responses[response];
  if (settings.bodies.size() == 1 && places == segments_of(file, settings)) {
    auto ranges = places_of_segments(analysis, settings, channels, places);
    if (!ranges.empty()) return ranges;
  }
  return equal_places(channels, places);
}

std::vector<Reduction> peaks_of_places(const Analysis& analysis, std::size_t response,
                                       const std::vector<ChannelRange>& places, int windows) {
  if (places.size() <= 1) return peaks_of_windows(analysis, response, windows);
  const Response& observed = analysis.responses[response];
  const Eigen::VectorXd& time = analysis.trajectory.time;
  std::vector<Reduction> peaks;
  for (const ChannelRange& place : places) {
    const Eigen::MatrixXd values =
        analysis.histories[response].middleRows(place.first, place.count);
    for (Reduction& peak : reduce_windows(observed.history()->over_time, time, values, windows,
                                          observed.steps(time), analysis.breaks)) {
      peaks.push_back(of_whole(std::move(peak), place.first));
    }
  }
  return peaks;
}

bool has_peaks(const ResponseSettings& response) {
  const bool is_constant = response.type == ResponseType::mass ||
                           response.type == ResponseType::frequency ||
                           response.type == ResponseType::expression;
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
    int windows = fewest;
    for (std::size_t c = 0; c < problem.case_count(); ++c) {
      DesignCase& one = problem.load_case(c);
      Analysis& analysis = one.analysis_at(x);
      while (windows < most && have_kinks(one, analysis, windows)) windows *= 2;
    }
    return windows;
  } catch (const SimulationError&) {
    return fewest;
  }
}

std::vector<std::size_t> optimized_responses(const DesignCase& problem) {
  std::vector<std::size_t> responses;
  const auto add = [&](std::size_t response) {
    for (const std::size_t part : parts_of(problem.file(), response)) responses.push_back(part);
  };
  add(*problem.response_of({}));
  for (std::size_t i = 0; i < problem.file().constraints.size(); ++i) {
    if (const auto response = problem.response_of({i, std::nullopt})) add(*response);
  }
  return responses;
}

}  // namespace pleuel
