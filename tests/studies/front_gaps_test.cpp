#include "studies/front_gaps.hpp"

#include <functional>
#include <numeric>

#include "core/base/eager_matrices.hpp"
#include "studies/pareto_point.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::front_gaps_test {
namespace {

/// What a search for the best design below a limit comes to.
using Search = std::function<ParetoPoint(double limit)>;

ParetoPoint point_at(double limit, double limited, double objective) {
  ParetoPoint point;
  point.limit = limit;
  point.limited_value = limited;
  point.result.status = Status::verified;
  point.result.evaluation.objective = objective;
  point.result.evaluation.objective_gradient = Eigen::VectorXd::Zero(1);
  return point;
}

ParetoPoint on_front(double limited, double objective) {
  return point_at(limited, limited, objective);
}

ParetoPoint failed_at(double limit) {
  ParetoPoint point;
  point.limit = limit;
  return point;
}

double objective_of(const ParetoPoint& point) {
  return point.result.evaluation.objective;
}

/// A front whose limit is active: objective(limit), and its slope.
Search smooth(const std::function<double(double)>& objective,
              const std::function<double(double)>& slope) {
  return [=](double limit) {
    ParetoPoint point = point_at(limit, limit, objective(limit));
    point.multiplier = -slope(limit);
    return point;
  };
}

/// The tightest limit whose best design has at most this objective, by bisection from the loosest.
ParetoPoint exchanged(const Search& search, double tight, double loose, double objective_limit) {
  for (int i = 0; i < 80; ++i) {
    const double middle = std::midpoint(tight, loose);
    const ParetoPoint point = search(middle);
    const bool keeps_it =
        point.has_design() && point.result.evaluation.objective <= objective_limit;
    (keeps_it ? loose : tight) = middle;
  }
  ParetoPoint point = search(loose);
  point.limit = point.limited_value;
  point.objective_limit = objective_limit;
  return point;
}

struct Closed {
  std::vector<ParetoPoint> points;
  FrontGaps gaps;
};

/// Adds points until none is asked for.
Closed close(const Search& search, const std::vector<double>& limits, double gap,
             int most_points = 100, GoodSide side = GoodSide::low,
             ObjectiveLimits objective_limits = ObjectiveLimits::possible) {
  Closed closed;
  for (const double limit : limits) closed.points.push_back(search(limit));
  while (true) {
    mark_dominated(closed.points, side);
    const int room = most_points - static_cast<int>(closed.points.size());
    closed.gaps = find_front_gaps(closed.points, side, gap, std::max(room, 0), objective_limits);
    if (closed.gaps.probes.empty()) return closed;
    for (const FrontProbe& probe : closed.gaps.probes) {
      closed.points.push_back(
          probe.objective_limit
              ? exchanged(search, limits.front(), limits.back(), *probe.objective_limit)
              : search(probe.limit));
    }
  }
}

/// Of points that all are on the front, over the ranges of both goals.
double largest_distance(std::vector<ParetoPoint> points) {
  std::ranges::sort(points, {}, &ParetoPoint::limited_value);
  const ParetoPoint &first = points.front(), &last = points.back();
  double largest = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double width = points[i].limited_value - points[i - 1].limited_value;
    const double height = objective_of(points[i]) - objective_of(points[i - 1]);
    largest = std::max(largest, std::hypot(width / (last.limited_value - first.limited_value),
                                           height / (objective_of(first) - objective_of(last))));
  }
  return largest;
}

/// The quarter of a circle around (1, 1) that is good for both, in units of 50 and 3.
Search circle() {
  const auto at = [](double limit) { return 1.0 - limit / 50.0; };
  return smooth([=](double limit) { return 3.0 - 3.0 * std::sqrt(1.0 - at(limit) * at(limit)); },
                [=](double limit) {
                  const double y = std::max(std::sqrt(1.0 - at(limit) * at(limit)), 1e-9);
                  return -3.0 / 50.0 * at(limit) / y;
                });
}

