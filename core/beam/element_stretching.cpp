#include "core/beam/element_stretching.hpp"

#include "core/base/eager_matrices.hpp"

namespace pleuel {

std::vector<int> active_displacements(const ElasticCoordinates& coordinates, int element) {
  std::vector<int> active;
  for (int i = 0; i < 12; ++i) {
    if (coordinates.index(element + i / 6, i % 6) >= 0) active.push_back(i);
  }
  return active;
}

Eigen::VectorXd elongation_of(const std::vector<int>& active) {
  Eigen::VectorXd elongation = Eigen::VectorXd::Zero(active.size());
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (active[i] % 6 != 0) continue;
    elongation(i) = active[i] == 0 ? -1.0 : 1.0;
  }
  return elongation;
}

}  // namespace pleuel
