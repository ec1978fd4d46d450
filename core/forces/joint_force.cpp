#include "core/forces/joint_force.hpp"

#include <cmath>
#include <sstream>

#include "core/base/error.hpp"
#include "core/forces/force_term.hpp"

namespace pleuel {

namespace {

/// δW = τ δs,  τ = −k (s − s₀) − c ṡ + m(t), with the exact gradient and the exact rate of s: the
/// spring has the potential ½k (s − s₀)², and the damper takes the power c ṡ². Where the joint
/// holds, δs = n · (δπ₂ − δπ₁) is the virtual rotation about its axis n.
struct JointForceLaw {
  static constexpr std::size_t marker_count = 2;
  template <class Scalar>
  using Data = JointForceData<Scalar>;
  template <class Scalar>
  using Markers = MarkerKinematics<Scalar, 2>;

  std::string name;
  RelativeCoordinate coordinate;
  double sense;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    switch (coordinate) {
      case RelativeCoordinate::planar_angle:
        return add_planar_moment(data, time, markers);
      case RelativeCoordinate::angle:
        return add_moment(data, time, markers);
      case RelativeCoordinate::displacement:
        return add_force(data, time, markers);
    }
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    return is_moving(row) && is_moving(col);
  }

 private:
  /// Whether s depends on the coordinate.
  bool is_moving(const LocalCoordinate& local) const {
    using enum CoordinatePart;
    if (coordinate != RelativeCoordinate::displacement) {
      return local.part == rotation || local.part == turn;
    }
    return local.part != turn || local.marker == 0;
  }

  template <class Scalar>
  static Scalar force(const Data<Scalar>& data, double time, const Scalar& s, const Scalar& rate) {
    return data.motor.at(time).value - data.stiffness * (s - data.rest) - data.damping * rate;
  }

  /// s = ±(φ₂ + nᵀψ₂ − φ₁ − nᵀψ₁ − offset)
  template <class Scalar>
  void add_planar_moment(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const Scalar s = sense * (markers.planar_angle(1) - markers.planar_angle(0) - data.offset);
    const Scalar rate = sense * (markers.planar_angle(1, 1) - markers.planar_angle(0, 1));
    const Scalar moment = sense * force<Scalar>(data, time, s, rate);
    markers.add_planar_torque(1, moment);
    markers.add_planar_torque(0, -moment);
  }

  /// s = atan2(y, x), x = d' · d_a, y = d' · d_b,   δs = (x δy − y δx) / (x² + y²)
  template <class Scalar>
  void add_moment(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    using std::atan2;
    const auto& [local_a, local_b, local_d] = data.directions;
    const Vector3<Scalar> a = markers.direction(0, local_a), b = markers.direction(0, local_b);
    const Vector3<Scalar> d = markers.direction(1, local_d);
    const Scalar x = d.dot(a), y = d.dot(b);
    const Scalar squared = x * x + y * y;
    if (value_of(squared) == 0.0) throw_undefined(time);
    const Vector3<Scalar> d_dot = markers.direction_rate(1, local_d);
    const Scalar x_dot = d_dot.dot(a) + d.dot(markers.direction_rate(0, local_a));
    const Scalar y_dot = d_dot.dot(b) + d.dot(markers.direction_rate(0, local_b));
    const Scalar s = atan2(y, x), rate = (x * y_dot - y * x_dot) / squared;
    const Scalar share = force<Scalar>(data, time, s, rate) / squared;
    const Scalar on_x = -share * y, on_y = share * x;
    markers.add_to_direction(1, on_x * a + on_y * b, local_d);
    markers.add_to_direction(0, on_x * d, local_a);
    markers.add_to_direction(0, on_y * d, local_b);
  }

  /// s = d · D, D = P₂ − P₁,   δs = d · δD + D · δd
  template <class Scalar>
  void add_force(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const Vector3<Scalar>& local = data.directions[0];
    const Vector3<Scalar> d = markers.direction(0, local);
    const Vector3<Scalar> D =
        markers.position(1, data.points[1]) - markers.position(0, data.points[0]);
    const Vector3<Scalar> D_dot =
        markers.velocity(1, data.points[1]) - markers.velocity(0, data.points[0]);
    const Scalar s = d.dot(D), rate = d.dot(D_dot) + D.dot(markers.direction_rate(0, local));
    const Scalar value = force<Scalar>(data, time, s, rate);
    markers.add_force(1, value * d, data.points[1]);
    markers.add_force(0, -value * d, data.points[0]);
    markers.add_to_direction(0, value * D, local);
  }

  [[noreturn]] void throw_undefined(double time) const {
    std::ostringstream message;
    message << name << ": the angle has no value at t = " << time
            << " s, the second body having tilted by a right angle against the axis";
    throw SimulationError(message.str());
  }
};

}  // namespace

std::unique_ptr<Term> make_joint_force_term(
    JointForceTopology topology, JointForceData<double> data,
    std::vector<DesignDerivative<JointForceData<double>>> derivatives) {
  return std::make_unique<ForceTerm<JointForceLaw>>(
      JointForceLaw{"joint force " + topology.name, topology.coordinate, topology.sense},
      std::move(topology.markers), std::move(data), derivatives);
}

}  // namespace pleuel
