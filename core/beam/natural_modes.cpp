#include "core/beam/natural_modes.hpp"

#include <utility>

#include "core/base/dense_solvers.hpp"
#include "core/base/eager_matrices.hpp"

namespace pleuel {

NaturalModes natural_modes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  SymmetricModes modes = symmetric_modes(stiffness, mass);
  return {std::move(modes.values), std::move(modes.vectors)};
}

}  // namespace pleuel
