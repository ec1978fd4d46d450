#include "core/linear/linearization.hpp"

#include <array>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

Linearization linearize(const Mechanism& mechanism, const State& state, const Turning& axes,
                        bool is_damped) {
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  constexpr std::array<Weights, 3> weights{{{.q = 1.0}, {.v = 1.0}, {.a = 1.0}}};
  std::vector<System::Matrix> matrices(weights.size(), system.make_matrix());
  Eigen::VectorXd residual;
  system.linearize(state, weights, ConstraintLevel::position, residual, matrices);
  const auto& [T, V, P, Q] = axes;
  using Sparse = Eigen::SparseMatrix<double>;
  const Sparse of_q = matrices[0].topLeftCorner(n, n), of_v = matrices[1].topLeftCorner(n, n),
               of_a = matrices[2].topLeftCorner(n, n), phi = matrices[0].bottomLeftCorner(m, n);
  const Sparse left = T.transpose();
  const Sparse rates = left * Sparse(of_a * P) + left * Sparse(of_v * T);
  const Sparse skew = Sparse(rates.transpose());
  Linearization found;
  found.is_damped = is_damped;
  found.M = Sparse(left * Sparse(of_a * T));
  found.G = is_damped ? rates : Sparse(0.5 * (rates - skew));
  found.K = Sparse(left * Sparse(of_a * Q) + left * Sparse(of_v * V) + left * Sparse(of_q * T));
  found.phi = Sparse(phi * T);
  found.left_out = system.left_out();
  return found;
}

Linearization linearize(const Mechanism& mechanism, const State& state, bool is_damped) {
  return linearize(mechanism, state, standing_axes(mechanism, state), is_damped);
}

}  // namespace pleuel
