#include "reduction/element_shape.hpp"

#include <array>

#include <gtest/gtest.h>

#include "tests/reduction/solid_block.hpp"

namespace pleuel::test::element_shape_test {
namespace {

constexpr std::array shapes = {SolidShape::tetrahedron4, SolidShape::tetrahedron10,
                               SolidShape::hexahedron8, SolidShape::hexahedron20};

TEST(ElementShape, FunctionsAreOneAtTheirNodeAndZeroAtOthers) {
  for (const SolidShape shape : shapes) {
    for (int i = 0; i < node_count(shape); ++i) {
      const Eigen::VectorXd n = shape_functions(shape, local_node(shape, i));
      EXPECT_LT((n - Eigen::VectorXd::Unit(node_count(shape), i)).norm(), 1e-14);
    }
  }
}

/// Central differences of polynomials of third order at most along an axis: exact but for round-off
/// and h² times the third derivative.
TEST(ElementShape, DerivativesAreThoseOfDifferences) {
  const Eigen::Vector3d at(0.2, 0.3, 0.1);
  constexpr double h = 1e-5;
  for (const SolidShape shape : shapes) {
    const Eigen::MatrixX3d d = shape_derivatives(shape, at);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
      const Eigen::VectorXd difference =
          (shape_functions(shape, at + step) - shape_functions(shape, at - step)) / (2.0 * h);
      EXPECT_LT((d.col(k) - difference).norm(), 1e-9);
    }
  }
}

TEST(ElementShape, OfTwentyNodesIsThatOfMonomials) {
  const Eigen::Vector3d at(0.2, -0.7, 0.4);
  EXPECT_LT((shape_functions(SolidShape::hexahedron20, at) - monomial_functions(at)).norm(), 1e-13);
  EXPECT_LT((shape_derivatives(SolidShape::hexahedron20, at) - monomial_derivatives(at)).norm(),
            1e-12);
}

/// ∫ r² s over the unit tetrahedron = 2! 1!/6! (Dirichlet), over the cube of r² s² = 8/9.
TEST(ElementShape, QuadratureIsExactForPolynomials) {
  double tetrahedron = 0.0, cube = 0.0, volume = 0.0;
  for (const auto& [x, w] : quadrature(SolidShape::tetrahedron10)) {
    tetrahedron += w * x(0) * x(0) * x(1);
    volume += w;
  }
  for (const auto& [x, w] : quadrature(SolidShape::hexahedron20)) {
    cube += w * x(0) * x(0) * x(1) * x(1);
  }
  EXPECT_NEAR(volume, 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(tetrahedron, 2.0 / 360.0 / 2.0, 1e-16);
  EXPECT_NEAR(cube, 8.0 / 9.0, 1e-14);
}

}  // namespace
}  // namespace pleuel::test::element_shape_test
