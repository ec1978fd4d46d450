#include "studies/front_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

constexpr int most_failures = 3;
constexpr double shortest_end = 1e-4;      ///< of the range: no end is looked for in less
constexpr std::size_t most_crossings = 2;  ///< limits on the objective in one gap
constexpr double near_gap = 0.9;           ///< of the gap asked
constexpr int most_parts = 4;              ///< of a gap at a time
constexpr double same_place = 0.1, short_interval = 0.25, slope_share = 0.5;  ///< of the gap asked
constexpr double end_share = 0.02;  ///< of an interval of limits: no probe is nearer to its ends
constexpr int segments = 64;        ///< of the curve that is measured

/// A point in the plane of both goals over their ranges; the limit is looser at the larger number.
struct Place {
  std::size_t index = 0;
  double limit = 0.0, limited = 0.0, objective = 0.0;
  std::optional<double> slope;            ///< of the objective by the limit
  std::optional<double> objective_limit;  ///< that it was found with
  bool is_on_front = false;
};

double distance(const Place& one, const Place& other) {
  return std::hypot(one.limited - other.limited, one.objective - other.objective);
}

/// Two neighbours, and the limits that points between them may have.
struct Neighbours {
  const Place *tight, *loose;
  double lower, upper;           ///< limits below and above lead to either of them
  std::vector<double> failures;  ///< limits between these that did not lead between, ascending

  double interval() const { return upper - lower; }
};

class GapFinder {
 public:
  GapFinder(const std::vector<ParetoPoint>& points, GoodSide side, double gap,
            ObjectiveLimits objective_limits)
      : points_(points),
        gap_(gap),
        sign_(side == GoodSide::low ? 1.0 : -1.0),
        takes_objective_limits_(objective_limits == ObjectiveLimits::possible) {
    measure(side);
    for (std::size_t i = 0; i < points.size(); ++i) places_.push_back(place_of(points[i], i));
    for (const Place& place : places_) {
      if (place.is_on_front) front_.push_back(&place);
    }
    std::ranges::stable_sort(
        front_, [](const Place* one, const Place* other) { return one->limited < other->limited; });
  }

  FrontGaps run(int room) {
    FrontGaps found;
    std::vector<std::pair<double, Neighbours>> open;
    add_end(found, open);
    for (std::size_t i = 1; i < front_.size(); ++i) {
      const Place &tight = *front_[i - 1], &loose = *front_[i];
      const double size = distance(tight, loose);
      found.largest = std::max(found.largest.value_or(0.0), size);
      if (size <= gap_) continue;
      Neighbours between = neighbours(tight, loose);
      const FrontGap::Cause cause = cause_of(between);
      found.gaps.push_back({tight.index, loose.index, size, cause});
      if (cause == FrontGap::Cause::open) open.emplace_back(size, std::move(between));
    }
    found.probes = probes(std::move(open), room);
    return found;
  }

 private:
  /// Ranges of both goals; one that is not traded plays no part.
  void measure(GoodSide side) {
    std::vector<Goals> goals;
    for (const ParetoPoint& point : points_) {
      if (is_on_front(point)) goals.push_back(goals_of(point, side));
    }
    const FrontScale scale(goals);
    objective_scale_ = scale.objective().per_range();
    limited_scale_ = scale.limited().per_range();
  }

  static bool is_on_front(const ParetoPoint& point) {
    return point.has_design() && point.keeps_limits() && !point.is_dominated;
  }

  Place place_of(const ParetoPoint& point, std::size_t index) const {
    Place place;
    place.index = index;
    place.limit = sign_ * point.limit * limited_scale_;
    place.is_on_front = is_on_front(point);
    if (point.objective_limit) place.objective_limit = *point.objective_limit * objective_scale_;
    if (!point.has_design()) return place;
    place.limited = sign_ * point.limited_value * limited_scale_;
    place.objective = point.result.evaluation.objective * objective_scale_;
    if (point.has_multiplier() && limited_scale_ > 0.0) {
      place.slope = -sign_ * point.multiplier * objective_scale_ / limited_scale_;
    }
    return place;
  }

  Neighbours neighbours(const Place& tight, const Place& loose) const {
    Neighbours between{&tight, &loose, tight.limited, std::min(loose.limited, loose.limit), {}};
    for (const Place& place : places_) {
      // Where the limit is not active, more of it changes nothing.
      const bool is_tight = place.is_on_front && distance(place, tight) <= same_place * gap_;
      if (is_tight && place.limit < between.upper) {
        between.lower = std::max(between.lower, place.limit);
      }
    }
    for (const Place& place : places_) {
      const bool is_loose = place.is_on_front && distance(place, loose) <= same_place * gap_;
      if (is_loose && place.limit > between.lower) {
        between.upper = std::min(between.upper, place.limit);
      }
    }
    for (const Place& place : places_) {
      if (between.lower < place.limit && place.limit < between.upper) {
        between.failures.push_back(place.limit);
      }
    }
    std::ranges::sort(between.failures);
    return between;
  }

