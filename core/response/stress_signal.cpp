#include "core/response/stress_signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/response/section_force_signal.hpp"
#include "core/response/section_forces.hpp"

namespace pleuel {

namespace {

/// The section as a whole, a stress point of it or a point of a round outline, by its number, or half
/// of a round outline.
struct OutlinePlace {
  enum class Kind { section, point, outline, tension_side, compression_side };
  Kind kind;
  int number = 0;

  bool moves() const { return kind == Kind::tension_side || kind == Kind::compression_side; }
  bool is_tension_side() const { return kind == Kind::tension_side; }

  template <class Scalar>
  StressPoint<Scalar> at(const SectionProperties<Scalar>& section) const {
    if (kind == Kind::point) return section.points[number];
    return outline_point(section, 2.0 * std::numbers::pi * number / fixed_outline_points);
  }
};

/// Points that torsion tells apart.
std::vector<int> points_of_distinct_shear(const SectionProperties<double>& section) {
  std::vector<int> distinct;
  for (int i = 0; i < int_size(section.points); ++i) {
    const auto is_same = [&](int other) {
      return section.points[other].shear == section.points[i].shear;
    };
    if (std::ranges::none_of(distinct, is_same)) distinct.push_back(i);
  }
  return distinct;
}

template <class Scalar, class Force>
StressOf<Scalar, Force> bending_stress(const SectionProperties<Scalar>& section,
                                       const SectionForces<Force>& forces,
                                       const OutlinePlace& place) {
  using std::sqrt;
  if (!place.moves()) {
    const StressPoint<Scalar> at = place.at(section);
    return forces.moment_y * at.z / section.inertia_y - forces.moment_z * at.y / section.inertia_z;
  }
  // The largest b_y cos θ + b_z sin θ of a round outline.
  constexpr double tiny = 1e-300;  // keeps the root differentiable at zero [Pa²]
  const auto along_y = forces.moment_z * section.radius_y / section.inertia_z;
  const auto along_z = forces.moment_y * section.radius_z / section.inertia_y;
  const StressOf<Scalar, Force> largest = sqrt(along_y * along_y + along_z * along_z + tiny);
  return place.is_tension_side() ? largest : -largest;
}

template <class Scalar, class Force>
StressOf<Scalar, Force> von_mises(const SectionProperties<Scalar>& section,
                                  const SectionForces<Force>& forces, const OutlinePlace& place) {
  return von_mises_stress(section, forces,
                          place.moves()
                              ? most_stressed_point(section, forces, place.is_tension_side())
                              : place.at(section));
}

/// Normal stress, what it is made from, and the stress of torsion (StressPart).
class StressQuantity {
 public:
  static constexpr std::array parts = section_force_parts;
  using Point = OutlinePlace;

  StressQuantity(StressPart part, OutlinePoints points) : part_(part), points_(points) {}

  std::vector<Point> points(const BodyModel& body, const SectionProperties<double>& section) const {
    const bool is_planar = body.frame.rotation == RotationCoordinates::angle;
    const bool is_shear = part_ == StressPart::shear;
    std::vector<Point> all;
    if (part_ == StressPart::axial) return {{Point::Kind::section}};
    if (!is_shear && section.is_round() && !is_planar) {
      if (points_ == OutlinePoints::most_stressed) {
        return {{Point::Kind::tension_side}, {Point::Kind::compression_side}};
      }
      for (int i = 0; i < fixed_outline_points; ++i) all.push_back({Point::Kind::outline, i});
      return all;
    }
    for (const int point :
         is_shear ? points_of_distinct_shear(section) : distinct_stress_points(body, section)) {
      all.push_back({Point::Kind::point, point});
    }
    return all;
  }

  std::string name(const SectionProperties<double>& section, const Point& place) const {
    if (place.kind == Point::Kind::section) return "";
    if (place.moves()) return place.is_tension_side() ? ", tension side" : ", compression side";
    if (place.kind == Point::Kind::outline) {
      return fmt::format(", {} degrees from y to z", place.number * 360 / fixed_outline_points);
    }
    const StressPoint<double>& at = section.points[place.number];
    return fmt::format(", y = {:.4g} m, z = {:.4g} m", at.y, at.z);
  }

  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>& beam,
                                   const SectionProperties<Scalar>& section, const Force* numbers,
                                   const Point& place) const {
    const SectionForces<Force> forces = section_forces(numbers);
    switch (part_) {
      case StressPart::axial:
        return forces.axial / section.area;
      case StressPart::normal:
        return forces.axial / section.area + bending_stress(section, forces, place);
      case StressPart::bending:
        return bending_stress(section, forces, place);
      case StressPart::shear:
        return forces.torque * section.points[place.number].shear;
      case StressPart::utilization:  // a beam has one material
        return von_mises(section, forces, place) / beam.elements.front().strengths.yield;
      default:
        return von_mises(section, forces, place);
    }
  }

