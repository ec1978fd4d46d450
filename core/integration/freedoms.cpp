#include "core/integration/freedoms.hpp"

#include <Eigen/QR>

#include "core/integration/initial_state.hpp"

namespace pleuel {

namespace {

/// Of rows of length one.
constexpr double independent = 1e-8;

std::vector<int> rigid_coordinates(const Mechanism& mechanism) {
  std::vector<bool> is_elastic(static_cast<std::size_t>(mechanism.system->coordinates()), false);
  for (const int i : mechanism.elastic) is_elastic[static_cast<std::size_t>(i)] = true;
  std::vector<int> rigid;
  for (int i = 0; i < mechanism.system->coordinates(); ++i) {
    if (!is_elastic[static_cast<std::size_t>(i)]) rigid.push_back(i);
  }
  return rigid;
}

}  // namespace

Freedoms rigid_freedoms(const Mechanism& mechanism, const State& state) {
  const System& system = *mechanism.system;
  const std::vector<int> rigid = rigid_coordinates(mechanism);
  Freedoms freedoms;
  freedoms.coordinates = static_cast<int>(rigid.size());
  if (rigid.empty() || system.multipliers() == 0) return freedoms;
  System::Matrix matrix = system.make_matrix();
  projection_matrix(mechanism, state, matrix);
  Eigen::MatrixXd jacobian(system.multipliers(), freedoms.coordinates);
  for (int j = 0; j < freedoms.coordinates; ++j) {
    const int i = rigid[static_cast<std::size_t>(j)];
    jacobian.col(j) =
        mechanism.scale(i) * Eigen::VectorXd(matrix.col(i)).tail(system.multipliers());
  }
  for (auto row : jacobian.rowwise()) {
    if (row.norm() > 0.0) row.normalize();
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition(jacobian);
  decomposition.setThreshold(independent);
  freedoms.constraints = static_cast<int>(decomposition.rank());
  return freedoms;
}

}  // namespace pleuel
