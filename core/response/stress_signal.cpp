#include "core/response/stress_signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/response/recovered_signal.hpp"
#include "core/response/section_force_signal.hpp"
#include "core/response/section_forces.hpp"

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

  StressQuantity(StressPart part, OutlinePoints points) : part_(part), points_(points) {}

  std::vector<Point> points(const BodyModel& body, const SectionProperties<double>& section) const {
    const bool is_planar = body.frame.rotation == RotationCoordinates::angle;
    const bool is_shear = part_ == StressPart::shear;
    std::vector<Point> all;
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
    if (place.moves()) return place.is_tension_side() ? ", tension side" : ", compression side";
    if (place.kind == Point::Kind::outline) {
      return fmt::format(", {} degrees from y to z", place.number * 360 / fixed_outline_points);
    }
    const StressPoint<double>& at = section.points[place.number];
    return fmt::format(", y = {:.4g} m, z = {:.4g} m", at.y, at.z);
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
  if (part == StressPart::axial) {
    return make_section_signal(body, gravity, stations, AxialStress());
  }
  return make_section_signal(body, gravity, stations, StressQuantity(part, points));
}

namespace {

using ForcesDual = DualOf<shearing_force_count>;

/// √(a² + b²), differentiable at zero.
template <class Scalar>
Scalar magnitude_of(const Scalar& a, const Scalar& b) {
  using std::sqrt;
  constexpr double tiny = 1e-300;  // [Pa²]
  return sqrt(a * a + b * b + tiny);
}

/// @param along_y, along_z, torque  V_y, V_z, T
template <class Scalar>
Scalar shear_stress(const ShearPoint<Scalar>& point, const Scalar& along_y, const Scalar& along_z,
                    const Scalar& torque) {
  const Scalar of_y = point.by_y * along_y, of_z = point.by_z * along_z;
  const Scalar none(0), of_torque = magnitude_of<Scalar>(point.by_torque * torque, none);
  if (!point.is_in_wall) return magnitude_of<Scalar>(of_y, of_z) + of_torque;
  return magnitude_of<Scalar>(of_y, none) + magnitude_of<Scalar>(of_z, none) + of_torque;
}

/// One channel a station and a place of its section.
class ShearPlaces final : public Stations {
 public:
  ShearPlaces(const BodyModel& body, const StationChoice& choice)
      : body_(body), stations_(find_stations(body, choice)) {
    for (int station = 0; station < int_size(stations_); ++station) {
      for (const int point : points_of(section(body.beam, station))) {
        channels_.push_back({station, point});
      }
    }
  }

  int numbers() const override { return shearing_force_count; }
  Recovery recovery() const override { return shearing_force_recovery(body_, stations_); }
  Recovery recovery_derivative(std::size_t k) const override {
    return shearing_force_derivative(body_, stations_, k);
  }

  int channels() const override { return int_size(channels_); }
  int station(int channel) const override { return at(channel).first; }
  std::string describe(int channel) const override {
    const auto& [station, point] = at(channel);
    const std::string place = pleuel::describe(stations_[station], body_);
    const std::size_t count = section(body_.beam, station).shear_points.size();
    const bool is_one = count == 1 || body_.frame.rotation == RotationCoordinates::angle;
    return is_one ? place : fmt::format("{}, place {} of {}", place, point + 1, count);
  }

  double value(int channel, const double* numbers) const override {
    return shear_stress(point(body_.beam, channel), numbers[0], numbers[1], numbers[2]);
  }

  Numbers slopes(int channel, const double* numbers) override {
    const ShearPoint<double>& fixed = point(body_.beam, channel);
    std::array<ForcesDual, shearing_force_count> forces;
    for (int i = 0; i < shearing_force_count; ++i) {
      forces[i] = {numbers[i], ForcesDual::Derivatives::Unit(i)};
    }
    const ShearPoint<ForcesDual> seeded{fixed.by_y, fixed.by_z, fixed.by_torque, fixed.is_in_wall};
    return shear_stress(seeded, forces[0], forces[1], forces[2]).derivatives();
  }

  double design_slope(int channel, const double* numbers, std::size_t k) const override {
    return derivative_of(shear_stress<Dual>(point(body_.beam_x[k].second, channel), numbers[0],
                                            numbers[1], numbers[2]));
  }

 private:
  /// In a plane there is one shear force and no torsion.
  std::vector<int> points_of(const SectionProperties<double>& section) const {
    const std::vector<ShearPoint<double>>& points = section.shear_points;
    std::vector<int> all;
    for (int i = 0; i < int_size(points); ++i) all.push_back(i);
    if (body_.frame.rotation != RotationCoordinates::angle) return all;
    const Eigen::Vector3d normal = body_.frame.reference.transpose() * body_.frame.axis;
    const auto share = [&](const ShearPoint<double>& point) {
      return std::abs(normal.z()) > 0.5 ? point.by_y : point.by_z;
    };
    const auto largest = std::max_element(
        points.begin(), points.end(),
        [&](const auto& one, const auto& other) { return share(one) < share(other); });
    return {static_cast<int>(largest - points.begin())};
  }

  const std::pair<int, int>& at(int channel) const { return channels_[channel]; }

  template <class Scalar>
  const SectionProperties<Scalar>& section(const Beam<Scalar>& beam, int station) const {
    return beam.elements[stations_[station].elements.front()].section;
  }

  template <class Scalar>
  const ShearPoint<Scalar>& point(const Beam<Scalar>& beam, int channel) const {
    return section(beam, at(channel).first).shear_points[at(channel).second];
  }

  const BodyModel& body_;
  std::vector<Station> stations_;
  std::vector<std::pair<int, int>> channels_;  ///< station, place of its section
};

}  // namespace

std::unique_ptr<Signal> make_shear_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity,
                                                 const StationChoice& stations) {
  return make_recovered_signal(body, gravity, std::make_unique<ShearPlaces>(body, stations));
}

}  // namespace pleuel
