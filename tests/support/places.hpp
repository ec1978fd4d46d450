#pragma once

#include "core/beam/beam_shape.hpp"
#include "core/model/model.hpp"

namespace pleuel::test {

/// Nodal displacements of a beam in an instant, whatever its elastic coordinates are: six a node,
/// local axes.
inline Eigen::VectorXd stacked_displacements(const BodyModel& body, const State& state) {
  return body.places.shape * state.q.segment(body.elastic_offset(), body.elastic_size());
}

/// The frame of a body in an instant.
inline FrameMotion<double> frame_of(const BodyModel& body, const State& state) {
  const int first = body.frame.offset, size = body.frame.size();
  return frame_motion<double>(body.frame, state.q.segment(first, size),
                              state.v.segment(first, size), state.a.segment(first, size));
}

/// Displacement in local axes of the axis of a beam at a share of its length.
inline Eigen::Vector3d deflection_at(const BodyModel& body, const State& state, double at) {
  const ElementPlace place = find_place(body.beam, at);
  return axis_shape(place.xi, form_of(body.beam.elements[place.element])) *
         stacked_displacements(body, state).segment<12>(6 * place.element);
}

/// Where a body is in space: its centre of mass, or of a beam the axis at a share of the length.
inline Eigen::Vector3d position_of(const BodyModel& body, const State& state, double at = 0.0) {
  const auto frame = frame_of(body, state);
  if (!body.is_beam()) return frame.r;
  Eigen::Vector3d p = deflection_at(body, state, at);
  p.x() += pleuel::position_of(body.beam, find_place(body.beam, at));
  return frame.r + frame.A * p;
}

}  // namespace pleuel::test
