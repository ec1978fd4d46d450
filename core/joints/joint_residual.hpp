#pragma once

#include "core/frame/marker_kinematics.hpp"
#include "core/joints/joint.hpp"
#include "core/system/term.hpp"

/// The equations of a joint in any scalar type: value, tangent and design derivative are one text.
///
/// All equations are linear or bilinear in points and directions attached to a marker
/// (marker_kinematics.hpp), so that Φ̇ and Φ̈ follow by Leibniz' rule, and the generalized forces
/// Φ_qᵀ λ by the transposed derivatives of these vectors.
namespace pleuel {

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
  using Kinematics = MarkerKinematics<Scalar, 2>;

  /// @param q, v, a   local coordinates: first marker's, then second marker's
  JointEvaluation(const JointTopology& topology, const JointData<Scalar>& data, double time,
                  const Scalar* q, const Scalar* v, const Scalar* a)
      : topology_(topology), data_(data), markers_(topology.markers, q, v, a) {
    if (topology.is_driven) drive_ = data.drive.at(time);
  }

  /// Writes the equations at the level.
  void evaluate(ConstraintLevel level, const Scalar* lambda, Scalar* equations) {
    for (std::size_t i = 0; i < topology_.equations.size(); ++i) {
      equations[i] = evaluate_equation(topology_.equations[i], level, lambda[i]);
    }
  }

  /// Φ_qᵀ λ on the local coordinates.
  const typename Kinematics::Coordinates& forces() const { return markers_.forces(); }

  /// What the joint does to its second body.
  const Wrench<Scalar>& wrench() const { return wrench_; }

 private:
  Motion<Scalar> point(std::size_t m) const { return markers_.point(m, data_.points[m]); }

  Motion<Scalar> fixed_direction(int index) const {
    const Vector3<Scalar> zero = Vector3<Scalar>::Constant(Scalar(0));
    return {data_.directions[index], zero, zero};
  }

  /// cos f d_b − sin f d_a, turning with the drive in the first marker.
  Motion<Scalar> driven_direction(const JointEquation& equation) const {
    using std::cos;
    using std::sin;
    const Scalar c = cos(drive_.value), s = sin(drive_.value);
    const Vector3<Scalar>& a = data_.directions[equation.first];
    const Vector3<Scalar>& b = data_.directions[equation.third];
    const Vector3<Scalar> normal = c * b - s * a, tangent = -(s * b) - c * a;
    const Scalar rate2 = drive_.rate * drive_.rate;
    return {normal, Vector3<Scalar>(drive_.rate * tangent),
            Vector3<Scalar>(drive_.acceleration * tangent - rate2 * normal)};
  }

  /// Of a force g, global axes.
  void apply_to_point(std::size_t m, const Vector3<Scalar>& g) {
    if (m == 1) wrench_.force -= g;
    markers_.add_force(m, g, data_.points[m]);
  }

  /// … of g = ∂(…)/∂d on the direction d = A R s of a marker.
  void apply_to_direction(std::size_t m, const Vector3<Scalar>& g, const Vector3<Scalar>& s) {
    if (m == 1) wrench_.moment -= markers_.direction(m, s).cross(g);
    markers_.add_to_direction(m, g, s);
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
      case EquationKind::planar_angle:
        break;
    }
    return planar_angle(equation, level, lambda);
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
    const Motion<Scalar> d = markers_.direction(0, s);
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
    const Motion<Scalar> d1 = markers_.direction(0, local_first);
    const Motion<Scalar> d2 = markers_.direction(1, local_second);
    apply_to_direction(0, Vector3<Scalar>(lambda * d2[0]), local_first[0]);
    apply_to_direction(1, Vector3<Scalar>(lambda * d1[0]), local_second[0]);
    return dot_at(level, d1, d2);
  }

  Scalar planar_angle(const JointEquation& equation, ConstraintLevel level, const Scalar& lambda) {
    const auto order = static_cast<std::size_t>(level);
    const Scalar difference =
        equation.sense * (markers_.planar_angle(1, order) - markers_.planar_angle(0, order));
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    for (std::size_t m = 0; m < 2; ++m) {
      if (markers_.turns(m)) axis = equation.sense * topology_.markers[m].frame.axis;
      markers_.add_planar_torque(m, (m == 0 ? -equation.sense : equation.sense) * lambda);
    }
    wrench_.moment -= lambda * axis.template cast<Scalar>();
    const Scalar prescribed = equation.is_driven ? drive_at(level) : Scalar(0);
    if (level != ConstraintLevel::position) return difference - prescribed;
    return difference - equation.sense * data_.offset - prescribed;
  }

  const JointTopology& topology_;
  const JointData<Scalar>& data_;
  Kinematics markers_;
  TimeValue<Scalar> drive_{Scalar(0), Scalar(0), Scalar(0)};
  Wrench<Scalar> wrench_;
};

}  // namespace pleuel
