#include "core/response/point_stress_signal.hpp"

#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/response/recovered_signal.hpp"

namespace pleuel {

namespace {

/// Stress at a point: xx yy zz xy yz xz [Pa].
using Stress = Eigen::Matrix<double, 6, 1>;

constexpr double tiny = 1e-300;  // keeps the root differentiable at zero [Pa²]

double von_mises(const Stress& s) {
  const double xy = s(0) - s(1), yz = s(1) - s(2), zx = s(2) - s(0);
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * s.tail<3>().squaredNorm() + tiny);
}

Stress von_mises_slope(const Stress& s) {
  Stress slope;
  slope << 2 * s(0) - s(1) - s(2), 2 * s(1) - s(2) - s(0), 2 * s(2) - s(0) - s(1), 6 * s(3),
      6 * s(4), 6 * s(5);
  return slope / (2.0 * von_mises(s));
}

/// One channel a point.
class StressPoints final : public Stations {
 public:
  StressPoints(const BodyModel& body, StressPart part)
      : body_(body),
        stress_(body.stress),
        part_(part),
        strength_(part == StressPart::utilization ? stress_.strength : 1.0) {}

  int numbers() const override { return 6; }
  Recovery recovery() const override { return rows_of(stress_); }
  Recovery recovery_derivative(std::size_t k) const override {
    return rows_of(body_.stress_x[k].data);
  }

  int channels() const override { return int_size(stress_.points); }
  int station(int channel) const override { return channel; }
  std::string describe(int channel) const override { return stress_.points[channel]; }

  double value(int, const double* numbers) const override {
    const Eigen::Map<const Stress> stress(numbers);
    return part_ == StressPart::normal ? stress(0) : von_mises(stress) / strength_;
  }
  Numbers slopes(int, const double* numbers) override {
    if (part_ == StressPart::normal) return Stress::Unit(0);
    return von_mises_slope(Eigen::Map<const Stress>(numbers)) / strength_;
  }
  double design_slope(int channel, const double* numbers, std::size_t k) const override {
    if (part_ != StressPart::utilization) return 0.0;
    return -value(channel, numbers) / strength_ * body_.stress_x[k].data.strength;
  }

 private:
  static Recovery rows_of(const StressRecovery& stress) {
    return {stress.of_coordinates, stress.of_accelerations, stress.of_stretching};
  }

  const BodyModel& body_;
  const StressRecovery& stress_;
  StressPart part_;
  double strength_;  ///< that stress is divided by
};

}  // namespace

std::unique_ptr<Signal> make_point_stress_signal(const BodyModel& body,
                                                 const Eigen::Vector3d& gravity, StressPart part) {
  return make_recovered_signal(body, gravity, std::make_unique<StressPoints>(body, part));
}

}  // namespace pleuel
