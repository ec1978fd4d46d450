#include "core/response/fatigue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/eager_matrices.hpp"
#include "core/integration/period_map.hpp"
#include "core/response/history_jump.hpp"

namespace pleuel {

namespace {

/// Points within this relative distance of the largest are called tied.
constexpr double cycle_tie_gap = 1e-3;
/// So many ties are remembered.
constexpr std::size_t max_cycle_ties = 16;
/// Extrema between samples add little to those of the samples: points below this share of the
/// largest use cannot become it.
constexpr double out_of_reach = 0.9;

/// The utilization of one point.
struct Cycle {
  int point = 0;
  Reduction highest, lowest;  ///< of its first row
  double mean = 0.0;          ///< of its second row
  CycleValue use = {};

  int row() const { return 2 * point; }
};

/// Σ weight · value in a row, at samples of the same or another one.
double in_row(int row, const std::vector<Sample>& samples, const Eigen::MatrixXd& values) {
  double sum = 0.0;
  for (const Sample& sample : samples) sum += sample.weight * values(row, sample.step);
  return sum;
}

/// The closest come first.
void keep_closest(std::vector<PeakTie>& ties) {
  std::ranges::stable_sort(ties, [](const PeakTie& a, const PeakTie& b) { return a.gap < b.gap; });
  if (ties.size() > max_cycle_ties) ties.resize(max_cycle_ties);
}

/// One extreme's part in amplitude and mean.
void add_samples(const std::vector<Sample>& extreme, int row, double of_amplitude, double of_mean,
                 std::vector<Sample>& samples) {
  for (const Sample& sample : extreme) {
    samples.push_back({sample.step, row, of_amplitude * sample.weight});
    if (of_mean != 0.0) samples.push_back({sample.step, row + 1, of_mean * sample.weight});
  }
}

std::vector<Sample> samples_of(const Cycle& cycle, const CycleValue& use,
                               const std::vector<Sample>& highest,
                               const std::vector<Sample>& lowest) {
  std::vector<Sample> samples;
  add_samples(highest, cycle.row(), 0.5 * use.by_amplitude, 0.5 * use.by_mean, samples);
  add_samples(lowest, cycle.row(), -0.5 * use.by_amplitude, 0.5 * use.by_mean, samples);
  return samples;
}

std::vector<Sample> samples_of(const Cycle& cycle) {
  return samples_of(cycle, cycle.use, cycle.highest.samples, cycle.lowest.samples);
}

class CycleSearch {
 public:
  CycleSearch(FatigueCriterion criterion, const Eigen::VectorXd& time,
              const Eigen::MatrixXd& values, const StepRange& range, const BrokenInstants& breaks)
      : criterion_(criterion), time_(time), values_(values), range_(range), breaks_(breaks) {}

  Reduction run() const {
    const std::vector<Cycle> cycles = near_the_largest();
    const auto best = std::ranges::max_element(
        cycles, [](const Cycle& a, const Cycle& b) { return a.use.value < b.use.value; });
    Reduction reduction;
    reduction.value = best->use.value;
    reduction.samples = samples_of(*best);
    if (reduction.value <= 0.0) return reduction;
    add_other_points(cycles, *best, reduction.ties);
    add_other_instants(*best, reduction.ties);
    add_zero_mean(*best, reduction.ties);
    keep_closest(reduction.ties);
    return reduction;
  }

 private:
  /// By samples alone.
  double rough_use(Eigen::Index point) const {
    const auto of_row = [&](Eigen::Index row) {
      return values_.row(row).segment(range_.first, range_.steps());
    };
    const auto stress = of_row(2 * point), over_mean = of_row(2 * point + 1);
    const double amplitude = 0.5 * (stress.maxCoeff() - stress.minCoeff());
    return cycle_use(criterion_, amplitude, 0.5 * (over_mean.maxCoeff() + over_mean.minCoeff()))
        .value;
  }

  Cycle cycle_of(int point) const {
    const Eigen::MatrixXd stress = values_.row(2 * point);
    Cycle cycle{point, reduce(OverTime::max, time_, stress, range_, breaks_),
                reduce(OverTime::min, time_, stress, range_, breaks_)};
    cycle.mean = 0.5 * (in_row(cycle.row() + 1, cycle.highest.samples, values_) +
                        in_row(cycle.row() + 1, cycle.lowest.samples, values_));
    cycle.use = cycle_use(criterion_, 0.5 * (cycle.highest.value - cycle.lowest.value), cycle.mean);
    return cycle;
  }

