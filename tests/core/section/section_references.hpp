#pragma once

#include <complex>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/base/dual.hpp"
#include "core/section/section_properties.hpp"
#include "tests/support/test.hpp"

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

/// Euler's theorem of homogeneous functions: a property that goes with the n-th power of all sizes
/// together has Σ sizeᵢ ∂p/∂sizeᵢ = n p. Area n = 2, second moments and torsion constant 4, places
/// 1, shear per torque −3. So dual numbers are compared with values that know no derivative. 1e-11:
/// a sum of terms of both signs.
void expect_derivatives_that_scale(const auto& make, const std::vector<double>& sizes) {
  std::vector<SectionProperties<Dual>> along;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    std::vector<Dual> dual_sizes(sizes.begin(), sizes.end());
    dual_sizes[i].derivatives()[0] = 1.0;
    along.push_back(make(dual_sizes));
  }
  const SectionProperties<double> value = make(sizes);
  const auto expect = [&](double power, double at, const auto& property, const char* what) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      EXPECT_NEAR(value_of(property(along[i])), at, 1e-14 * std::abs(at)) << what;
      sum += sizes[i] * derivative_of(property(along[i]));
    }
    EXPECT_NEAR(sum, power * at, 1e-11 * std::abs(at)) << what;
  };
  using Properties = SectionProperties<Dual>;
  expect(
      2, value.area, [](const Properties& s) { return s.area; }, "area");
  expect(
      4, value.inertia_y, [](const Properties& s) { return s.inertia_y; }, "inertia_y");
  expect(
      4, value.inertia_z, [](const Properties& s) { return s.inertia_z; }, "inertia_z");
  expect(
      4, value.torsion, [](const Properties& s) { return s.torsion; }, "torsion");
  expect(
      1, value.radius_y, [](const Properties& s) { return s.radius_y; }, "radius_y");
  expect(
      1, value.radius_z, [](const Properties& s) { return s.radius_z; }, "radius_z");
  for (std::size_t k = 0; k < value.points.size(); ++k) {
    const StressPoint<double>& point = value.points[k];
    expect(
        1, point.y, [&](const Properties& s) { return s.points[k].y; }, "y");
    expect(
        1, point.z, [&](const Properties& s) { return s.points[k].z; }, "z");
    expect(
        -3, point.shear, [&](const Properties& s) { return s.points[k].shear; }, "shear");
  }
}

/// Each derivative by central differences of the values over 1e-4 and 2e-4 of the size,
/// extrapolated: error (1e-4)⁴ of the fifth derivative and 1e-16/1e-4 of round-off.
void expect_derivatives_of_differences(const auto& make, const std::vector<double>& sizes) {
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    SCOPED_TRACE(i);
    std::vector<Dual> dual_sizes(sizes.begin(), sizes.end());
    dual_sizes[i].derivatives()[0] = 1.0;
    const SectionProperties<Dual> dual = make(dual_sizes);
    const auto at = [&](double change) {
      std::vector<double> changed = sizes;
      changed[i] += change;
      return make(changed);
    };
    const double h = 1e-4 * sizes[i];
    const auto more = at(h), less = at(-h), far = at(2 * h), back = at(-2 * h);
    const auto expect = [&](const auto& property, const char* what) {
      const double narrow = (property(more) - property(less)) / (2 * h);
      const double wide = (property(far) - property(back)) / (4 * h);
      const double size = std::abs(value_of(property(dual))) / sizes[i];
      EXPECT_NEAR(derivative_of(property(dual)), (4 * narrow - wide) / 3, 1e-10 * size) << what;
    };
    expect([](const auto& s) { return s.area; }, "area");
    expect([](const auto& s) { return s.inertia_y; }, "inertia_y");
    expect([](const auto& s) { return s.inertia_z; }, "inertia_z");
    expect([](const auto& s) { return s.torsion; }, "torsion");
    for (std::size_t k = 0; k < dual.points.size(); ++k) {
      expect([&](const auto& s) { return s.points[k].y; }, "y");
      expect([&](const auto& s) { return s.points[k].z; }, "z");
      expect([&](const auto& s) { return s.points[k].shear; }, "shear");
    }
  }
}

/// By all three: the complex step goes through the same template; the others know values only.
void expect_right_derivatives(const auto& make, const std::vector<double>& sizes) {
  expect_derivatives_of_the_complex_step(make, sizes);
  expect_derivatives_that_scale(make, sizes);
  expect_derivatives_of_differences(make, sizes);
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

/// An independent solution of Saint-Venant's torsion problem, to compare formulas with.

namespace pleuel::test {

/// What fills a cell of the grid.
enum class Fill { nothing, solid, hole };

/// Prandtl's stress function of a doubly symmetric section,
///     ∇²φ = −2 in the solid, φ = 0 on the outer boundary, φ constant over a hole,
///     J = 2 ∫φ dA (holes included), shear stress per torque at the boundary −(∂φ/∂n)/J,
/// by bilinear finite elements on the quarter y, z ≥ 0. The energy is minimal over the functions of
/// the grid, so that J is approached from below. Timoshenko & Goodier, Theory of Elasticity,
/// §§104–107, 115.
class SaintVenant {
 public:
  /// @param y, z  lines of the grid, ascending from 0; the last ones bound the section.
  /// @param fill  of the cell with this middle (y, z).
  SaintVenant(std::vector<double> y, std::vector<double> z,
              const std::function<Fill(double, double)>& fill);

  double constant() const { return constant_; }  ///< J [m⁴]

  /// Shear per torque on the side y = last line, by the second-order one-sided difference.
  double shear_at_top(double z) const;
  double shear_at_side(double y) const;  ///< on the side z = last line

 private:
  static Eigen::Index nearest(const std::vector<double>& lines, double place);

  std::vector<double> y_, z_;
  Eigen::MatrixXd phi_;
  double constant_ = 0.0;
};

struct GridStretch {
  double end;
  int cells;
};

/// Lines from 0 over the ends of the stretches, each evenly divided.
std::vector<double> grid_lines(const std::vector<GridStretch>& stretches);

/// The limit of values on grids of n, 2n and 4n cells, with the order that they show.
double extrapolated(double coarse, double middle, double fine);

}  // namespace pleuel::test
