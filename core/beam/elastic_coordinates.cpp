#include "core/beam/elastic_coordinates.hpp"

#include "core/base/eager_matrices.hpp"

namespace pleuel {

ElasticCoordinates::ElasticCoordinates(int node_count, const NodalFlags& active)
    : index_(node_count) {
  for (auto& node : index_) {
    for (std::size_t i = 0; i < 6; ++i) node[i] = active[i] ? 0 : -1;
  }
  number();
}

void ElasticCoordinates::clamp(int node, int displacement) {
  index_[node][displacement] = -1;
  number();
}

void ElasticCoordinates::number() {
  size_ = 0;
  for (auto& node : index_) {
    for (int& index : node) {
      if (index >= 0) index = size_++;
    }
  }
}

std::array<int, 12> ElasticCoordinates::element_indices(int element) const {
  std::array<int, 12> indices{};
  for (int i = 0; i < 12; ++i) {
    indices[i] = index(element + i / 6, i % 6);
  }
  return indices;
}

ElasticCoordinates tangent_coordinates(int node_count, const NodalFlags& active) {
  ElasticCoordinates coordinates(node_count, active);
  for (int i = 0; i < 6; ++i) coordinates.clamp(0, i);
  return coordinates;
}

ElasticCoordinates tangent_end_coordinates(int node_count, const NodalFlags& active) {
  ElasticCoordinates coordinates(node_count, active);
  for (int i = 0; i < 6; ++i) coordinates.clamp(node_count - 1, i);
  return coordinates;
}

ElasticCoordinates chord_coordinates(int node_count, const NodalFlags& active) {
  ElasticCoordinates coordinates(node_count, active);
  for (int i = 0; i < 4; ++i) coordinates.clamp(0, i);
  coordinates.clamp(node_count - 1, 1);
  coordinates.clamp(node_count - 1, 2);
  return coordinates;
}

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
