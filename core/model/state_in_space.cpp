#include "core/model/state_in_space.hpp"

#include "core/base/rotation_vector.hpp"
#include "core/model/body_frames.hpp"
#include "core/start/initial_state.hpp"

namespace pleuel {

namespace {

void set_frame(const BodyModel& planar, const State& from, const BodyFrame& frame, State& to) {
  const FrameMotion<double> motion = frame_motion(planar.frame, from);
  const int translations = frame.translations();
  to.q.segment(frame.offset, translations) = frame.basis.transpose() * (motion.r - frame.origin);
  to.v.segment(frame.offset, translations) = frame.basis.transpose() * motion.r_dot;
  if (frame.rotation != RotationCoordinates::rotation_vector) return;
  to.q.segment<3>(frame.offset + translations) = rotation_vector(motion.A);
  to.v.segment<3>(frame.offset + translations) = motion.omega;
}

/// Nodal displacements, which the body in space has as coordinates. @returns whether it has
bool set_deformation(const BodyModel& planar, const State& from, const BodyModel& body, State& to) {
  const int size = planar.elastic_size();
  if (size == 0) return body.elastic_size() == 0;
  const auto q = from.q.segment(planar.elastic_offset(), size),
             v = from.v.segment(planar.elastic_offset(), size);
  if (!body.is_beam() && body.elastic_size() == size) {
    to.q.segment(body.elastic_offset(), size) = q;
    to.v.segment(body.elastic_offset(), size) = v;
    return true;
  }
  if (!body.is_beam() || body.has_basis || body.places.size() != planar.places.size()) return false;
  const auto displacements = planar.places.displacements(q), rates = planar.places.displacements(v);
  for (int node = 0; node < planar.places.size(); ++node) {
    for (int displacement = 0; displacement < 6; ++displacement) {
      const int index = body.coordinate(node, displacement);
      if (index < 0) continue;
      // Without a stretch of its own the body would bear its axial force by no deformation.
      const bool is_stretch = displacement == 0;
      if (is_stretch && planar.places.shape.row(6 * node).nonZeros() == 0) return false;
      to.q(index) = displacements(displacement, node);
      to.v(index) = rates(displacement, node);
    }
  }
  return true;
}

}  // namespace

std::optional<State> state_in_space(const Model& planar, const State& state, Model& space) {
  if (planar.bodies.size() != space.bodies.size()) return std::nullopt;
  State& guess = space.mechanism.guess;
  guess.time = state.time;
  for (std::size_t i = 0; i < planar.bodies.size(); ++i) {
    set_frame(planar.bodies[i], state, space.bodies[i].frame, guess);
    if (!set_deformation(planar.bodies[i], state, space.bodies[i], guess)) return std::nullopt;
  }
  space.mechanism.starts_in_equilibrium = false;
  return initial_state(space.mechanism).state;
}

}  // namespace pleuel
