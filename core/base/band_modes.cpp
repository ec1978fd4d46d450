#include "core/base/band_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// Shifts come so near, relatively: round-off of matrices of some hundred rows is smaller.
constexpr double nearest_shift = 1e-8;

/// Diagonals beside the main one. Loops of a length that the compiler knows are twice as fast.
constexpr Eigen::Index beside = 5;

Eigen::MatrixXd dense(const Band& band) {
  const Eigen::Index n = band.cols();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index d = 0; d < std::min(band.rows(), n - j); ++d) {
      matrix(j + d, j) = matrix(j, j + d) = band(d, j);
    }
  }
  return matrix;
}

/// Neither smooth nor symmetric, so that it has a part of every mode.
Eigen::VectorXd any_vector(Eigen::Index size) {
  Eigen::VectorXd vector(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    vector(i) = 1.0 + 0.5 * std::sin(2.4 * static_cast<double>(i * i));
  }
  return vector;
}

}  // namespace

void multiply(const Band& a, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  const Eigen::Index n = a.cols();
  y = a.row(0).transpose().cwiseProduct(x);
  const auto add = [&](Eigen::Index j, Eigen::Index below) {
    double sum = 0.0;
    for (Eigen::Index d = 1; d <= below; ++d) {
      y(j + d) += a(d, j) * x(j);
      sum += a(d, j) * x(j + d);
    }
    y(j) += sum;
  };
  for (Eigen::Index j = 0; j < n - beside; ++j) add(j, beside);
  for (Eigen::Index j = std::max<Eigen::Index>(0, n - beside); j < n; ++j) add(j, n - 1 - j);
}

bool BandFactors::factorize(const Band& a) {
  factors_ = a;
  const Eigen::Index n = a.cols();
  const auto eliminate = [this](Eigen::Index j, Eigen::Index below) {
    const double inverse = 1.0 / factors_(0, j);
    for (Eigen::Index i = 1; i <= below; ++i) {
      const double l = factors_(i, j) * inverse;
      for (Eigen::Index k = i; k <= below; ++k) factors_(k - i, j + i) -= l * factors_(k, j);
    }
    for (Eigen::Index i = 1; i <= below; ++i) factors_(i, j) *= inverse;
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    if (!(factors_(0, j) > 0.0)) return false;
    if (j < n - beside) {
      eliminate(j, beside);
    } else {
      eliminate(j, n - 1 - j);
    }
  }
  return true;
}

void BandFactors::solve(Eigen::VectorXd& x) const {
  const Eigen::Index n = factors_.cols();
  const auto forward = [&](Eigen::Index j, Eigen::Index below) {
    for (Eigen::Index d = 1; d <= below; ++d) x(j + d) -= factors_(d, j) * x(j);
  };
  const auto backward = [&](Eigen::Index j, Eigen::Index below) {
    double sum = x(j) / factors_(0, j);
    for (Eigen::Index d = 1; d <= below; ++d) sum -= factors_(d, j) * x(j + d);
    x(j) = sum;
  };
  const Eigen::Index full = std::max<Eigen::Index>(0, n - beside);  // columns within the matrix
  for (Eigen::Index j = 0; j < full; ++j) forward(j, beside);
  for (Eigen::Index j = full; j < n; ++j) forward(j, n - 1 - j);
  for (Eigen::Index j = n - 1; j >= full; --j) backward(j, n - 1 - j);
  for (Eigen::Index j = full - 1; j >= 0; --j) backward(j, beside);
}

/// σB − A into the factors of a trial.
bool LargestBandMode::factorize(double shift) {
  shifted_.noalias() = shift * b_ - a_;
  if (!trial_.factorize(shifted_)) return false;
  std::swap(factors_, trial_);
  shift_ = shift;
  return true;
}

/// One step of inverse iteration. @returns the Rayleigh quotient φᵀ A φ of φᵀ B φ = 1
double LargestBandMode::improve(Eigen::VectorXd& x) {
  multiply(b_, x, image_);
  x = image_;
  factors_.solve(x);
  multiply(b_, x, image_);
  x /= std::sqrt(x.dot(image_));
  multiply(a_, x, image_);
  return x.dot(image_);
}

/// Whether μ lies below a shift, which becomes the upper end of the bracket, else the lower one.
bool LargestBandMode::bisect(double shift) {
  const bool is_above = factorize(shift);
  if (!is_above) low_ = std::max(low_, shift);
  return is_above;
}

/// @returns false if there is nothing to find
bool LargestBandMode::bracket(double guess, double least) {
  constexpr double step = 3.0;
  low_ = 0.0;
  if (bisect(least)) return false;
  double shift = std::max(guess, step * least);
  while (!bisect(shift) && std::isfinite(shift)) shift *= step;
  return true;
}

/// @returns false if round-off keeps it from an end
bool LargestBandMode::iterate() {
  constexpr int most = 100;
  vector_ = any_vector(b_.cols());
  value_ = improve(vector_);
  for (int i = 0; i < most; ++i) {
    const double before = std::exchange(value_, improve(vector_));
    const double error = std::abs(value_ - before);
    const double trial = value_ + std::max(error, nearest_shift * std::abs(value_));
    const bool is_nearer = low_ < trial && trial < shift_ && bisect(trial);
    if (shift_ - value_ <= 2.0 * nearest_shift * value_) {
      value_ = improve(vector_);
      return true;
    }
    if (!is_nearer) bisect(std::sqrt(low_ * shift_));
  }
  return false;
}

void LargestBandMode::find_densely() {
  const SymmetricModes modes = symmetric_modes(dense(a_), dense(b_));
  const Eigen::Index last = modes.values.size() - 1;
  value_ = modes.values(last);
  vector_ = modes.vectors.col(last);
}

double LargestBandMode::value(const Band& a, double guess, double least) {
  if (!a.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  a_ = a;
  value_ = 0.0;
  if (a.cols() == 0 || !bracket(guess, least)) return 0.0;
  if (!iterate()) find_densely();
  return value_;
}

Eigen::MatrixXd LargestBandMode::vectors() {
  improve(vector_);
  multiply(b_, vector_, image_);
  const Eigen::VectorXd first = image_;
  // Another one, kept from the first.
  Eigen::VectorXd other = any_vector(b_.cols()).reverse();
  double value = 0.0;
  for (int i = 0; i < 4; ++i) {
    other -= first.dot(other) * vector_;
    value = improve(other);
  }
  const bool is_double = value >= (1.0 - nearest_shift) * value_;
  Eigen::MatrixXd all(b_.cols(), is_double ? 2 : 1);
  all.col(0) = vector_;
  if (is_double) all.col(1) = other - first.dot(other) * vector_;
  return all;
}

}  // namespace pleuel
