#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/rotation_vector.hpp"
#include "core/frame/body_frame.hpp"
#include "core/frame/marker.hpp"

namespace pleuel {

/// How the elastic rotation ψ of a place turns the directions that are attached to it: by the
/// rotation R = exp(ψ̃), so that they keep their lengths and angles, and turn in space by the angle
/// that they turn by in a plane. All vectors are in the axes of the floating frame.
///
/// With c_k of RotationSeries at x = ψ·ψ:
///     R s = s + c₁ ψ × s + c₂ ψ × (ψ × s)
/// A change δψ turns by δθ = T δψ against the frame, δ(R s) = δθ × R s, and a moment M does the
/// work M · δθ:
///     T δψ = δψ + c₂ ψ × δψ + c₃ ψ × (ψ × δψ)
/// T is the transpose of the operator of rotation_vector.hpp, which belongs to turned axes. About
/// one axis T is one.
template <class Scalar>
class ElasticRotation {
 public:
  using Vector = Vector3<Scalar>;
  using Matrix = Matrix3<Scalar>;

  /// No rotation.
  ElasticRotation() = default;
  explicit ElasticRotation(const Vector& psi) : psi_(psi), series_(psi.dot(psi)) {}

  /// R s
  Vector turned(const Vector& s) const {
    const Vector across = psi_.cross(s);
    return s + series_.c1 * across + series_.c2 * psi_.cross(across);
  }

  /// T ψ̇: the angular velocity against the frame [rad/s].
  Vector spin(const Vector& rate) const {
    const Vector across = psi_.cross(rate);
    return rate + series_.c2 * across + series_.c3 * psi_.cross(across);
  }

  /// d(T ψ̇)/dt: the angular acceleration against the frame [rad/s²].
  Vector spin_rate(const Vector& rate, const Vector& acceleration) const {
    const Vector across = psi_.cross(rate);
    const Scalar growth = 2.0 * psi_.dot(rate);
    return spin(acceleration) + (growth * series_.slope_of_c2()) * across +
           (growth * series_.slope_of_c3()) * psi_.cross(across) + series_.c3 * rate.cross(across);
  }

  /// Tᵀ M: what a moment M does on ψ.
  Vector generalized(const Vector& moment) const {
    const Vector across = psi_.cross(moment);
    return moment - series_.c2 * across + series_.c3 * psi_.cross(across);
  }

  /// T = (1 − c₃ x) I + c₂ ψ̃ + c₃ ψ ψᵀ
  Matrix tangent() const {
    const Vector scaled = series_.c3 * psi_;
    Matrix columns = skew<Scalar>(Vector(series_.c2 * psi_)) + scaled * psi_.transpose();
    columns.diagonal().array() += 1.0 - scaled.dot(psi_);
    return columns;
  }

  /// ∂(Tᵀ M)/∂ψ for a constant M.
  Matrix slope_of_generalized(const Vector& moment) const {
    const Vector across = psi_.cross(moment);
    Matrix slope = series_.c2 * skew<Scalar>(moment);
    slope.diagonal().array() += series_.c3 * psi_.dot(moment);
    slope += series_.c3 * psi_ * moment.transpose();
    slope += (-2.0 * series_.c3 * moment - 2.0 * series_.slope_of_c2() * across +
              2.0 * series_.slope_of_c3() * psi_.cross(across)) *
             psi_.transpose();
    return slope;
  }

  /// ∂²(g · R s)/∂ψ², symmetric; t is T and `turned` is R s.
  Matrix curvature(const Matrix& t, const Vector& turned, const Vector& g) const {
    const Vector along_turned = t.transpose() * turned, along_g = t.transpose() * g;
    // ∂(tᵢ · R s × g)/∂ψⱼ:  tᵢ changes, and R s by tⱼ × R s.
    return slope_of_generalized(turned.cross(g)) + along_turned * along_g.transpose() -
           g.dot(turned) * t.transpose() * t;
  }

 private:
  Vector psi_ = Vector::Constant(Scalar(0));
  RotationSeries<Scalar> series_;
};

/// What a local coordinate of a joint or a force element moves.
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

/// Their indices in q.
template <std::size_t Count>
std::vector<int> coordinate_indices(const std::array<Marker, Count>& markers) {
  std::vector<int> indices;
  for (const LocalCoordinate& local : local_coordinates(markers)) indices.push_back(local.index);
  return indices;
}

/// A vector with its first two time derivatives.
template <class Scalar>
using Motion = std::array<Vector3<Scalar>, 3>;

/// Kinematics of the markers of a joint or a force element, and the generalized forces of what acts
/// on them.
///
/// Points and directions are attached to a marker by their undeformed local vectors p and s, with
/// the elastic displacement u and rotation ψ of the marker, R = exp(ψ̃):
///     P = r + A (p + u),      d = A R s
/// Forces enter by their virtual work, so that they are the exact gradients of what was computed
/// from P and d.
template <class Scalar, std::size_t Count>
class MarkerKinematics {
 public:
  static constexpr int max_size = static_cast<int>(Count) * max_marker_size;
  using Vector = Vector3<Scalar>;
  using Coordinates = std::array<Scalar, static_cast<std::size_t>(max_size)>;

  /// @param q, v, a  local coordinates and their rates; without a there are no accelerations
  MarkerKinematics(const std::array<Marker, Count>& markers, const Scalar* q, const Scalar* v,
                   const Scalar* a = nullptr)
      : markers_(markers) {
    int first = 0;
    for (std::size_t m = 0; m < Count; ++m) {
      start_[m] = first;
      first += set_marker(m, q + first, v + first, a == nullptr ? nullptr : a + first);
    }
    for (Scalar& force : forces_) force = Scalar(0);
  }

