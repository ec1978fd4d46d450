#include "core/scene/beam_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/int_size.hpp"
#include "core/scene/held_points.hpp"
#include "core/scene/visit_numbers.hpp"

namespace pleuel {

namespace {

/// A node moves to a place that is so near, in lengths of the element: another one would leave a short
/// element between them.
constexpr double near_node = 0.01;
/// Where the node has to stay, there is another one that is farther away than this.
constexpr double least_distance = 0.001;
/// Shares of the length that differ by less are the same.
constexpr double node_tolerance = 1e-9;

/// Where joints and loads act on a beam, and initial deflections are given.
struct HeldPlace {
  double share;  ///< of the length of the whole beam, from the beginning of its part
  Point at;
};

/// Ascending.
std::vector<HeldPlace> held_places(const Body& body, const Scene& scene,
                                   const Design<double>& start) {
  const auto& beam = std::get<BeamBody>(body.shape);
  const double part = beam.part ? beam.part->end - beam.part->begin : 1.0;
  std::vector<HeldPlace> places;
  for (const AttachedPoint& point : attached_points(scene, body.name)) {
    places.push_back({part * share_along(beam, point.at, start), point.at});
  }
  std::ranges::stable_sort(
      places, [](const HeldPlace& a, const HeldPlace& b) { return a.share < b.share; });
  return places;
}

/// Elements with nodes at places.
class PlacedElements {
 public:
  explicit PlacedElements(std::vector<MeshElement> elements) : elements_(std::move(elements)) {
    is_fixed_.assign(elements_.size() + 1, false);
    is_fixed_.front() = is_fixed_.back() = true;
    for (std::size_t e = 1; e < elements_.size(); ++e) {
      is_fixed_[e] = elements_[e].segment != elements_[e - 1].segment;
    }
  }

  void add(double at) {
    double begin = 0.0;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const double size = elements_[e].share, within = at - begin;
      if (std::abs(within) <= node_tolerance) return fix(e);
      if (within <= size - node_tolerance || e + 1 == elements_.size()) {
        return put_inside(e, within);
      }
      begin += size;
    }
  }

  std::vector<MeshElement> take() { return std::move(elements_); }

 private:
  void fix(std::size_t node) { is_fixed_[node] = true; }

  void put_inside(std::size_t e, double within) {
    const double size = elements_[e].share, left = size - within;
    if (within <= near_node * size && !is_fixed_[e]) return move(e, within);
    if (left <= near_node * size && !is_fixed_[e + 1]) return move(e + 1, -left);
    if (std::min(within, left) <= least_distance * size) return;
    elements_[e].share = within;
    elements_.insert(elements_.begin() + static_cast<std::ptrdiff_t>(e) + 1,
                     {elements_[e].segment, left});
    is_fixed_.insert(is_fixed_.begin() + static_cast<std::ptrdiff_t>(e) + 1, true);
  }

  void move(std::size_t node, double by) {
    elements_[node - 1].share += by;
    elements_[node].share -= by;
    fix(node);
  }

