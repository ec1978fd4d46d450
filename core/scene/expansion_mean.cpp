#include "core/scene/expansion_mean.hpp"

#include <algorithm>

#include "core/base/dense_solvers.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the largest eigenvalue of the normal equations: directions in which nothing is known.
constexpr double unknown = 1e-6;

/// Where B_ab of a symmetric matrix has its place among its numbers.
int packed_index(int a, int b) {
  return std::max(a, b) * (std::max(a, b) + 1) / 2 + std::min(a, b);
}

/// The rows of B d = g for the numbers of B.
MatrixXd rows_of(const VectorXd& d) {
  const int n = int_size(d);
  MatrixXd rows = MatrixXd::Zero(n, n * (n + 1) / 2);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) rows(a, packed_index(a, b)) += d(b);
  }
  return rows;
}

/// The pseudo-inverse, of A with full rank or not.
MatrixXd pseudo_inverse(const MatrixXd& a) {
  const SymmetricModes modes = symmetric_modes(a.transpose() * a);
  VectorXd inverse = modes.values;
  const double least = unknown * modes.values.maxCoeff();
  for (double& value : inverse) value = value > least ? 1.0 / value : 0.0;
  return modes.vectors * inverse.asDiagonal() * modes.vectors.transpose() * a.transpose();
}

}  // namespace

ExpansionMean::ExpansionMean(std::vector<Expansion> expansions)
    : expansions_(std::move(expansions)) {
  for (std::size_t j = 0; j < expansions_.size(); ++j) bends_.push_back(bends_of(j));
}

ExpansionMean::Bends ExpansionMean::bends_of(std::size_t expansion) const {
  const Expansion& here = expansions_[expansion];
  const int n = int_size(here.place), others = int_size(expansions_) - 1;
  if (others == 0 || n == 0) return {};
  MatrixXd rows(n * others, n * (n + 1) / 2);
  std::vector<BodyConstants> right;
  for (std::size_t i = 0; i < expansions_.size(); ++i) {
    if (i == expansion) continue;
    const VectorXd away = expansions_[i].place - here.place;
    const double weight = 1.0 / away.squaredNorm();
    rows.middleRows(int_size(right), n) = weight * rows_of(away);
    for (int a = 0; a < n; ++a) {
      right.push_back(zero_constants(here.value));
      add_constants(right.back(), weight, expansions_[i].slopes[a]);
      add_constants(right.back(), -weight, here.slopes[a]);
    }
  }
  const MatrixXd solution = pseudo_inverse(rows);
  Bends bends(n, std::vector<BodyConstants>(n, zero_constants(here.value)));
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      for (int r = 0; r < int_size(right); ++r) {
        add_constants(bends[a][b], solution(packed_index(a, b), r), right[r]);
      }
    }
  }
  return bends;
}

ExpansionMean::Weights ExpansionMean::weights_at(const VectorXd& place) const {
  const int count = int_size(expansions_);
  Weights weights{VectorXd(count), MatrixXd(count, place.size())};
  for (int j = 0; j < count; ++j) {
    const VectorXd away = place - expansions_[j].place;
    const double square = away.squaredNorm();
    weights.values(j) = 1.0 / (square * square);
    weights.slopes.row(j) = (-4.0 / square) * away.transpose();
  }
  weights.values /= weights.values.sum();
  const Eigen::RowVectorXd mean = weights.values.transpose() * weights.slopes;
  for (int j = 0; j < count; ++j) {
    weights.slopes.row(j) = weights.values(j) * (weights.slopes.row(j) - mean);
  }
  return weights;
}

Expansion ExpansionMean::polynomial(std::size_t expansion, const VectorXd& place) const {
  Expansion there = expansions_[expansion];
  const VectorXd away = place - there.place;
  const std::vector<BodyConstants> slopes = there.slopes;
  for (int a = 0; a < int_size(away); ++a) {
    add_constants(there.value, away(a), slopes[a]);
    if (bends_[expansion].empty()) continue;
    for (int b = 0; b < int_size(away); ++b) {
      add_constants(there.value, 0.5 * away(a) * away(b), bends_[expansion][a][b]);
      add_constants(there.slopes[a], away(b), bends_[expansion][a][b]);
    }
  }
  return there;
}

Expansion ExpansionMean::at(const VectorXd& place) const {
  for (const Expansion& known : expansions_) {
    if (known.place == place) return known;
  }
  const Weights weights = weights_at(place);
  const BodyConstants zero = zero_constants(expansions_.front().value);
  Expansion sum{place, zero, std::vector<BodyConstants>(place.size(), zero)};
  for (int j = 0; j < int_size(expansions_); ++j) {
    const Expansion one = polynomial(static_cast<std::size_t>(j), place);
    add_constants(sum.value, weights.values(j), one.value);
    for (int a = 0; a < int_size(place); ++a) {
      add_constants(sum.slopes[a], weights.values(j), one.slopes[a]);
      add_constants(sum.slopes[a], weights.slopes(j, a), one.value);
    }
  }
  return sum;
}

}  // namespace pleuel
