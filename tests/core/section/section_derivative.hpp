#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/dual.hpp"
#include "core/section/section_properties.hpp"

namespace pleuel::test {

/// The derivatives of all properties by each size, dual numbers against the complex step.
/// @param make  from std::vector<Scalar> of sizes to SectionProperties<Scalar>, for any scalar
/// 1e-13: the two do the same operations in another order; no difference is formed in either.
void expect_derivatives_of_the_complex_step(const auto& make, const std::vector<double>& sizes) {
  using Complex = std::complex<double>;
  constexpr double tiny = 1e-40;
  const auto expect_same = [](const Dual& dual, const Complex& step, const char* what) {
    const double expected = step.imag() / tiny;
    EXPECT_NEAR(derivative_of(dual), expected, 1e-13 * std::abs(expected) + 1e-300) << what;
  };
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    SCOPED_TRACE(i);
    std::vector<Complex> complex_sizes(sizes.begin(), sizes.end());
    std::vector<Dual> dual_sizes(sizes.begin(), sizes.end());
    complex_sizes[i] += Complex(0, tiny);
    dual_sizes[i].derivatives()[0] = 1.0;
    const SectionProperties<Complex> step = make(complex_sizes);
    const SectionProperties<Dual> dual = make(dual_sizes);
    expect_same(dual.area, step.area, "area");
    expect_same(dual.inertia_y, step.inertia_y, "inertia_y");
    expect_same(dual.inertia_z, step.inertia_z, "inertia_z");
    expect_same(dual.torsion, step.torsion, "torsion");
    expect_same(dual.radius_y, step.radius_y, "radius_y");
    expect_same(dual.radius_z, step.radius_z, "radius_z");
    ASSERT_EQ(dual.points.size(), step.points.size());
    for (std::size_t k = 0; k < dual.points.size(); ++k) {
      expect_same(dual.points[k].y, step.points[k].y, "y");
      expect_same(dual.points[k].z, step.points[k].z, "z");
      expect_same(dual.points[k].shear, step.points[k].shear, "shear");
    }
  }
}

/// The first three moments of an area by the midpoint rule on n × n cells of the rectangle that
/// contains it.
struct AreaMoments {
  double area = 0.0, yy = 0.0, zz = 0.0;

  AreaMoments(double width, double height, int n, const auto& is_inside) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double y = ((i + 0.5) / n - 0.5) * height, z = ((j + 0.5) / n - 0.5) * width;
        if (!is_inside(y, z)) continue;
        area += 1.0;
        yy += y * y;
        zz += z * z;
      }
    }
    const double cell = width * height / n / n;
    area *= cell;
    yy *= cell;
    zz *= cell;
  }
};

}  // namespace pleuel::test
