#pragma once

#include <vector>

#include "core/beam/beam_shape.hpp"
#include "core/model/model.hpp"

namespace pleuel {

/// Where a point of a body is, and how it moves with the elastic coordinates; or the derivatives.
struct PointShape {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< undeformed, local axes [m]
  SparseMatrix shape = SparseMatrix(6, 0);             ///< u v w θx θy θz = shape · q_f
};

/// What joints and loads hold on to, and where responses look. By default the origin of a frame.
struct BodyPoint : PointShape {
  std::vector<DesignDerivative<PointShape>> derivatives;  ///< as those of the body
};

/// A share of the length of a beam, whatever its elements are.
BeamPlace place_at(const BodyModel& beam, double share);

/// Derivatives of where that is in an element (0 … 1, or beside it), in the order of those of the body;
/// none where they are zero, as all elements keep their shares of the length.
std::vector<double> slopes_in_element(const BodyModel& beam, double share, int element);

/// Where joints and loads hold on to an elastic beam that lie at a share of its length at the start.
BeamPlace held_place(const BodyModel& beam, double share);

/// One of the places of a body.
BodyPoint point_of(const BodyModel& body, int place);

/// A place of a beam. Between two nodes it moves with both (core/beam/beam_shape.hpp).
BodyPoint point_of(const BodyModel& body, const BeamPlace& place);

/// The mean of all places of a stretch of a beam. A force on it does the work of one that is spread evenly
/// along the stretch. Places that joints and loads hold on to are its ends (held_place()).
BodyPoint mean_point(const BodyModel& beam, const BeamPlace& one, const BeamPlace& other);

}  // namespace pleuel
