#include "core/response/reduction.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"
#include "core/response/history_jump.hpp"
#include "core/response/reduced_value.hpp"

namespace pleuel {

namespace {

/// Limits from within at the ends of a range that lie on a jump, as a window that begins when a
/// load is let go: the sample there is the mean of both sides. Along the straight line through the
/// two samples within, of those channels that jump.
class LimitsAtEnds {
 public:
  /// @param values  channels × instants
  /// @param breaks  where channels may jump
  LimitsAtEnds(const Eigen::MatrixXd& values, const StepRange& range, const BrokenInstants& breaks);

  bool is_empty() const { return limits_.empty(); }
  /// The values with the limits in place.
  Eigen::MatrixXd applied() const;
  /// Samples of limits become those that they are made from.
  void restore(Reduction& reduction) const;

 private:
  struct Limit {
    int step, within, channel;  ///< within: ±1
  };
  void look_at(int step, int within, const StepRange& range, const BrokenInstants& breaks);
  void restore(std::vector<Sample>& samples) const;

  const Eigen::MatrixXd& values_;
  std::vector<Limit> limits_;
};

/// A jump is so many times what the steps beside it change, and the sample is so much of it from
/// both sides at least.
constexpr double steep = 8.0, inside = 0.25;

LimitsAtEnds::LimitsAtEnds(const Eigen::MatrixXd& values, const StepRange& range,
                           const BrokenInstants& breaks)
    : values_(values) {
  if (breaks.empty()) return;
  look_at(range.first, 1, range, breaks);
  look_at(range.last, -1, range, breaks);
}

void LimitsAtEnds::look_at(int step, int within, const StepRange& range,
                           const BrokenInstants& breaks) {
  const auto last = static_cast<int>(values_.cols()) - 1;
  if (!breaks[step] || step < 2 || step > last - 2 || range.steps() < 4) return;
  for (int channel = 0; channel < static_cast<int>(values_.rows()); ++channel) {
    const auto y = [&](int offset) { return values_(channel, step + offset); };
    const double jump = y(1) - y(-1);
    const double beside = std::max(std::abs(y(-1) - y(-2)), std::abs(y(2) - y(1)));
    const double share = (y(0) - y(-1)) / jump;
    if (!(std::abs(jump) > steep * beside) || share < inside || share > 1.0 - inside) continue;
    limits_.push_back({step, within, channel});
  }
}

Eigen::MatrixXd LimitsAtEnds::applied() const {
  Eigen::MatrixXd values = values_;
  for (const auto& [step, within, channel] : limits_) {
    values(channel, step) =
        2.0 * values_(channel, step + within) - values_(channel, step + 2 * within);
  }
  return values;
}

void LimitsAtEnds::restore(Reduction& reduction) const {
  restore(reduction.samples);
  for (PeakTie& tie : reduction.ties) restore(tie.other_samples);
}

void LimitsAtEnds::restore(std::vector<Sample>& samples) const {
  for (const Limit& limit : limits_) {
    const auto found = std::ranges::find_if(samples, [&](const Sample& sample) {
      return sample.step == limit.step && sample.channel == limit.channel;
    });
    if (found == samples.end()) continue;
    const double weight = found->weight;
    *found = {limit.step + limit.within, limit.channel, 2.0 * weight};
    samples.push_back({limit.step + 2 * limit.within, limit.channel, -weight});
  }
}

/// Peaks within this relative distance of the highest are called tied.
constexpr double tie_gap = 1e-3;
/// So many ties are remembered.
constexpr std::size_t max_ties = 16;
/// Chosen from so many candidates: noise about a constant has a peak at every other step.
constexpr std::size_t max_candidates = 2000;

struct Peak {
  double height, time;
  int channel, step;
  double sign;
  std::array<double, 3> weights;  ///< of the samples before, at and after `step`
  double bend;                    ///< half the second derivative over time, 0 at the ends
};

/// Vertex of the parabola through (−before, a), (0, b), (after, c), b ≥ a, c. By the envelope
/// theorem the derivative of the height is the Lagrange polynomials at the vertex.
Peak interpolate(double a, double b, double c, double before, double after) {
  const double rise = (b - a) / before, fall = (c - b) / after, width = before + after;
  const double slope = (rise * after + fall * before) / width, bend = (fall - rise) / width;
  const double s = bend < 0.0 ? -0.5 * slope / bend : 0.0;
  Peak peak{};
  peak.weights = {s * (s - after) / (before * width), (s + before) * (after - s) / (before * after),
                  s * (s + before) / (after * width)};
  peak.height = peak.weights[0] * a + peak.weights[1] * b + peak.weights[2] * c;
  peak.time = s;
  peak.bend = bend;
  return peak;
}

/// A history, the steps of it that count, and the stretch of those in which peaks are sought.
struct Search {
  const Eigen::VectorXd& time;
  const Eigen::MatrixXd& values;
  StepRange whole, range;
  const BrokenInstants& breaks;

