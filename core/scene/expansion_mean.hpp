#pragma once

#include <vector>

#include "core/scene/body_constants.hpp"

namespace pleuel {

/// Numbers of a body about a place, with their derivatives by its coordinates.
struct Expansion {
  Eigen::VectorXd place;
  BodyConstants value;
  std::vector<BodyConstants> slopes;  ///< one a coordinate
};

/// A function that has values and slopes of some expansions: a mean of their Taylor polynomials,
///     z(x) = Σ wⱼ (zⱼ + zⱼ′ (x − xⱼ) + ½ (x − xⱼ)ᵀ Bⱼ (x − xⱼ)),   wⱼ ∝ 1/|x − xⱼ|⁴,   Σ wⱼ = 1
/// (Shepard 1968; with derivatives Farwig 1986): the weights are flat at the places. The second
/// derivatives Bⱼ are the smallest that explain how slopes differ from place to place,
///     Bⱼ (xᵢ − xⱼ) = zᵢ′ − zⱼ′,
/// by least squares with weights 1/|xᵢ − xⱼ|⁴, as what third derivatives leave goes with the square of the
/// distance.
class ExpansionMean {
 public:
  /// @param expansions  at least one, at different places, of one arrangement
  explicit ExpansionMean(std::vector<Expansion> expansions);

  /// Value and slopes.
  Expansion at(const Eigen::VectorXd& place) const;

 private:
  /// B of an expansion: its columns, as derivatives of slopes.
  using Bends = std::vector<std::vector<BodyConstants>>;
  /// Weights and their slopes, expansions × coordinates.
  struct Weights {
    Eigen::VectorXd values;
    Eigen::MatrixXd slopes;
  };

  Bends bends_of(std::size_t expansion) const;
  Weights weights_at(const Eigen::VectorXd& place) const;
  Expansion polynomial(std::size_t expansion, const Eigen::VectorXd& place) const;

  std::vector<Expansion> expansions_;
  std::vector<Bends> bends_;
};

}  // namespace pleuel
