#include "optimization/design/peak_rows.hpp"

#include <algorithm>
#include <utility>

#include "core/base/eager_matrices.hpp"
#include "core/base/find_named.hpp"
#include "core/base/int_size.hpp"
#include "core/model/motion_plane.hpp"
#include "core/response/history_reduction.hpp"
#include "core/response/signal_of_body.hpp"

namespace pleuel {

namespace {

/// Of one segment; and of all segments of a beam, or all points of an imported body.
constexpr int places_of_a_part = 4, most_places = 256;

/// Channels of a response that belong together: a place.
struct ChannelRange {
  Eigen::Index first = 0, count = 0;
};

/// Ends of the places of equal size.
/// @param together  channels of one point, which stay together
std::vector<ChannelRange> equal_places(Eigen::Index channels, int places, Eigen::Index together) {
  std::vector<ChannelRange> ranges;
  const Eigen::Index points = channels / together;
  for (Eigen::Index i = 0; i < places; ++i) {
    const Eigen::Index first = std::min(points * i / places, points - 1);
    const Eigen::Index end = std::max(first + 1, points * (i + 1) / places);
    ranges.push_back({together * first, together * (end - first)});
  }
  return ranges;
}

bool is_round(const Section& section) {
  return std::holds_alternative<CircleSection>(section) ||
         std::holds_alternative<TubeSection>(section);
}

/// Whether the Euler loads of a beam in both planes are two numbers.
bool has_two_euler_loads(const ProblemFile& file, const BucklingResponse& buckling) {
  const auto* beam = std::get_if<BeamBody>(&find_named(file.scene.bodies, buckling.body)->shape);
  return beam != nullptr && !std::ranges::all_of(beam->segments, [](const Segment& one) {
           return is_round(one.section);
         });
}

bool moves_in_a_plane(const ProblemFile& file) {
  const Eigen::VectorXd start = start_design(file);
  const Design<double> design(start.begin(), start.end());
  return decide_motion_plane(file.scene, file.effects.spatial_motion, design).plane.has_value();
}

/// Into how many planes of bending the channels of a response fall, one plane after the other.
/// Joints may hold a round beam differently in both, but it has one Euler load. A minimum over time
/// is that of the worse plane at each instant.
int planes_of(const ProblemFile& file, const ResponseSettings& response) {
  if (response.over_time == OverTime::min) return 1;
  if (const auto* buckling = response.as<BucklingResponse>()) {
    return has_two_euler_loads(file, *buckling) ? 2 : 1;
  }
  if (response.is<LateralBucklingResponse>()) return moves_in_a_plane(file) ? 1 : 2;
  return 1;
}

/// A response of stress with one segment alone.
ResponseSettings with_segment(ResponseSettings response, int segment) {
  const auto set = [&](auto& one) {
    if constexpr (requires { one.where; }) one.where.segment = segment;
  };
  std::visit(set, response.what);
  return response;
}

/// One place a segment; empty where the segments do not add up to the channels of the response.
std::vector<ChannelRange> places_of_segments(const Analysis& analysis,
                                             const ResponseSettings& response,
                                             Eigen::Index channels, int segments) {
  if (analysis.model.parts(bodies_of(response).front()).size() != 1) return {};
  std::vector<ChannelRange> ranges;
  Eigen::Index first = 0;
  for (int segment = 0; segment < segments; ++segment) {
    const auto signal = make_signal_of_body(with_segment(response, segment), analysis.model);
    ranges.push_back({first, signal->channels()});
    first += signal->channels();
  }
  const bool is_whole =
      first == channels &&
      std::ranges::all_of(ranges, [](const ChannelRange& range) { return range.count > 0; });
  return is_whole ? ranges : std::vector<ChannelRange>();
}

/// Number of segments that a response looks at; 0 if it is not of a beam.
int segments_of(const ProblemFile& file, const StressPlaces& places) {
  const Body& body = *find_named(file.scene.bodies, places.bodies.front());
  const auto* beam = std::get_if<BeamBody>(&body.shape);
  if (beam == nullptr) return 0;
  return places.segment ? 1 : int_size(beam->segments);
}

/// Number of points of an imported body that a response looks at; 0 if it is of another one.
int points_of(const ProblemFile& file, const StressPlaces& places) {
  const Body& body = *find_named(file.scene.bodies, places.bodies.front());
  const auto* imported = std::get_if<ImportedBody>(&body.shape);
  if (imported == nullptr) return 0;
  const StressRecovery& stress = *imported->file->constants.stress;
  return places.place.empty() ? int_size(stress.points)
                              : int_size(named_points(stress, places.place));
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
  for (PeakTie& tie : peak.ties) shift(tie);
  return peak;
}

/// So many places, at a simulated design.
std::vector<ChannelRange> places_of(const Analysis& analysis, const ProblemFile& file,
                                    std::size_t response, int places) {
  const Eigen::Index channels = analysis.histories[response].rows();
  const ResponseSettings& settings = file.responses[response];
  const auto* stress = stress_places(settings);
  const bool is_of_one = stress != nullptr && stress->bodies.size() == 1;
  if (is_of_one && places == segments_of(file, *stress)) {
    auto ranges = places_of_segments(analysis, settings, channels, places);
    if (!ranges.empty()) return ranges;
  }
  return equal_places(channels, places, settings.is<FatigueResponse>() ? 2 : 1);
}

/// The peak of each window of some channels of a response.
std::vector<Reduction> peaks_of(const Analysis& analysis, std::size_t response,
                                const Eigen::MatrixXd& values, int windows) {
  return reduce_history_windows(analysis.responses[response], analysis.trajectory, values, windows,
                                analysis.breaks);
}

}  // namespace

bool has_peaks(const ResponseSettings& response) {
  const bool is_constant = response.is<MassResponse, ModeResponse, ExpressionResponse>();
  return !is_constant && is_peak(response.over_time);
}

bool can_be_divided(const ResponseSettings& response) {
  return has_peaks(response) || response.is<FatigueResponse>();
}

int place_count(const ProblemFile& file, const ResponseSettings& response) {
  if (!can_be_divided(response)) return 1;
  const auto* stress = stress_places(response);
  if (stress == nullptr) return planes_of(file, response);
  if (stress->station) return 1;
  if (stress->bodies.size() > 1) {
    return std::min(places_of_a_part * int_size(stress->bodies), most_places);
  }
  const int points = points_of(file, *stress);
  if (points > 0) return std::min(points, most_places);
  const int segments = segments_of(file, *stress);
  return segments > 1 ? std::min(segments, most_places) : places_of_a_part;
}

std::vector<Reduction> divided_peaks(const Analysis& analysis, const ProblemFile& file,
                                     std::size_t response, const PeakDivision& division) {
  const Eigen::MatrixXd& history = analysis.histories[response];
  if (division.places <= 1) return peaks_of(analysis, response, history, division.windows);
  std::vector<Reduction> peaks;
  for (const ChannelRange& place : places_of(analysis, file, response, division.places)) {
    const Eigen::MatrixXd values = history.middleRows(place.first, place.count);
    for (Reduction& peak : peaks_of(analysis, response, values, division.windows)) {
      peaks.push_back(of_whole(std::move(peak), place.first));
    }
  }
  return peaks;
}

}  // namespace pleuel
