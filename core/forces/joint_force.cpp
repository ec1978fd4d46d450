#include "core/forces/joint_force.hpp"

#include "core/forces/force_term.hpp"
#include "core/forces/spring_damper.hpp"

namespace pleuel {

namespace {

/// δW = τ δs,  τ = −k (s − s₀) − c ṡ − r + M, with the exact gradient and the exact rate of s: the
/// spring has the potential ½k (s − s₀)², and the damper takes the power c ṡ². Where the joint
/// holds, δs = n · (δπ₂ − δπ₁) is the virtual rotation about its axis n.
struct JointForceLaw {
  static constexpr std::size_t marker_count = 2;
  template <class Scalar>
  using Data = JointForceData<Scalar>;
  template <class Scalar>
  using Markers = MarkerKinematics<Scalar, 2>;

  std::string name;
  RelativeKinematics along;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    switch (along.coordinate) {
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
    const Relative<Scalar> now = along.at<Scalar>(data, time, markers);
    switch (reading) {
      case Reading::coordinate:
        return now.s;
      case Reading::rate:
        return now.rate;
      case Reading::force:
        return passive_force(data, time, now);
      case Reading::damper_power:
        return damper_force(data.damping, data.resistance, time, Scalar(now.s - data.rest),
                            now.rate) *
               now.rate;
      case Reading::motor_power:
        break;
    }
    return motor_force(data, time, now) * now.rate;
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    return along.depends_on(row) && along.depends_on(col);
  }

 private:
  template <class Scalar>
  static Scalar passive_force(const Data<Scalar>& data, double time, const Relative<Scalar>& now) {
    const Scalar stretch = now.s - data.rest;
    return -data.stiffness * stretch - data.damping * now.rate -
           data.resistance.value_at(time, stretch, now.rate);
  }
  template <class Scalar>
  static Scalar motor_force(const Data<Scalar>& data, double time, const Relative<Scalar>& now) {
    Scalar force = data.motor.value_at(time, now.s, now.rate);
    if (data.target.parameters.empty()) return force;
    const TimeValue<Scalar> target = data.target.at(time);
    return force + data.proportional * (target.value - now.s) +
           data.derivative * (target.rate - now.rate);
  }
  template <class Scalar>
  static Scalar force(const Data<Scalar>& data, double time, const Relative<Scalar>& now) {
    return motor_force(data, time, now) + passive_force(data, time, now);
  }

  template <class Scalar>
  void add_planar_moment(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const Scalar moment =
        along.sense * force<Scalar>(data, time, along.planar_turn<Scalar>(data, markers));
    markers.add_planar_torque(1, moment);
    markers.add_planar_torque(0, -moment);
  }

  template <class Scalar>
  void add_moment(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const auto& [local_a, local_b, local_d] = data.directions;
    const RelativeTurn<Scalar> now = along.turn<Scalar>(data, time, markers);
    const Scalar share = force<Scalar>(data, time, now) / now.squared;
    const Scalar on_x = -share * now.y, on_y = share * now.x;
    markers.add_to_direction(1, on_x * now.a + on_y * now.b, local_d);
    markers.add_to_direction(0, on_x * now.d, local_a);
    markers.add_to_direction(0, on_y * now.d, local_b);
  }

  template <class Scalar>
  void add_force(const Data<Scalar>& data, double time, Markers<Scalar>& markers) const {
    const RelativeSlide<Scalar> now = along.slide<Scalar>(data, markers);
    const Scalar value = force<Scalar>(data, time, now);
    markers.add_force(1, value * now.d, data.points[1]);
    markers.add_force(0, -value * now.d, data.points[0]);
    markers.add_to_direction(0, value * now.D, data.directions[0]);
  }
};

/// @param what  it is to who reads an error
JointForceLaw law_of(const std::string& what, const JointForceTopology& topology) {
  const std::string name = what + " " + topology.name;
  return {name, {name, topology.coordinate, topology.sense}};
}

}  // namespace

ForceElement make_joint_force(
    const JointForceTopology& topology, const JointForceData<double>& data,
    const std::vector<DesignDerivative<JointForceData<double>>>& derivatives) {
  return make_force_element(law_of("joint force", topology), topology.markers, data, derivatives);
}

std::unique_ptr<Gauge> make_joint_gauge(
    const JointForceTopology& topology, const JointForceData<double>& data,
    const std::vector<DesignDerivative<JointForceData<double>>>& derivatives) {
  return std::make_unique<MarkerGauge<JointForceLaw>>(law_of("joint", topology), topology.markers,
                                                      data, derivatives);
}

}  // namespace pleuel