 private:
  StressPart part_;
  OutlinePoints points_;
};

}  // namespace

std::vector<int> distinct_stress_points(const BodyModel& body,
                                        const SectionProperties<double>& section) {
  const bool is_planar = body.frame.rotation == RotationCoordinates::angle;
  const Eigen::Vector3d normal = body.frame.reference.transpose() * body.frame.axis;
  const bool bends_along_y = std::abs(normal.z()) > 0.5;
  const int points = int_size(section.points);
  const auto lever = [&](int k) {
    const StressPoint<double>& point = section.points[k];
    return bends_along_y ? point.y : point.z;
  };
  bool has_upper = false, has_lower = false;
  for (int i = 0; i < points; ++i) {
    has_upper = has_upper || lever(i) > 0.0;
    has_lower = has_lower || lever(i) < 0.0;
  }
  std::vector<int> distinct;
  for (int i = 0; i < points; ++i) {
    bool is_new = !is_planar || lever(i) != 0.0 || !(has_upper && has_lower);
    for (int other : distinct) is_new = is_new && !(is_planar && lever(other) == lever(i));
    if (is_new) distinct.push_back(i);
  }
  return distinct;
}

std::unique_ptr<Signal> make_stress_signal(const BodyModel& body, const Eigen::Vector3d& gravity,
                                           StressPart part, OutlinePoints points,
                                           const StationChoice& stations) {
  return make_section_signal(body, gravity, stations, StressQuantity(part, points));
}

namespace {

/// √(a² + b²), differentiable at zero.
template <class Scalar>
Scalar magnitude_of(const Scalar& a, const Scalar& b) {
  using std::sqrt;
  constexpr double tiny = 1e-300;  // [Pa²]
  return sqrt(a * a + b * b + tiny);
}

/// Shear stress at the places of a section where it can be the largest.
class ShearStress {
 public:
  static constexpr std::array parts = {SectionForcePart::shear_y, SectionForcePart::shear_z,
                                       SectionForcePart::torque};
  struct Point {
    int number;
    bool is_only;
  };

  /// In a plane there is one shear force and no torsion.
  std::vector<Point> points(const BodyModel& body, const SectionProperties<double>& section) const {
    const std::vector<ShearPoint<double>>& places = section.shear_points;
    std::vector<Point> all;
    for (int i = 0; i < int_size(places); ++i) all.push_back({i, places.size() == 1});
    if (body.frame.rotation != RotationCoordinates::angle) return all;
    const Eigen::Vector3d normal = body.frame.reference.transpose() * body.frame.axis;
    const auto share = [&](const ShearPoint<double>& point) {
      return std::abs(normal.z()) > 0.5 ? point.by_y : point.by_z;
    };
    const auto largest = std::ranges::max_element(
        places, [&](const auto& one, const auto& other) { return share(one) < share(other); });
    return {{static_cast<int>(largest - places.begin()), true}};
  }

  std::string name(const SectionProperties<double>& section, const Point& point) const {
    if (point.is_only) return "";
    return fmt::format(", place {} of {}", point.number + 1, section.shear_points.size());
  }

  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>&, const SectionProperties<Scalar>& section,
                                   const Force* forces, const Point& place) const {
    using Stress = StressOf<Scalar, Force>;
    const ShearPoint<Scalar>& point = section.shear_points[place.number];
    const Stress of_y = point.by_y * forces[0], of_z = point.by_z * forces[1], none(0);
    const Stress of_torque = magnitude_of<Stress>(point.by_torque * forces[2], none);
    if (!point.is_in_wall) return magnitude_of(of_y, of_z) + of_torque;
    return magnitude_of(of_y, none) + magnitude_of(of_z, none) + of_torque;
  }
};

}  // namespace

std::unique_ptr<Signal> make_shear_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity,
                                                 const StationChoice& stations) {
  return make_section_signal(body, gravity, stations, ShearStress());
}

}  // namespace pleuel
