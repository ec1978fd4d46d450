#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/model/model.hpp"
#include "core/response/recovered_signal.hpp"
#include "core/response/section_forces.hpp"
#include "core/response/signal.hpp"
#include "core/response/station.hpp"

namespace pleuel {

/// A section force of a beam [N] or [N m], as stress is made from them.
std::unique_ptr<Signal> make_section_force_signal(const BodyModel& body,
                                                  const Eigen::Vector3d& gravity,
                                                  SectionForcePart part,
                                                  const StationChoice& stations);

/// What is made of the section forces of a beam. Quantity is a formula for any scalar types, those
/// of the beam and of the forces:
///     static constexpr std::array parts = {…};  // SectionForcePart: which forces it is made of
///     using Point = …;  // a place of a section
///     std::vector<Point> points(const BodyModel&, const SectionProperties<double>&) const;
///     template <class Scalar, class Force> StressOf<Scalar, Force> evaluate(const Beam<Scalar>&,
///         const SectionProperties<Scalar>&, const Force* forces, const Point&) const;
///     std::string name(const SectionProperties<double>&, const Point&) const;  // ", tension side"
/// One channel a station and point.
template <class Quantity>
class SectionStations final : public Stations {
 public:
  SectionStations(const BodyModel& body, const StationChoice& choice, Quantity quantity)
      : body_(body), quantity_(std::move(quantity)), stations_(find_stations(body, choice)) {
    for (int s = 0; s < int_size(stations_); ++s) {
      for (const Point& point : quantity_.points(body, section_of(body.beam, s))) {
        channels_.push_back({s, point});
      }
    }
  }

  int numbers() const override { return count; }
  Recovery recovery() const override { return section_recovery(body_, stations_, Quantity::parts); }
  Recovery recovery_derivative(std::size_t k) const override {
    return section_recovery_derivative(body_, stations_, Quantity::parts, k);
  }

  int channels() const override { return int_size(channels_); }
  int station(int channel) const override { return at(channel).station; }
  std::string describe(int channel) const override {
    const auto& [station, point] = at(channel);
    return pleuel::describe(stations_[station], body_) +
           quantity_.name(section_of(body_.beam, station), point);
  }

  double value(int channel, const double* numbers) const override {
    return evaluate(body_.beam, channel, numbers);
  }

  Numbers slopes(int channel, const double* numbers) override {
    std::array<ForcesDual, count> seeded;
    for (int i = 0; i < count; ++i) {
      seeded[i] = {numbers[i], ForcesDual::Derivatives::Unit(i)};
    }
    return evaluate(body_.beam, channel, seeded.data()).derivatives();
  }

  double design_slope(int channel, const double* numbers, std::size_t k) const override {
    return derivative_of(evaluate(body_.beam_x[k].second, channel, numbers));
  }

 private:
  static constexpr int count = Quantity::parts.size();
  using ForcesDual = DualOf<count>;
  using Point = typename Quantity::Point;

  /// One number of a station.
  struct Channel {
    int station;
    Point point;
  };

  const Channel& at(int channel) const { return channels_[channel]; }

  template <class Scalar>
  const SectionProperties<Scalar>& section_of(const Beam<Scalar>& beam, int station) const {
    const int element = stations_[station].elements.front();
    return beam.elements[element].section;
  }

  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>& beam, int channel,
                                   const Force* forces) const {
    const auto& [station, point] = at(channel);
    return quantity_.evaluate(beam, section_of(beam, station), forces, point);
  }

  const BodyModel& body_;
  Quantity quantity_;
  std::vector<Station> stations_;
  std::vector<Channel> channels_;
};

/// @param gravity  [m/s²], global axes
template <class Quantity>
std::unique_ptr<Signal> make_section_signal(const BodyModel& body, const Eigen::Vector3d& gravity,
                                            const StationChoice& choice, Quantity quantity) {
  return make_recovered_signal(
      body, gravity,
      std::make_unique<SectionStations<Quantity>>(body, choice, std::move(quantity)));
}

}  // namespace pleuel
