#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reduction/interface.hpp"
#include "reduction/reduce.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pleuel::test::plane_motion_test {
namespace {

ReducedBody reduced(int modes, const std::string& more) {
  const TemporaryFolder folder;
  Block block{0.4, 0.04, 0.03, 6, 2, 2};
  block.poisson = 0.3;
  const auto path = write_block_model(folder.path(), block, make_block(block), "rigid",
                                      fmt::format(", \"modes\": {}{}", modes, more));
  return reduce(read_reduction_model(path.string()));
}

/// The coordinates in the plane and the others share no stiffness and no inertia in a symmetric body: those that
/// are kept have the matrices that they had among all of them.
TEST(PlaneMotion, KeepsTheCoordinatesInThePlaneAsTheyAre) {
  const ReducedBody all = reduced(20, ""), some = reduced(6, ", \"plane\": \"z = 0\"");
  std::vector<int> kept = {0, 1, 5};  // u, v, rz
  for (const double frequency : some.frequencies) {
    Eigen::Index nearest = 0;
    const double off = (all.frequencies.array() - frequency).abs().minCoeff(&nearest);
    EXPECT_LT(off, 1e-8 * frequency);
    kept.push_back(6 + static_cast<int>(nearest));
  }
  EXPECT_THAT(
      std::vector<std::string>(some.file.coordinates.begin(), some.file.coordinates.begin() + 3),
      testing::ElementsAre("u of right", "v of right", "rz of right"));
  EXPECT_EQ(kept.size(), 9u);
  EXPECT_LT(some.asymmetry, 1e-9);
  const Eigen::MatrixXd k(all.file.constants.stiffness), m(all.file.constants.mass_matrix);
  // Modes may have other signs.
  const auto difference = [&](const SparseMatrix& one, const Eigen::MatrixXd& other) {
    return (Eigen::MatrixXd(one).cwiseAbs() - other(kept, kept).cwiseAbs()).norm() / other.norm();
  };
  EXPECT_LT(difference(some.file.constants.stiffness, k), 1e-9);
  EXPECT_LT(difference(some.file.constants.mass_matrix, m), 1e-9);
  for (int i = 0; i < static_cast<int>(k.rows()); ++i) {
    if (std::find(kept.begin(), kept.end(), i) != kept.end()) continue;
    // Higher ones may be of the plane, too.
    if (i >= 6 && all.frequencies(i - 6) > some.frequencies.tail(1)(0)) continue;
    for (const int j : kept) {
      EXPECT_NEAR(k(i, j), 0.0, 1e-8 * std::sqrt(k(i, i) * k(j, j))) << i << " " << j;
      EXPECT_NEAR(m(i, j), 0.0, 1e-8 * std::sqrt(m(i, i) * m(j, j))) << i << " " << j;
    }
  }
}

/// What a planar mechanism asks of a body: nothing couples z with x and y. Poisson's effect stays.
TEST(PlaneMotion, LeavesNothingAcrossThePlane) {
  const BodyConstants body = reduced(6, ", \"plane\": \"z = 0\"").file.constants;
  EXPECT_EQ(Eigen::MatrixXd(body.shape).row(2).norm(), 0.0);
  EXPECT_EQ(Eigen::MatrixXd(body.moments[4]).norm(), 0.0);
  EXPECT_EQ(Eigen::MatrixXd(body.moments[5]).norm(), 0.0);
  EXPECT_GT(Eigen::MatrixXd(body.moments[2]).norm(), 0.0);
  for (const BodyPlace& place : body.places) {
    EXPECT_EQ(Eigen::MatrixXd(place.displacement).row(2).norm(), 0.0);
    EXPECT_EQ(Eigen::MatrixXd(place.rotation).topRows<2>().norm(), 0.0);
  }
}

}  // namespace
}  // namespace pleuel::test::plane_motion_test