  /// Where tighter limits led to no design, the front may go on from its tightest point as far as
  /// these: at most by the length that its slope predicts.
  void add_end(FrontGaps& found, std::vector<std::pair<double, Neighbours>>& open) const {
    if (front_.empty() || limited_scale_ == 0.0) return;
    const Place& first = *front_.front();
    const Place* failed = nullptr;
    for (const Place& place : places_) {
      const bool is_nearer = failed == nullptr || place.limit > failed->limit;
      const bool is_failed = !points_[place.index].keeps_limits();
      if (is_failed && place.limit < first.limited && is_nearer) failed = &place;
    }
    if (failed == nullptr) return;
    Neighbours between{failed, &first, failed->limit, std::min(first.limit, first.limited), {}};
    const double size = between.interval() * std::hypot(1.0, first.slope.value_or(0.0));
    if (size <= gap_ || between.interval() <= shortest_end) return;
    found.gaps.push_back({failed->index, first.index, size, FrontGap::Cause::open});
    open.emplace_back(size, std::move(between));
  }

  /// Whether the slopes account for less than half of a change of the objective.
  static bool is_unexplained(const Neighbours& between, double change) {
    const auto &tight = between.tight->slope, &loose = between.loose->slope;
    return tight && loose &&
           (std::abs(*tight) + std::abs(*loose)) * between.interval() <= slope_share * change;
  }

  /// Beyond a jump the designs of the loose side may go on, better than those that were found.
  bool asks_for_look_back(const Neighbours& between) const {
    const Place& tight = *between.tight;
    if (!tight.is_on_front) return false;
    const bool is_active = tight.limit - tight.limited <= same_place * gap_;
    if (!is_active || tight.limit > between.upper) return false;
    if (!is_unexplained(between, tight.objective - between.loose->objective)) return false;
    const double limit = points_[tight.index].limit;
    return 1 == std::ranges::count_if(
                    points_, [&](const ParetoPoint& point) { return point.limit == limit; });
  }

  FrontGap::Cause cause_of(const Neighbours& between) const {
    if (asks_for_look_back(between)) return FrontGap::Cause::open;
    if (is_narrow(between)) return cause_of_narrow(between);
    return between.failures.size() < most_failures ? FrontGap::Cause::open
                                                   : FrontGap::Cause::failure;
  }

  /// Whether limits between do not divide it: they would be nearer to each other than optima can be
  /// told apart, or lead to one side or the other as far as the slopes tell.
  bool is_narrow(const Neighbours& between) const {
    if (objective_scale_ == 0.0 || !between.tight->is_on_front) return false;
    const double size = std::max(std::abs(between.lower), std::abs(between.upper));
    if (between.interval() <= optimum_accuracy * size) return true;
    if (between.interval() > short_interval * gap_) return false;
    const bool knows_slopes = between.tight->slope && between.loose->slope;
    return knows_slopes ? is_unexplained(between, gap_) : takes_objective_limits_;
  }

  // ---- limits on the objective

  /// What such limits between two neighbours led to.
  struct Crossings {
    double cleared = 0.0;  ///< up to here the loose neighbour is best
    std::size_t tried = 0;
  };

  Crossings crossings(const Neighbours& between) const {
    Crossings found{between.loose->objective, 0};
    for (const Place& place : places_) {
      if (!place.objective_limit) continue;
      const double limit = *place.objective_limit;
      const double margin = same_place * gap_;
      const bool is_between =
          limit > between.loose->objective + margin && limit < between.tight->objective - margin;
      if (!is_between) continue;
      ++found.tried;
      const bool is_loose = place.is_on_front && place.limited >= between.loose->limited - margin;
      if (is_loose) found.cleared = std::max(found.cleared, limit);
    }
    return found;
  }

  FrontGap::Cause cause_of_narrow(const Neighbours& between) const {
    if (!takes_objective_limits_) return FrontGap::Cause::narrow;
    const auto [cleared, tried] = crossings(between);
    if (tried > 0 && between.tight->objective - cleared <= gap_) return FrontGap::Cause::jump;
    return tried < most_crossings ? FrontGap::Cause::open : FrontGap::Cause::failure;
  }

  /// First the middle of a gap, then what is nearly as near to its tight side as the gap asked.
  double next_objective_limit(const Neighbours& between) const {
    const double tight = between.tight->objective, loose = between.loose->objective;
    const double middle = std::midpoint(tight, loose);
    return crossings(between).tried == 0 ? middle : std::max(middle, tight - near_gap * gap_);
  }

  FrontProbe crossing_of(const Neighbours& between) const {
    return {sign_ * std::midpoint(between.lower, between.upper) / limited_scale_,
            between.loose->index, between.tight->index,
            next_objective_limit(between) / objective_scale_};
  }

  // ---- probes