TEST(FrontGaps, OfASmoothFrontAreClosedWithFewPoints) {
  for (const double gap : {0.4, 0.1, 0.05, 0.02}) {
    const Closed closed = close(circle(), {0.0, 25.0, 50.0}, gap);
    EXPECT_LE(largest_distance(closed.points), gap * (1 + 1e-9));
    EXPECT_NEAR(closed.gaps.largest.value(), largest_distance(closed.points), 1e-9);
    EXPECT_TRUE(closed.gaps.gaps.empty());
    // Equal distances on the arc of length π/2 need so many; a rounded number of parts of each gap
    // makes at most half as many more.
    const double least = 1.0 + std::ceil(0.5 * std::numbers::pi / gap);
    EXPECT_LE(static_cast<double>(closed.points.size()), 1.5 * least + 1.0) << gap;
  }
}

/// 1/c from 0.01 to 1: in equal steps of the limit 0.02 of the range would take 5000 points.
struct SteepFront {
  const char* what;
  double (*objective)(double);
  double (*slope)(double);
  std::vector<double> limits;
  double gap;
  std::size_t most_points;
};

const std::vector<SteepFront> steep_fronts = {
    // In equal steps of the limit 0.02 of the range would take 5000 points. Both legs have about
    // the length 1: 40 at the least.
    {"1/c from 0.01 to 1",
     [](double c) { return 1.0 / c; },
     [](double c) { return -1.0 / (c * c); },
     {0.01, 0.505, 1.0},
     0.05,
     70},
    {"a slope of 1000 over a width of 2e-3 is no jump",
     [](double c) { return -std::atan(1000.0 * (c - 0.4)); },
     [](double c) { return -1000.0 / (1.0 + std::pow(1000.0 * (c - 0.4), 2)); },
     {0.0, 0.25, 0.5, 0.75, 1.0},
     0.05,
     200},
    // Flat on both sides: slopes say nothing, and no limits on either side of it are known to lead
    // into it.
    {"a step of 0.001 of the width",
     [](double c) { return -std::tanh((c - 0.53) / 5e-4) - 0.02 * c; },
     [](double c) { return -1.0 / std::pow(std::cosh((c - 0.53) / 5e-4), 2) / 5e-4 - 0.02; },
     {0.0, 0.5, 1.0},
     0.2,
     25},
    // Of exp(−20 x), x² is the objective: 0.7 of it lies in 1e-4 of the limits.
    {"decades of the limit",
     [](double c) { return std::pow(std::log(c) / 20.0, 2); },
     [](double c) { return std::log(c) / 200.0 / c; },
     {1e-8, 0.5, 1.0},
     0.2,
     100}};

TEST(FrontGaps, OfFrontsThatAreSteepButSmoothAreClosed) {
  for (const SteepFront& steep : steep_fronts) {
    SCOPED_TRACE(steep.what);
    const Closed closed = close(smooth(steep.objective, steep.slope), steep.limits, steep.gap, 200);
    EXPECT_TRUE(closed.gaps.gaps.empty());
    EXPECT_LE(largest_distance(closed.points), steep.gap);
    EXPECT_LE(closed.points.size(), steep.most_points);
    for (const ParetoPoint& point : closed.points) EXPECT_FALSE(point.is_dominated);
  }
}

TEST(FrontGaps, OverALowerLimitAreThoseOfTheMirroredFront) {
  const Search mirrored = [](double limit) {
    ParetoPoint point = circle()(50.0 - limit);
    point.limit = limit;
    point.limited_value = limit;
    point.multiplier = -point.multiplier;
    return point;
  };
  const Closed low = close(circle(), {0.0, 25.0, 50.0}, 0.05);
  const Closed high = close(mirrored, {50.0, 25.0, 0.0}, 0.05, 100, GoodSide::high);
  ASSERT_EQ(high.points.size(), low.points.size());
  for (std::size_t i = 0; i < low.points.size(); ++i) {
    EXPECT_NEAR(high.points[i].limit, 50.0 - low.points[i].limit, 1e-9);
  }
}

