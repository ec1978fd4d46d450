#pragma once

#include <vector>

#include <Eigen/Core>

namespace pleuel {

/// A strain that is quadratic in some of the generalized coordinates, with its stiffness:
///     g = bᵀ q + ½ qᵀ G q,   force κ g (b + G q)
struct QuadraticStrain {
  std::vector<int> coordinates;  ///< indices in q
  Eigen::VectorXd linear;        ///< b
  Eigen::MatrixXd quadratic;     ///< G, symmetric
  double stiffness = 0.0;        ///< κ
};

/// What a term implements that is made of such strains: who solves for an equilibrium treats their
/// forces as unknowns of their own (core/linear/axial_strains.hpp).
class StrainSource {
 public:
  virtual ~StrainSource() = default;
  virtual std::vector<QuadraticStrain> strains() const = 0;
};

}  // namespace pleuel
