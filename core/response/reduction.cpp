#include "core/response/reduction.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pleuel {

namespace {

/// Peaks within this relative distance of the highest are called tied.
constexpr double tie_gap = 1e-3;
/// So many ties are remembered.
constexpr std::size_t max_ties = 8;

struct Peak {
  double height, time;
  int channel, step;
  double sign;
  std::array<double, 3> weights;  ///< of the samples before, at and after `step`
};

/// Vertex of the parabola through (−1, a), (0, b), (1, c), b ≥ a, c. By the envelope theorem the
/// derivative of the height is the Lagrange polynomials at the vertex.
Peak interpolate(double a, double b, double c) {
  const double curvature = a - 2 * b + c;
  const double s = curvature < 0.0 ? 0.5 * (a - c) / curvature : 0.0;
  Peak peak{};
  peak.weights = {0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)};
  peak.height = peak.weights[0] * a + peak.weights[1] * b + peak.weights[2] * c;
  peak.time = s;
  return peak;
}

/// Steps first … last of a history.
struct Range {
  int first, last;
};

/// All local maxima of sign · y in a range that can reach the highest sample.
void add_peaks(const Eigen::VectorXd& time, const Eigen::MatrixXd& values, const Range& range,
               double sign, double threshold, std::vector<Peak>& peaks) {
  const auto last = static_cast<int>(values.cols()) - 1;
  const double h = last > 0 ? time(1) - time(0) : 0.0;
  for (int step = range.first; step <= range.last; ++step) {
    for (int channel = 0; channel < values.rows(); ++channel) {
      const double b = sign * values(channel, step);
      if (b < threshold) continue;
      const double a = step > 0 ? sign * values(channel, step - 1) : b;
      const double c = step < last ? sign * values(channel, step + 1) : b;
      if (b < a || b <= c) {
        if (!(step == last && b >= a)) continue;
      }
      Peak peak{b, 0.0, channel, step, sign, {0.0, 1.0, 0.0}};
      if (step > 0 && step < last) {
        const Peak vertex = interpolate(a, b, c);
        peak.height = vertex.height;
        peak.time = vertex.time;
        peak.weights = vertex.weights;
      }
      peak.time = time(step) + h * peak.time;
      peaks.push_back(peak);
    }
  }
}

std::vector<Sample> samples_of(const Peak& peak) {
  std::vector<Sample> samples;
  for (int i = 0; i < 3; ++i) {
    const double weight = peak.sign * peak.weights[static_cast<std::size_t>(i)];
    if (weight != 0.0) samples.push_back({peak.step + i - 1, peak.channel, weight});
  }
  return samples;
}

void note_ties(const std::vector<Peak>& peaks, const Peak& best, Reduction& reduction) {
  for (const Peak& peak : peaks) {
    const bool is_other = peak.channel != best.channel || std::abs(peak.step - best.step) > 1;
    const double gap = (best.height - peak.height) / std::abs(best.height);
    if (!is_other || !(gap <= tie_gap)) continue;
    reduction.ties.push_back(
        {best.time, peak.time, best.channel, peak.channel, gap, samples_of(peak)});
  }
  std::sort(reduction.ties.begin(), reduction.ties.end(),
            [](const PeakTie& a, const PeakTie& b) { return a.gap < b.gap; });
  if (reduction.ties.size() > max_ties) reduction.ties.resize(max_ties);
  if (!reduction.ties.empty()) reduction.tie = reduction.ties.front();
}

/// The highest sample of a range, where no local maximum lies in it.
Reduction highest_sample(const Eigen::MatrixXd& values, const Range& range,
                         const std::vector<double>& signs) {
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

Reduction reduce_peaks(const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                       const Range& range, const std::vector<double>& signs) {
  Reduction reduction = highest_sample(values, range, signs);
  const double threshold = reduction.value - 0.05 * std::abs(reduction.value);
  std::vector<Peak> peaks;
  for (double sign : signs) add_peaks(time, values, range, sign, threshold, peaks);
  const auto best = std::max_element(
      peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.height < b.height; });
  // At the edge of a window the highest sample may not be a peak.
  if (best == peaks.end() || best->height < reduction.value) return reduction;
  reduction.value = best->height;
  reduction.samples = samples_of(*best);
  note_ties(peaks, *best, reduction);
  return reduction;
}