/// 2 − c below 0.6, and 0.8 − c from there on: the objective jumps by 0.6 of its range of 1.6.
Search falling_by_a_jump(double jump_at) {
  return smooth([=](double c) { return c < jump_at ? 2.0 - c : 1.4 - c; },
                [](double) { return -1.0; });
}

/// height − c.
Search falling_from(double height) {
  return smooth([=](double c) { return height - c; }, [](double) { return -1.0; });
}

/// The only gap that is left.
FrontGap left_gap(const Closed& closed, FrontGap::Cause cause) {
  EXPECT_EQ(closed.gaps.gaps.size(), 1u);
  if (closed.gaps.gaps.empty()) return {};
  EXPECT_EQ(closed.gaps.gaps.front().cause, cause);
  return closed.gaps.gaps.front();
}

/// A jump is said after searches between both sides, and of no other gap.
TEST(FrontGaps, EndAtAJumpOfTheObjective) {
  const double jump_at = 0.6180339887;
  const Closed closed = close(falling_by_a_jump(jump_at), {0.0, 0.5, 1.0}, 0.05);
  const FrontGap gap = left_gap(closed, FrontGap::Cause::jump);
  const ParetoPoint &tight = closed.points[gap.tight], &loose = closed.points[gap.loose];
  EXPECT_LT(tight.limit, jump_at);
  EXPECT_GE(loose.limit, jump_at);
  // A quarter of the gap asked.
  EXPECT_LE(loose.limit - tight.limit, 0.0125);
  EXPECT_NEAR(gap.size, 0.6 / 1.6, 0.02);
  double highest = objective_of(loose);
  for (const ParetoPoint& point : closed.points) {
    if (point.objective_limit && *point.objective_limit < objective_of(tight)) {
      highest = std::max(highest, *point.objective_limit);
    }
  }
  // Of the range of 1.6 that is left over less than the gap asked.
  EXPECT_LE(objective_of(tight) - highest, 0.05 * 1.6);
}

/// Up to a limit of 0.7 the same design at 0.2 is best; then a better island begins.
TEST(FrontGaps, EndWhereTheLimitIsNotActiveBetweenTwoIslands) {
  const Search islands = [](double limit) {
    if (limit >= 0.2 && limit < 0.7) return point_at(limit, 0.2, 1.8);
    return falling_from(limit < 0.2 ? 2.0 : 1.7)(limit);
  };
  const Closed closed = close(islands, {0.0, 0.5, 1.0}, 0.05);
  const FrontGap gap = left_gap(closed, FrontGap::Cause::jump);
  EXPECT_NEAR(closed.points[gap.tight].limited_value, 0.2, 0.05);
  EXPECT_NEAR(closed.points[gap.loose].limited_value, 0.7, 0.0125);
  EXPECT_LE(closed.points.size(), 45u);
}

