#include "core/trust/turning_axes.hpp"

#include <array>

#include "core/base/eager_matrices.hpp"
#include "core/response/mechanism_modes.hpp"
#include "core/start/turning.hpp"

namespace pleuel {

Eigen::VectorXd frequencies_in_turning_axes(const Model& model, const State& state) {
  System& system = *model.mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  constexpr std::array<Weights, 3> weights{{{.q = 1.0}, {.v = 1.0}, {.a = 1.0}}};
  std::vector<System::Matrix> matrices(weights.size(), system.make_matrix());
  Eigen::VectorXd residual;
  system.linearize(state, weights, ConstraintLevel::position, residual, matrices);
  const auto motion_rows = [&](std::size_t i) {
    return Eigen::MatrixXd(Eigen::MatrixXd(matrices[i]).topLeftCorner(n, n));
  };
  const Eigen::MatrixXd of_q = motion_rows(0), of_v = motion_rows(1), of_a = motion_rows(2);
  const auto [T, V, P, Q] = turning_of(model.mechanism, state);
  const Eigen::MatrixXd rates = T.transpose() * (of_a * P + of_v * T);
  FrozenMechanism frozen;
  frozen.M = T.transpose() * of_a * T;
  frozen.G = 0.5 * (rates - rates.transpose());
  frozen.K = T.transpose() * (of_a * Q + of_v * V + of_q * T);
  frozen.phi = Eigen::MatrixXd(matrices[0]).bottomLeftCorner(m, n) * T;
  frozen.left_out = system.left_out();
  const Eigen::VectorXcd modes = modes_of(frozen);
  Eigen::VectorXd frequencies(modes.size());
  for (Eigen::Index i = 0; i < modes.size(); ++i) frequencies(i) = frequency_of(modes(i));
  return frequencies;
}

}  // namespace pleuel
