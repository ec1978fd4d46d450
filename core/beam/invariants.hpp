#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/base/int_size.hpp"

/// The invariants (inertia shape integrals) of a flexible body: all that the equations of motion
/// know of its finite-element model.
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

}  // namespace pleuel
