#include <array>

#include <Eigen/Geometry>

#include "core/base/error.hpp"
#include "reduction/element_shape.hpp"
#include "reduction/reduce.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::surface_test {
namespace {

// The surface of a block, whose area, volume and stretching are known.

ReducedBody with_surface(const Block& block, int points) {
  const TemporaryFolder folder;
  const auto path = write_block_model(folder.path(), block, make_block(block), "rigid",
                                      fmt::format(", \"modes\": 0, \"surface\": {}", points));
  return reduce(read_reduction_model(path.string()));
}

struct Enclosed {
  double area = 0.0, volume = 0.0;
};

/// By triangles that are anticlockwise seen from outside.
Enclosed enclosed_by(const BodySurface& surface) {
  Enclosed sum;
  for (const auto& [a, b, c] : surface.triangles) {
    const Eigen::Vector3d p = surface.positions.col(a), q = surface.positions.col(b),
                          r = surface.positions.col(c);
    sum.area += 0.5 * (q - p).cross(r - p).norm();
    sum.volume += p.dot(q.cross(r)) / 6.0;
  }
  return sum;
}

TEST(Surface, EnclosesTheBlock) {
  const Block block;
  const BodySurface surface = *with_surface(block, 100000).file.surface;
  const Enclosed found = enclosed_by(surface);
  const double around = 2.0 * (block.height + block.width) * block.length;
  EXPECT_NEAR(found.area / (around + 2.0 * block.area()), 1.0, 1e-9);
  EXPECT_NEAR(found.volume / (block.area() * block.length), 1.0, 1e-9);
  EXPECT_EQ(surface.young, block.young);
}

/// Fewer points keep the flat sides, and lose edges: by less than a cell of the grid.
TEST(Surface, OfFewerPointsIsNearly) {
  const Block block{0.4, 0.04, 0.03, 16, 4, 4};
  const BodySurface all = *with_surface(block, 100000).file.surface;
  const int most = static_cast<int>(all.positions.cols()) / 2;
  const BodySurface few = *with_surface(block, most).file.surface;
  EXPECT_LE(few.positions.cols(), most);
  EXPECT_GT(few.positions.cols(), most / 3);
  EXPECT_NEAR(enclosed_by(few).volume / enclosed_by(all).volume, 1.0, 0.15);
}

/// Pulled by a force, a prism without lateral contraction stretches by F x/EA.
TEST(Surface, StretchesAsThePrism) {
  const Block block;
  const ReducedBody body = with_surface(block, 200);
  const BodySurface& surface = *body.file.surface;
  const Eigen::VectorXd q = solve_dense(Eigen::MatrixXd(body.file.constants.stiffness),
                                        Eigen::VectorXd(Eigen::VectorXd::Unit(6, 0)));
  const Eigen::VectorXd u = surface.displacement * q;
  for (Eigen::Index i = 0; i < surface.positions.cols(); ++i) {
    const double expected = surface.positions(0, i) / (block.young * block.area());
    EXPECT_NEAR(u(3 * i), expected, 1e-8 * block.length / (block.young * block.area()));
  }
}

/// Single precision of the file.
TEST(Surface, IsReadAsItIsWritten) {
  const InvariantsFile file = with_surface(Block(), 60).file;
  const BodySurface &expected = *file.surface,
                    found = *read_invariants_text(write_invariants(file), "block.json").surface;
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_LE((found.positions - expected.positions).cwiseAbs().maxCoeff(), 1e-6 * 0.4);
  EXPECT_LE((found.displacement - expected.displacement).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Surface, HasToBeWhole) {
  const InvariantsFile file = with_surface(Block(), 60).file;
  std::string text = write_invariants(file);
  const std::string word = "\"triangles\": [[";
  text.replace(text.find(word), word.size(), "\"triangles\": [[9");
  EXPECT_THAT(thrown<InputError>([&] { read_invariants_text(text, "block.json"); }),
              HasSubstr("/surface/triangles/0/0"))
      << "a triangle with an unknown corner";
}

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

// Points of stress in groups that responses can name.

ReducedBody with_groups(const std::string& more) {
  const TemporaryFolder folder;
  const Block block;
  const auto path = write_block_model(folder.path(), block, make_block(block), "rigid",
                                      R"(, "modes": 0, "stress": {"nodes": {
                             "top": {"box": [[0.1, 0.02, -1], [0.3, 0.02, 1]]},
                             "middle": {"box": [[0.2, -1, -1], [0.2, 1, 1]]}},
                             "strength": 3e8, "endurance_limit": 1e8)" +
                                          more + "}");
  return reduce(read_reduction_model(path.string()));
}

/// The three corners on the top in the middle are in both: 5 × 3 and 3 × 3 nodes.
TEST(StressGroups, ShareTheirPoints) {
  const StressRecovery stress = *with_groups("").file.constants.stress;
  ASSERT_EQ(stress.groups.size(), 2U);
  EXPECT_EQ(stress.groups[0].name, "top");
  EXPECT_EQ(named_points(stress, "top").size(), 15U);
  EXPECT_EQ(named_points(stress, "middle").size(), 9U);
  EXPECT_EQ(stress.points.size(), 21U);
  EXPECT_EQ(stress.strengths.endurance_limit, 1e8);
}

TEST(StressGroups, KeepThePointsOfEachThatCanBeLargest) {
  const StressRecovery stress = *with_groups(", \"most\": 4").file.constants.stress;
  for (const char* name : {"top", "middle"}) {
    EXPECT_FALSE(named_points(stress, name).empty()) << name;
    EXPECT_LE(named_points(stress, name).size(), 4U) << name;
  }
}

}  // namespace
}  // namespace pleuel::test::surface_test
