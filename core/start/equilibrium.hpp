#pragma once

#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "core/base/error.hpp"
#include "core/linear/axial_strains.hpp"
#include "core/start/assembly.hpp"

namespace pleuel {

/// The loads are beyond those that the members bear: the message says which buckles.
class UnstableEquilibrium : public SimulationError {
 public:
  using SimulationError::SimulationError;
};

/// The equations of a start from elastic equilibrium: the mechanism begins to move as given, and
/// its members are deformed as if their elastic accelerations were zero, so that nothing rings.
/// Unknowns z = (q, v, a, λ, μ, ν); with e the elastic and r the other coordinates, W the weights
/// of the assembly:
///     R(q, v, a, λ) = 0,  Φ̈ = 0                  equations of motion
///     a_e + (Φ_qᵀ μ_d)_e = 0                      no elastic acceleration that joints do not need
///     Φ(q) = 0,  W_r (q ⊖ q̂)_r + (Φ_qᵀ μ_r)_r = 0  the nearest frames that close the joints
///     Φ̇ = 0,     W (v − v̂) + Φ_qᵀ ν = 0            the nearest velocities
/// μ_d are the multipliers of constraints that only deformation can meet, since others hold the
/// frames (two clamped members coupled at their tips), μ_r all others. As a rule there is no μ_d.
///
/// Newton's method for F(z) = 0 treats axial forces as unknowns (axial_strains.hpp). Where it does
/// not converge, loads come in parts,
/// F(z) = (1 − s) F(z₀), s → 1. Where it ends far deformed, or in an equilibrium that is not stable,
/// loads grow slowly instead; what is unstable then is refused, with the load factor
/// (elastic_stability.hpp). The derivatives with respect to the design use the same Jacobian.
class Equilibrium {
 public:
  explicit Equilibrium(Mechanism& mechanism);

  /// Starts from consistent initial values.
  /// @param similar  see initial_state()
  /// @throws SimulationError if Newton's method fails
  /// @throws UnstableEquilibrium
  InitialState solve(InitialState start, const State* similar = nullptr);
  /// The same, stable or not.
  InitialState find(InitialState start);

  /// ∂z/∂x at a solution.
  struct Derivatives {
    Eigen::MatrixXd q, v, a, lambda;
  };
  Derivatives differentiate(const InitialState& solution);

  /// Of the equations, 3 (coordinates + multipliers) square. Its pattern is the same at all states:
  /// what is zero before members are deformed is stored, too.
  Eigen::SparseMatrix<double> jacobian(const InitialState& at) const;

 private:
  Eigen::VectorXd residual(const InitialState& at) const;
  Eigen::MatrixXd design_derivative(const InitialState& at) const;
  void advance_by(const Eigen::VectorXd& step, InitialState& at) const;
  Eigen::VectorXd unknowns(const InitialState& at) const;

  /// The multipliers μ_r, μ_d: zero for the others.
  Eigen::VectorXd of_frames(const Eigen::VectorXd& all) const { return all - of_deformation(all); }
  Eigen::VectorXd of_deformation(const Eigen::VectorXd& all) const {
    return closed_by_deformation_.cwiseProduct(all);
  }

  /// The Jacobian with axial forces of these strains.
  Eigen::SparseMatrix<double> mixed_jacobian(const InitialState& at,
                                             const Eigen::VectorXd& strains) const;
  /// Newton's method for F(z) = target. @returns whether it converged; if not, z is anything
  bool solve_from(const Eigen::VectorXd& target, InitialState& at);
  /// Newton's method with loads that come in parts, of this share of them at most.
  /// @throws SimulationError if it fails
  InitialState follow(const InitialState& start, double largest_part);
  struct Found {
    InitialState state;
    bool is_plausible;  ///< stable, and neither far deformed nor at a dead point
  };
  Found look_for(const InitialState& start);
  bool is_plausible(const InitialState& start, const InitialState& found) const;
  /// Near a state of as many unknowns, by Newton's method alone; nothing where that leads nowhere.
  std::optional<InitialState> look_beside(const InitialState& start, const State& similar);
  /// The largest elastic coordinate over its scale.
  double deformation(const State& state) const;
  /// At what share of the loads members buckle; not a number if that cannot be said.
  double load_factor(const InitialState& start);
  [[noreturn]] void fail(const InitialState& start, double share);
  /// Whether joints leave a motion free there that they held at the start.
  bool is_dead_point(const InitialState& start, const InitialState& found) const;
  void refuse_unstable(const InitialState& start, const InitialState& found);

  Mechanism& mechanism_;
  System& system_;
  int n_, m_;
  AxialStrains strains_;
  Eigen::VectorXd closed_by_deformation_;  ///< 1 of multipliers with a μ_d, 0 of the others
};

}  // namespace pleuel
