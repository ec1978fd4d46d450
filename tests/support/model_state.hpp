#pragma once

#include <random>

#include <Eigen/Core>

#include "core/beam/beam_shape.hpp"
#include "core/model/model.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/dense_algebra.hpp"

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

/// A state somewhere near the start, with all rates and multipliers: no law of a term or of a
/// signal needs a consistent one. Lengths are some 0.1 m, strains far beyond what is sensible.
inline pleuel::State random_state(const pleuel::Model& model, unsigned seed) {
  const pleuel::System& system = *model.mechanism.system;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  pleuel::State state(system.coordinates(), system.multipliers());
  state.time = 0.013;
  state.q = model.mechanism.guess.q;
  const auto disturb = [&](Eigen::Index first, Eigen::Index size, double q, double v, double a) {
    for (Eigen::Index i = first; i < first + size; ++i) {
      state.q(i) += q * uniform(random);
      state.v(i) += v * uniform(random);
      state.a(i) += a * uniform(random);
    }
  };
  for (const pleuel::BodyModel& body : model.bodies) {
    disturb(body.frame.offset, body.frame.size(), 0.2, 3.0, 30.0);
    disturb(body.elastic_offset(), body.elastic_size(), 5e-3, 0.3, 3.0);
  }
  for (double& lambda : state.lambda) lambda = 10.0 * uniform(random);
  return state;
}

/// Derivatives of a basis of elastic coordinates hold up to changes of basis within its span. What
/// differences of neighbouring models are to be compared with them must be in the same coordinates:
/// the matrix B of
///     q_neighbour = B q,   Z_neighbour B = Z + change · ∂Z/∂x  (least squares)
/// for all coordinates of the system; the identity where there is no basis. If the span of the
/// derivative is wrong, the differences show it: Z_neighbour B stays in the true span.
inline Eigen::MatrixXd change_of_basis(const pleuel::Model& model, const pleuel::Model& neighbour,
                                       int variable, double change) {
  const int n = model.mechanism.system->coordinates();
  Eigen::MatrixXd b = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const pleuel::BodyModel& body = model.bodies[i];
    if (!body.has_basis) continue;
    Eigen::MatrixXd expected(body.places.shape);
    for (const auto& [k, derivative] : body.places_x) {
      if (k == variable) expected += change * derivative.shape;
    }
    const int first = body.elastic_offset(), size = body.elastic_size();
    b.block(first, first, size, size) =
        pleuel::test::least_squares(Eigen::MatrixXd(neighbour.bodies[i].places.shape), expected);
  }
  return b;
}
