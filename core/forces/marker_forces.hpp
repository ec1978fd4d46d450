#pragma once

#include <array>
#include <vector>

#include "core/frame/elastic_rotation.hpp"
#include "core/frame/marker.hpp"

namespace pleuel {

/// What a local coordinate of a force element moves.
enum class CoordinatePart {
  translation,   ///< of the frame
  rotation,      ///< of the frame
  displacement,  ///< elastic u
  turn           ///< elastic ψ
};

struct LocalCoordinate {
  int index;           ///< in q
  std::size_t marker;  ///< of the element
  CoordinatePart part;
};

/// Coordinates of the markers one after the other, each: frame, then active elastic ones.
template <std::size_t Count>
std::vector<LocalCoordinate> local_coordinates(const std::array<Marker, Count>& markers) {
  std::vector<LocalCoordinate> all;
  for (std::size_t m = 0; m < Count; ++m) {
    const BodyFrame& frame = markers[m].frame;
    for (int i = 0; i < frame.size(); ++i) {
      const bool moves = i < frame.translations();
      all.push_back(
          {frame.offset + i, m, moves ? CoordinatePart::translation : CoordinatePart::rotation});
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const int index = markers[m].elastic[i];
      if (index < 0) continue;
      all.push_back({index, m, i < 3 ? CoordinatePart::displacement : CoordinatePart::turn});
    }
  }
  return all;
}

/// Kinematics of the markers of a force element, and the generalized forces of what acts on them.
///
/// Points and directions are attached to a marker by their undeformed local vectors p and s, with
/// the elastic displacement u and rotation ψ of the marker, R = exp(ψ̃) (elastic_rotation.hpp):
///     P = r + A (p + u),      d = A R s
/// Forces enter by their virtual work, so that they are the exact gradients of what was computed
/// from P and d.
template <class Scalar, std::size_t Count>
class MarkerForces {
 public:
  static constexpr int max_size = static_cast<int>(Count) * max_marker_size;
  using Vector = Vector3<Scalar>;
  using Coordinates = std::array<Scalar, static_cast<std::size_t>(max_size)>;

  /// @param q, v  local coordinates and their rates
  MarkerForces(const std::array<Marker, Count>& markers, const Coordinates& q, const Coordinates& v)
      : markers_(markers) {
    int first = 0;
    for (std::size_t m = 0; m < Count; ++m) {
      start_[m] = first;
      first += set_marker(m, q.data() + first, v.data() + first);
    }
    for (Scalar& force : forces_) force = Scalar(0);
  }

  const FrameMotion<Scalar>& frame(std::size_t m) const { return states_[m].frame; }

  Vector position(std::size_t m, const Vector& p) const {
    const MarkerState& state = states_[m];
    return state.frame.r + state.frame.A * (p + state.u);
  }
  Vector velocity(std::size_t m, const Vector& p) const {
    const MarkerState& state = states_[m];
    return state.frame.r_dot + state.frame.A_dot * (p + state.u) + state.frame.A * state.u_dot;
  }

  /// R s
  Vector local_direction(std::size_t m, const Vector& s) const { return states_[m].turn.turned(s); }
  Vector direction(std::size_t m, const Vector& s) const {
    return states_[m].frame.A * local_direction(m, s);
  }
  Vector direction_rate(std::size_t m, const Vector& s) const {
    const MarkerState& state = states_[m];
    const Vector turned = local_direction(m, s);
    return state.frame.A_dot * turned + state.frame.A * state.spin.cross(turned);
  }

  /// φ + nᵀψ of a body that moves in a plane with normal n (local axes), counting whole turns; zero
  /// for what does not turn.
  Scalar planar_angle(std::size_t m) const {
    if (!turns(m)) return Scalar(0);
    return states_[m].angle + states_[m].frame.G.col(0).dot(states_[m].psi);
  }
  Scalar planar_rate(std::size_t m) const {
    if (!turns(m)) return Scalar(0);
    return states_[m].angle_rate + states_[m].frame.G.col(0).dot(states_[m].psi_dot);
  }

