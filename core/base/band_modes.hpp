#pragma once

#include <utility>

#include <Eigen/Core>

namespace pleuel {

/// Lower triangle of a symmetric matrix with five diagonals beside the main one: entry (j + d, j) is
/// band(d, j).
using Band = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// y = A x
void multiply(const Band& a, const Eigen::VectorXd& x, Eigen::VectorXd& y);

/// L D Lᵀ of a band. Without pivoting: for positive definite matrices.
class BandFactors {
 public:
  /// @returns  false if a pivot is not positive: A is not positive definite
  bool factorize(const Band& a);
  /// x ← A⁻¹ x
  void solve(Eigen::VectorXd& x) const;
  /// The smallest pivot.
  double least_pivot() const { return factors_.row(0).minCoeff(); }

 private:
  Band factors_;  ///< D in row 0, L below
};

/// The largest eigenvalue μ of A φ = μ B φ, with B positive definite, if it is positive. Inverse
/// iteration with shifts σ from above (Parlett, The Symmetric Eigenvalue Problem, ch. 4): σB − A is
/// positive definite as long as σ > μ, which certifies that no larger one is missed. Costs some
/// twenty factorizations of the band.
class LargestBandMode {
 public:
  explicit LargestBandMode(Band b) : b_(std::move(b)) {}

  /// @param guess  of the size of μ, positive
  /// @returns      0 where no eigenvalue is larger than `least`; NaN where A is not finite
  double value(const Band& a, double guess, double least);

  /// The eigenvector φᵀ B φ = 1 of the last value, if it was positive; two of them where the next
  /// eigenvalue is as large (to 1e-8).
  Eigen::MatrixXd vectors();

 private:
  bool bracket(double guess, double least);
  bool bisect(double shift);
  bool factorize(double shift);
  bool iterate();
  void find_densely();
  double improve(Eigen::VectorXd& x);

  Band b_, a_, shifted_;
  BandFactors factors_, trial_;
  double low_ = 0.0, shift_ = 0.0;  ///< μ lies between
  double value_ = 0.0;
  Eigen::VectorXd vector_, image_;
};

}  // namespace pleuel
