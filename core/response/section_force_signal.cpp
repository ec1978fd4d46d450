#include "core/response/section_force_signal.hpp"

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

/// Of every station one number, the section force itself.
class ForceStations final : public Stations {
 public:
  ForceStations(const BodyModel& body, const StationChoice& choice, SectionForcePart part)
      : body_(body), parts_{part}, stations_(find_stations(body, choice)) {}

  int numbers() const override { return 1; }
  Recovery recovery() const override { return section_recovery(body_, stations_, parts_); }
  Recovery recovery_derivative(std::size_t k) const override {
    return section_recovery_derivative(body_, stations_, parts_, k);
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
  std::array<SectionForcePart, 1> parts_;
  std::vector<Station> stations_;
};

}  // namespace

std::unique_ptr<Signal> make_section_force_signal(const BodyModel& body,
                                                  const Eigen::Vector3d& gravity,
                                                  SectionForcePart part,
                                                  const StationChoice& stations) {
  return make_recovered_signal(body, gravity,
                               std::make_unique<ForceStations>(body, stations, part));
}

}  // namespace pleuel
