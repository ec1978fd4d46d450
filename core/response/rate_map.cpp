#include "core/response/rate_map.hpp"

#include <algorithm>
#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

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
