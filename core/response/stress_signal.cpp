#include "core/response/stress_signal.hpp"

#include <algorithm>
#include <numbers>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/response/section_stations.hpp"

namespace pleuel {

namespace {

/// A stress point of the section or a point of a round outline, by its number, or half of a round
/// outline.
struct OutlinePlace {
  enum class Kind { point, outline, tension_side, compression_side };
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
    if (std::none_of(distinct.begin(), distinct.end(), is_same)) distinct.push_back(i);
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

class AxialStress : public OneASection {
 public:
  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>&, const SectionProperties<Scalar>& section,
                                   const SectionForces<Force>& forces, Point) const {
    return forces.axial / section.area;
  }
};

/// All parts but the axial one.
class StressQuantity {
 public:
  using Point = OutlinePlace;

  StressQuantity(StressPart part, bool is_averaged) : part_(part), is_averaged_(is_averaged) {}

  std::vector<Point> points(const BodyModel& body, const SectionProperties<double>& section) const {
    const bool is_planar = body.frame.rotation == RotationCoordinates::angle;
    const bool is_shear = part_ == StressPart::shear;
    std::vector<Point> all;
    if (!is_shear && section.is_round() && !is_planar) {
      if (!is_averaged_) return {{Point::Kind::tension_side}, {Point::Kind::compression_side}};
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
    if (place.kind == Point::Kind::point) return stress_point_name(section, place.number);
    if (!place.moves()) return outline_point_name(place.number);
    return place.is_tension_side() ? ", tension side" : ", compression side";
  }

  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>& beam,
                                   const SectionProperties<Scalar>& section,
                                   const SectionForces<Force>& forces, const Point& place) const {
    switch (part_) {
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
  bool is_averaged_;
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
                                           StressPart part, bool is_averaged,
                                           const StationChoice& stations) {
  if (part == StressPart::axial) {
    return make_section_signal(body, gravity, stations, AxialStress());
  }
  return make_section_signal(body, gravity, stations, StressQuantity(part, is_averaged));
}

}  // namespace pleuel
