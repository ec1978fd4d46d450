#include "studies/front_scale.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

namespace {

constexpr double least_part = 1e-4;  ///< of the range of a goal: a gain
constexpr double near_zero = 1e-6;   ///< of the accuracy: values below are round-off of 0

GoalScale scale_of(const std::vector<Goals>& front, std::size_t goal) {
  GoalScale scale;
  if (front.empty()) return scale;
  const auto [low, high] = std::minmax_element(
      front.begin(), front.end(),
      [&](const Goals& one, const Goals& other) { return one[goal] < other[goal]; });
  scale.low = (*low)[goal];
  scale.high = (*high)[goal];
  scale.accuracy = optimum_accuracy * std::max(std::abs(scale.low), std::abs(scale.high));
  return scale;
}

}  // namespace

double GoalScale::least_gain() const {
  return std::max(least_part * range(), accuracy);
}

double GoalScale::round_off(double one, double other) const {
  return std::max(equal_numbers * std::max(std::abs(one), std::abs(other)), near_zero * accuracy);
}

FrontScale::FrontScale(const std::vector<Goals>& designs) {
  const std::vector<bool> counts = non_dominated(designs);
  std::vector<Goals> front;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (counts[i]) front.push_back(designs[i]);
  }
  goals_ = {scale_of(front, 0), scale_of(front, 1)};
}

bool FrontScale::dominates(const Goals& one, const Goals& other, Limits limits) const {
  bool is_better = false;
  for (std::size_t i = 0; i < 2; ++i) {
    const double gain = other[i] - one[i];
    const bool is_kept_alike = i == 1 && limits == Limits::same;
    const double allowed =
        is_kept_alike ? goals_[i].least_gain() : goals_[i].round_off(one[i], other[i]);
    if (gain < -allowed) return false;
    is_better = is_better || gain > goals_[i].least_gain();
  }
  return is_better;
}

bool is_no_better(double one, double other) {
  return one >= other - equal_numbers * std::max(std::abs(one), std::abs(other));
}

std::vector<bool> non_dominated(const std::vector<Goals>& goals) {
  std::vector<bool> marks;
  for (const Goals& one : goals) {
    marks.push_back(std::none_of(goals.begin(), goals.end(), [&](const Goals& other) {
      const bool is_nowhere_worse =
          is_no_better(one[0], other[0]) && is_no_better(one[1], other[1]);
      const bool is_somewhere_better =
          !is_no_better(other[0], one[0]) || !is_no_better(other[1], one[1]);
      return is_nowhere_worse && is_somewhere_better;
    }));
  }
  return marks;
}

}  // namespace pleuel
