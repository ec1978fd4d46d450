#pragma once

#include <vector>

#include "studies/pareto_point.hpp"

/// Gaps of a front, and the points that close them.
///
/// The distance of two points is that in the plane of both goals, each divided by its range on the
/// front. Neighbours are those of the points within their limits that no other dominates, by their
/// limited value. Between two of them limits are taken along the cubic that has their values and,
/// by the multipliers, their slopes (kept monotone after Fritsch & Carlson 1980, SIAM J. Numer.
/// Anal. 17, 238–246), at equal lengths of it.
namespace pleuel {

/// A limit that a point is looked for at.
struct FrontProbe {
  double limit = 0.0;  ///< [SI]
  std::size_t from = 0,
              other = 0;  ///< the nearer neighbour by its limit, and the other one, if any
};

/// Two neighbours that are further apart than asked.
struct FrontGap {
  enum class Cause {
    open,  ///< more points would make it smaller
    jump,  ///< no point is between: limits as near as a quarter of the gap lead to either side of it
    failure  ///< searches for points between failed, or came to designs that others dominate
  };
  std::size_t tight = 0, loose = 0;  ///< the points, by their limit
  double size = 0.0;                 ///< both goals over their ranges
  Cause cause = Cause::open;
};

struct FrontGaps {
  std::vector<FrontGap> gaps;  ///< that are larger than asked, by their limited value
  std::vector<FrontProbe>
      probes;            ///< for the larger half of the open ones; none: nothing is to be done
  double largest = 0.0;  ///< distance of neighbours
};

/// What follows from the points so far, and from nothing else. Where limits tighter than those of
/// the front led to no design, its end is looked for between, until what its slope predicts up to
/// there is no larger than the gap.
///
/// Where the slopes account for less than half of what the objective changes, the tighter limit is
/// solved once more from the loose side: designs of that side may be better there than those that
/// were found. A jump has no point within. It is told from a steep part of a front by limits on
/// either side that are nearer than a quarter of the gap asked, where the slopes account for less
/// than half of it, or that are nearer than optima can be told apart (10⁻⁴ of the range). Limits at
/// which a search led nowhere are passed by; after three of them between the same neighbours no
/// more are taken.
/// @param points  marked by mark_dominated()
/// @param gap     both goals over their ranges, 0.001 … 1
/// @param room    how many probes there may be
FrontGaps find_front_gaps(const std::vector<ParetoPoint>& points, GoodSide side, double gap,
                          int room);

}  // namespace pleuel
