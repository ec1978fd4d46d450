#include "core/model/body_point.hpp"

#include <cmath>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;

PointShape shape_of(const BodyPlaces& places, int place) {
  return {places.positions.col(place), places.shape.middleRows(6 * place, 6)};
}

/// Two neighbouring nodes, from which the points between them are made.
struct NodePair {
  Eigen::Vector3d start, way;
  MatrixXd rows;  ///< the twelve displacements from the elastic coordinates

  NodePair(const BodyPlaces& nodes, int first)
      : start(nodes.positions.col(first)),
        way(nodes.positions.col(first + 1) - start),
        rows(nodes.shape.middleRows(6 * first, 12)) {}
};

/// Of one element, in its ξ.
struct Piece {
  int element;
  double begin, end;

  template <class Scalar>
  Scalar length(const Beam<Scalar>& beam) const {
    return (end - begin) * beam.elements[static_cast<std::size_t>(element)].length;
  }
};

std::vector<Piece> pieces_between(const ElementPlace& first, const ElementPlace& last) {
  std::vector<Piece> pieces;
  for (int e = first.element; e <= last.element; ++e) {
    pieces.push_back({e, e == first.element ? first.xi : 0.0, e == last.element ? last.xi : 1.0});
  }
  return pieces;
}

template <class Scalar>
Scalar length_of_all(const std::vector<Piece>& pieces, const Beam<Scalar>& beam) {
  Scalar sum(0.0);
  for (const Piece& piece : pieces) sum += piece.length(beam);
  return sum;
}

void add(double weight, const PointShape& part, PointShape& sum) {
  sum.position += weight * part.position;
  sum.shape = SparseMatrix(sum.shape + weight * part.shape);
}

}  // namespace

BodyPoint point_of(const BodyModel& body, int place) {
  BodyPoint point{shape_of(body.places, place), {}};
  for (const auto& [variable, change] : body.places_x) {
    point.derivatives.push_back({variable, shape_of(change, place)});
  }
  return point;
}

std::vector<double> slopes_in_element(const BodyModel& beam, double share, int element) {
  std::vector<double> slopes;
  if (!beam.mesh.depends_on_design()) return slopes;
  const int elements = beam.beam.node_count() - 1;
  for (const auto& [variable, along] : beam.beam_x) {
    const Dual length = along.node_position(elements), first = along.node_position(element);
    slopes.push_back(derivative_of((share * length - first) / along.elements[element].length));
  }
  return slopes;
}

BeamPlace place_at(const BodyModel& beam, double share) {
  const ElementPlace place = find_place(beam.beam, share);
  return {place, slopes_in_element(beam, share, place.element)};
}

BeamPlace held_place(const BodyModel& beam, double share) {
  return {find_place(beam.mesh, share)};
}

BodyPoint point_of(const BodyModel& body, const BeamPlace& place) {
  const bool is_node = place.is_node() && place.xi_x.empty();
  if (is_node) return point_of(body, place.node());
  const NodePair nodes(body.places, place.element);
  const MatrixXd shape = place_shape(place.xi, form_of(body.beam.elements[place.element]));
  BodyPoint point{{nodes.start + place.xi * nodes.way, (shape * nodes.rows).sparseView()}, {}};
  for (std::size_t k = 0; k < body.places_x.size(); ++k) {
    const auto& [variable, of_places] = body.places_x[k];
    const NodePair change(of_places, place.element);
    const BeamElement<Dual>& element = body.beam_x[k].second.elements[place.element];
    const double slope = place.xi_x.empty() ? 0.0 : place.xi_x[k];
    const Dual xi(place.xi, Dual::Derivatives::Constant(slope));
    const MatrixXd shape_x = derivative_matrix(place_shape(xi, form_of(element)));
    point.derivatives.push_back(
        {variable,
         {change.start + place.xi * change.way + slope * nodes.way,
          MatrixXd(shape_x * nodes.rows + shape * change.rows).sparseView()}});
  }
  return point;
}

/// By two points of Gauss a piece, which are exact for cubic shapes.
BodyPoint mean_point(const BodyModel& beam, const BeamPlace& one, const BeamPlace& other) {
  const auto along = [](const BeamPlace& place) { return place.element + place.xi; };
  const bool is_forward = along(one) <= along(other);
  const std::vector<Piece> pieces =
      pieces_between(is_forward ? one : other, is_forward ? other : one);
  const PointShape nothing{Eigen::Vector3d::Zero(), SparseMatrix(6, beam.places.shape.cols())};
  BodyPoint mean{nothing, {}};
  for (const auto& [variable, change] : beam.places_x)
    mean.derivatives.push_back({variable, nothing});
  const double whole = length_of_all(pieces, beam.beam);
  for (const Piece& piece : pieces) {
    for (const double side : {-1.0, 1.0}) {
      const double xi = piece.begin + (piece.end - piece.begin) * (0.5 + side / std::sqrt(12.0));
      const BodyPoint point = point_of(beam, BeamPlace{{piece.element, xi}});
      const double weight = 0.5 * piece.length(beam.beam) / whole;
      add(weight, point, mean);
      for (std::size_t k = 0; k < mean.derivatives.size(); ++k) {
        const Beam<Dual>& changed = beam.beam_x[k].second;
        const Dual share = 0.5 * piece.length(changed) / length_of_all(pieces, changed);
        add(weight, point.derivatives[k].data, mean.derivatives[k].data);
        add(derivative_of(share), point, mean.derivatives[k].data);
      }
    }
  }
  return mean;
}

}  // namespace pleuel
