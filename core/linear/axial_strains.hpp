#pragma once

#include <Eigen/SparseCore>

#include "core/system/system.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// The axial strains of a mechanism whose members bend: g = bᵀq + ½qᵀGq, one an element.
///
/// Newton's method in displacements alone fails from small rotations on: bending shortens by the
/// square of its rotation, which the stiff axial strain takes for a large force. With the force as
/// an unknown of its own (and eliminated again) the method converges in few steps: only the tangent
/// changes, in which the force of the last linearization, κ (g + (b + Gq)ᵀ δq), stands in place of
/// κ g (Magisano, Leonetti & Garcea 2017).
class AxialStrains {
 public:
  explicit AxialStrains(const System& system);

  bool are_none() const { return strains_.empty(); }

  /// g of each.
  Eigen::VectorXd at(const Eigen::VectorXd& q) const;

  /// g + (b + Gq)ᵀ δq of each.
  Eigen::VectorXd predicted(const Eigen::VectorXd& q, const Eigen::VectorXd& change) const;

  /// Σ κ c G, n × n: what strains that are larger by c add to the stiffness.
  void add_stress_stiffness(const Eigen::VectorXd& c,
                            std::vector<Eigen::Triplet<double>>& entries) const;

  /// Σ κ ((b + Gq)(b + Gq)ᵀ − b bᵀ), n × n: how deflection couples bending with stretching.
  Eigen::SparseMatrix<double> coupling(const Eigen::VectorXd& q) const;

 private:
  std::vector<QuadraticStrain> strains_;
};

}  // namespace pleuel
