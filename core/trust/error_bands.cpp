#include "core/trust/error_bands.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/response/shown_history.hpp"

namespace pleuel {

namespace {

/// Orders from here on say what is left.
constexpr double least_order = 0.7;
/// The bound at an instant is the largest within so many instants of twice the step.
constexpr Eigen::Index reach = 2;

struct Curve {
  Eigen::VectorXd time, values;
};

/// Straight between the instants.
double value_at(const Curve& curve, double time) {
  const double* begin = curve.time.data();
  const double* end = begin + curve.time.size();
  const Eigen::Index next = std::clamp<Eigen::Index>(std::lower_bound(begin, end, time) - begin, 1,
                                                     curve.time.size() - 1);
  const double before = curve.time(next - 1);
  const double share = std::clamp((time - before) / (curve.time(next) - before), 0.0, 1.0);
  return (1.0 - share) * curve.values(next - 1) + share * curve.values(next);
}

/// |fine − coarse| at the instants of the coarse one.
Curve difference(const Curve& fine, const Curve& coarse) {
  Curve curve = coarse;
  for (Eigen::Index i = 0; i < curve.time.size(); ++i) {
    curve.values(i) = std::abs(value_at(fine, coarse.time(i)) - coarse.values(i));
  }
  return curve;
}

double root_mean_square(const Curve& curve) {
  return std::sqrt(curve.values.squaredNorm() / static_cast<double>(curve.values.size()));
}

/// The order that the histories show as wholes, up to the promised one.
double observed_order(const Curve& of_twice, const Curve& of_four, double promised) {
  const double now = root_mean_square(of_twice), before = root_mean_square(of_four);
  return now > 0.0 && before > 0.0 ? std::min(std::log2(before / now), promised) : 0.0;
}

Curve curve_of(const Response& response, const RefinedRun& run, std::size_t index) {
  return {run.time, shown_history(response, run.histories[index])};
}

bool is_there(const RefinedRun* run) {
  return run != nullptr && !run->has_failed();
}

class WidthsInTime {
 public:
  explicit WidthsInTime(const Eigen::VectorXd& time)
      : time_(time), half_width_(Eigen::VectorXd::Zero(time.size())) {}

  /// Adds `factor` times the largest of a curve near each instant.
  void add(const Curve& curve, double factor) { half_width_ += factor * envelope(curve); }

  /// Adds what is left by steps: of the differences, or of what those of the coarser runs promise
  /// of them where that is more, as where differences are small by accident.
  void add_steps(const Curve& of_twice, const std::optional<Curve>& of_four, double promised) {
    const double order = of_four ? observed_order(of_twice, *of_four, promised) : 0.0;
    Eigen::VectorXd difference = envelope(of_twice);
    if (order < least_order) {
      half_width_ += safety::of_seen * difference;
      return;
    }
    const double growth = std::pow(2.0, order);
    difference = difference.cwiseMax(envelope(*of_four) / growth);
    half_width_ += safety::of_seen / (growth - 1.0) * difference;
  }

  void add(const Comparison& comparison, const Response& response, std::size_t index,
           double factor) {
    if (!is_there(comparison.run) || !is_there(comparison.beside)) return;
    add(difference(curve_of(response, *comparison.run, index),
                   curve_of(response, *comparison.beside, index)),
        factor);
  }

  Eigen::VectorXd half_width() && { return std::move(half_width_); }

 private:
  Eigen::VectorXd envelope(const Curve& curve) const {
    const double* begin = curve.time.data();
    const double* end = begin + curve.time.size();
    Eigen::VectorXd largest(time_.size());
    for (Eigen::Index i = 0; i < time_.size(); ++i) {
      const Eigen::Index at = std::lower_bound(begin, end, time_(i)) - begin;
      const Eigen::Index first = std::max<Eigen::Index>(at - reach, 0);
      const Eigen::Index last = std::min(at + reach, curve.time.size() - 1);
      largest(i) = curve.values.segment(first, last - first + 1).maxCoeff();
    }
    return largest;
  }

  const Eigen::VectorXd& time_;
  Eigen::VectorXd half_width_;
};

}  // namespace

std::vector<Eigen::VectorXd> error_bands(const Analysis& analysis, const JudgingRuns& runs,
                                         double order) {
  std::vector<Eigen::VectorXd> bands(analysis.responses.size());
  if (!is_there(runs.twice_step)) return bands;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const Response& response = analysis.responses[i];
    if (analysis.histories[i].size() == 0) continue;
    const Curve now{analysis.trajectory.time, shown_history(response, analysis.histories[i])};
    const Curve twice = curve_of(response, *runs.twice_step, i);
    const Curve of_twice = difference(now, twice);
    std::optional<Curve> of_four;
    if (is_there(runs.four_steps)) {
      of_four = difference(twice, curve_of(response, *runs.four_steps, i));
    }
    WidthsInTime band(now.time);
    band.add_steps(of_twice, of_four, order);
    band.add(runs.more_elements, response, i, safety::of_more);
    if (!is_there(runs.more_elements.run)) {
      band.add(runs.fewer_elements, response, i, safety::of_fewer);
    }
    band.add(runs.modes, response, i, safety::of_modes);
    band.add(runs.newton, response, i, safety::of_newton);
    bands[i] = std::move(band).half_width();
  }
  return bands;
}

}  // namespace pleuel
