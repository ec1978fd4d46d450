#pragma once

#include "studies/pareto_point.hpp"

/// Gaps of a front, and the points that close them.
///
/// The distance of two points is that in the plane of both goals, each divided by its range on the
/// front. Neighbours are those of the points within their limits that no other dominates, by their
/// limited value. Between two of them limits are taken along the cubic that has their values and,
/// by the multipliers, their slopes (kept monotone after Fritsch & Carlson 1980, SIAM J. Numer.
/// Anal. 17, 238–246), at equal lengths of it. Where an interval of limits is too short to be divided,
/// the other goal is limited: the ε-constraint method with the goals exchanged.
namespace pleuel {

/// A limit that a point is looked for at.
struct FrontProbe {
  double limit = 0.0;  ///< [SI]
  std::size_t from = 0,
              other = 0;  ///< the nearer neighbour by its limit, and the other one, if any
  /// The limit is on the objective, and what else is limited is improved (ParetoPoint).
  std::optional<double> objective_limit = {};
};

/// Whether a front takes limits on its objective.
enum class ObjectiveLimits { possible, impossible };

/// Two neighbours that are further apart than asked.
struct FrontGap {
  enum class Cause {
    open,     ///< more points would make it smaller
    jump,     ///< searches between came to the loose side
    failure,  ///< searches for points between failed, or came to designs that others dominate
    narrow    ///< nothing was looked for: the limits are too near to each other
  };
  std::size_t tight = 0, loose = 0;  ///< the points, by their limit
  double size = 0.0;                 ///< both goals over their ranges
  Cause cause = Cause::open;
};

struct FrontGaps {
  std::vector<FrontGap> gaps;  ///< that are larger than asked, by their limited value
  std::vector<FrontProbe>
      probes;  ///< for the larger half of the open ones; none: nothing is to be done
  std::optional<double> largest;  ///< distance of neighbours; none of fewer than two points
};

/// What follows from the points so far, and from nothing else. Where limits tighter than those of
/// the front led to no design, its end is looked for between, until what its slope predicts up to
/// there is no larger than the gap.
///
/// Where the slopes account for less than half of what the objective changes, the tighter limit is
/// solved once more from the loose side: designs of that side may be better there than those that
/// were found. Where limits on either side are nearer than a quarter of the gap asked, and the slopes
/// are unknown or account for less than half of it, or nearer than optima can be told apart (FrontScale),
/// the objective is limited, at first to the middle between both. If the best design there is the
/// loose neighbour, no point is up to that limit; if a second one, as near to the tight neighbour as
/// the gap, leads there too, the front jumps. Limits at which a search led nowhere are passed by;
/// after three of them between the same neighbours, or two on the objective, no more are taken.
/// @param points  marked by mark_dominated()
/// @param gap     both goals over their ranges, 0.001 … 1
/// @param room    how many probes there may be
FrontGaps find_front_gaps(const std::vector<ParetoPoint>& points, GoodSide side, double gap,
                          int room, ObjectiveLimits objective_limits = ObjectiveLimits::possible);

}  // namespace pleuel
