#include "core/forces/joint_force.hpp"

#include <cmath>
#include <sstream>

#include "core/base/error.hpp"
#include "core/forces/force_term.hpp"
#include "core/forces/marker_gauge.hpp"

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

  template <class Scalar>
  Scalar read(const Data<Scalar>& data, double time, const Markers<Scalar>& markers,
              Reading reading) const {
    const Relative<Scalar> now = relative(data, time, markers);
    switch (reading) {
      case Reading::coordinate:
        return now.s;
      case Reading::rate:
        return now.rate;
      case Reading::force:
        return passive_force(data, now);
      case Reading::motor_power:
        break;
    }
    return data.motor.at(time).value * now.rate;
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    return is_moving(row) && is_moving(col);
  }

 private:
  template <class Scalar>
  struct Relative {
    Scalar s, rate;
  };

  /// With what its virtual work is written in.
  template <class Scalar>
  struct Turn : Relative<Scalar> {
    Vector3<Scalar> a, b, d;
    Scalar x, y, squared;
  };

  template <class Scalar>
  struct Slide : Relative<Scalar> {
    Vector3<Scalar> d, D;
  };

  template <class Scalar>
  Relative<Scalar> relative(const Data<Scalar>& data, double time,
                            const Markers<Scalar>& markers) const {
    switch (coordinate) {
      case RelativeCoordinate::planar_angle:
        return planar_turn(data, markers);
      case RelativeCoordinate::angle:
        return turn(data, time, markers);
      case RelativeCoordinate::displacement:
        break;
    }
    return slide(data, markers);
  }
  /// Whether s depends on the coordinate.
  bool is_moving(const LocalCoordinate& local) const {
    using enum CoordinatePart;
    if (coordinate != RelativeCoordinate::displacement) {
      return local.part == rotation || local.part == turn;
    }
    return local.part != turn || local.marker == 0;
  }

  template <class Scalar>
  static Scalar passive_force(const Data<Scalar>& data, const Relative<Scalar>& now) {
    return -data.stiffness * (now.s - data.rest) - data.damping * now.rate;
  }
  template <class Scalar>
  static Scalar force(const Data<Scalar>& data, double time, const Relative<Scalar>& now) {
    return data.motor.at(time).value + passive_force(data, now);
  }

  /// s = ±(φ₂ + nᵀψ₂ − φ₁ − nᵀψ₁ − offset)
  template <class Scalar>
  Relative<Scalar> planar_turn(const Data<Scalar>& data, const Markers<Scalar>& markers) const {
    return {sense * (markers.planar_angle(1) - markers.planar_angle(0) - data.offset),
            sense * (markers.planar_angle(1, 1) - markers.planar_angle(0, 1))};
  }

  template <class Scalar>
  void add_planar_moment(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const Scalar moment = sense * force<Scalar>(data, time, planar_turn(data, markers));
    markers.add_planar_torque(1, moment);
    markers.add_planar_torque(0, -moment);
  }

  /// s = atan2(y, x), x = d' · d_a, y = d' · d_b,   δs = (x δy − y δx) / (x² + y²)
  template <class Scalar>
  Turn<Scalar> turn(const Data<Scalar>& data, double time, const Markers<Scalar>& markers) const {
    using std::atan2;
    const auto& [local_a, local_b, local_d] = data.directions;
    Turn<Scalar> now;
    now.a = markers.direction(0, local_a);
    now.b = markers.direction(0, local_b);
    now.d = markers.direction(1, local_d);
    now.x = now.d.dot(now.a);
    now.y = now.d.dot(now.b);
    now.squared = now.x * now.x + now.y * now.y;
    if (value_of(now.squared) == 0.0) throw_undefined(time);
    const Vector3<Scalar> d_dot = markers.direction_rate(1, local_d);
    const Scalar x_dot = d_dot.dot(now.a) + now.d.dot(markers.direction_rate(0, local_a));
    const Scalar y_dot = d_dot.dot(now.b) + now.d.dot(markers.direction_rate(0, local_b));
    now.s = atan2(now.y, now.x);
    now.rate = (now.x * y_dot - now.y * x_dot) / now.squared;
    return now;
  }

  template <class Scalar>
  void add_moment(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const auto& [local_a, local_b, local_d] = data.directions;
    const Turn<Scalar> now = turn(data, time, markers);
    const Scalar share = force<Scalar>(data, time, now) / now.squared;
    const Scalar on_x = -share * now.y, on_y = share * now.x;
    markers.add_to_direction(1, on_x * now.a + on_y * now.b, local_d);
    markers.add_to_direction(0, on_x * now.d, local_a);
    markers.add_to_direction(0, on_y * now.d, local_b);
  }

  /// s = d · D, D = P₂ − P₁,   δs = d · δD + D · δd
  template <class Scalar>
  Slide<Scalar> slide(const Data<Scalar>& data, const Markers<Scalar>& markers) const {
    const Vector3<Scalar>& local = data.directions[0];
    Slide<Scalar> now;
    now.d = markers.direction(0, local);
    now.D = markers.position(1, data.points[1]) - markers.position(0, data.points[0]);
    const Vector3<Scalar> D_dot =
        markers.velocity(1, data.points[1]) - markers.velocity(0, data.points[0]);
    now.s = now.d.dot(now.D);
    now.rate = now.d.dot(D_dot) + now.D.dot(markers.direction_rate(0, local));
    return now;
  }

  template <class Scalar>
  void add_force(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const Slide<Scalar> now = slide(data, markers);
    const Scalar value = force<Scalar>(data, time, now);
    markers.add_force(1, value * now.d, data.points[1]);
    markers.add_force(0, -value * now.d, data.points[0]);
    markers.add_to_direction(0, value * now.D, data.directions[0]);
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

std::unique_ptr<Gauge> make_joint_gauge(
    JointForceTopology topology, JointForceData<double> data,
    std::vector<DesignDerivative<JointForceData<double>>> derivatives) {
  return std::make_unique<MarkerGauge<JointForceLaw>>(
      JointForceLaw{"joint " + topology.name, topology.coordinate, topology.sense},
      std::move(topology.markers), std::move(data), derivatives);
}

}  // namespace pleuel
