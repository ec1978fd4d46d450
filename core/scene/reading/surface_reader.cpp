#include "core/scene/reading/surface_reader.hpp"

#include <cmath>

#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

/// Rows of so many numbers.
Eigen::MatrixXd read_table(const JsonNode& node, std::size_t columns) {
  const std::vector<JsonNode> rows = node.items();
  Eigen::MatrixXd table(int_size(rows), columns);
  for (int i = 0; i < int_size(rows); ++i) {
    int k = 0;
    for (const JsonNode& number : rows[i].items(columns)) {
      table(i, k) = number.number();
      if (!std::isfinite(table(i, k++))) number.fail_with_value("must be finite");
    }
  }
  return table;
}

std::vector<std::array<int, 3>> read_triangles(const JsonNode& node, int points) {
  std::vector<std::array<int, 3>> triangles;
  for (const JsonNode& item : node.items()) {
    const std::vector<JsonNode> corners = item.items(3);
    std::array<int, 3>& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = corners[i].whole_number(0, points - 1);
  }
  return triangles;
}

}  // namespace

BodySurface read_surface(const JsonNode& node, int coordinates) {
  node.allow_keys({"positions", "triangles", "displacement", "young", "poisson"});
  BodySurface surface;
  surface.positions = read_table(node.at("positions"), 3).transpose();
  const int points = int_size(surface.positions.row(0));
  surface.triangles = read_triangles(node.at("triangles"), points);
  const JsonNode displacement = node.at("displacement");
  surface.displacement = read_table(displacement, coordinates);
  if (surface.displacement.rows() != 3 * points) {
    displacement.fail("must have three rows for each of the \"positions\"");
  }
  surface.young = node.at("young").number();
  surface.poisson = node.at("poisson").number();
  if (!(surface.young > 0.0)) node.at("young").fail_with_value("must be positive [Pa]");
  if (!(std::abs(surface.poisson) < 1.0)) {
    node.at("poisson").fail_with_value("must be between -1 and 1");
  }
  return surface;
}

}  // namespace pleuel
