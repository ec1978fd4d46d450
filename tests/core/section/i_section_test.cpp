#include "core/section/i_section.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/section/saint_venant.hpp"
#include "tests/core/section/section_derivative.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::i_section_test {
namespace {

struct Sizes {
  double width, height, flange, web;
};

void PrintTo(const Sizes& s, std::ostream* stream) {
  *stream << s.width << " × " << s.height << ", flange " << s.flange << ", web " << s.web;
}

/// `cells` across the thinner wall.
SaintVenant solve_i(const Sizes& s, int cells) {
  const double thinner = std::min(s.flange, s.web);
  const auto along = [&](double length) {
    return static_cast<int>(cells * std::clamp(std::round(length / thinner), 1.0, 10.0));
  };
  const double y = s.height / 2 - s.flange, z = s.web / 2;
  return SaintVenant(
      grid_lines({{y, along(y)}, {s.height / 2, along(s.flange)}}),
      grid_lines({{z, along(z)}, {s.width / 2, along(s.width / 2 - z)}}),
      [=](double cy, double cz) { return cy > y || cz < z ? Fill::solid : Fill::nothing; });
}

class ITorsionOf : public testing::TestWithParam<Sizes> {
 protected:
  Sizes sizes_ = GetParam();
  ITorsion<double> torsion_ = i_torsion(sizes_.width, sizes_.height, sizes_.flange, sizes_.web);
};

/// 1e-3: these flanges stick out by four times their thickness. The reference, extrapolated,
/// is good to 1e-4.
TEST_P(ITorsionOf, ConstantIsThatOfFiniteElements) {
  const auto constant = [&](int cells) { return solve_i(sizes_, cells).constant(); };
  const double expected = extrapolated(constant(4), constant(8), constant(16));
  EXPECT_NEAR(torsion_.constant / expected, 1.0, 1e-3);
}

/// 0.6 %: fit of the bulge and O(h²) of the reference.
TEST_P(ITorsionOf, ShearOfTheFlangeIsThatOfFiniteElements) {
  const SaintVenant reference = solve_i(sizes_, 16);
  EXPECT_NEAR(torsion_.junction_shear / reference.shear_at_top(0.0), 1.0, 0.006);
  const double between = (sizes_.web + sizes_.width) / 4;  // the web, and the end of the flange
  EXPECT_NEAR(torsion_.flange_shear / reference.shear_at_top(between), 1.0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ITorsionOf,
                         testing::Values(Sizes{0.5, 1.0, 0.05, 0.015}, Sizes{0.5, 1.0, 0.05, 0.025},
                                         Sizes{0.5, 1.0, 0.05, 0.05}, Sizes{0.5, 1.0, 0.05, 0.1},
                                         Sizes{1.0, 1.0, 0.1, 0.05}, Sizes{1.0, 1.0, 0.1, 0.1},
                                         Sizes{1.0, 1.0, 0.1, 0.15}, Sizes{1.0, 0.5, 0.1, 0.08},
                                         Sizes{0.46, 0.8, 0.052, 0.038}),
                         named_as_printed());  // IPE 80 without its fillets

/// El Darwish & Johnston 1965 (also AISC Design Guide 9): an independent fit of the junction, for
/// fillets of any radius, here 0. Their own numbers have about this accuracy.
TEST(ISection, TorsionIsThatOfElDarwishAndJohnston) {
  const double b = 0.1, h = 0.2, f = 0.0085;
  for (double ratio : {0.5, 0.66, 0.8, 1.0}) {
    const double w = ratio * f, d = f + w * w / (4 * f);
    const double alpha = -0.042 + 0.2204 * ratio - 0.0725 * ratio * ratio;
    const double expected = 2.0 / 3 * b * f * f * f + (h - 2 * f) * w * w * w / 3 +
                            2 * alpha * std::pow(d, 4) - 0.42 * std::pow(f, 4);
    EXPECT_NEAR(i_section(b, h, f, w).torsion / expected, 1.0, 0.006) << ratio;
  }
}

TEST(ISection, SecondMomentsAreTheIntegralsOverItsArea) {
  const double w = 0.03, h = 0.06, f = 0.006, t = 0.003;  // the grid of 600 lines cuts no cell
  const AreaMoments sum(w, h, 600, [&](double y, double z) {
    return std::abs(y) > h / 2 - f || std::abs(z) < t / 2;
  });
  const auto section = i_section(w, h, f, t);
  EXPECT_NEAR(section.area / sum.area, 1.0, 1e-12);    // a sum of cells
  EXPECT_NEAR(section.inertia_z / sum.yy, 1.0, 1e-5);  // midpoint rule: O(1/n²)
  EXPECT_NEAR(section.inertia_y / sum.zz, 1.0, 1e-4);  // of a web of 60 cells
}

/// IPE 200 in EN 10365: h 200, b 100, web 5.6, flange 8.5, fillet r 12 mm; A = 28.48 cm²,
/// I_y = 1943 cm⁴, I_z = 142.4 cm⁴. The four fillets add (4 − π) r², 10/12 (1 − …) of the way out.
TEST(ISection, WithFilletsAddedIsTheTableOfTheStandard) {
  const double h = 0.2, f = 0.0085, web = 0.0056, r = 0.012, pi = std::numbers::pi;
  const auto section = i_section(0.1, h, f, web);
  const double fillet = (1 - pi / 4) * r * r;
  const double centroid = r * (10 - 3 * pi) / (12 - 3 * pi);  // of a fillet, from its square corner
  const double y = h / 2 - f - centroid, z = web / 2 + centroid;
  EXPECT_NEAR(section.area + 4 * fillet, 28.48e-4, 0.005e-4);
  // Their own second moments are 0.0075 r⁴ each: 4 · 1.6e-10 m⁴, less than half a last digit.
  EXPECT_NEAR(section.inertia_z + 4 * fillet * y * y, 1943e-8, 0.5e-8);
  EXPECT_NEAR(section.inertia_y + 4 * fillet * z * z, 142.4e-8, 0.11e-8);
}

/// I 100 × 200, flange 8.5, web 5.6 mm. The shear of torsion in a wall of thickness t is T t/J
/// (Timoshenko & Goodier, §112); the points are where bending about either axis is largest in each
/// wall: the corners of the flanges, the ends of the web, and the middles of the flanges.
TEST(ISection, HasPointsAtTheEndsOfItsWallsWithTheShearOfTheWalls) {
  const double b = 0.1, h = 0.2, f = 0.0085, w = 0.0056;
  const auto section = i_section(b, h, f, w);
  const auto points_at = [&](double y, double z) {
    std::vector<double> shears;
    for (const auto& point : section.points) {
      if (std::abs(std::abs(point.y) - y) < 1e-12 && std::abs(std::abs(point.z) - z) < 1e-12) {
        shears.push_back(point.shear);
      }
    }
    return shears;
  };
  const double torsion = section.torsion;
  const std::vector<double> corners = points_at(h / 2, b / 2), middles = points_at(h / 2, 0.0),
                            web = points_at(h / 2 - f, w / 2);
  ASSERT_EQ(corners.size(), 4u);
  ASSERT_EQ(middles.size(), 2u);
  ASSERT_EQ(web.size(), 4u);
  EXPECT_EQ(section.points.size(), 10u);
  for (const double shear : corners) EXPECT_NEAR(shear * torsion / f, 1.0, 1e-12);
  for (const double shear : web) EXPECT_NEAR(shear * torsion / w, 1.0, 1e-12);
  // Thicker where the web joins: between the flange alone and a wall of the inscribed circle.
  for (const double shear : middles) {
    EXPECT_GT(shear * torsion / f, 1.0);
    EXPECT_LT(shear * torsion / f, (f + w * w / (4 * f)) / f + 0.05);
  }
}

TEST(ISection, DerivativesAreThoseOfTheComplexStepAndOfDifferences) {
  expect_right_derivatives(
      [](const auto& size) { return i_section(size[0], size[1], size[2], size[3]); },
      {0.046, 0.08, 0.0052, 0.0038});
}

}  // namespace
}  // namespace pleuel::test::i_section_test
