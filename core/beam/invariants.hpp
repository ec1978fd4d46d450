#pragma once

/// The invariants (inertia shape integrals) of a flexible body: all that the equations of motion
/// know of its finite-element model.

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"

namespace pleuel {

/// Non-zeros of an n × n matrix by rows; structurally symmetric.
struct ElasticPattern {
  int size = 0;
  std::vector<int> row_start;  ///< size + 1
  std::vector<int> column;

  int nonzeros() const { return int_size(column); }
  /// Position of an entry, or −1.
  int find(int row, int col) const;
};

/// Pattern in which all coordinates of each group are coupled with each other; −1 entries are
/// skipped.
ElasticPattern pattern_of_groups(int size, const std::vector<std::vector<int>>& groups);

/// With the local position p = p₀ + S q_f of a material point (p₀ undeformed, S = 3 × n shape
/// functions), after Shabana, Dynamics of Multibody Systems, ch. 5, all integrals over the volume:
///     mass           m        = ∫ρ                                                       [kg]
///     first_moment   c₀       = ∫ρ p₀                                                 [kg m]
///     second_moment  J₀       = ∫ρ p₀ p₀ᵀ                                            [kg m²]
///     shape          S̄        = ∫ρ S                     3 × n
///     mixed          H_kl     = ∫ρ p₀_k S_l              row 3k + l of 9 × n
///     moments        S_kl     = ∫ρ S_kᵀ S_l              n × n for each listed pair (k, l)
///     mass_matrix    S_ff     = S_11 + S_22 + S_33       n × n
///     stiffness      K,  damping D                       n × n
/// The residual is linear in all of them: called with their derivatives in place of them it
/// returns its own explicit design derivative.
template <class Scalar>
struct Invariants {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using RowMajorMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  ElasticPattern pattern;
  std::vector<std::pair<int, int>> pairs;  ///< the (k, l) with S_kl ≠ 0; (l, k) is listed too

  Scalar mass = Scalar(0);
  Eigen::Matrix<Scalar, 3, 1> first_moment = Eigen::Matrix<Scalar, 3, 1>::Constant(Scalar(0));
  Eigen::Matrix<Scalar, 3, 3> second_moment = Eigen::Matrix<Scalar, 3, 3>::Constant(Scalar(0));
  Matrix shape;                            ///< 3 × n
  Matrix mixed;                            ///< 9 × n
  RowMajorMatrix moments;                  ///< non-zeros × pairs
  Vector mass_matrix, stiffness, damping;  ///< non-zeros

  int size() const { return pattern.size; }
};

/// A body without elastic coordinates.
template <class Scalar>
Invariants<Scalar> rigid_invariants(const Scalar& mass, const Eigen::Matrix<Scalar, 3, 1>& first,
                                    const Eigen::Matrix<Scalar, 3, 3>& second) {
  Invariants<Scalar> invariants;
  invariants.pattern = pattern_of_groups(0, {});
  invariants.mass = mass;
  invariants.first_moment = first;
  invariants.second_moment = second;
  invariants.shape.resize(3, 0);
  invariants.mixed.resize(9, 0);
  invariants.moments.resize(0, 0);
  return invariants;
}

/// The same constants in another scalar type, entry by entry.
template <class To, class From, class Function>
Invariants<To> transform_invariants(const Invariants<From>& from, Function&& function) {
  Invariants<To> to;
  to.pattern = from.pattern;
  to.pairs = from.pairs;
  to.mass = function(from.mass);
  to.first_moment = from.first_moment.unaryExpr(function);
  to.second_moment = from.second_moment.unaryExpr(function);
  to.shape = from.shape.unaryExpr(function);
  to.mixed = from.mixed.unaryExpr(function);
  to.moments = from.moments.unaryExpr(function);
  to.mass_matrix = from.mass_matrix.unaryExpr(function);
  to.stiffness = from.stiffness.unaryExpr(function);
  to.damping = from.damping.unaryExpr(function);
  return to;
}

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