  std::vector<Cycle> near_the_largest() const {
    std::vector<double> rough;
    for (Eigen::Index point = 0; 2 * point < values_.rows(); ++point) {
      rough.push_back(rough_use(point));
    }
    const double largest = *std::ranges::max_element(rough);
    std::vector<Cycle> cycles;
    for (std::size_t i = 0; i < rough.size(); ++i) {
      if (rough[i] >= out_of_reach * largest) cycles.push_back(cycle_of(static_cast<int>(i)));
    }
    return cycles;
  }

  double time_of(const std::vector<Sample>& samples) const {
    const auto main = std::ranges::max_element(
        samples, [](const Sample& a, const Sample& b) { return a.weight < b.weight; });
    return time_(main->step);
  }

  void add(const Cycle& best, const Cycle& other, double other_time, double gap,
           std::vector<Sample> samples, std::vector<PeakTie>& ties) const {
    if (gap > cycle_tie_gap) return;
    ties.push_back({time_of(best.highest.samples), other_time, best.row(), other.row(), gap,
                    std::move(samples)});
  }

  void add_other_points(const std::vector<Cycle>& cycles, const Cycle& best,
                        std::vector<PeakTie>& ties) const {
    for (const Cycle& other : cycles) {
      if (other.point == best.point) continue;
      add(best, other, time_of(other.highest.samples), 1.0 - other.use.value / best.use.value,
          samples_of(other), ties);
    }
  }

  /// Of ties of a maximum or a minimum, gaps are shares of it.
  void add_other_instants(const Cycle& best, std::vector<PeakTie>& ties) const {
    const double share = 0.5 * best.use.by_amplitude / best.use.value;
    for (const PeakTie& tie : best.highest.ties) {
      add(best, best, tie.other_time, tie.gap * share * std::abs(best.highest.value),
          samples_of(best, best.use, tie.other_samples, best.lowest.samples), ties);
    }
    for (const PeakTie& tie : best.lowest.ties) {
      add(best, best, tie.other_time, tie.gap * share * std::abs(best.lowest.value),
          samples_of(best, best.use, best.highest.samples, tie.other_samples), ties);
    }
  }

  /// What the other side of zero mean says.
  void add_zero_mean(const Cycle& best, std::vector<PeakTie>& ties) const {
    if (criterion_ == FatigueCriterion::gerber) return;
    CycleValue other = best.use;
    other.by_mean = best.mean > 0.0 ? 0.0 : 1.0;
    add(best, best, time_of(best.lowest.samples), std::abs(best.mean) / best.use.value,
        samples_of(best, other, best.highest.samples, best.lowest.samples), ties);
  }

  FatigueCriterion criterion_;
  const Eigen::VectorXd& time_;
  const Eigen::MatrixXd& values_;
  StepRange range_;
  const BrokenInstants& breaks_;
};

/// A maximum or minimum of a history: Σ weight · sample.
using TurningPoint = std::vector<Sample>;

/// 2 σ̂^k, σ̂ = a/(1 − m), of Gerber a/(1 − m²): a = σ_a/σ_f', m = σ_m/S.
CycleValue cycle_damage(FatigueCriterion criterion, double exponent, double amplitude,
                        double mean) {
  const bool is_gerber = criterion == FatigueCriterion::gerber;
  const double m = std::max(mean, 0.0), room = is_gerber ? 1.0 - m * m : 1.0 - m;
  if (room <= 0.0) return {std::numeric_limits<double>::infinity()};
  if (amplitude <= 0.0) return {};
  const double full = amplitude / room, value = 2.0 * std::pow(full, exponent);
  const double slope = exponent * value / full;  // by σ̂
  return {value, slope / room,
          mean > 0.0 ? slope * full / room * (is_gerber ? 2.0 * m : 1.0) : 0.0};
}

class PointDamage {
 public:
  PointDamage(FatigueCriterion criterion, double exponent, const Eigen::VectorXd& time,
              const Eigen::MatrixXd& values, const StepRange& range, const BrokenInstants& breaks,
              RangeEnds ends)
      : criterion_(criterion),
        exponent_(exponent),
        time_(time),
        values_(values),
        range_(range),
        breaks_(breaks),
        repeats_(ends == RangeEnds::repeating) {}

