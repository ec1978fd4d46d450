#pragma once

#include "core/frame/elastic_rotation.hpp"
#include "core/joints/joint.hpp"
#include "core/system/term.hpp"

/// The equations of a joint in any scalar type: value, tangent and design derivative are one text.
///
/// All equations are linear or bilinear in vectors attached to a marker,
///     points: y = r + A (p₀ + u),    directions: y = A R(ψ) s
/// (u, ψ: elastic displacement and rotation, R: elastic_rotation.hpp), so that Φ̇ and Φ̈ follow by
/// Leibniz' rule, and the generalized forces Φ_qᵀ λ by the transposed derivatives of y.
namespace pleuel {

/// Coordinates of one marker: frame coordinates, then its active elastic ones.
template <class Scalar>
struct MarkerMotion {
  FrameMotion<Scalar> frame;
  std::array<Vector3<Scalar>, 3> u, psi;  ///< value, rate, acceleration
  ElasticRotation<Scalar> turn;           ///< by ψ
  /// Of that turn against the frame, local axes.
  Vector3<Scalar> spin = Vector3<Scalar>::Constant(Scalar(0)), spin_rate = spin;
};

/// A vector with its first two time derivatives.
template <class Scalar>
using Motion = std::array<Vector3<Scalar>, 3>;

/// What a joint does to its second body, global axes: Φ_qᵀ λ is a load on the left-hand side, so
///     force = −(∂Φ/∂P₂)ᵀ λ at P₂,    moment = −(∂Φ/∂θ₂)ᵀ λ about P₂
template <class Scalar>
struct Wrench {
  Vector3<Scalar> force = Vector3<Scalar>::Constant(Scalar(0));   ///< [N]
  Vector3<Scalar> moment = Vector3<Scalar>::Constant(Scalar(0));  ///< [N m]
};

template <class Scalar>
class JointEvaluation {
 public:
  JointEvaluation(const JointTopology& topology, const JointData<Scalar>& data, double time)
      : topology_(topology), data_(data) {
    if (topology.is_driven) drive_ = data.drive.at(time);
  }

  /// @param q, v, a   local coordinates: first marker's, then second marker's
  void set_state(const Scalar* q, const Scalar* v, const Scalar* a) {
    int first = 0;
    for (std::size_t m = 0; m < 2; ++m) {
      start_[m] = first;
      first += set_marker(m, q + first, v + first, a + first);
    }
  }

  /// Adds Φ_qᵀ λ to `forces` (local coordinates) and writes the equations at the level.
  void evaluate(ConstraintLevel level, const Scalar* lambda, Scalar* forces, Scalar* equations) {
    forces_ = forces;
    wrench_ = {};
    for (std::size_t i = 0; i < topology_.equations.size(); ++i) {
      equations[i] = evaluate_equation(topology_.equations[i], level, lambda[i]);
    }
  }

  /// What the joint did to its second body in the last evaluation.
  const Wrench<Scalar>& wrench() const { return wrench_; }

 private:
  int set_marker(std::size_t m, const Scalar* q, const Scalar* v, const Scalar* a) {
    const Marker& marker = topology_.markers[m];
    MarkerMotion<Scalar>& motion = markers_[m];
    using Map = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;
    int next = marker.frame.size();
    motion.frame = frame_motion<Scalar>(marker.frame, Map(q, next), Map(v, next), Map(a, next));
    if (marker.frame.rotation == RotationCoordinates::angle) {
      angles_[m] = {q[next - 1], v[next - 1], a[next - 1]};
    }
    for (int i = 0; i < 6; ++i) {
      auto& target = i < 3 ? motion.u : motion.psi;
      const bool is_active = marker.elastic[static_cast<std::size_t>(i)] >= 0;
      target[0](i % 3) = is_active ? q[next] : Scalar(0);
      target[1](i % 3) = is_active ? v[next] : Scalar(0);
      target[2](i % 3) = is_active ? a[next] : Scalar(0);
      if (is_active) ++next;
    }
    if (!marker.turns()) return next;
    motion.turn = ElasticRotation<Scalar>(motion.psi[0]);
    motion.spin = motion.turn.spin(motion.psi[1]);
    motion.spin_rate = motion.turn.spin_rate(motion.psi[1], motion.psi[2]);
    return next;
  }

  Motion<Scalar> to_global(std::size_t m, const Motion<Scalar>& s) const {
    const FrameMotion<Scalar>& frame = markers_[m].frame;
    return {Vector3<Scalar>(frame.A * s[0]), Vector3<Scalar>(frame.A_dot * s[0] + frame.A * s[1]),
            Vector3<Scalar>(frame.A_ddot * s[0] + 2.0 * (frame.A_dot * s[1]) + frame.A * s[2])};
  }

  Motion<Scalar> local_point(std::size_t m) const {
    Motion<Scalar> s = markers_[m].u;
    s[0] += data_.points[m];
    return s;
  }

  Motion<Scalar> point(std::size_t m) const {
    Motion<Scalar> y = to_global(m, local_point(m));
    y[0] += markers_[m].frame.r;
    y[1] += markers_[m].frame.r_dot;
    y[2] += markers_[m].frame.r_ddot;
    return y;
  }

