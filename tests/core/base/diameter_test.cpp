#include "core/base/diameter.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"

namespace pleuel::test::diameter_test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

double largest_of_all_pairs(const Points& points) {
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      largest = std::max(largest, diameter({points[i], points[j]}));
    }
  }
  return largest;
}

/// To the last digit: pairs by the same function.
TEST(Diameter, IsTheLargestOfAllPairs) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 60; ++n) {
    for (const Eigen::Vector3d& shape :
         {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, 1e-3, 0), Eigen::Vector3d(0, 0, 0)}) {
      Points points, sphere;
      for (int i = 0; i < n; ++i) {
        const Eigen::Vector3d point(normal(random), normal(random), normal(random));
        points.push_back(Eigen::Vector3d(100, -3, 7) + shape.cwiseProduct(point));
        sphere.push_back(point.normalized());
      }
      EXPECT_EQ(diameter(points), largest_of_all_pairs(points)) << n;
      EXPECT_EQ(diameter(sphere), largest_of_all_pairs(sphere)) << n;
    }
  }
}

TEST(Diameter, OfTwoPointsIsTheirDistance) {
  const Eigen::Vector3d a(100, -3, 7), b(0.1, 1.7, 1e-3);
  EXPECT_DOUBLE_EQ(diameter({a, b}), (a - b).norm());
}

TEST(Diameter, OfAChainIsItsLength) {
  Points points;
  for (int i = 0; i <= 5000; ++i) points.emplace_back(0.5 * i, 0.0, i % 2);
  EXPECT_DOUBLE_EQ(diameter(points), 2500.0);
}

}  // namespace
}  // namespace pleuel::test::diameter_test