  /// Of the point whose rows begin at `row`.
  Reduction of(int row) const {
    std::vector<TurningPoint> turning = repeats_ ? extremes(row) : turning_points(row);
    if (repeats_) begin_at_largest(row, turning);
    std::vector<double> heights;
    for (const TurningPoint& point : turning) heights.push_back(in_row(row, point, values_));
    Reduction damage;
    for (const CountedCycle& cycle : count_rainflow(heights)) {
      add(cycle, turning, row, damage);
    }
    return damage;
  }

 private:
  bool is_broken(int step) const {
    if (breaks_.empty()) return false;
    const auto broken = [&](int at) { return breaks_[at]; };
    return broken(step) || broken(before(step)) || broken(after(step));
  }

  /// Steps beside a step; of a range that repeats itself the last one is the first.
  int before(int step) const {
    return repeats_ && step == range_.first ? range_.last - 1 : step - 1;
  }
  int after(int step) const {
    return repeats_ && step + 1 == range_.last ? range_.first : step + 1;
  }

  /// First and last sample, and what lies between.
  std::vector<TurningPoint> turning_points(int row) const {
    std::vector<TurningPoint> turning = {{{range_.first, row, 1.0}}};
    for (TurningPoint& point : extremes(row)) turning.push_back(std::move(point));
    turning.push_back({{range_.last, row, 1.0}});
    return turning;
  }

  /// Where the history turns: by the parabola through three samples.
  std::vector<TurningPoint> extremes(int row) const {
    std::vector<TurningPoint> turning;
    double way = repeats_ ? last_way(row) : 0.0;  // of the last step that was none
    for (int step = range_.first + 1; step <= range_.last; ++step) {
      const double change = values_(row, step) - values_(row, step - 1);
      if (change == 0.0) continue;
      if (change * way < 0.0) turning.push_back(extreme(row, step - 1));
      way = change;
    }
    return turning;
  }

  double last_way(int row) const {
    for (int step = range_.last; step > range_.first; --step) {
      const double change = values_(row, step) - values_(row, step - 1);
      if (change != 0.0) return change;
    }
    return 0.0;
  }

  /// Near a step; where a stretch is level, its last sample.
  TurningPoint extreme(int row, int step) const {
    const std::array<int, 3> steps = {before(step), step, after(step)};
    const double value = values_(row, step), previous = values_(row, steps[0]);
    if (value == previous || is_broken(step) || jumps_beside(time_, values_, row, step)) {
      return {{step, row, 1.0}};
    }
    const double turn = time_(range_.last) - time_(range_.first);
    const Eigen::Vector3d times(time_(steps[0]) - (steps[0] > step ? turn : 0.0), time_(step),
                                time_(steps[2]) + (steps[2] < step ? turn : 0.0));
    const Eigen::RowVector3d three(previous, value, values_(row, steps[2]));
    const Reduction vertex = reduce(value > previous ? OverTime::max : OverTime::min, times, three);
    TurningPoint point = vertex.samples;
    for (Sample& sample : point) sample.step = steps[sample.step];
    return point;
  }

  void begin_at_largest(int row, std::vector<TurningPoint>& turning) const {
    const auto largest = std::ranges::max_element(turning, [&](const auto& one, const auto& other) {
      return in_row(row, one, values_) < in_row(row, other, values_);
    });
    if (largest == turning.end()) return;
    std::rotate(turning.begin(), largest, turning.end());
    turning.push_back(turning.front());
  }

  void add(const CountedCycle& cycle, const std::vector<TurningPoint>& turning, int row,
           Reduction& damage) const {
    const TurningPoint &from = turning[cycle.from], &to = turning[cycle.to];
    const double change = in_row(row, to, values_) - in_row(row, from, values_);
    const double mean = 0.5 * (in_row(row + 1, to, values_) + in_row(row + 1, from, values_));
    const CycleValue one = cycle_damage(criterion_, exponent_, 0.5 * std::abs(change), mean);
    if (one.value == 0.0) return;
    damage.value += cycle.count * one.value;
    const double of_change = 0.5 * cycle.count * one.by_amplitude * (change < 0.0 ? -1.0 : 1.0);
    const double of_mean = 0.5 * cycle.count * one.by_mean;
    add_samples(from, row, -of_change, of_mean, damage.samples);
    add_samples(to, row, of_change, of_mean, damage.samples);
  }

