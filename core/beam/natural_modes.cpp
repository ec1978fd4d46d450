#include "core/beam/natural_modes.hpp"

#include <Eigen/Eigenvalues>

namespace pleuel {

// The solver stands here alone: it takes the compiler seconds wherever it is used.
NaturalModes natural_modes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace pleuel
