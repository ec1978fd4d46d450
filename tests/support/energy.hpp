#pragma once

#include "core/model/model.hpp"
#include "tests/support/dense.hpp"

/// Kinetic energy, elastic energy (with stretching by bending) and weight's potential of a
/// mechanism.
inline double energy_of(pleuel::Model& model, const pleuel::State& state) {
  using namespace pleuel;
  double energy = 0.0;
  for (const auto& term : model.mechanism.system->terms()) {
    if (!term->name().starts_with("inertia")) continue;
    const Eigen::MatrixXd mass = tangent_of(*term, state, {.a = 1.0}, ConstraintLevel::position);
    energy += 0.5 * state.v.dot(mass.topLeftCorner(state.v.size(), state.v.size()) * state.v);
  }
  for (const BodyModel& body : model.bodies) {
    if (!body.is_beam()) {
      const auto u = state.q.segment(body.frame.offset, body.frame.translations());
      energy -= body.mass * model.gravity.dot(body.frame.origin + body.frame.basis * u);
      continue;
    }
    const auto invariants = beam_invariants(body.beam, body.coordinates);
    const auto motion =
        frame_motion<double>(body.frame, state.q.segment(body.frame.offset, body.frame.size()),
                             state.v.segment(body.frame.offset, body.frame.size()),
                             state.a.segment(body.frame.offset, body.frame.size()));
    const Eigen::VectorXd q = state.q.segment(body.elastic_offset(), body.coordinates.size());
    const Eigen::Vector3d first = invariants.first_moment + invariants.shape * q;
    energy -= model.gravity.dot(body.mass * motion.r + motion.A * first);
    energy += 0.5 * q.dot(dense(invariants.pattern, invariants.stiffness) * q);
    if (!body.has_stiffening) continue;
    for (int e = 0; e < static_cast<int>(body.beam.elements.size()); ++e) {
      const auto& element = body.beam.elements[e];
      Eigen::Matrix<double, 12, 1> n;
      for (int i = 0; i < 12; ++i) {
        const int index = body.coordinate(e + i / 6, i % 6);
        n(i) = index < 0 ? 0.0 : state.q(index);
      }
      double total = n(6) - n(0);
      for (const GaussPoint& point : gauss_points) {
        const double v = deflection_y_row(point.xi, form_of(element), 1).dot(n);
        const double w = deflection_z_row(point.xi, form_of(element), 1).dot(n);
        total += 0.5 * point.weight * element.length * (v * v + w * w);
      }
      energy += 0.5 * element.young * element.section.area / element.length *
                (total * total - std::pow(n(6) - n(0), 2));
    }
  }
  return energy;
}
