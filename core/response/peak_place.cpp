#include "core/response/peak_place.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

namespace pleuel {

namespace {

/// The number behind the words that a text begins with.
std::optional<double> number_behind(std::string_view words, const std::string& text) {
  if (!text.starts_with(words)) return std::nullopt;
  const char* begin = text.c_str() + words.size();
  char* end = nullptr;
  const double number = std::strtod(begin, &end);
  return end == begin ? std::nullopt : std::optional<double>(number);
}

/// Of a place inside one frame of a beam, counted in its elements.
double share_in(const BodyModel& part, double place) {
  const int last = part.beam.node_count() - 1;
  const int node = std::clamp(static_cast<int>(std::floor(place)), 0, last - 1);
  const double from = part.beam.node_position(node), to = part.beam.node_position(node + 1);
  const double position = from + (place - node) * (to - from);
  return part.stretch.of_whole(position / part.beam.node_position(last));
}

}  // namespace

std::optional<double> share_of_place(const Model& model, const std::string& body,
                                     const std::string& place) {
  if (const auto share = number_behind("at ", place)) return share;
  const auto node = number_behind("node ", place);
  if (!node) return std::nullopt;
  for (const BodyModel* part : model.parts(body)) {
    if (!part->is_beam()) return std::nullopt;
    const double inside = *node - part->stretch.first_element;
    const int elements = part->beam.node_count() - 1;
    if (inside <= elements) return share_in(*part, inside);
  }
  return std::nullopt;
}

std::optional<Peak> find_peak(const ProblemFile& problem, const Analysis& analysis,
                              std::size_t response) {
  const Response& of = analysis.responses[response];
  const std::vector<Sample>& samples = analysis.reductions[response].samples;
  if (!of.is_peak_over_time() || samples.empty()) return std::nullopt;
  const Sample& sample = *std::ranges::max_element(samples, [](const Sample& a, const Sample& b) {
    return std::abs(a.weight) < std::abs(b.weight);
  });
  Peak peak{analysis.trajectory.time(sample.step), of.history()->signal->describe(sample.channel)};
  const std::vector<std::string> bodies = bodies_of(problem.responses[response]);
  if (bodies.size() == 1) peak.share = share_of_place(analysis.model, bodies.front(), peak.place);
  return peak;
}

std::string describe_tie(const PeakTie& tie, const Response& response) {
  const Signal& signal = *response.history()->signal;
  return fmt::format("at {:.5g} s ({}) and at {:.5g} s ({})", tie.time,
                     signal.describe(tie.channel), tie.other_time,
                     signal.describe(tie.other_channel));
}

}  // namespace pleuel