/// The peak in a range: max, min or max-abs.
Reduction reduce_range(OverTime kind, const Eigen::VectorXd& time, const Eigen::MatrixXd& values,
                       const Range& range) {
  if (kind == OverTime::max) return reduce_peaks(time, values, range, {1.0});
  if (kind == OverTime::max_abs) return reduce_peaks(time, values, range, {1.0, -1.0});
  Reduction reduction = reduce_peaks(time, values, range, {-1.0});
  reduction.value = -reduction.value;
  const auto negate = [](std::vector<Sample>& samples) {
    for (Sample& sample : samples) sample.weight = -sample.weight;
  };
  negate(reduction.samples);
  for (PeakTie& tie : reduction.ties) negate(tie.other_samples);
  if (reduction.tie) negate(reduction.tie->other_samples);
  return reduction;
}

/// Trapezoidal weights [s].
Eigen::VectorXd quadrature(const Eigen::VectorXd& time) {
  const auto n = time.size();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const double half = 0.5 * (time(i + 1) - time(i));
    weights(i) += half;
    weights(i + 1) += half;
  }
  return weights;
}

Reduction reduce_linear(const Eigen::VectorXd& weights, const Eigen::MatrixXd& values) {
  assert(values.rows() == 1);
  Reduction reduction;
  reduction.value = values.row(0) * weights;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (weights(i) != 0.0) reduction.samples.push_back({static_cast<int>(i), 0, weights(i)});
  }
  return reduction;
}

Reduction reduce_rms(const Eigen::VectorXd& time, const Eigen::MatrixXd& values) {
  const Eigen::VectorXd weights = quadrature(time) / (time(time.size() - 1) - time(0));
  Eigen::Index channel = 0;
  const double square = (values.cwiseAbs2() * weights).maxCoeff(&channel);
  Reduction reduction;
  reduction.value = std::sqrt(square);
  if (reduction.value == 0.0) return reduction;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    reduction.samples.push_back({static_cast<int>(i), static_cast<int>(channel),
                                 weights(i) * values(channel, i) / reduction.value});
  }
  return reduction;
}

}  // namespace

bool is_peak(OverTime kind) {
  return kind == OverTime::max || kind == OverTime::min || kind == OverTime::max_abs;
}

Reduction reduce(OverTime kind, const Eigen::VectorXd& time, const Eigen::MatrixXd& values) {
  const Eigen::Index last = time.size() - 1;
  if (is_peak(kind)) return reduce_range(kind, time, values, {0, static_cast<int>(last)});
  switch (kind) {
    case OverTime::rms:
      return reduce_rms(time, values);
    case OverTime::mean:
      return reduce_linear(quadrature(time) / (time(last) - time(0)), values);
    case OverTime::integral:
      return reduce_linear(quadrature(time), values);
    default:
      return reduce_linear(Eigen::VectorXd::Unit(time.size(), last), values);
  }
}

std::vector<Reduction> reduce_windows(OverTime kind, const Eigen::VectorXd& time,
                                      const Eigen::MatrixXd& values, int windows) {
  assert(is_peak(kind));
  const auto steps = static_cast<int>(time.size());
  const int count = std::min(windows, steps);
  std::vector<Reduction> reductions;
  for (int i = 0; i < count; ++i) {
    const int first = static_cast<int>(std::int64_t{steps} * i / count);
    const int last = static_cast<int>(std::int64_t{steps} * (i + 1) / count) - 1;
    reductions.push_back(reduce_range(kind, time, values, {first, last}));
  }
  return reductions;
}

}  // namespace pleuel
