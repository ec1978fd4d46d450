#include "core/base/value_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pleuel {

namespace {

double inner_slope(double before, double after) {
  if (before * after <= 0.0) return 0.0;
  return 2.0 * before * after / (before + after);
}

/// @param chord  beside the end, @param next  the one behind it
double end_slope(double chord, double next) {
  const double slope = 0.5 * (3.0 * chord - next);
  if (slope * chord <= 0.0) return 0.0;
  const bool turns = chord * next <= 0.0;
  return turns && std::abs(slope) > 3.0 * std::abs(chord) ? 3.0 * chord : slope;
}

double slope_at(const std::vector<double>& values, std::size_t i) {
  const std::size_t last = values.size() - 1;
  const auto chord = [&](std::size_t k) { return values[k + 1] - values[k]; };
  if (last == 1) return chord(0);
  if (i == 0) return end_slope(chord(0), chord(1));
  if (i == last) return end_slope(chord(last - 1), chord(last - 2));
  return inner_slope(chord(i - 1), chord(i));
}

}  // namespace

PathPoint path_point(const std::vector<double>& values, double at) {
  const std::size_t last = values.size() - 1;
  if (last == 0) return {values.front(), 0.0};
  const auto end = static_cast<double>(last);
  if (!(at >= 0.0 && at <= end)) {
    const std::size_t nearest = at < 0.0 ? 0 : last;
    const double slope = slope_at(values, nearest);
    return {values[nearest] + slope * (at - (at < 0.0 ? 0.0 : end)), slope};
  }
  const std::size_t i = std::min(static_cast<std::size_t>(at), last - 1);
  const double s = at - static_cast<double>(i);
  if (s == 0.0) return {values[i], slope_at(values, i)};
  if (s == 1.0) return {values[i + 1], slope_at(values, i + 1)};
  const double rise = values[i + 1] - values[i];
  const double before = slope_at(values, i), after = slope_at(values, i + 1);
  const double c2 = 3.0 * rise - 2.0 * before - after, c3 = before + after - 2.0 * rise;
  return {values[i] + s * (before + s * (c2 + s * c3)), before + s * (2.0 * c2 + 3.0 * s * c3)};
}

}  // namespace pleuel