  /// Whether something breaks at a step or beside it.
  bool is_broken(int step) const {
    if (breaks.empty()) return false;
    return breaks[step] || (step > 0 && breaks[step - 1]) ||
           (step + 1 < std::ssize(breaks) && breaks[step + 1]);
  }
};

/// All local maxima of sign · y in a range that can reach the highest sample. At the edges of the
/// whole they are samples.
void add_peaks(const Search& search, double sign, double threshold, std::vector<Peak>& peaks) {
  const auto& [time, values, whole, range, breaks] = search;
  for (int step = range.first; step <= range.last; ++step) {
    for (int channel = 0; channel < values.rows(); ++channel) {
      const double b = sign * values(channel, step);
      if (b < threshold) continue;
      const double a = step > whole.first ? sign * values(channel, step - 1) : b;
      const double c = step < whole.last ? sign * values(channel, step + 1) : b;
      if (b < a || b <= c) {
        if (!(step == whole.last && b >= a)) continue;
      }
      Peak peak{b, 0.0, channel, step, sign, {0.0, 1.0, 0.0}, 0.0};
      if (step > whole.first && step < whole.last && !search.is_broken(step) &&
          !jumps_beside(time, values, channel, step)) {
        const Peak vertex =
            interpolate(a, b, c, time(step) - time(step - 1), time(step + 1) - time(step));
        peak.height = vertex.height;
        peak.time = vertex.time;
        peak.weights = vertex.weights;
        peak.bend = vertex.bend;
      }
      peak.time += time(step);
      peaks.push_back(peak);
    }
  }
}

std::vector<Sample> samples_of(const Peak& peak) {
  std::vector<Sample> samples;
  for (int i = 0; i < 3; ++i) {
    const double weight = peak.sign * peak.weights[i];
    if (weight != 0.0) samples.push_back({peak.step + i - 1, peak.channel, weight});
  }
  return samples;
}

/// How different two peaks are, without a unit: in all that is observed at their instants, and in
/// their sharpness. Repetitions in a periodic motion are alike but for where the steps hit them.
double difference(const Eigen::MatrixXd& values, const Peak& one, const Peak& other) {
  constexpr double of_channels = 0.1;  // at one instant neighbours move alike, more often than not
  const double height = std::abs(one.height), bend = std::abs(one.bend) + std::abs(other.bend);
  const double state =
      (values.col(one.step) - values.col(other.step)).lpNorm<Eigen::Infinity>() / height;
  const double sharpness = bend > 0.0 ? std::abs(one.bend - other.bend) / bend : 0.0;
  return state + sharpness + (one.channel != other.channel ? of_channels : 0.0);
}

/// The closest tie, then those that differ most from the highest peak and from the ties before: of
/// a periodic motion one of each kind comes first, however many revolutions are simulated.
std::vector<Peak> choose_ties(const Eigen::MatrixXd& values, const Peak& best,
                              const std::vector<Peak>& tied) {
  const auto is_lower = [](const Peak& a, const Peak& b) { return a.height < b.height; };
  std::vector<Peak> chosen;
  std::vector<double> distances(tied.size(), std::numeric_limits<double>::infinity());
  const auto move_away_from = [&](const Peak& peak) {
    for (std::size_t i = 0; i < tied.size(); ++i) {
      distances[i] = std::min(distances[i], difference(values, tied[i], peak));
    }
  };
  const auto choose = [&](std::size_t i) {
    chosen.push_back(tied[i]);
    move_away_from(tied[i]);
    distances[i] = -1.0;
  };
  if (tied.empty()) return chosen;
  move_away_from(best);
  choose(static_cast<std::size_t>(std::ranges::max_element(tied, is_lower) - tied.begin()));
  while (chosen.size() < std::min(max_ties, tied.size())) {
    choose(static_cast<std::size_t>(std::ranges::max_element(distances) - distances.begin()));
  }
  return chosen;
}

/// Every nth, at distances that are in step with no period (multiples of the golden ratio).
std::vector<Peak> thin_out(const std::vector<Peak>& tied) {
  if (tied.size() <= max_candidates) return tied;
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < max_candidates; ++k) {
    const double share = std::fmod(static_cast<double>(k) * 0.6180339887498949, 1.0);
    indices.push_back(static_cast<std::size_t>(share * static_cast<double>(tied.size())));
  }
  std::ranges::sort(indices);
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<Peak> kept;
  for (std::size_t index : indices) kept.push_back(tied[index]);
  return kept;
}

void record_ties(const Search& search, const std::vector<Peak>& peaks, const Peak& best,
                 Reduction& reduction) {
  const auto gap_of = [&](const Peak& peak) {
    return (best.height - peak.height) / std::abs(best.height);
  };
  std::vector<Peak> tied;
  for (const Peak& peak : peaks) {
    const bool is_other = peak.channel != best.channel || std::abs(peak.step - best.step) > 1;
    if (is_other && gap_of(peak) <= tie_gap) tied.push_back(peak);
  }
  for (const Peak& peak : choose_ties(search.values, best, thin_out(tied))) {
    reduction.ties.push_back(
        {best.time, peak.time, best.channel, peak.channel, gap_of(peak), samples_of(peak)});
  }
  std::ranges::sort(reduction.ties,
                    [](const PeakTie& one, const PeakTie& other) { return one.gap < other.gap; });
}

/// The highest sample of a range, where no local maximum lies in it.
Reduction highest_sample(const Search& search, const std::vector<double>& signs) {
  const auto& [time, values, whole, range, breaks] = search;
  Reduction reduction;
  reduction.value = -std::numeric_limits<double>::infinity();
  for (double sign : signs) {
    for (int step = range.first; step <= range.last; ++step) {
      for (int channel = 0; channel < values.rows(); ++channel) {
        const double height = sign * values(channel, step);
        if (height <= reduction.value) continue;
        reduction.value = height;
        reduction.samples = {{step, channel, sign}};
      }
    }
  }
  return reduction;
}

Reduction reduce_peaks(const Search& search, const std::vector<double>& signs) {
  Reduction reduction = highest_sample(search, signs);
  const double threshold = reduction.value - 0.05 * std::abs(reduction.value);
  std::vector<Peak> peaks;
  for (double sign : signs) add_peaks(search, sign, threshold, peaks);
  const auto best = std::ranges::max_element(
      peaks, [](const Peak& a, const Peak& b) { return a.height < b.height; });
  // At the edge of a stretch the highest sample may not be a peak.
  if (best == peaks.end() || best->height < reduction.value) return reduction;
  reduction.value = best->height;
  reduction.samples = samples_of(*best);
  record_ties(search, peaks, *best, reduction);
  return reduction;
}

/// The peak in a stretch: max, min or max-abs.
Reduction reduce_stretch(OverTime kind, const Search& search) {
  if (kind == OverTime::max) return reduce_peaks(search, {1.0});
  if (kind == OverTime::max_abs) return reduce_peaks(search, {1.0, -1.0});
  Reduction reduction = reduce_peaks(search, {-1.0});
  reduction.value = -reduction.value;
  const auto negate = [](std::vector<Sample>& samples) {
    for (Sample& sample : samples) sample.weight = -sample.weight;
  };
  negate(reduction.samples);
  for (PeakTie& tie : reduction.ties) negate(tie.other_samples);
  return reduction;
}

/// Trapezoidal weights of the steps of a range [s], zero for the others.
Eigen::VectorXd quadrature(const Eigen::VectorXd& time, const StepRange& range) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(time.size());
  for (int i = range.first; i < range.last; ++i) {
    const double half = 0.5 * (time(i + 1) - time(i));
    weights(i) += half;
    weights(i + 1) += half;
  }
  return weights;
}

