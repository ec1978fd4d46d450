#pragma once

#include <cmath>
#include <sstream>
#include <string>

#include "core/base/error.hpp"
#include "core/frame/marker_kinematics.hpp"

namespace pleuel {

/// The relative coordinate s of two markers.
enum class RelativeCoordinate {
  planar_angle,  ///< ±(φ₂ − φ₁ − offset), with elastic rotations: counts whole turns
  angle,         ///< by which d' has turned from d_a to d_b, in (−π, π]
  displacement   ///< d · (P₂ − P₁)
};

template <class Scalar>
struct Relative {
  Scalar s, rate;
};

/// An angle in space, with what its virtual work is written in.
template <class Scalar>
struct RelativeTurn : Relative<Scalar> {
  Vector3<Scalar> a, b, d;
  Scalar x, y, squared;
};

template <class Scalar>
struct RelativeSlide : Relative<Scalar> {
  Vector3<Scalar> d, D;
};

/// s and its exact rate. The numbers that it needs are members of `data` (JointForceData): points,
/// directions, offset.
struct RelativeKinematics {
  std::string name;  ///< for errors
  RelativeCoordinate coordinate = RelativeCoordinate::planar_angle;
  double sense = 1.0;  ///< of planar_angle: −1 if the joint's axis is opposite to the normal
  std::size_t first = 0, second = 1;  ///< which markers

  /// @throws SimulationError where the angle has no value
  template <class Scalar, class Data, class Markers>
  Relative<Scalar> at(const Data& data, double time, const Markers& markers) const {
    switch (coordinate) {
      case RelativeCoordinate::planar_angle:
        return planar_turn<Scalar>(data, markers);
      case RelativeCoordinate::angle:
        return turn<Scalar>(data, time, markers);
      case RelativeCoordinate::displacement:
        break;
    }
    return slide<Scalar>(data, markers);
  }

  /// Whether s depends on the coordinate.
  bool depends_on(const LocalCoordinate& local) const {
    using enum CoordinatePart;
    if (local.marker != first && local.marker != second) return false;
    if (coordinate != RelativeCoordinate::displacement) {
      return local.part == rotation || local.part == CoordinatePart::turn;
    }
    return local.part != CoordinatePart::turn || local.marker == first;
  }

  /// s = ±(φ₂ + nᵀψ₂ − φ₁ − nᵀψ₁ − offset)
  template <class Scalar, class Data, class Markers>
  Relative<Scalar> planar_turn(const Data& data, const Markers& markers) const {
    return {sense * (markers.planar_angle(second) - markers.planar_angle(first) - data.offset),
            sense * (markers.planar_angle(second, 1) - markers.planar_angle(first, 1))};
  }

  /// s = atan2(y, x), x = d' · d_a, y = d' · d_b,   δs = (x δy − y δx) / (x² + y²)
  template <class Scalar, class Data, class Markers>
  RelativeTurn<Scalar> turn(const Data& data, double time, const Markers& markers) const {
    using std::atan2;
    const auto& [local_a, local_b, local_d] = data.directions;
    RelativeTurn<Scalar> now;
    now.a = markers.direction(first, local_a);
    now.b = markers.direction(first, local_b);
    now.d = markers.direction(second, local_d);
    now.x = now.d.dot(now.a);
    now.y = now.d.dot(now.b);
    now.squared = now.x * now.x + now.y * now.y;
    if (value_of(now.squared) == 0.0) throw_undefined(time);
    const Vector3<Scalar> d_dot = markers.direction_rate(second, local_d);
    const Scalar x_dot = d_dot.dot(now.a) + now.d.dot(markers.direction_rate(first, local_a));
    const Scalar y_dot = d_dot.dot(now.b) + now.d.dot(markers.direction_rate(first, local_b));
    now.s = atan2(now.y, now.x);
    now.rate = (now.x * y_dot - now.y * x_dot) / now.squared;
    return now;
  }

  /// s = d · D, D = P₂ − P₁,   δs = d · δD + D · δd
  template <class Scalar, class Data, class Markers>
  RelativeSlide<Scalar> slide(const Data& data, const Markers& markers) const {
    const Vector3<Scalar>& local = data.directions[0];
    RelativeSlide<Scalar> now;
    now.d = markers.direction(first, local);
    now.D = markers.position(second, data.points[1]) - markers.position(first, data.points[0]);
    const Vector3<Scalar> D_dot =
        markers.velocity(second, data.points[1]) - markers.velocity(first, data.points[0]);
    now.s = now.d.dot(now.D);
    now.rate = now.d.dot(D_dot) + now.D.dot(markers.direction_rate(first, local));
    return now;
  }

 private:
  [[noreturn]] void throw_undefined(double time) const {
    std::ostringstream message;
    message << name << ": the angle has no value at t = " << time
            << " s, the second body having tilted by a right angle against the axis";
    throw SimulationError(message.str());
  }
};

}  // namespace pleuel
