#include "cli/reports/law_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "core/base/number_text.hpp"
#include "core/scene/shown_unit.hpp"
#include "core/scene/time_breaks.hpp"

namespace pleuel {

double LawPoints::lowest() const {
  return *std::min_element(values.begin(), values.end());
}

double LawPoints::highest() const {
  return *std::max_element(values.begin(), values.end());
}

LawPoints law_points(const TimeFunction& function, double end_time, const Design<double>& design,
                     LawOf purpose) {
  constexpr int points = 240;
  const TimeLaw<double> law = resolve_time_law(function, design, purpose);
  std::set<double> instants;
  for (int i = 0; i <= points; ++i) instants.insert(end_time * i / points);
  for (const double knot : sharp_times(function, end_time)) {
    const double before = std::nextafter(knot, 0.0);
    if (before >= 0.0 && knot <= end_time)
      instants.insert({before, knot, std::nextafter(knot, 1e9)});
  }
  LawPoints curve;
  for (const double instant : instants) {
    curve.times.push_back(instant);
    curve.values.push_back(law.at(instant).value);
  }
  return curve;
}

std::string range_text(const LawPoints& points, const std::string& si) {
  ShownUnit unit = engineering_unit(si);
  if (si == "rad") unit = {si, "°", std::numbers::pi / 180.0};
  const double low = unit.shown(points.lowest()), high = unit.shown(points.highest());
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-9 * size) return fmt::format("{} {}", significant(high, 4), unit.name);
  const auto text = [&](double value) {
    return std::abs(value) <= 1e-9 * size ? std::string("0") : significant(value, 4);
  };
  return fmt::format("{} … {} {}", text(low), text(high), unit.name);
}

}  // namespace pleuel
