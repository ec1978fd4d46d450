#include "core/model/body_point.hpp"

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

}  // namespace pleuel
