#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "reduction/reduce.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/dense_algebra.hpp"
#include "tests/support/temporary_folder.hpp"

/// The surface of a block, whose area, volume and stretching are known.
namespace pleuel::test::surface_test {
namespace {

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
  try {
    read_invariants_text(text, "block.json");
    FAIL() << "a triangle with an unknown corner";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/surface/triangles/0/0"));
  }
}

}  // namespace
}  // namespace pleuel::test::surface_test
