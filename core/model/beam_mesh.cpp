#include "core/model/beam_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/int_size.hpp"
#include "core/model/attached_points.hpp"
#include "core/model/scene_geometry.hpp"

namespace pleuel {

namespace {

/// A node at a place has to be so far from others, in lengths of the element.
constexpr double least_distance = 0.01;
/// Shares of the length that differ by less are the same.
constexpr double node_tolerance = 1e-9;

/// Shares of the length of the whole beam, from the beginning of its part, at which joints and
/// loads act, ascending.
std::vector<double> attached_shares(const Body& body, const Scene& scene,
                                    const Design<double>& start) {
  const auto& beam = std::get<BeamBody>(body.shape);
  const double part = beam.part ? beam.part->end - beam.part->begin : 1.0;
  std::vector<double> shares;
  for (const AttachedPoint& point : attached_points(scene)) {
    if (point.body != body.name) continue;
    shares.push_back(part * share_along(beam, point.at, start));
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

void divide(std::vector<MeshElement>& elements, double at) {
  double begin = 0.0;
  for (auto element = elements.begin(); element != elements.end(); ++element) {
    const double size = element->share, within = at - begin;
    if (within > least_distance * size && within < (1.0 - least_distance) * size) {
      element->share = within;
      elements.insert(element + 1, {element->segment, size - within});
      return;
    }
    begin += size;
  }
}

/// Each element into so many of the same size.
std::vector<MeshElement> in_pieces(const std::vector<MeshElement>& elements, int pieces) {
  std::vector<MeshElement> all;
  for (const MeshElement& element : elements) {
    all.insert(all.end(), static_cast<std::size_t>(pieces),
               {element.segment, element.share / pieces});
  }
  return all;
}

}  // namespace

BeamMesh make_mesh(const Body& body, const Scene& scene, const Design<double>& start,
                   bool is_elastic) {
  const BeamBody& beam = std::get<BeamBody>(body.shape);
  const std::vector<double> fractions = length_fractions(beam);
  BeamMesh mesh;
  for (std::size_t s = 0; s < beam.segments.size(); ++s) {
    const int elements = beam.segments[s].elements;
    if (elements == 0) continue;
    mesh.elements.insert(mesh.elements.end(), static_cast<std::size_t>(elements),
                         {static_cast<int>(s), fractions[s] / elements});
  }
  if (!is_elastic) return mesh;
  const std::vector<double> attached = attached_shares(body, scene, start);
  for (double share : attached) divide(mesh.elements, share);
  if (beam.pieces > 1) mesh.elements = in_pieces(mesh.elements, beam.pieces);
  double node_share = 0.0;
  for (int node = 0; node <= int_size(mesh.elements); ++node) {
    const bool is_attached = std::any_of(attached.begin(), attached.end(), [&](double share) {
      return std::abs(share - node_share) <= node_tolerance;
    });
    if (is_attached) mesh.attached_nodes.push_back(node);
    if (node < int_size(mesh.elements)) {
      node_share += mesh.elements[node].share;
    }
  }
  return mesh;
}

double share_along(const BeamBody& beam, const Point& point, const Design<double>& start) {
  const Eigen::Vector3d from = resolve_point(beam.from, start), to = resolve_point(beam.to, start);
  const double share =
      (resolve_point(point, start) - from).dot(to - from) / (to - from).squaredNorm();
  if (!beam.part) return share;
  return (share - beam.part->begin) / (beam.part->end - beam.part->begin);
}

}  // namespace pleuel
