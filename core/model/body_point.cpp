#include "core/model/body_point.hpp"

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

}  // namespace

BodyPoint point_of(const BodyModel& body, int place) {
  BodyPoint point{shape_of(body.places, place), {}};
  for (const auto& [variable, change] : body.places_x) {
    point.derivatives.push_back({variable, shape_of(change, place)});
  }
  return point;
}

BodyPoint point_of(const BodyModel& body, const BeamPlace& place) {
  if (place.is_node()) return point_of(body, place.node());
  const NodePair nodes(body.places, place.element);
  const MatrixXd shape = place_shape(place, form_of(body.beam.elements[place.element]));
  BodyPoint point{{nodes.start + place.xi * nodes.way, (shape * nodes.rows).sparseView()}, {}};
  for (std::size_t k = 0; k < body.places_x.size(); ++k) {
    const auto& [variable, of_places] = body.places_x[k];
    const NodePair change(of_places, place.element);
    const BeamElement<Dual>& element = body.beam_x[k].second.elements[place.element];
    const MatrixXd shape_x = derivative_matrix(place_shape(place, form_of(element)));
    point.derivatives.push_back(
        {variable,
         {change.start + place.xi * change.way,
          MatrixXd(shape_x * nodes.rows + shape * change.rows).sparseView()}});
  }
  return point;
}

}  // namespace pleuel