Reduction reduce_linear(const Eigen::VectorXd& weights, const Eigen::MatrixXd& values,
                        AmongChannels among) {
  Reduction reduction;
  Eigen::Index channel = 0;
  const Eigen::VectorXd sums = values * weights;
  if (among == AmongChannels::largest) {
    sums.maxCoeff(&channel);
  } else {
    sums.cwiseAbs().maxCoeff(&channel);
  }
  reduction.value = sums(channel);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (weights(i) == 0.0) continue;
    reduction.samples.push_back({static_cast<int>(i), static_cast<int>(channel), weights(i)});
  }
  return reduction;
}

Reduction reduce_rms(const Eigen::VectorXd& weights, const Eigen::MatrixXd& values) {
  Eigen::Index channel = 0;
  const double square = (values.cwiseAbs2() * weights).maxCoeff(&channel);
  Reduction reduction;
  reduction.value = std::sqrt(square);
  if (reduction.value == 0.0) return reduction;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (weights(i) == 0.0) continue;
    reduction.samples.push_back({static_cast<int>(i), static_cast<int>(channel),
                                 weights(i) * values(channel, i) / reduction.value});
  }
  return reduction;
}

}  // namespace

bool is_peak(OverTime kind) {
  return kind == OverTime::max || kind == OverTime::min || kind == OverTime::max_abs;
}

