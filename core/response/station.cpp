#include "core/response/station.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/model/body_point.hpp"

namespace pleuel {

namespace {

class StationFinder {
 public:
  explicit StationFinder(const BodyModel& body) : body_(body) {}

  std::vector<Station> along(std::optional<int> segment) const {
    std::vector<Station> stations;
    for (int e = 0; e < elements(); ++e) {
      if (segment && segment_of(e) != *segment) continue;
      if (continues(e)) {
        stations.back().elements.push_back(e);
      } else {
        stations.push_back({{e}, double(e)});
      }
      for (double xi : {0.25, 0.5, 0.75}) stations.push_back({{e}, e + xi});
      stations.push_back({{e}, e + 1.0});
    }
    return stations;
  }

  std::vector<Station> at(double share) const {
    const BeamPlace place = place_at(body_, share);
    if (!place.is_node() && !is_beside_attached(place)) {
      return {station({place.element}, place.element + place.xi, share)};
    }
    const int node = place.node();
    if (node == 0) return {station({0}, 0.0, share)};
    if (node == elements()) return {station({node - 1}, double(node), share)};
    if (continues(node)) return {station({node - 1, node}, double(node), share)};
    return {station({node - 1}, double(node), share), station({node}, double(node), share)};
  }

 private:
  int elements() const { return int_size(body_.beam.elements); }
  Station station(std::vector<int> adjacent, double place, double share) const {
    Station result{std::move(adjacent), place};
    for (const int element : result.elements) {
      std::vector<double> slopes = slopes_in_element(body_, share, element);
      if (!slopes.empty()) result.place_x.push_back(std::move(slopes));
    }
    return result;
  }
  /// Whether the place of a joint or load is meant, which section forces may jump at: written numbers
  /// are rounded.
  bool is_beside_attached(const BeamPlace& place) const {
    constexpr double rounding = 1e-5;  // of the length
    const std::vector<int>& attached = body_.mesh.attached_nodes;
    for (const MeshKnot& knot : body_.mesh.knots) {
      if (knot.node == place.node() && knot.at) return false;  // it moves
    }
    if (std::ranges::find(attached, place.node()) == attached.end()) return false;
    const double distance = body_.beam.node_position(place.node()) - position_of(body_.beam, place);
    return std::abs(distance) <= rounding * body_.beam.node_position(elements());
  }
  int segment_of(int e) const { return body_.mesh.elements[e].segment; }
  /// Whether an element continues the segment of the one before, and nothing acts between them.
  bool continues(int e) const {
    const std::vector<int>& attached = body_.mesh.attached_nodes;
    return e > 0 && segment_of(e - 1) == segment_of(e) &&
           std::ranges::find(attached, e) == attached.end();
  }

  const BodyModel& body_;
};

}  // namespace

std::vector<Station> find_stations(const BodyModel& body, const StationChoice& choice) {
  const StationFinder finder(body);
  if (!choice.place) return finder.along(choice.segment);
  std::vector<Station> stations = finder.at(*choice.place);
  if (!choice.side || stations.size() == 1) return stations;
  return {*choice.side == SectionSide::before ? stations.front() : stations.back()};
}

std::string describe(const Station& station, const BodyModel& body) {
  const int first = body.stretch.first_element;
  const std::string text = fmt::format("node {}", first + station.place);
  const double inside = station.place - station.elements.front();  // of an element, 0 … 1
  const bool is_end =
      (station.place == 0.0 && body.stretch.begin == 0.0) ||
      (station.place == double(body.beam.elements.size()) && body.stretch.end == 1.0);
  const bool is_one_side = station.elements.size() == 1 && (inside == 0.0 || inside == 1.0);
  if (is_end || !is_one_side) return text;
  const int other = station.elements.front() + (inside == 0.0 ? 1 : 0);
  return fmt::format("{} towards node {}", text, first + other);
}

}  // namespace pleuel