/// Two branches, 2 − c and 1.4 − c from c = 0.314 on. A search stays on the branch that it begins
/// on, as long as that is there: the points of the worse one are optima, but not of the front.
TEST(FrontGaps, AreLookedAtFromBothSides) {
  const double end = 0.3141592654;
  std::vector<ParetoPoint> points;
  const auto add = [&](double limit, bool is_on_better) {
    const bool stays = is_on_better && limit >= end;
    points.push_back(falling_from(stays ? 1.4 : 2.0)(limit));
  };
  for (const double limit : {0.0, 0.25, 0.5, 0.75}) add(limit, false);
  add(1.0, true);
  FrontGaps gaps;
  while (true) {
    mark_dominated(points, GoodSide::low);
    gaps = find_front_gaps(points, GoodSide::low, 0.05, 200 - static_cast<int>(points.size()));
    if (gaps.probes.empty()) break;
    for (const FrontProbe& probe : gaps.probes) {
      const ParetoPoint from = points[probe.from];
      if (probe.objective_limit) {
        // Down the branch that it begins on, which ends.
        add(std::max(end, 1.4 - *probe.objective_limit), true);
        points.back().objective_limit = probe.objective_limit;
        continue;
      }
      add(probe.limit, from.result.evaluation.objective < 1.7 - from.limit);
    }
  }
  ASSERT_EQ(gaps.gaps.size(), 1u);
  EXPECT_EQ(gaps.gaps.front().cause, FrontGap::Cause::jump);
  EXPECT_NEAR(points[gaps.gaps.front().loose].limit, end, 0.0125);
  for (const ParetoPoint& point : points) {
    const bool is_at_jump = point.limit >= end && point.limit < end + 0.0125;
    if (point.is_dominated || is_at_jump) continue;
    const double best = point.limit >= end ? 1.4 - point.limit : 2.0 - point.limit;
    EXPECT_NEAR(point.result.evaluation.objective, best, 1e-12) << point.limit;
  }
  EXPECT_LE(points.size(), 80u);
}

TEST(FrontGaps, AreNoJumpsWhereTheObjectiveTakesNoLimits) {
  const Closed closed = close(falling_by_a_jump(0.6180339887), {0.0, 0.5, 1.0}, 0.05, 100,
                              GoodSide::low, ObjectiveLimits::impossible);
  left_gap(closed, FrontGap::Cause::narrow);
}

TEST(FrontGaps, AreNoneWhereNothingIsTraded) {
  // The same design for all limits; one point; none.
  const Search flat = [](double limit) { return point_at(limit, 0.3, 2.0); };
  EXPECT_TRUE(close(flat, {1.0, 2.0, 3.0}, 0.05).gaps.gaps.empty());
  // An objective that does not change: the tightest dominates all others.
  const Search level = [](double limit) { return point_at(limit, limit, 2.0); };
  EXPECT_TRUE(close(level, {1.0, 2.0, 3.0}, 0.05).gaps.probes.empty());
  for (const FrontGaps& none :
       {find_front_gaps({}, GoodSide::low, 0.05, 10), close(circle(), {25.0}, 0.05).gaps,
        close(flat, {1.0}, 0.05).gaps, close(failed_at, {1.0, 2.0, 3.0}, 0.05).gaps}) {
    EXPECT_TRUE(none.probes.empty());
    EXPECT_FALSE(none.largest);
  }
}

TEST(FrontGaps, EndWhereSearchesFail) {
  const Search failing = [](double limit) {
    return limit > 15.0 && limit < 30.0 ? failed_at(limit) : circle()(limit);
  };
  const Closed closed = close(failing, {0.0, 25.0, 50.0}, 0.05);
  left_gap(closed, FrontGap::Cause::failure);
  const auto failures = std::count_if(closed.points.begin(), closed.points.end(),
                                      [](const ParetoPoint& point) { return !point.has_design(); });
  EXPECT_LE(failures, 8);
}

/// 1/c from c = 0.1 on; below that no design keeps the limits.
TEST(FrontGaps, LookForTheEndWhereTighterLimitsLeadToNoDesign) {
  const Search cut = [](double limit) {
    const SteepFront& hyperbola = steep_fronts.front();
    return limit < 0.1 ? failed_at(limit) : smooth(hyperbola.objective, hyperbola.slope)(limit);
  };
  const Closed closed = close(cut, {0.0, 0.5, 1.0}, 0.05);
  EXPECT_TRUE(closed.gaps.gaps.empty());
  double first = 1.0;
  for (const ParetoPoint& point : closed.points) {
    if (point.has_design()) first = std::min(first, point.limit);
  }
  // Ranges of 0.9 and 9: at the end the slope is 100/10, and 0.05 of the length 0.005 of the width.
  EXPECT_NEAR(first, 0.1, 0.005);
  EXPECT_LE(closed.points.size(), 70u);
}

