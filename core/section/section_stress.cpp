#include "core/section/section_stress.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace pleuel {
namespace {

/// g = σ² + 3τ² along the outline; its derivatives by the angle.
class SquaredStress {
 public:
  explicit SquaredStress(const OutlineStress& stress)
      : stress_(stress),
        shear_(3.0 * (stress.shear_z * stress.shear_z - stress.shear_y * stress.shear_y)) {}

  /// Up to a constant.
  double value(double theta) const {
    const double s = std::sin(theta), normal = sigma(theta);
    return normal * normal + shear_ * s * s;
  }
  double slope(double theta) const {
    return 2.0 * sigma(theta) * sigma_slope(theta) + shear_ * std::sin(2.0 * theta);
  }
  double curvature(double theta) const {
    const double normal = sigma(theta), change = sigma_slope(theta);
    return 2.0 * (change * change - normal * (normal - stress_.axial)) +
           2.0 * shear_ * std::cos(2.0 * theta);
  }

 private:
  double sigma(double theta) const {
    return stress_.axial + stress_.bending_y * std::cos(theta) +
           stress_.bending_z * std::sin(theta);
  }
  double sigma_slope(double theta) const {
    return stress_.bending_z * std::cos(theta) - stress_.bending_y * std::sin(theta);
  }

  OutlineStress stress_;
  double shear_;
};

/// The zero of the falling slope between two angles, by Newton's method with bisection as a net.
double stationary_angle(const SquaredStress& squared, double low, double high, double theta) {
  for (int iteration = 0; iteration < 60 && high - low > 1e-15; ++iteration) {
    const double slope = squared.slope(theta), curvature = squared.curvature(theta);
    (slope > 0.0 ? low : high) = theta;
    const double newton = theta - slope / curvature;
    const bool is_inside = curvature < 0.0 && newton > low && newton < high;
    const double next = is_inside ? newton : 0.5 * (low + high);
    if (std::abs(next - theta) < 1e-15) return next;
    theta = next;
  }
  return theta;
}

}  // namespace

double angle_of_largest_stress(const OutlineStress& stress, bool where_bending_pulls) {
  constexpr double pi = std::numbers::pi;
  const double bending =
      std::atan2(stress.bending_z, stress.bending_y) + (where_bending_pulls ? 0.0 : pi);
  if (std::abs(stress.shear_y) == std::abs(stress.shear_z)) return bending;
  // Two maxima on the half at most: every hump of a grid is climbed.
  constexpr int cells = 16;
  const SquaredStress squared(stress);
  std::array<double, cells + 1> angles, heights;
  for (std::size_t i = 0; i <= cells; ++i) {
    angles[i] = bending + pi * (static_cast<double>(i) / cells - 0.5);
    heights[i] = squared.value(angles[i]);
  }
  double best = bending;
  for (std::size_t i = 0; i <= cells; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min<std::size_t>(i + 1, cells);
    if (heights[i] < std::max(heights[before], heights[after])) continue;
    const double top = stationary_angle(squared, angles[before], angles[after], angles[i]);
    if (squared.value(top) > squared.value(best)) best = top;
  }
  return best;
}

}  // namespace pleuel