  /// R s with its time derivatives, s moving in the undeformed marker.
  Motion<Scalar> local_direction(std::size_t m, const Motion<Scalar>& s) const {
    const MarkerMotion<Scalar>& motion = markers_[m];
    const Vector3<Scalar> turned = motion.turn.turned(s[0]), moved = motion.turn.turned(s[1]);
    const Vector3<Scalar> carried = motion.spin.cross(turned);
    return {turned, Vector3<Scalar>(carried + moved),
            Vector3<Scalar>(motion.spin_rate.cross(turned) +
                            motion.spin.cross(Vector3<Scalar>(carried + 2.0 * moved)) +
                            motion.turn.turned(s[2]))};
  }

  Motion<Scalar> fixed_direction(int index) const {
    const Vector3<Scalar> zero = Vector3<Scalar>::Constant(Scalar(0));
    return {data_.directions[static_cast<std::size_t>(index)], zero, zero};
  }

  /// cos f d_b − sin f d_a, turning with the drive in the first marker.
  Motion<Scalar> driven_direction(const JointEquation& equation) const {
    using std::cos;
    using std::sin;
    const Scalar c = cos(drive_.value), s = sin(drive_.value);
    const Vector3<Scalar> a = data_.directions[static_cast<std::size_t>(equation.first)];
    const Vector3<Scalar> b = data_.directions[static_cast<std::size_t>(equation.third)];
    const Vector3<Scalar> normal = c * b - s * a, tangent = -(s * b) - c * a;
    const Scalar rate2 = drive_.rate * drive_.rate;
    return {normal, Vector3<Scalar>(drive_.rate * tangent),
            Vector3<Scalar>(drive_.acceleration * tangent - rate2 * normal)};
  }

  /// Generalized forces of a force g (global axes) on the point of a marker.
  void apply_to_point(std::size_t m, const Vector3<Scalar>& g) {
    if (m == 1) wrench_.force -= g;
    apply_to_frame(m, g, markers_[m].u[0] + data_.points[m]);
    const BodyFrame& frame = topology_.markers[m].frame;
    for (int i = 0; i < frame.translations(); ++i) {
      forces_[start_[m] + i] += frame.basis.col(i).template cast<Scalar>().dot(g);
    }
    apply_to_elastic(m, 0, markers_[m].frame.A.transpose() * g);
  }

  /// … of g = ∂(…)/∂d on the direction d = A R s of a marker.
  void apply_to_direction(std::size_t m, const Vector3<Scalar>& g, const Vector3<Scalar>& s) {
    const MarkerMotion<Scalar>& motion = markers_[m];
    const Vector3<Scalar> turned = motion.turn.turned(s);
    apply_to_frame(m, g, turned);
    if (m == 1) wrench_.moment -= Vector3<Scalar>(motion.frame.A * turned).cross(g);
    const Vector3<Scalar> local = motion.frame.A.transpose() * g;
    apply_to_elastic(m, 3, motion.turn.generalized(turned.cross(local)));
  }

  void apply_to_frame(std::size_t m, const Vector3<Scalar>& g, const Vector3<Scalar>& s) {
    const BodyFrame& frame = topology_.markers[m].frame;
    for (int i = 0; i < frame.rotations(); ++i) {
      const Vector3<Scalar> lever = markers_[m].frame.A_p[static_cast<std::size_t>(i)] * s;
      forces_[start_[m] + frame.translations() + i] += lever.dot(g);
    }
  }

  void apply_to_elastic(std::size_t m, int first, const Vector3<Scalar>& local) {
    const Marker& marker = topology_.markers[m];
    int position = start_[m] + marker.frame.size();
    for (int i = 0; i < 6; ++i) {
      if (marker.elastic[static_cast<std::size_t>(i)] < 0) continue;
      if (i / 3 == first / 3) forces_[position] += local(i % 3);
      ++position;
    }
  }

  static Scalar dot_at(ConstraintLevel level, const Motion<Scalar>& a, const Motion<Scalar>& b) {
    switch (level) {
      case ConstraintLevel::position:
        return a[0].dot(b[0]);
      case ConstraintLevel::velocity:
        return a[1].dot(b[0]) + a[0].dot(b[1]);
      default:
        return a[2].dot(b[0]) + 2.0 * a[1].dot(b[1]) + a[0].dot(b[2]);
    }
  }

  Scalar evaluate_equation(const JointEquation& equation, ConstraintLevel level,
                           const Scalar& lambda) {
    switch (equation.kind) {
      case EquationKind::coincident:
        return coincident(equation, level, lambda);
      case EquationKind::on_plane:
        return on_plane(equation, level, lambda);
      case EquationKind::slide:
        return on_plane(equation, level, lambda) - drive_at(level);
      case EquationKind::distance:
        return distance(level, lambda);
      case EquationKind::perpendicular:
        return directions(level, lambda, fixed_direction(equation.first), equation.second);
      case EquationKind::drive:
        return directions(level, lambda, driven_direction(equation), equation.second);
      default:
        return planar_angle(equation, level, lambda);
    }
  }

