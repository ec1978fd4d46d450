#pragma once

#include <optional>
#include <vector>

#include "core/base/element_place.hpp"
#include "core/scene/point.hpp"
#include "core/scene/scene.hpp"

namespace pleuel {

/// An element as a share of the beam's length, at the start design.
struct MeshElement {
  int segment = 0;
  double share = 0.0;
};

/// A node that the elements around it follow: it keeps its share of the length, or is where a point
/// is.
struct MeshKnot {
  int node = 0;
  std::optional<Point> at = {};  ///< t = 0, global axes [m]; none: keeps its share
};

struct BeamMesh {
  std::vector<MeshElement> elements;
  std::vector<int> attached_nodes;  ///< that joints and loads act on, of elastic beams
  /// Ascending, from the first node to the last. Empty: no share depends on the design.
  std::vector<MeshKnot> knots;

  bool depends_on_design() const { return !knots.empty(); }
  /// Share of the length before a node, at the start design.
  double share_at(int node) const;
};

/// The elements of a beam: those that the file asks for. Where a joint or a load acts inside one it
/// is divided: section forces are recovered with the fixed-end terms of inertia loads only, and so
/// have no kinks or jumps inside elements. A node within a hundredth of the element moves there
/// instead, unless it is an end of the beam, a boundary of segments or another such place; nearer than
/// a thousandth of the element to one of these a place is left inside (short elements drown in
/// round-off). Each of these elements is divided into the `pieces` of the beam.
///
/// A place whose share of the length depends on the design takes its node with it, and the elements
/// on both sides, to the next knots, all change by one factor. The number of elements does not
/// depend on the design.
/// @param start      at which places are looked at
/// @param is_elastic otherwise nothing is divided
BeamMesh make_mesh(const Body& body, const Scene& scene, const Design<double>& start,
                   bool is_elastic);

/// Where a share of the length is, of the start design; what is a node up to round-off becomes one.
ElementPlace find_place(const BeamMesh& mesh, double share);

/// Share of the length at which a point of the scene lies on a beam, or on a part of one.
template <class Scalar>
Scalar share_along(const BeamBody& beam, const Point& point, const Design<Scalar>& design) {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  const Vector from = resolve_point(beam.from, design);
  const Vector way = resolve_point(beam.to, design) - from;
  const Vector there = resolve_point(point, design) - from;
  const Scalar share = there.cwiseProduct(way).sum() / way.cwiseProduct(way).sum();
  if (!beam.part) return share;
  return (share - beam.part->begin) / (beam.part->end - beam.part->begin);
}

/// How much of a stretch between two points of a beam lies on a part of it, 0 … 1.
template <class Scalar>
Scalar share_of_stretch(const BeamBody& part, const std::array<Point, 2>& ends,
                        const Design<Scalar>& design) {
  const Scalar one = share_along(part, ends[0], design), other = share_along(part, ends[1], design);
  const auto on_part = [](const Scalar& share) {
    return value_of(share) < 0.0 ? Scalar(0.0) : value_of(share) > 1.0 ? Scalar(1.0) : share;
  };
  return (on_part(other) - on_part(one)) / (other - one);
}

/// Shares of the length between the knots of a mesh, one less than there are knots.
template <class Scalar>
std::vector<Scalar> knot_distances(const BeamBody& beam, const BeamMesh& mesh,
                                   const Design<Scalar>& design) {
  std::vector<Scalar> distances;
  Scalar before(0);
  for (std::size_t i = 1; i < mesh.knots.size(); ++i) {
    const MeshKnot& knot = mesh.knots[i];
    const Scalar share =
        knot.at ? share_along(beam, *knot.at, design) : Scalar(mesh.share_at(knot.node));
    distances.push_back(share - before);
    before = share;
  }
  return distances;
}

/// Shares of the length of all elements of a beam (whole length: of one that is not divided into
/// frames).
template <class Scalar>
std::vector<Scalar> element_shares(const BeamBody& beam, const BeamMesh& mesh,
                                   const Design<Scalar>& design) {
  std::vector<Scalar> shares;
  for (const MeshElement& element : mesh.elements) shares.push_back(Scalar(element.share));
  const std::vector<Scalar> distances = knot_distances(beam, mesh, design);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const int first = mesh.knots[i].node, end = mesh.knots[i + 1].node;
    const double at_start = mesh.share_at(end) - mesh.share_at(first);
    for (int e = first; e < end; ++e) shares[e] *= distances[i] / at_start;
  }
  return shares;
}

/// Shares of a beam's length that its segments take.
std::vector<double> length_fractions(const BeamBody& body);

}  // namespace pleuel
