#include "core/response/mechanism_modes.hpp"

#include <array>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "core/base/error.hpp"

namespace pleuel {

namespace {

/// Below this share of the largest frequency a motion counts as free. Its double eigenvalue 0 comes
/// out of the solver as √(machine precision) of the largest, some 1e-8.
constexpr double free_motion = 1e-6;

}  // namespace

FrozenMechanism freeze(const Mechanism& mechanism, const State& state) {
  System& system = *mechanism.system;
  const int n = system.coordinates(), m = system.multipliers();
  constexpr std::array<Weights, 3> weights{{{.q = 1.0}, {.v = 1.0}, {.a = 1.0}}};
  std::vector<System::Matrix> matrices(weights.size(), system.make_matrix());
  Eigen::VectorXd residual;
  system.linearize(state, weights, ConstraintLevel::position, residual, matrices);
  const Eigen::MatrixXd stiffness(matrices[0]), damping(matrices[1]), mass(matrices[2]);
  FrozenMechanism frozen;
  frozen.M = mass.topLeftCorner(n, n);
  frozen.G = 0.5 * (damping.topLeftCorner(n, n) - damping.topLeftCorner(n, n).transpose());
  frozen.K = stiffness.topLeftCorner(n, n);
  frozen.phi = stiffness.bottomLeftCorner(m, n);
  return frozen;
}

FreeVibration free_vibration(const FrozenMechanism& frozen) {
  const Eigen::Index n = frozen.M.rows(), m = frozen.phi.rows();
  FreeVibration vibration;
  Eigen::MatrixXd null_space = Eigen::MatrixXd::Identity(n, n).rightCols(n - m);
  if (m > 0) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(frozen.phi.transpose());
    null_space = qr.householderQ() * null_space;
  }
  const Eigen::LLT<Eigen::MatrixXd> mass(null_space.transpose() * frozen.M * null_space);
  if (mass.info() != Eigen::Success) {
    throw SimulationError("the natural frequencies do not exist: a free motion has no inertia");
  }
  vibration.Z = mass.matrixL().solve(null_space.transpose()).transpose();
  vibration.G = vibration.Z.transpose() * frozen.G * vibration.Z;
  vibration.K = vibration.Z.transpose() * frozen.K * vibration.Z;
  return vibration;
}

Eigen::VectorXd frequencies_of(const FreeVibration& vibration) {
  const Eigen::Index n = vibration.K.rows();
  if (n == 0) return {};
  const double w = std::max(std::sqrt(vibration.K.norm()), std::numeric_limits<double>::min());
  Eigen::MatrixXd first_order = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  first_order.topRightCorner(n, n).diagonal().setConstant(w);
  first_order.bottomLeftCorner(n, n) = vibration.K / -w;
  first_order.bottomRightCorner(n, n) = -vibration.G;
  const Eigen::VectorXcd values =
      Eigen::EigenSolver<Eigen::MatrixXd>(first_order, false).eigenvalues();
  const double least = free_motion * values.cwiseAbs().maxCoeff();
  std::vector<double> frequencies;
  for (const auto& value : values) {
    if (value.imag() > least) frequencies.push_back(value.imag());
  }
  std::sort(frequencies.begin(), frequencies.end());
  return Eigen::Map<Eigen::VectorXd>(frequencies.data(),
                                     static_cast<Eigen::Index>(frequencies.size()));
}

Eigen::VectorXd mechanism_frequencies(const Mechanism& mechanism, const State& state) {
  return frequencies_of(free_vibration(freeze(mechanism, state)));
}

}  // namespace pleuel