  const FrameMotion<Scalar>& frame(std::size_t m) const { return states_[m].frame; }

  Vector position(std::size_t m, const Vector& p) const {
    const MarkerState& state = states_[m];
    return state.frame.r + state.frame.A * (p + state.u[0]);
  }
  Vector velocity(std::size_t m, const Vector& p) const {
    const MarkerState& state = states_[m];
    return state.frame.r_dot + state.frame.A_dot * (p + state.u[0]) + state.frame.A * state.u[1];
  }
  /// P with its time derivatives.
  Motion<Scalar> point(std::size_t m, const Vector& p) const {
    const MarkerState& state = states_[m];
    const FrameMotion<Scalar>& frame = state.frame;
    Motion<Scalar> y = to_global(m, {Vector(p + state.u[0]), state.u[1], state.u[2]});
    y[0] += frame.r;
    y[1] += frame.r_dot;
    y[2] += frame.r_ddot;
    return y;
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

  /// d with its time derivatives, s moving in the undeformed marker.
  Motion<Scalar> direction(std::size_t m, const Motion<Scalar>& s) const {
    const MarkerState& state = states_[m];
    const Vector turned = state.turn.turned(s[0]), moved = state.turn.turned(s[1]);
    const Vector carried = state.spin.cross(turned);
    return to_global(
        m, {turned, Vector(carried + moved),
            Vector(state.spin_rate.cross(turned) + state.spin.cross(Vector(carried + 2.0 * moved)) +
                   state.turn.turned(s[2]))});
  }

  /// φ + nᵀψ of a body that moves in a plane with normal n (local axes), counting whole turns; zero
  /// for what does not turn.
  /// @param order  of the time derivative, 0 … 2
  Scalar planar_angle(std::size_t m, std::size_t order = 0) const {
    if (!turns(m)) return Scalar(0);
    return states_[m].angle[order] + states_[m].frame.G.col(0).dot(states_[m].psi[order]);
  }
  bool turns(std::size_t m) const { return markers_[m].frame.rotations() > 0; }

  /// Force F on the point p: Q += (∂P/∂q)ᵀ F. Global axes.
  void add_force(std::size_t m, const Vector& F, const Vector& p) {
    const BodyFrame& frame = markers_[m].frame;
    for (int i = 0; i < frame.translations(); ++i) {
      const Vector along = frame.basis.col(i).template cast<Scalar>();
      force(start_[m] + i) += along.dot(F);
    }
    add_lever(m, F, p + states_[m].u[0]);
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
    Motion<Scalar> u, psi;
    ElasticRotation<Scalar> turn;  ///< by ψ
    /// Of that turn against the frame, local axes.
    Vector spin = Vector::Constant(Scalar(0)), spin_rate = spin;
    std::array<Scalar, 3> angle;  ///< of motion in a plane, with its time derivatives
  };

  int set_marker(std::size_t m, const Scalar* q, const Scalar* v, const Scalar* a) {
    const Marker& marker = markers_[m];
    MarkerState& state = states_[m];
    using Local = Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, max_marker_size, 1>;
    using Map = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;
    const int size = marker.frame.size();
    const Local rest = Local::Constant(a == nullptr ? size : 0, Scalar(0));
    state.frame = frame_motion<Scalar>(marker.frame, Map(q, size), Map(v, size),
                                       Map(a == nullptr ? rest.data() : a, size));
    const std::size_t orders = a == nullptr ? 2 : 3;
    const std::array<const Scalar*, 3> rates = {q, v, a};
    for (std::size_t order = 0; order < orders; ++order) {
      if (marker.frame.rotation == RotationCoordinates::angle) {
        state.angle[order] = rates[order][size - 1];
      }
      const Scalar* next = rates[order] + size;
      for (int i = 0; i < 6; ++i) {
        const bool is_active = marker.elastic[i] >= 0;
        (i < 3 ? state.u : state.psi)[order](i % 3) = is_active ? *next++ : Scalar(0);
      }
    }
    if (marker.has_elastic_rotation()) {
      state.turn = ElasticRotation<Scalar>(state.psi[0]);
      state.spin = state.turn.spin(state.psi[1]);
      if (a != nullptr) state.spin_rate = state.turn.spin_rate(state.psi[1], state.psi[2]);
    }
    return size + static_cast<int>(
                      std::ranges::count_if(marker.elastic, [](int index) { return index >= 0; }));
  }

  Motion<Scalar> to_global(std::size_t m, const Motion<Scalar>& s) const {
    const FrameMotion<Scalar>& frame = states_[m].frame;
    return {Vector(frame.A * s[0]), Vector(frame.A_dot * s[0] + frame.A * s[1]),
            Vector(frame.A_ddot * s[0] + 2.0 * (frame.A_dot * s[1]) + frame.A * s[2])};
  }

  Scalar& force(int i) { return forces_[i]; }

  /// g · ∂A/∂(rotation coordinate) s
  void add_lever(std::size_t m, const Vector& g, const Vector& s) {
    const BodyFrame& frame = markers_[m].frame;
    for (int i = 0; i < frame.rotations(); ++i) {
      const Vector moved = states_[m].frame.A_p[i] * s;
      force(start_[m] + frame.translations() + i) += moved.dot(g);
    }
  }

  void add_elastic(std::size_t m, CoordinatePart part, const Vector& local) {
    int position = start_[m] + markers_[m].frame.size();
    for (int i = 0; i < 6; ++i) {
      if (markers_[m].elastic[i] < 0) continue;
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