  /// The largest gaps first, and no gap of less than half the largest before that is divided.
  std::vector<FrontProbe> probes(std::vector<std::pair<double, Neighbours>> open, int room) const {
    std::ranges::stable_sort(
        open, [](const auto& one, const auto& other) { return one.first > other.first; });
    std::vector<FrontProbe> all;
    for (const auto& [size, between] : open) {
      if (size < 0.5 * open.front().first) break;
      for (const FrontProbe& probe : probes_of(between)) {
        if (int_size(all) == room) return all;
        all.push_back(probe);
      }
    }
    return all;
  }

  std::vector<FrontProbe> probes_of(const Neighbours& between) const {
    const std::size_t tight = between.tight->index, loose = between.loose->index;
    if (asks_for_look_back(between)) return {{points_[tight].limit, loose, tight}};
    if (is_narrow(between)) return {crossing_of(between)};
    std::vector<FrontProbe> all;
    for (const double limit : limits_between(between)) {
      const bool is_nearer_to_tight = limit - between.lower <= between.upper - limit;
      const std::size_t nearer = is_nearer_to_tight ? tight : loose;
      const std::size_t other = is_nearer_to_tight ? loose : tight;
      const double at = sign_ * limit / limited_scale_;
      if (between.tight->is_on_front) {
        all.push_back({at, nearer, other});
      } else {
        all.push_back({at, loose, loose});
      }
    }
    return all;
  }

  std::vector<double> limits_between(const Neighbours& between) const {
    const bool is_inactive = between.lower - between.tight->limited > same_place * gap_;
    const bool is_end = !between.tight->is_on_front;
    if (is_end || is_inactive || !between.failures.empty()) return {middle_of_largest(between)};
    return limits_along_curve(between);
  }

  /// Of the intervals between limits that were tried.
  static double middle_of_largest(const Neighbours& between) {
    std::vector<double> bounds = between.failures;
    bounds.insert(bounds.begin(), between.lower);
    bounds.push_back(between.upper);
    std::size_t largest = 1;
    for (std::size_t i = 2; i < bounds.size(); ++i) {
      if (bounds[i] - bounds[i - 1] > bounds[largest] - bounds[largest - 1]) largest = i;
    }
    return std::midpoint(bounds[largest - 1], bounds[largest]);
  }

  /// Limits that divide the curve into equal lengths.
  std::vector<double> limits_along_curve(const Neighbours& between) const {
    const std::vector<double> lengths = lengths_of_curve(between);
    const double whole = lengths.back();
    const int parts = std::clamp(static_cast<int>(std::ceil(whole / gap_)), 2, most_parts);
    std::vector<double> limits;
    for (int k = 1; k < parts; ++k) {
      const auto next = std::ranges::lower_bound(lengths, whole * k / parts);
      const auto i = static_cast<double>(next - lengths.begin());
      const double before = *(next - 1), after = *next;
      const double share = (i - 1.0 + (whole * k / parts - before) / (after - before)) / segments;
      const double inside =
          std::clamp(share, end_share * k, 1.0 - end_share * static_cast<double>(parts - k));
      limits.push_back(std::lerp(between.lower, between.upper, inside));
    }
    return limits;
  }

  /// Of the cubic of Hermite from one neighbour to the other, up to each of its segments.
  static std::vector<double> lengths_of_curve(const Neighbours& between) {
    const double from = between.tight->objective, to = between.loose->objective;
    const double interval = between.interval();
    // Times the interval; within three times the rise of the chord it is monotone.
    const double rise = to - from;
    const auto kept = [&](const std::optional<double>& slope) {
      const double own = slope ? *slope * interval : rise;
      return std::clamp(own, std::min(3.0 * rise, 0.0), std::max(3.0 * rise, 0.0));
    };
    const double first = kept(between.tight->slope), last = kept(between.loose->slope);
    std::vector<double> lengths = {0.0};
    double before = from;
    for (int i = 1; i <= segments; ++i) {
      const double t = static_cast<double>(i) / segments;
      const double s = 1.0 - t;
      const double at = from * (1.0 + 2.0 * t) * s * s + to * (3.0 - 2.0 * t) * t * t +
                        first * t * s * s - last * t * t * s;
      lengths.push_back(lengths.back() + std::hypot(interval / segments, at - before));
      before = at;
    }
    return lengths;
  }

  const std::vector<ParetoPoint>& points_;
  double gap_, sign_;
  bool takes_objective_limits_;
  double limited_scale_ = 0.0, objective_scale_ = 0.0;  ///< 1 / range
  std::vector<Place> places_;                           ///< of all points
  std::vector<const Place*> front_;                     ///< by their limited value
};

}  // namespace

FrontGaps find_front_gaps(const std::vector<ParetoPoint>& points, GoodSide side, double gap,
                          int room, ObjectiveLimits objective_limits) {
  return GapFinder(points, side, gap, objective_limits).run(room);
}

}  // namespace pleuel
