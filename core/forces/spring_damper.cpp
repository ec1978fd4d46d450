#include "core/forces/spring_damper.hpp"

#include <cmath>
#include <sstream>

#include "core/base/error.hpp"
#include "core/forces/force_term.hpp"

namespace pleuel {

namespace {

/// Added to the length where squares are added, so that the force and its derivatives are finite where
/// both points coincide, too [m]; and what counts as no force there [N].
constexpr double no_length = 1e-100, no_pull = 1e-50;

/// With D = P₂ − P₁, l = |D|, e = D/l and l̇ = e · Ḋ:
///     F = k (l − l₀) + c l̇ + r(l − l₀, l̇, t),   δW = −F δl = F e · δP₁ − F e · δP₂
/// (Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, 1989, sec. 6.2). Where the
/// points coincide nothing may pull: with l₀ = 0 the force is k D there, and none within a clearance.
struct SpringDamperLaw {
  static constexpr std::size_t marker_count = 2;
  template <class Scalar>
  using Data = SpringDamperData<Scalar>;

  std::string name;

  template <class Scalar>
  void add_forces(const Data<Scalar>& data, double time,
                  MarkerKinematics<Scalar, 2>& markers) const {
    const Stretch<Scalar> now = stretch(data, time, markers);
    const Vector3<Scalar> F = pull(data, time, now) * now.direction;
    markers.add_force(0, F, data.points[0]);
    markers.add_force(1, -F, data.points[1]);
  }

  template <class Scalar>
  Scalar read(const Data<Scalar>& data, double time, const MarkerKinematics<Scalar, 2>& markers,
              Reading reading) const {
    const Stretch<Scalar> now = stretch(data, time, markers);
    switch (reading) {
      case Reading::coordinate:
        return now.length;
      case Reading::rate:
        return now.rate;
      case Reading::force:
        return pull(data, time, now);
      case Reading::damper_power:
        return damper_force(data.damping, data.resistance, time,
                            Scalar(now.length - data.free_length), now.rate) *
               now.rate;
      case Reading::motor_power:
        break;
    }
    return Scalar(0);
  }

  bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const {
    return row.part != CoordinatePart::turn && col.part != CoordinatePart::turn;
  }

 private:
  template <class Scalar>
  struct Stretch {
    Scalar length, rate;
    Vector3<Scalar> direction;
  };

  template <class Scalar>
  Stretch<Scalar> stretch(const Data<Scalar>& data, double time,
                          const MarkerKinematics<Scalar, 2>& markers) const {
    using std::sqrt;
    const Vector3<Scalar> D =
        markers.position(1, data.points[1]) - markers.position(0, data.points[0]);
    const Scalar squared = D.dot(D);
    const Scalar length = sqrt(squared + no_length * no_length);
    const Vector3<Scalar> e = D / length;
    const Vector3<Scalar> D_dot =
        markers.velocity(1, data.points[1]) - markers.velocity(0, data.points[0]);
    const Stretch<Scalar> now{length, e.dot(D_dot), e};
    if (value_of(squared) == 0.0 && std::abs(value_of(pull(data, time, now))) > no_pull) {
      throw_coincident(time);
    }
    return now;
  }

  template <class Scalar>
  static Scalar pull(const Data<Scalar>& data, double time, const Stretch<Scalar>& now) {
    const Scalar elongation = now.length - data.free_length;
    return data.stiffness * elongation + data.damping * now.rate +
           data.resistance.value_at(time, elongation, now.rate);
  }

  [[noreturn]] void throw_coincident(double time) const {
    std::ostringstream message;
    message
        << name << ": its ends coincide at t = " << time
        << " s, where its force has no direction; give it no free length, or attach it so that its "
           "length stays positive";
    throw SimulationError(message.str());
  }
};

}  // namespace

ForceElement make_spring_damper(
    const SpringDamperTopology& topology, const SpringDamperData<double>& data,
    const std::vector<DesignDerivative<SpringDamperData<double>>>& derivatives) {
  return make_force_element(SpringDamperLaw{"spring-damper " + topology.name}, topology.markers,
                            data, derivatives);
}

}  // namespace pleuel
