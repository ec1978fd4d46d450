#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/frame/marker_kinematics.hpp"
#include "core/frame/number_data.hpp"
#include "core/system/gauge.hpp"

namespace pleuel {

/// Readings of a force law between two markers (force_term.hpp), which besides its forces gives
///       template <class Scalar>
///       Scalar read(const Data<Scalar>&, double time, const MarkerKinematics<Scalar, 2>&,
///                   Reading) const;
/// Derivatives are those of dual numbers.
template <class Law>
class MarkerGauge final : public Gauge {
 public:
  template <class Scalar>
  using Data = typename Law::template Data<Scalar>;
  using Markers = std::array<Marker, 2>;

  MarkerGauge(Law law, Markers markers, Data<double> data,
              const std::vector<DesignDerivative<Data<double>>>& derivatives)
      : law_(std::move(law)),
        markers_(std::move(markers)),
        data_(std::move(data)),
        wide_data_(cast_data<Wide>(data_)),
        coordinates_(coordinate_indices(markers_)) {
    for (const auto& [variable, derivative] : derivatives) {
      derivatives_.push_back({variable, seed_data(data_, derivative)});
    }
  }

  double read(const State& state, Reading reading) const override {
    Local<double> q, v;
    load<double>(state, q, v);
    return evaluate<double>(data_, state.time, q, v, reading);
  }

  void add_gradient(const State& state, Reading reading, double weight, Eigen::VectorXd& q,
                    Eigen::VectorXd& v, Eigen::VectorXd& design) const override {
    const auto count = int_size(coordinates_);
    for (int first = 0; first < 2 * count; first += width) {
      add_columns(state, reading, weight, first, q, v);
    }
    Local<Dual> local_q, local_v;
    load<Dual>(state, local_q, local_v);
    for (const auto& [variable, data] : derivatives_) {
      design(variable) +=
          weight * derivative_of(evaluate<Dual>(data, state.time, local_q, local_v, reading));
    }
  }

 private:
  template <class Scalar>
  using Local = typename MarkerKinematics<Scalar, 2>::Coordinates;
  /// Coordinates and their rates at a time.
  static constexpr int width = max_marker_size;
  using Wide = DualOf<width>;

  template <class Scalar>
  void load(const State& state, Local<Scalar>& q, Local<Scalar>& v) const {
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      q[i] = Scalar(state.q(coordinates_[i]));
      v[i] = Scalar(state.v(coordinates_[i]));
    }
  }

  template <class Scalar>
  Scalar evaluate(const Data<Scalar>& data, double time, const Local<Scalar>& q,
                  const Local<Scalar>& v, Reading reading) const {
    const MarkerKinematics<Scalar, 2> markers(markers_, q.data(), v.data());
    return law_.template read<Scalar>(data, time, markers, reading);
  }

  /// Of the coordinates from `first` on, then of their rates.
  void add_columns(const State& state, Reading reading, double weight, int first,
                   Eigen::VectorXd& q, Eigen::VectorXd& v) const {
    Local<Wide> local_q, local_v;
    load<Wide>(state, local_q, local_v);
    const auto count = int_size(coordinates_);
    const int end = std::min(first + width, 2 * count);
    for (int i = first; i < end; ++i) {
      Wide& seeded = i < count ? local_q[i] : local_v[i - count];
      seeded.derivatives()[i - first] = 1.0;
    }
    const Wide value = evaluate<Wide>(wide_data_, state.time, local_q, local_v, reading);
    for (int i = first; i < end; ++i) {
      const int index = coordinates_[i < count ? i : i - count];
      (i < count ? q : v)(index) += weight * derivative_of(value, i - first);
    }
  }

  Law law_;
  Markers markers_;
  Data<double> data_;
  Data<Wide> wide_data_;
  std::vector<DesignDerivative<Data<Dual>>> derivatives_;
  std::vector<int> coordinates_;
};

}  // namespace pleuel
