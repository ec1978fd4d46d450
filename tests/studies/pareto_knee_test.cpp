#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/eager_matrices.hpp"
#include "studies/pareto_point.hpp"

namespace pleuel::test::pareto_knee_test {
namespace {

ParetoPoint point_at(double objective, double limited) {
  ParetoPoint point;
  point.limit = point.limited_value = limited;
  point.result.status = Status::verified;
  point.result.evaluation.objective = objective;
  point.result.evaluation.objective_gradient = Eigen::VectorXd::Zero(1);
  return point;
}

/// So many points of a curve with the parameter from 0 to 1.
std::vector<ParetoPoint> front_of(int count, const std::function<ParetoPoint(double)>& at) {
  std::vector<ParetoPoint> points;
  for (int i = 0; i < count; ++i) points.push_back(at(static_cast<double>(i) / (count - 1)));
  return points;
}

/// On a quarter of a circle around (1, 1) the tangent is parallel to the chord at 45°.
ParetoPoint on_circle(double share) {
  const double angle = 0.5 * std::numbers::pi * share;
  return point_at(3.0 - 3.0 * std::sin(angle), 50.0 - 50.0 * std::cos(angle));
}

TEST(Knee, OfACircleIsItsMiddle) {
  EXPECT_EQ(find_knee(front_of(9, on_circle), GoodSide::low), 4u);
}

/// Of c = 1/f from f = 1 to 10 the tangent of the front over its ranges is that of the chord where
/// 1/f² = 1/10; the points are 10^(k/8).
TEST(Knee, OfAHyperbolaIsWhereTheTangentIsTheChord) {
  const auto hyperbola = [](double share) {
    const double f = std::pow(10.0, share);
    return point_at(f, 1.0 / f);
  };
  EXPECT_EQ(find_knee(front_of(9, hyperbola), GoodSide::low), 4u);
}

TEST(Knee, IsTheSameWhereMuchIsGood) {
  const auto mirrored = [](double share) {
    ParetoPoint point = on_circle(share);
    point.limited_value = -point.limited_value;
    return point;
  };
  EXPECT_EQ(find_knee(front_of(9, mirrored), GoodSide::high), 4u);
}

TEST(Knee, IsNoneOfALineAndOfAFrontThatBendsAway) {
  const auto line = [](double share) { return point_at(1.0 - share, share); };
  const auto away = [](double share) {
    const double angle = 0.5 * std::numbers::pi * share;
    return point_at(std::cos(angle), std::sin(angle));
  };
  EXPECT_EQ(find_knee(front_of(9, line), GoodSide::low), std::nullopt);
  EXPECT_EQ(find_knee(front_of(9, away), GoodSide::low), std::nullopt);
}

TEST(Knee, IsAPointThatCounts) {
  std::vector<ParetoPoint> points = front_of(9, on_circle);
  points[4].is_dominated = true;
  points[5].result.status = Status::infeasible;
  EXPECT_EQ(find_knee(points, GoodSide::low), 3u);
  EXPECT_EQ(find_knee({points[0], points[8]}, GoodSide::low), std::nullopt);
}

}  // namespace
}  // namespace pleuel::test::pareto_knee_test
