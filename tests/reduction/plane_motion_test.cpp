#include "reduction/plane_motion.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reduction/reduce.hpp"
#include "tests/reduction/solid_block.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pleuel::test::plane_motion_test {
namespace {

ReducedBody reduced(const std::string& more) {
  const TemporaryFolder folder;
  Block block{0.4, 0.04, 0.03, 6, 2, 2};
  block.poisson = 0.3;
  const auto path =
      write_block_model(folder.path(), block, make_block(block), "rigid", ", \"modes\": 6" + more);
  return reduce(read_reduction_model(path.string()));
}

/// The coordinates in the plane and the others share no stiffness and no inertia in a symmetric body: those that
/// are kept have the matrices that they had among all of them.
TEST(PlaneMotion, KeepsTheCoordinatesInThePlaneAsTheyAre) {
  const ReducedBody all = reduced(""), some = reduced(", \"plane\": \"z = 0\"");
  std::vector<int> kept;
  for (const std::string& name : some.file.coordinates) {
    const auto& names = all.file.coordinates;
    kept.push_back(static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin()));
  }
  EXPECT_THAT(
      std::vector<std::string>(some.file.coordinates.begin(), some.file.coordinates.begin() + 3),
      testing::ElementsAre("u of right", "v of right", "rz of right"));
  EXPECT_GT(kept.size(), 4u);
  EXPECT_LT(kept.size(), 9u);
  EXPECT_LT(some.asymmetry, 1e-9);
  const Eigen::MatrixXd k(all.file.constants.stiffness), m(all.file.constants.mass_matrix);
  EXPECT_LT(
      (Eigen::MatrixXd(some.file.constants.stiffness) - Eigen::MatrixXd(k(kept, kept))).norm(),
      1e-9 * k.norm());
  EXPECT_LT(
      (Eigen::MatrixXd(some.file.constants.mass_matrix) - Eigen::MatrixXd(m(kept, kept))).norm(),
      1e-9 * m.norm());
  for (int i = 0; i < static_cast<int>(k.rows()); ++i) {
    if (std::find(kept.begin(), kept.end(), i) != kept.end()) continue;
    for (const int j : kept) {
      EXPECT_NEAR(k(i, j), 0.0, 1e-8 * std::sqrt(k(i, i) * k(j, j))) << i << " " << j;
      EXPECT_NEAR(m(i, j), 0.0, 1e-8 * std::sqrt(m(i, i) * m(j, j))) << i << " " << j;
    }
  }
}

/// What a planar mechanism asks of a body: nothing couples z with x and y. Poisson's effect stays.
TEST(PlaneMotion, LeavesNothingAcrossThePlane) {
  const BodyConstants body = reduced(", \"plane\": \"z = 0\"").file.constants;
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