  /// Force F on the point p: Q += (∂P/∂q)ᵀ F. Global axes.
  void add_force(std::size_t m, const Vector& F, const Vector& p) {
    const BodyFrame& frame = markers_[m].frame;
    for (int i = 0; i < frame.translations(); ++i) {
      const Vector along = frame.basis.col(i).template cast<Scalar>();
      force(start_[m] + i) += along.dot(F);
    }
    add_lever(m, F, p + states_[m].u);
    add_elastic(m, CoordinatePart::displacement, states_[m].frame.A.transpose() * F);
  }

  /// What does the work g · δd on the direction d of s: Q += (∂d/∂q)ᵀ g. Global axes.
  void add_to_direction(std::size_t m, const Vector& g, const Vector& s) {
    const Vector turned = local_direction(m, s);
    add_lever(m, g, turned);
    const Vector local = states_[m].frame.A.transpose() * g;
    add_elastic(m, CoordinatePart::turn, states_[m].turn.generalized(turned.cross(local)));
  }

  /// Torque M in axes of the frame, on the virtual rotation δπ + T δψ of the marker.
  void add_torque(std::size_t m, const Vector& M) {
    const BodyFrame& frame = markers_[m].frame;
    for (int i = 0; i < frame.rotations(); ++i) {
      force(start_[m] + frame.translations() + i) += states_[m].frame.G.col(i).dot(M);
    }
    add_elastic(m, CoordinatePart::turn, states_[m].turn.generalized(M));
  }

  /// Moment about the normal of the plane, positive as planar_angle() is.
  void add_planar_torque(std::size_t m, const Scalar& moment) {
    if (turns(m)) add_torque(m, moment * states_[m].frame.G.col(0));
  }

  /// Generalized forces on the local coordinates.
  const Coordinates& forces() const { return forces_; }

 private:
  struct MarkerState {
    FrameMotion<Scalar> frame;
    Vector u, u_dot, psi, psi_dot;
    ElasticRotation<Scalar> turn;               ///< by ψ
    Vector spin = Vector::Constant(Scalar(0));  ///< of that turn against the frame, local axes
    Scalar angle = Scalar(0), angle_rate = Scalar(0);
  };

  int set_marker(std::size_t m, const Scalar* q, const Scalar* v) {
    const Marker& marker = markers_[m];
    MarkerState& state = states_[m];
    using Local = Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, max_marker_size, 1>;
    using Map = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;
    int next = marker.frame.size();
    state.frame = frame_motion<Scalar>(marker.frame, Map(q, next), Map(v, next),
                                       Local(Local::Constant(next, Scalar(0))));
    if (marker.frame.rotation == RotationCoordinates::angle) {
      state.angle = q[next - 1];
      state.angle_rate = v[next - 1];
    }
    for (int i = 0; i < 6; ++i) {
      const bool is_active = marker.elastic[static_cast<std::size_t>(i)] >= 0;
      (i < 3 ? state.u : state.psi)(i % 3) = is_active ? q[next] : Scalar(0);
      (i < 3 ? state.u_dot : state.psi_dot)(i % 3) = is_active ? v[next] : Scalar(0);
      if (is_active) ++next;
    }
    if (!marker.turns()) return next;
    state.turn = ElasticRotation<Scalar>(state.psi);
    state.spin = state.turn.spin(state.psi_dot);
    return next;
  }

  bool turns(std::size_t m) const { return markers_[m].frame.rotations() > 0; }
  Scalar& force(int i) { return forces_[static_cast<std::size_t>(i)]; }

  /// g · ∂A/∂(rotation coordinate) s
  void add_lever(std::size_t m, const Vector& g, const Vector& s) {
    const BodyFrame& frame = markers_[m].frame;
    for (int i = 0; i < frame.rotations(); ++i) {
      const Vector moved = states_[m].frame.A_p[static_cast<std::size_t>(i)] * s;
      force(start_[m] + frame.translations() + i) += moved.dot(g);
    }
  }

  void add_elastic(std::size_t m, CoordinatePart part, const Vector& local) {
    int position = start_[m] + markers_[m].frame.size();
    for (int i = 0; i < 6; ++i) {
      if (markers_[m].elastic[static_cast<std::size_t>(i)] < 0) continue;
      if ((i < 3) == (part == CoordinatePart::displacement)) force(position) += local(i % 3);
      ++position;
    }
  }

  const std::array<Marker, Count>& markers_;
  std::array<MarkerState, Count> states_;
  std::array<int, Count> start_{};
  Coordinates forces_;
};

}  // namespace pleuel
