#include "core/response/section_force_signal.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

class SectionForceQuantity : public OneASection {
 public:
  explicit SectionForceQuantity(SectionForcePart part) : part_(part) {}

  template <class Scalar, class Force>
  StressOf<Scalar, Force> evaluate(const Beam<Scalar>&, const SectionProperties<Scalar>&,
                                   const SectionForces<Force>& forces, Point) const {
    switch (part_) {
      case SectionForcePart::axial:
        return forces.axial;
      case SectionForcePart::moment_y:
        return forces.moment_y;
      case SectionForcePart::moment_z:
        return forces.moment_z;
      default:
        break;
    }
    return forces.torque;
  }

 private:
  SectionForcePart part_;
};

/// Of every station one number, the shear force itself.
class ShearStations final : public Stations {
 public:
  ShearStations(const BodyModel& body, const StationChoice& choice, int direction)
      : body_(body), direction_(direction), stations_(find_stations(body, choice)) {}

  int numbers() const override { return 1; }
  Recovery recovery() const override { return shear_force_recovery(body_, stations_, direction_); }
  Recovery recovery_derivative(std::size_t k) const override {
    return shear_force_derivative(body_, stations_, direction_, k);
  }
  int channels() const override { return int_size(stations_); }
  int station(int channel) const override { return channel; }
  std::string describe(int channel) const override {
    return pleuel::describe(stations_[channel], body_);
  }
  double value(int, const double* numbers) const override { return numbers[0]; }
  Numbers slopes(int, const double*) override { return Numbers::Ones(1); }
  double design_slope(int, const double*, std::size_t) const override { return 0.0; }

 private:
  const BodyModel& body_;
  int direction_;
  std::vector<Station> stations_;
};

}  // namespace

std::unique_ptr<Signal> make_section_force_signal(const BodyModel& body,
                                                  const Eigen::Vector3d& gravity,
                                                  SectionForcePart part,
                                                  const StationChoice& stations) {
  if (part == SectionForcePart::shear_y || part == SectionForcePart::shear_z) {
    const int direction = part == SectionForcePart::shear_y ? 1 : 2;
    return make_recovered_signal(body, gravity,
                                 std::make_unique<ShearStations>(body, stations, direction));
  }
  return make_section_signal(body, gravity, stations, SectionForceQuantity(part));
}

}  // namespace pleuel