  FatigueCriterion criterion_;
  double exponent_;
  const Eigen::VectorXd& time_;
  const Eigen::MatrixXd& values_;
  StepRange range_;
  const BrokenInstants& breaks_;
  bool repeats_;
};

/// One sample a step and channel, those that count most first.
void gather(std::vector<Sample>& samples) {
  const auto before = [](const Sample& a, const Sample& b) {
    return std::pair(a.step, a.channel) < std::pair(b.step, b.channel);
  };
  std::ranges::sort(samples, before);
  std::vector<Sample> sums;
  for (const Sample& sample : samples) {
    const bool is_new = sums.empty() || before(sums.back(), sample);
    if (is_new) {
      sums.push_back(sample);
    } else {
      sums.back().weight += sample.weight;
    }
  }
  // The history that is shown is that of the first sample's channel: the even one of both.
  const auto even =
      std::ranges::find_if(sums, [](const Sample& sample) { return sample.channel % 2 == 0; });
  if (even != sums.end()) std::iter_swap(sums.begin(), even);
  samples = std::move(sums);
}

}  // namespace

CycleValue cycle_use(FatigueCriterion criterion, double amplitude, double mean) {
  if (mean <= 0.0) return {amplitude, 1.0, 0.0};
  if (criterion != FatigueCriterion::gerber) return {amplitude + mean, 1.0, 1.0};
  const double root = std::hypot(amplitude, 2.0 * mean), use = 0.5 * (amplitude + root);
  return {use, use / root, 2.0 * mean / root};
}

Reduction reduce_cycle(FatigueCriterion criterion, const Eigen::VectorXd& time,
                       const Eigen::MatrixXd& values, const StepRange& range,
                       const BrokenInstants& breaks) {
  return CycleSearch(criterion, time, values, range, breaks).run();
}

Reduction reduce_damage(FatigueCriterion criterion, double exponent, const Eigen::VectorXd& time,
                        const Eigen::MatrixXd& values, const StepRange& range,
                        const BrokenInstants& breaks, RangeEnds ends) {
  const PointDamage damage(criterion, exponent, time, values, range, breaks, ends);
  std::vector<Reduction> points;
  for (int row = 0; row < values.rows(); row += 2) points.push_back(damage.of(row));
  const auto worst = std::ranges::max_element(
      points, [](const Reduction& a, const Reduction& b) { return a.value < b.value; });
  Reduction reduction{worst->value, worst->samples, {}};
  gather(reduction.samples);
  for (auto other = points.begin(); other != points.end(); ++other) {
    const double gap = 1.0 - other->value / worst->value;
    if (other == worst || !(gap <= cycle_tie_gap)) continue;
    const double end = time(range.last);
    gather(other->samples);
    reduction.ties.push_back({end, end, 2 * static_cast<int>(worst - points.begin()),
                              2 * static_cast<int>(other - points.begin()), gap, other->samples});
  }
  keep_closest(reduction.ties);
  return reduction;
}

RangeEnds ends_of(const StepRange& range, const Trajectory& trajectory) {
  constexpr double round_off = 1e-9;
  if (!trajectory.periodic) return RangeEnds::cut;
  const double duration = trajectory.time(range.last) - trajectory.time(range.first);
  const double turns = duration / trajectory.periodic->period, whole = std::round(turns);
  const bool is_whole = whole >= 1.0 && std::abs(turns - whole) <= round_off * whole;
  return is_whole ? RangeEnds::repeating : RangeEnds::cut;
}

std::vector<CountedCycle> count_rainflow(const std::vector<double>& turning) {
  std::vector<CountedCycle> cycles;
  std::vector<std::size_t> open;  // turning points that are not counted yet
  const auto range = [&](std::size_t from, std::size_t to) {
    return std::abs(turning[open[to]] - turning[open[from]]);
  };
  for (std::size_t next = 0; next < turning.size(); ++next) {
    open.push_back(next);
    while (open.size() >= 3) {
      const std::size_t last = open.size() - 1;
      if (range(last - 1, last) < range(last - 2, last - 1)) break;
      const bool holds_the_start = last == 2;
      cycles.push_back({open[last - 2], open[last - 1], holds_the_start ? 0.5 : 1.0});
      // Of the range that holds the start its first point goes, else both of its points do.
      if (holds_the_start) {
        open.erase(open.begin());
      } else {
        open.erase(open.end() - 3, open.end() - 1);
      }
    }
  }
  for (std::size_t i = 1; i < open.size(); ++i) cycles.push_back({open[i - 1], open[i], 0.5});
  return cycles;
}

}  // namespace pleuel
