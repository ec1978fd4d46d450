#pragma once

#include "core/beam/invariants.hpp"

namespace pleuel {

/// How the numbers of invariants stand one after the other in a vector, for what is linear in them:
/// mass, first_moment, second_moment, shape, mixed (each by columns), moments (by rows),
/// mass_matrix, stiffness, damping.
class InvariantLayout {
 public:
  explicit InvariantLayout(const Invariants<double>& invariants);

  int size() const { return damping_ + nonzeros_; }

  /// All numbers as a vector.
  Eigen::VectorXd flatten(const Invariants<double>& invariants) const;

  // The parts of such a vector.
  static double& mass(double* vector) { return vector[0]; }
  static auto first_moment(double* vector) {
    return Eigen::Map<Eigen::Vector3d>(vector + first_moment_);
  }
  static auto second_moment(double* vector) {
    return Eigen::Map<Eigen::Matrix3d>(vector + second_moment_);
  }
  auto shape(double* vector) const {
    return Eigen::Map<Eigen::Matrix3Xd>(vector + shape_, 3, coordinates_);
  }
  auto mixed(double* vector) const {
    return Eigen::Map<Eigen::Matrix<double, 9, Eigen::Dynamic>>(vector + mixed_, 9, coordinates_);
  }
  /// Row of a non-zero.
  double* moments(double* vector, int entry) const {
    return vector + moments_ + static_cast<std::ptrdiff_t>(entry) * pairs_;
  }
  auto mass_matrix(double* vector) const {
    return Eigen::Map<Eigen::VectorXd>(vector + mass_matrix_, nonzeros_);
  }
  auto stiffness(double* vector) const {
    return Eigen::Map<Eigen::VectorXd>(vector + stiffness_, nonzeros_);
  }
  auto damping(double* vector) const {
    return Eigen::Map<Eigen::VectorXd>(vector + damping_, nonzeros_);
  }

 private:
  static constexpr int first_moment_ = 1, second_moment_ = 4, shape_ = 13;
  int coordinates_, pairs_, nonzeros_;
  int mixed_, moments_, mass_matrix_, stiffness_, damping_;
};

/// The numbers of invariants that belong to some of the elastic coordinates.
struct PartialInvariants {
  std::vector<int> coordinates;  ///< of the whole body
  Invariants<double> data;       ///< on these
};

/// Leaves out coordinates of which all numbers are zero: what a design variable changes is often
/// part of a body only.
PartialInvariants without_zeros(const Invariants<double>& invariants);

}  // namespace pleuel
