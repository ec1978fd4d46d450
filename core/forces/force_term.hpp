#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/int_size.hpp"
#include "core/frame/marker_kinematics.hpp"
#include "core/frame/number_data.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// Readings of a force law between two markers, which besides its forces gives
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

/// A force element as a term of the system: residual += −Q(q, v, t; x), Q written once by a law:
///
///     struct Law {
///       static constexpr std::size_t marker_count;
///       template <class Scalar> using Data;         // its numbers, see number_data.hpp
///       std::string name;
///       // Q
///       template <class Scalar>
///       void add_forces(const Data<Scalar>&, double time, MarkerKinematics<Scalar, …>&) const;
///       // whether ∂Q(row)/∂(col) or its rate can differ from zero
///       bool couples(const LocalCoordinate& row, const LocalCoordinate& col) const;
///     };
///
/// The tangent comes from dual numbers that carry the weights of the scheme, one evaluation for
/// positions and velocities together and up to twelve coordinates that matter; the design
/// derivative from dual data. Nothing is allocated after construction.
template <class Law>
class ForceTerm : public Term {
 public:
  static constexpr std::size_t marker_count = Law::marker_count;
  template <class Scalar>
  using Data = typename Law::template Data<Scalar>;
  using Markers = std::array<Marker, marker_count>;

  ForceTerm(Law law, Markers markers, Data<double> data,
            const std::vector<DesignDerivative<Data<double>>>& derivatives)
      : law_(std::move(law)),
        markers_(std::move(markers)),
        data_(std::move(data)),
        wide_data_(cast_data<Wide>(data_)),
        coordinates_(local_coordinates(markers_)) {
    for (const auto& [variable, derivative] : derivatives) {
      derivatives_.push_back({variable, seed_data(data_, derivative)});
    }
    std::vector<int> slots(coordinates_.size(), -1);
    for (std::size_t row = 0; row < coordinates_.size(); ++row) {
      for (std::size_t col = 0; col < coordinates_.size(); ++col) {
        if (!law_.couples(coordinates_[row], coordinates_[col])) continue;
        if (slots[col] < 0) {
          slots[col] = int_size(columns_);
          columns_.push_back(col);
        }
        pattern_.emplace_back(row, slots[col]);
      }
    }
  }

  std::string name() const override { return law_.name; }

  void declare_entries(EntryList& entries) const override {
    for (const auto& [row, slot] : pattern_) {
      entries.emplace_back(coordinates_[row].index, coordinates_[columns_[slot]].index);
    }
  }

  void add_residual(const State& state, ConstraintLevel, Eigen::VectorXd& residual) override {
    Local<double> q, v;
    load<double>(state, q, v);
    const Local<double> forces = evaluate(data_, state.time, q, v);
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      residual(coordinates_[i].index) -= forces[i];
    }
  }

  void linearize(const State& state, const WeightList& weights, ConstraintLevel level,
                 Eigen::VectorXd& residual, const EntryBlocks& entries) override {
    add_residual(state, level, residual);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      write_entries(state, weights[i], entries.block(i));
    }
  }

  void add_design_derivative(const State& state, ConstraintLevel,
                             Eigen::MatrixXd& columns) override {
    Local<Dual> q, v;
    load<Dual>(state, q, v);
    for (const auto& [variable, data] : derivatives_) {
      const Local<Dual> forces = evaluate(data, state.time, q, v);
      for (std::size_t i = 0; i < coordinates_.size(); ++i) {
        columns(coordinates_[i].index, variable) -= derivative_of(forces[i]);
      }
    }
  }

  int parameter_adjoint_count() const override { return int_size(derivatives_); }

  void add_parameter_adjoints(const State& state, ConstraintLevel, const ConstColumns& mu,
                              Columns sums) override {
    Local<Dual> q, v;
    load<Dual>(state, q, v);
    for (std::size_t k = 0; k < derivatives_.size(); ++k) {
      const Local<Dual> forces = evaluate(derivatives_[k].data, state.time, q, v);
      for (std::size_t i = 0; i < coordinates_.size(); ++i) {
        sums.row(k) -= derivative_of(forces[i]) * mu.row(coordinates_[i].index);
      }
    }
  }

  void add_design_gradients(const ConstColumns& sums, Eigen::MatrixXd& gradients) const override {
    for (std::size_t k = 0; k < derivatives_.size(); ++k) {
      gradients.row(derivatives_[k].variable) += sums.row(k);
    }
  }

 private:
  template <class Scalar>
  using Local = typename MarkerKinematics<Scalar, marker_count>::Coordinates;
  /// Columns at a time: few forces in joints and springs depend on more.
  static constexpr int width = max_marker_size;
  using Wide = DualOf<width>;

  template <class Scalar>
  void load(const State& state, Local<Scalar>& q, Local<Scalar>& v) const {
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      q[i] = Scalar(state.q(coordinates_[i].index));
      v[i] = Scalar(state.v(coordinates_[i].index));
    }
  }

  template <class Scalar>
  Local<Scalar> evaluate(const Data<Scalar>& data, double time, const Local<Scalar>& q,
                         const Local<Scalar>& v) const {
    MarkerKinematics<Scalar, marker_count> markers(markers_, q.data(), v.data());
    law_.add_forces(data, time, markers);
    return markers.forces();
  }

  void write_entries(const State& state, const Weights& weights, double* entries) const {
    std::fill_n(entries, pattern_.size(), 0.0);
    if (weights.q == 0.0 && weights.v == 0.0) return;
    const auto count = int_size(columns_);
    for (int first = 0; first < count; first += width)
      write_columns(state, weights, first, entries);
  }

  /// Of the columns from `first` on.
  void write_columns(const State& state, const Weights& weights, int first, double* entries) const {
    Local<Wide> q, v;
    load<Wide>(state, q, v);
    const int count = std::min(width, int_size(columns_) - first);
    for (int i = 0; i < count; ++i) {
      const std::size_t column = columns_[first + i];
      q[column].derivatives()[i] = weights.q;
      v[column].derivatives()[i] = weights.v;
    }
    const Local<Wide> forces = evaluate(wide_data_, state.time, q, v);
    for (const auto& [row, slot] : pattern_) {
      const int i = slot - first;
      if (i >= 0 && i < count) *entries = -derivative_of(forces[row], i);
      ++entries;
    }
  }

  Law law_;
  Markers markers_;
  Data<double> data_;
  Data<Wide> wide_data_;
  std::vector<DesignDerivative<Data<Dual>>> derivatives_;
  std::vector<LocalCoordinate> coordinates_;
  std::vector<std::size_t> columns_;  ///< local coordinates that the forces depend on
  std::vector<std::pair<std::size_t, int>> pattern_;  ///< (local row, place in columns_)
};

/// A force element between two markers: what it adds to the system, and what can be read of it.
struct ForceElement {
  std::unique_ptr<Term> term;
  std::unique_ptr<Gauge> gauge;
};

/// Both of one law.
template <class Law>
ForceElement make_force_element(
    const Law& law, const std::array<Marker, 2>& markers,
    const typename Law::template Data<double>& data,
    const std::vector<DesignDerivative<typename Law::template Data<double>>>& derivatives) {
  return {std::make_unique<ForceTerm<Law>>(law, markers, data, derivatives),
          std::make_unique<MarkerGauge<Law>>(law, markers, data, derivatives)};
}

}  // namespace pleuel
