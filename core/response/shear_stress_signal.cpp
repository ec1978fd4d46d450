#include "core/response/shear_stress_signal.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/response/recovered_signal.hpp"
#include "core/response/section_forces.hpp"

namespace pleuel {

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
