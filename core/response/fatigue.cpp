#include "core/response/fatigue.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"

namespace pleuel {

namespace {

/// Uses within this relative distance of the largest are called tied.
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
  CycleUse use;

  int row() const { return 2 * point; }
};

/// Σ weight · value in the second row, at the samples of the first one.
double in_second_row(const Reduction& extreme, const Eigen::MatrixXd& values, int row) {
  double sum = 0.0;
  for (const Sample& sample : extreme.samples) sum += sample.weight * values(row, sample.step);
  return sum;
}

/// One extreme's part in amplitude and mean.
void add_samples(const std::vector<Sample>& extreme, int row, double of_amplitude, double of_mean,
                 std::vector<Sample>& samples) {
  for (const Sample& sample : extreme) {
    samples.push_back({sample.step, row, of_amplitude * sample.weight});
    if (of_mean != 0.0) samples.push_back({sample.step, row + 1, of_mean * sample.weight});
  }
}

std::vector<Sample> samples_of(const Cycle& cycle, const CycleUse& use,
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
    const auto best =
        std::max_element(cycles.begin(), cycles.end(),
                         [](const Cycle& a, const Cycle& b) { return a.use.value < b.use.value; });
    Reduction reduction;
    reduction.value = best->use.value;
    reduction.samples = samples_of(*best);
    if (reduction.value <= 0.0) return reduction;
    add_other_points(cycles, *best, reduction.ties);
    add_other_instants(*best, reduction.ties);
    add_zero_mean(*best, reduction.ties);
    std::stable_sort(reduction.ties.begin(), reduction.ties.end(),
                     [](const PeakTie& a, const PeakTie& b) { return a.gap < b.gap; });
    if (reduction.ties.size() > max_cycle_ties) reduction.ties.resize(max_cycle_ties);
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
    Cycle cycle{point,
                reduce(OverTime::max, time_, stress, range_, breaks_),
                reduce(OverTime::min, time_, stress, range_, breaks_),
                {}};
    const double mean = 0.5 * (in_second_row(cycle.highest, values_, cycle.row() + 1) +
                               in_second_row(cycle.lowest, values_, cycle.row() + 1));
    cycle.use = cycle_use(criterion_, 0.5 * (cycle.highest.value - cycle.lowest.value), mean);
    return cycle;
  }

  std::vector<Cycle> near_the_largest() const {
    std::vector<double> rough;
    for (Eigen::Index point = 0; 2 * point < values_.rows(); ++point) {
      rough.push_back(rough_use(point));
    }
    const double largest = *std::max_element(rough.begin(), rough.end());
    std::vector<Cycle> cycles;
    for (std::size_t i = 0; i < rough.size(); ++i) {
      if (rough[i] >= out_of_reach * largest) cycles.push_back(cycle_of(static_cast<int>(i)));
    }
    return cycles;
  }

  double time_of(const std::vector<Sample>& samples) const {
    const auto main =
        std::max_element(samples.begin(), samples.end(),
                         [](const Sample& a, const Sample& b) { return a.weight < b.weight; });
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
    const double mean = 0.5 * (in_second_row(best.highest, values_, best.row() + 1) +
                               in_second_row(best.lowest, values_, best.row() + 1));
    CycleUse other = best.use;
    other.by_mean = mean > 0.0 ? 0.0 : 1.0;
    add(best, best, time_of(best.lowest.samples), std::abs(mean) / best.use.value,
        samples_of(best, other, best.highest.samples, best.lowest.samples), ties);
  }

  FatigueCriterion criterion_;
  const Eigen::VectorXd& time_;
  const Eigen::MatrixXd& values_;
  StepRange range_;
  const BrokenInstants& breaks_;
};

}  // namespace

CycleUse cycle_use(FatigueCriterion criterion, double amplitude, double mean) {
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

}  // namespace pleuel
