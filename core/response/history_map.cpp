#include "core/response/history_map.hpp"

#include <algorithm>
#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

std::vector<int> BalanceMap::observed_channels(int channel) const {
  return {2 * channel, 2 * channel + 1};
}

Eigen::MatrixXd BalanceMap::apply(const Eigen::VectorXd& time, const StepRange& range,
                                  const Eigen::MatrixXd& observed) const {
  const Eigen::Index channels = observed.rows() / 2;
  Eigen::MatrixXd missing(channels, time.size());
  for (Eigen::Index k = 0; k < channels; ++k) {
    const auto amount = observed.row(2 * k), rate = observed.row(2 * k + 1);
    Eigen::RowVectorXd gained = Eigen::RowVectorXd::Zero(time.size());
    for (Eigen::Index i = 1; i < time.size(); ++i) {
      gained(i) = gained(i - 1) + 0.5 * (time(i) - time(i - 1)) * (rate(i - 1) + rate(i));
    }
    const Eigen::RowVectorXd all = amount - gained;
    missing.row(k) = all.array() - all(range.first);
  }
  return missing;
}

void BalanceMap::add_observed(const Eigen::VectorXd& time, const StepRange& range,
                              const Sample& sample, std::vector<Sample>& observed) const {
  const int amount = 2 * sample.channel, rate = amount + 1;
  if (sample.step == range.first) return;
  observed.push_back({range.first, amount, -sample.weight});
  observed.push_back({sample.step, amount, sample.weight});
  const auto [first, last] = std::minmax(range.first, sample.step);
  const double sign = sample.step > range.first ? -1.0 : 1.0;
  for (int i = first; i <= last; ++i) {
    const double before = i > first ? time(i) - time(i - 1) : 0.0;
    const double behind = i < last ? time(i + 1) - time(i) : 0.0;
    observed.push_back({i, rate, sign * sample.weight * 0.5 * (before + behind)});
  }
}

namespace {

/// Instants that an approximation takes, and their weights [1/s].
struct Stencil {
  int first = 0, count = 0;
  std::array<double, 3> weights{};
};

/// Derivatives of the Lagrange polynomials of the instants next to one of them.
Stencil stencil_at(const Eigen::VectorXd& time, int step) {
  const int size = int_size(time);
  Stencil stencil;
  stencil.count = std::min(3, size);
  stencil.first = std::clamp(step - 1, 0, size - stencil.count);
  for (int j = 0; j < stencil.count; ++j) {
    const int node = stencil.first + j;
    double slope = 0.0;
    for (int k = 0; k < stencil.count; ++k) {
      if (k == j) continue;
      double product = 1.0 / (time(node) - time(stencil.first + k));
      for (int l = 0; l < stencil.count; ++l) {
        if (l == j || l == k) continue;
        product *= (time(step) - time(stencil.first + l)) / (time(node) - time(stencil.first + l));
      }
      slope += product;
    }
    stencil.weights[j] = slope;
  }
  return stencil;
}

}  // namespace

std::vector<int> RateMap::observed_channels(int channel) const {
  return {channel};
}

Eigen::MatrixXd RateMap::apply(const Eigen::VectorXd& time, const StepRange&,
                               const Eigen::MatrixXd& observed) const {
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(observed.rows(), observed.cols());
  for (int step = 0; step < int_size(time); ++step) {
    const Stencil stencil = stencil_at(time, step);
    for (int j = 0; j < stencil.count; ++j) {
      rates.col(step) += stencil.weights[j] * observed.col(stencil.first + j);
    }
  }
  return rates;
}

void RateMap::add_observed(const Eigen::VectorXd& time, const StepRange&, const Sample& sample,
                           std::vector<Sample>& observed) const {
  const Stencil stencil = stencil_at(time, sample.step);
  for (int j = 0; j < stencil.count; ++j) {
    const double weight = sample.weight * stencil.weights[j];
    if (weight != 0.0) observed.push_back({stencil.first + j, sample.channel, weight});
  }
}

}  // namespace pleuel