  Scalar coincident(const JointEquation& equation, ConstraintLevel level, const Scalar& lambda) {
    const Vector3<Scalar> e = equation.fixed.template cast<Scalar>();
    const auto order = static_cast<std::size_t>(level);
    apply_to_point(0, Vector3<Scalar>(-lambda * e));
    apply_to_point(1, Vector3<Scalar>(lambda * e));
    return e.dot(point(1)[order] - point(0)[order]);
  }

  Scalar on_plane(const JointEquation& equation, ConstraintLevel level, const Scalar& lambda) {
    const Motion<Scalar> s = fixed_direction(equation.first);
    const Motion<Scalar> d = to_global(0, local_direction(0, s));
    Motion<Scalar> difference = point(1);
    const Motion<Scalar> start = point(0);
    for (std::size_t i = 0; i < 3; ++i) difference[i] -= start[i];
    apply_to_point(0, Vector3<Scalar>(-lambda * d[0]));
    apply_to_point(1, Vector3<Scalar>(lambda * d[0]));
    apply_to_direction(0, Vector3<Scalar>(lambda * difference[0]), s[0]);
    return dot_at(level, d, difference);
  }

  /// Φ = ½ (Δ·Δ/ℓ − ℓ), with c = Δ·Δ and its time derivatives.
  Scalar distance(ConstraintLevel level, const Scalar& lambda) {
    Motion<Scalar> delta = point(1);
    const Motion<Scalar> start = point(0);
    for (std::size_t i = 0; i < 3; ++i) delta[i] -= start[i];
    const Scalar l = data_.length + drive_.value;
    const Vector3<Scalar> g = (lambda / l) * delta[0];
    apply_to_point(0, Vector3<Scalar>(-g));
    apply_to_point(1, g);
    const Scalar c = delta[0].dot(delta[0]);
    if (level == ConstraintLevel::position) return 0.5 * (c / l - l);
    const Scalar c_dot = 2.0 * delta[0].dot(delta[1]), l_dot = drive_.rate;
    if (level == ConstraintLevel::velocity) {
      return 0.5 * (c_dot / l - c * l_dot / (l * l) - l_dot);
    }
    const Scalar c_ddot = 2.0 * (delta[1].dot(delta[1]) + delta[0].dot(delta[2]));
    const Scalar l_ddot = drive_.acceleration;
    return 0.5 * (c_ddot / l - 2.0 * c_dot * l_dot / (l * l) - c * l_ddot / (l * l) +
                  2.0 * c * l_dot * l_dot / (l * l * l) - l_ddot);
  }

  const Scalar& drive_at(ConstraintLevel level) const {
    switch (level) {
      case ConstraintLevel::position:
        return drive_.value;
      case ConstraintLevel::velocity:
        return drive_.rate;
      default:
        return drive_.acceleration;
    }
  }

  Scalar directions(ConstraintLevel level, const Scalar& lambda, const Motion<Scalar>& local_first,
                    int second) {
    const Motion<Scalar> local_second = fixed_direction(second);
    const Motion<Scalar> d1 = to_global(0, local_direction(0, local_first));
    const Motion<Scalar> d2 = to_global(1, local_direction(1, local_second));
    apply_to_direction(0, Vector3<Scalar>(lambda * d2[0]), local_first[0]);
    apply_to_direction(1, Vector3<Scalar>(lambda * d1[0]), local_second[0]);
    return dot_at(level, d1, d2);
  }

  /// φ + nᵀψ of a body that moves in a plane; zero for the ground. n is the normal in local axes.
  Scalar planar_angle(const JointEquation& equation, ConstraintLevel level, const Scalar& lambda) {
    Scalar difference(0);
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    for (std::size_t m = 0; m < 2; ++m) {
      const BodyFrame& frame = topology_.markers[m].frame;
      if (frame.rotations() == 0) continue;
      axis = equation.sense * frame.axis;
      const double sign = m == 0 ? -equation.sense : equation.sense;
      const auto order = static_cast<std::size_t>(level);
      const Vector3<Scalar> normal = markers_[m].frame.G.col(0);
      const Scalar elastic = normal.dot(markers_[m].psi[order]);
      difference += sign * (angles_[m][order] + elastic);
      forces_[start_[m] + frame.translations()] += sign * lambda;
      apply_to_elastic(m, 3, Vector3<Scalar>((sign * lambda) * normal));
    }
    wrench_.moment -= lambda * axis.template cast<Scalar>();
    const Scalar prescribed = equation.is_driven ? drive_at(level) : Scalar(0);
    if (level != ConstraintLevel::position) return difference - prescribed;
    return difference - equation.sense * data_.offset - prescribed;
  }

  const JointTopology& topology_;
  const JointData<Scalar>& data_;
  TimeValue<Scalar> drive_{Scalar(0), Scalar(0), Scalar(0)};
  std::array<MarkerMotion<Scalar>, 2> markers_;
  std::array<std::array<Scalar, 3>, 2> angles_{};
  std::array<int, 2> start_{};
  Scalar* forces_ = nullptr;
  Wrench<Scalar> wrench_;
};

}  // namespace pleuel