  std::vector<MeshElement> elements_;
  std::vector<bool> is_fixed_;  ///< of each node
};

/// Each element into so many of the same size.
std::vector<MeshElement> in_pieces(const std::vector<MeshElement>& elements, int pieces) {
  std::vector<MeshElement> all;
  for (const MeshElement& element : elements) {
    all.insert(all.end(), static_cast<std::size_t>(pieces),
               {element.segment, element.share / pieces});
  }
  return all;
}

std::vector<MeshElement> even_elements(const BeamBody& beam) {
  const std::vector<double> fractions = length_fractions(beam);
  std::vector<MeshElement> all;
  for (std::size_t s = 0; s < beam.segments.size(); ++s) {
    const int elements = beam.segments[s].elements;
    if (elements == 0) continue;
    all.insert(all.end(), static_cast<std::size_t>(elements),
               {static_cast<int>(s), fractions[s] / elements});
  }
  return all;
}

/// Which nodes are at places, ascending.
std::vector<int> nodes_at(const std::vector<HeldPlace>& places,
                          const std::vector<MeshElement>& elements) {
  std::vector<int> nodes;
  double share = 0.0;
  for (int node = 0; node <= int_size(elements); ++node) {
    const bool is_held = std::ranges::any_of(places, [&](const HeldPlace& place) {
      return std::abs(place.share - share) <= node_tolerance;
    });
    if (is_held) nodes.push_back(node);
    if (node < int_size(elements)) share += elements[node].share;
  }
  return nodes;
}

/// Whether the share of the length of a point depends on the design: about the start, and where its
/// slope there may vanish.
bool moves_along(const BeamBody& beam, const Point& at, const Design<double>& start) {
  constexpr double change = 1e-2, rounding = 1e-12;
  std::set<int> variables;
  for (const Point* point : {&at, &beam.from, &beam.to}) add_variables_of(*point, variables);
  const double share = variables.empty() ? 0.0 : share_along(beam, at, start);
  return std::ranges::any_of(variables, [&](int variable) {
    const double step = start[variable] == 0.0 ? change : change * start[variable];
    const auto moves_by = [&](double by) {
      Design<double> moved = start;
      moved[variable] += by;
      return !(std::abs(share_along(beam, at, moved) - share) <= rounding);
    };
    return moves_by(step) || moves_by(-step);
  });
}

/// None if no share depends on the design.
std::vector<MeshKnot> knots_of(const BeamBody& beam, const BeamMesh& mesh,
                               const std::vector<HeldPlace>& places, const Design<double>& start) {
  const int last = int_size(mesh.elements);
  std::vector<MeshKnot> knots;
  bool is_moving = false;
  for (int node = 0; node <= last; ++node) {
    const bool is_end = node == 0 || node == last;
    const bool is_boundary =
        is_end || mesh.elements[node - 1].segment != mesh.elements[node].segment;
    const bool is_held = std::ranges::binary_search(mesh.attached_nodes, node);
    if (!is_boundary && !is_held) continue;
    MeshKnot knot{node};
    for (const HeldPlace& place : places) {
      if (is_boundary || std::abs(place.share - mesh.share_at(node)) > node_tolerance) continue;
      if (moves_along(beam, place.at, start)) knot.at = place.at;
    }
    is_moving = is_moving || knot.at.has_value();
    knots.push_back(std::move(knot));
  }
  if (!is_moving) knots.clear();
  return knots;
}

}  // namespace

double BeamMesh::share_at(int node) const {
  return std::accumulate(elements.begin(), elements.begin() + node, 0.0,
                         [](double sum, const MeshElement& one) { return sum + one.share; });
}

BeamMesh make_mesh(const Body& body, const Scene& scene, const Design<double>& start,
                   bool is_elastic) {
  const BeamBody& beam = std::get<BeamBody>(body.shape);
  BeamMesh mesh{even_elements(beam), {}, {}};
  if (!is_elastic) return mesh;
  const std::vector<HeldPlace> places = held_places(body, scene, start);
  PlacedElements placed(std::move(mesh.elements));
  for (const HeldPlace& place : places) placed.add(place.share);
  mesh.elements = placed.take();
  if (beam.pieces > 1) mesh.elements = in_pieces(mesh.elements, beam.pieces);
  mesh.attached_nodes = nodes_at(places, mesh.elements);
  const bool is_divided = beam.frames > 1 || beam.part;
  if (!is_divided) mesh.knots = knots_of(beam, mesh, places, start);
  return mesh;
}

ElementPlace find_place(const BeamMesh& mesh, double share) {
  const int elements = int_size(mesh.elements);
  const double whole = mesh.share_at(elements);
  double begin = 0.0;
  for (int e = 0; e < elements; ++e) {
    const double size = mesh.elements[e].share, end = begin + size;
    if (share * whole > end && e + 1 < elements) {
      begin = end;
      continue;
    }
    const double xi = (share * whole - begin) / size;
    if (std::abs(xi) < node_tolerance) return {e, 0.0};
    if (std::abs(xi - 1.0) < node_tolerance) return {e, 1.0};
    return {e, xi};
  }
  return {};
}

std::vector<double> length_fractions(const BeamBody& body) {
  double elements = 0.0;
  for (const Segment& segment : body.segments) elements += segment.elements;
  std::vector<double> fractions;
  for (const Segment& segment : body.segments) {
    fractions.push_back(segment.fraction.value_or(segment.elements / elements));
  }
  return fractions;
}

}  // namespace pleuel
