#pragma once

#include <memory>
#include <string>

#include "core/model/elastic_body.hpp"
#include "core/model/model.hpp"
#include "core/response/signal.hpp"

namespace pleuel {

/// Stations of an elastic body, the same count of recovered numbers each (section forces, or the
/// components of stress), and what is made of them: any number of channels.
class Stations {
 public:
  /// Numbers of a station at most.
  static constexpr int most_numbers = 6;
  using Numbers = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_numbers, 1>;

  virtual ~Stations() = default;
  /// How many numbers a station has.
  virtual int numbers() const = 0;
  virtual Recovery recovery() const = 0;
  /// @param k  of a design variable: in the order of the derivatives of the body
  virtual Recovery recovery_derivative(std::size_t k) const = 0;

  virtual int channels() const = 0;
  virtual std::string describe(int channel) const = 0;
  virtual int station(int channel) const = 0;
  virtual double value(int channel, const double* numbers) const = 0;
  /// Derivatives with respect to the numbers.
  virtual Numbers slopes(int channel, const double* numbers) = 0;
  /// Derivative with respect to a design variable at given numbers.
  virtual double design_slope(int channel, const double* numbers, std::size_t k) const = 0;
};

/// Observes the channels of the stations of a body, which must outlive the signal.
std::unique_ptr<Signal> make_recovered_signal(const BodyModel& body, const Eigen::Vector3d& gravity,
                                              std::unique_ptr<Stations> stations);

}  // namespace pleuel