/// Searches that come to designs which others dominate lead nowhere either.
TEST(FrontGaps, EndWhereSearchesComeToWorseDesigns) {
  const Search lost = [](double limit) {
    if (limit > 10.0 && limit < 40.0) return point_at(limit, limit, 10.0);
    return circle()(limit);
  };
  const Closed closed = close(lost, {0.0, 25.0, 50.0}, 0.05, 1000);
  left_gap(closed, FrontGap::Cause::failure);
}

/// Searches that all end in the same two designs, whatever the limit.
TEST(FrontGaps, EndWhereSearchesDoNotHeedTheirLimit) {
  const Search deaf = [](double limit) {
    return limit < 0.9 ? point_at(limit, 0.0, 1.0) : point_at(limit, 1.0, 0.0);
  };
  const Closed closed = close(deaf, {0.0, 0.5, 1.0}, 0.01, 1000);
  left_gap(closed, FrontGap::Cause::jump);
  EXPECT_LE(closed.points.size(), 40u);
  const Search elsewhere = [](double limit) {
    if (limit <= 0.0) return point_at(limit, 0.0, 1.0);
    return point_at(limit, limit < 1.0 ? -1.0 : 1.0, limit < 1.0 ? 2.0 : 0.0);
  };
  EXPECT_LE(close(elsewhere, {0.0, 0.5, 1.0}, 0.01, 1000).points.size(), 40u);
}

TEST(FrontGaps, AreLeftWhereThereAreAsManyPointsAsThereMayBe) {
  const Closed closed = close(circle(), {0.0, 25.0, 50.0}, 0.02, 20);
  EXPECT_EQ(closed.points.size(), 20u);
  ASSERT_FALSE(closed.gaps.gaps.empty());
  for (const FrontGap& gap : closed.gaps.gaps) EXPECT_EQ(gap.cause, FrontGap::Cause::open);
  // The largest are closed first: 19 equal ones would have π/38.
  EXPECT_LE(closed.gaps.largest.value(), 2.5 * std::numbers::pi / 38.0);
}

TEST(FrontGaps, BeginSearchesAtTheNearerNeighbour) {
  std::vector<ParetoPoint> points = {circle()(0.0), circle()(50.0)};
  const FrontGaps gaps = find_front_gaps(points, GoodSide::low, 0.05, 10);
  ASSERT_EQ(gaps.probes.size(), 3u);
  for (const FrontProbe& probe : gaps.probes) EXPECT_EQ(probe.from, probe.limit <= 25.0 ? 0u : 1u);
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
  return on_front(50.0 - 50.0 * std::cos(angle), 3.0 - 3.0 * std::sin(angle));
}

/// Of c = 1/f from f = 1 to 10 the tangent of the front over its ranges is that of the chord where
/// 1/f² = 1/10; the points are 10^(k/8).
TEST(Knee, IsWhereTheTangentIsTheChord) {
  const auto hyperbola = [](double share) {
    const double f = std::pow(10.0, share);
    return on_front(1.0 / f, f);
  };
  const auto mirrored = [](double share) {
    ParetoPoint point = on_circle(share);
    point.limited_value = -point.limited_value;
    return point;
  };
  EXPECT_EQ(find_knee(front_of(9, on_circle), GoodSide::low), 4u);
  EXPECT_EQ(find_knee(front_of(9, hyperbola), GoodSide::low), 4u);
  EXPECT_EQ(find_knee(front_of(9, mirrored), GoodSide::high), 4u);
}

TEST(Knee, IsNoneOfALineAndOfAFrontThatBendsAway) {
  const auto line = [](double share) { return on_front(share, 1.0 - share); };
  const auto away = [](double share) {
    const double angle = 0.5 * std::numbers::pi * share;
    return on_front(std::sin(angle), std::cos(angle));
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
}  // namespace pleuel::test::front_gaps_test