BrokenInstants instants_at(const std::vector<double>& breaks, const Eigen::VectorXd& time) {
  if (breaks.empty()) return {};
  constexpr double round_off = 1e-9;  // of all time: instants of later periods are sums
  const double span = time(time.size() - 1) - time(0);
  BrokenInstants broken(time.size(), false);
  for (const double at : breaks) {
    const auto found = std::ranges::lower_bound(time, at - round_off * span);
    if (found != time.end() && *found <= at + round_off * span) broken[found - time.begin()] = true;
  }
  return broken;
}

StepRange whole_range(const Eigen::VectorXd& time) {
  return {0, int_size(time) - 1};
}

StepRange steps_between(const Eigen::VectorXd& time, std::optional<double> from,
                        std::optional<double> to) {
  StepRange range = whole_range(time);
  const double round_off = time.size() > 1 ? 1e-6 * (time(1) - time(0)) : 0.0;
  while (from && range.first <= range.last && time(range.first) < *from - round_off) ++range.first;
  while (to && range.last >= range.first && time(range.last) > *to + round_off) --range.last;
  return range;
}

Reduction reduce(OverTime kind, const Eigen::VectorXd& time, const Eigen::MatrixXd& values) {
  return reduce(kind, time, values, whole_range(time));
}

Reduction reduce(OverTime kind, const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                 const StepRange& range, const BrokenInstants& breaks, AmongChannels among) {
  const LimitsAtEnds limits(values, range, breaks);
  if (!limits.is_empty()) {
    Reduction reduction = reduce(kind, time, limits.applied(), range, breaks, among);
    limits.restore(reduction);
    return reduction;
  }
  if (is_peak(kind)) return reduce_stretch(kind, {time, values, range, range, breaks});
  const double duration = time(range.last) - time(range.first);
  switch (kind) {
    case OverTime::rms:
      return reduce_rms(quadrature(time, range) / duration, values);
    case OverTime::mean:
      return reduce_linear(quadrature(time, range) / duration, values, among);
    case OverTime::integral:
      return reduce_linear(quadrature(time, range), values, among);
    default:
      return reduce_linear(Eigen::VectorXd::Unit(time.size(), range.last), values, among);
  }
}

std::vector<Reduction> reduce_windows(OverTime kind, const Eigen::VectorXd& time,
                                      const Eigen::MatrixXd& values, int windows) {
  return reduce_windows(kind, time, values, windows, whole_range(time));
}

std::vector<Reduction> reduce_windows(OverTime kind, const Eigen::VectorXd& time,
                                      const Eigen::MatrixXd& values, int windows,
                                      const StepRange& range, const BrokenInstants& breaks) {
  assert(is_peak(kind));
  const LimitsAtEnds limits(values, range, breaks);
  if (!limits.is_empty()) {
    auto reductions = reduce_windows(kind, time, limits.applied(), windows, range, breaks);
    for (Reduction& reduction : reductions) limits.restore(reduction);
    return reductions;
  }
  std::vector<Reduction> reductions;
  const auto start_of = [&](int window) {
    return range.first + static_cast<int>(std::int64_t{range.steps()} * window / windows);
  };
  for (int i = 0; i < windows; ++i) {
    const int first = start_of(i), last = std::max(first, start_of(i + 1) - 1);
    reductions.push_back(reduce_stretch(kind, {time, values, range, {first, last}, breaks}));
  }
  return reductions;
}

}  // namespace pleuel
