#include "core/trust/missed_values.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/eager_matrices.hpp"
#include "core/base/number_text.hpp"

namespace pleuel {

namespace {

/// Samples of each step, at distances that are in step with no period.
constexpr int samples = 5;
constexpr double golden_ratio = 0.6180339887498949;
/// A jump at an instant belongs to neither side [steps].
constexpr double beside = 1e-6;

ObservedValues between(const ObservedValues& begin, const ObservedValues& end, double share) {
  return {begin[0] + share * (end[0] - begin[0]), begin[1] + share * (end[1] - begin[1])};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double distance(const ObservedValues& one, const ObservedValues& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1]);
}

}  // namespace

MissedValues missed_by(const Eigen::VectorXd& time, const ObservedFunction& value,
                       const std::vector<double>& knots) {
  const ObservedValues origin = {0.0, 0.0};
  MissedValues missed;
  std::vector<double> of_steps(time.size() - 1, 0.0), of_halves = of_steps;
  double place = 0.0;
  auto knot = knots.begin();
  for (Eigen::Index i = 0; i + 1 < time.size(); ++i) {
    const double h = time(i + 1) - time(i);
    const ObservedValues begin = value(time(i) + beside * h), middle = value(time(i) + 0.5 * h),
                         end = value(time(i + 1) - beside * h);
    missed.scale = std::max({missed.scale, distance(begin, origin), distance(end, origin)});
    const auto look = [&](double at) {
      const ObservedValues here = value(time(i) + (beside + (1.0 - 2.0 * beside) * at) * h);
      missed.scale = std::max(missed.scale, distance(here, origin));
      const double away = distance(here, between(begin, end, at));
      const ObservedValues of_half =
          at < 0.5 ? between(begin, middle, 2.0 * at) : between(middle, end, 2.0 * at - 1.0);
      of_halves[i] = std::max(of_halves[i], distance(here, of_half));
      of_steps[i] = std::max(of_steps[i], away);
      if (away <= missed.largest) return;
      missed.largest = away;
      missed.time = time(i) + at * h;
      missed.step = h;
    };
    for (int k = 0; k < samples; ++k) {
      place = std::fmod(place + golden_ratio, 1.0);
      look(place);
    }
    for (; knot != knots.end() && *knot < time(i + 1); ++knot) {
      if (*knot > time(i)) look((*knot - time(i)) / h);
    }
  }
  missed.median = median(std::move(of_steps));
  missed.median_of_halves = median(std::move(of_halves));
  return missed;
}

void add_missed(const MissedSubject& subject, const MissedValues& missed, double scale,
                std::vector<Finding>& findings) {
  if (!(missed.largest > subject.most * scale)) return;
  findings.push_back(
      {fmt::format("{} changes faster than the steps can follow: within the step of {:.3g} s at "
                   "t = {:.4g} s its {} is {} of the largest away from what the steps see. "
                   "Give an oscillation 22 steps or more, a revolution 32: a smaller "
                   "/simulation/step.",
                   subject.who, missed.step, missed.time, subject.what,
                   rough_percent(missed.largest / scale)),
       true});
}

}  // namespace pleuel
