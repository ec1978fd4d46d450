#include "core/beam/elastic_coordinates.hpp"

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

}  // namespace pleuel
