#include "core/section/box_section.hpp"
#include "core/section/i_section.hpp"
#include "core/section/rectangle_section.hpp"
#include "tests/core/section/section_references.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::thin_section_test {
namespace {

constexpr double width = 1.0;

/// `cells` across the wall.
SaintVenant solve_box(double height, double thickness, int cells) {
  const auto along = [&](double length) {
    return std::max(cells / 2, static_cast<int>(cells * std::min(length / thickness, 10.0)));
  };
  const double y = height / 2 - thickness, z = width / 2 - thickness;
  return SaintVenant(grid_lines({{y, along(y)}, {height / 2, cells}}),
                     grid_lines({{z, along(z)}, {width / 2, cells}}), [=](double cy, double cz) {
                       return cy < y && cz < z ? Fill::hole : Fill::solid;
                     });
}

struct Box {
  double height, thickness;
};

void PrintTo(const Box& box, std::ostream* stream) {
  *stream << "1 × " << box.height << " × " << box.thickness;
}

class BoxTorsionOf : public testing::TestWithParam<Box> {
 protected:
  Box box_ = GetParam();
  BoxTorsion<double> torsion_ = box_torsion(width, box_.height, box_.thickness);
};

/// Extrapolated to the limit of the grid, the reference is good to about 2e-5 (seen by refining
/// further). The accuracies are those that the formula's comment promises.
TEST_P(BoxTorsionOf, ConstantIsThatOfFiniteElements) {
  const auto constant = [&](int cells) {
    return solve_box(box_.height, box_.thickness, cells).constant();
  };
  const double expected = extrapolated(constant(8), constant(16), constant(32));
  const double accuracy = box_.thickness <= 0.25 ? 1.2e-4 : 0.013;
  EXPECT_NEAR(torsion_.constant / expected, 1.0, accuracy);
}

TEST_P(BoxTorsionOf, ShearOfTheWallsIsThatOfFiniteElementsOrLarger) {
  const SaintVenant reference = solve_box(box_.height, box_.thickness, 32);
  const double longer = torsion_.shear / reference.shear_at_side(0.0);
  const double shorter = torsion_.shear / reference.shear_at_top(0.0);
  const double excess = box_.thickness <= 0.2 ? 0.006 : 0.27;
  for (const double ratio : {longer, shorter}) {
    EXPECT_GT(ratio, 0.994);
    EXPECT_LT(ratio, 1.0 + excess);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, BoxTorsionOf,
                         testing::Values(Box{1.0, 0.05}, Box{1.0, 0.1}, Box{1.0, 0.2},
                                         Box{1.0, 0.25}, Box{1.0, 0.35}, Box{1.0, 0.45},
                                         Box{1.5, 0.1}, Box{1.5, 0.25}, Box{1.5, 0.45},
                                         Box{2.0, 0.05}, Box{2.0, 0.2}, Box{2.0, 0.4},
                                         Box{4.0, 0.1}, Box{4.0, 0.25}, Box{4.0, 0.49}),
                         named_as_printed());

/// The reference itself: the series of the rectangle, which the table of Timoshenko & Goodier
/// confirms. 3e-5: extrapolation from 10, 20 and 40 cells.
TEST(SaintVenantReference, IsTheSeriesOfTheRectangle) {
  const auto constant = [](int cells) {
    return SaintVenant(grid_lines({{1.0, cells}}), grid_lines({{0.5, cells}}),
                       [](double, double) { return Fill::solid; })
        .constant();
  };
  const RectangleTorsion<double> series = rectangle_torsion(2.0, 1.0);
  EXPECT_NEAR(extrapolated(constant(10), constant(20), constant(40)) / series.constant, 1.0, 3e-5);
  const SaintVenant solution(grid_lines({{1.0, 80}}), grid_lines({{0.5, 40}}),
                             [](double, double) { return Fill::solid; });
  EXPECT_NEAR(solution.shear_at_side(0.0) / series.longer_shear, 1.0, 1e-3);  // O(h²)
  EXPECT_NEAR(solution.shear_at_top(0.0) / series.shorter_shear, 1.0, 1e-3);
}

/// Bredt: J → 4 A_m² t/U and shear → 1/(2 A_m t). The corners take a share of order t/U.
TEST(BoxSection, WithThinWallsFollowsBredt) {
  const double height = 1.7, t = 1e-4;
  const double area = (width - t) * (height - t), perimeter = 2 * (width + height - 2 * t);
  const auto torsion = box_torsion(width, height, t);
  EXPECT_NEAR(torsion.constant / (4 * area * area * t / perimeter), 1.0, 2 * t / perimeter);
  EXPECT_NEAR(torsion.shear * 2 * area * t, 1.0, 4 * t);
}

TEST(BoxSection, WithoutAHoleIsTheRectangle) {
  const auto expect_near = [](double value, double expected) {
    EXPECT_NEAR(value, expected, 1e-14 * expected);
  };
  for (double height : {1.0, 1.6, 3.0}) {
    const auto box = box_section(width, height, width / 2);
    const auto rectangle = rectangle_section(width, height);
    expect_near(box.area, rectangle.area);
    expect_near(box.inertia_y, rectangle.inertia_y);
    expect_near(box.inertia_z, rectangle.inertia_z);
    EXPECT_NEAR(box.torsion / rectangle.torsion, 1.0, 0.013);  // the comment of box_torsion
  }
}

TEST(BoxSection, SecondMomentsAreTheIntegralsOverItsArea) {
  const double w = 0.03, h = 0.05, t = 0.005;  // of which the grid of 600 lines cuts no cell
  const AreaMoments sum(w, h, 600, [&](double y, double z) {
    return std::abs(y) > h / 2 - t || std::abs(z) > w / 2 - t;
  });
  const auto section = box_section(w, h, t);
  EXPECT_NEAR(section.area / sum.area, 1.0, 1e-12);    // a sum of 360000 cells
  EXPECT_NEAR(section.inertia_z / sum.yy, 1.0, 1e-5);  // midpoint rule: O(1/n²)
  EXPECT_NEAR(section.inertia_y / sum.zz, 1.0, 1e-5);
}

/// 30 × 50 mm outside, 20 × 40 mm inside: A = 700 mm², I_z = (30·50³ − 20·40³)/12 mm⁴, I_y =
/// (50·30³ − 40·20³)/12 mm⁴. Bredt with the middle line of 25 × 45 mm and the walls as strips of
/// their own (Timoshenko & Goodier, §117): J = 4 · 1125² · 5/140 + 140 · 5³/3 mm⁴, shear 1/(2 ·
/// 1125 · 5) + 5/J per mm³; corners add some percent where walls are as thick.
TEST(BoxSection, HasTheValuesOfHandCalculationAndStressInItsOuterCorners) {
  const double mm = 1e-3;
  const auto section = box_section(30 * mm, 50 * mm, 5 * mm);
  EXPECT_NEAR(section.area / (mm * mm), 700.0, 1e-9);
  EXPECT_NEAR(section.inertia_z / std::pow(mm, 4), (30 * 125000.0 - 20 * 64000.0) / 12, 1e-6);
  EXPECT_NEAR(section.inertia_y / std::pow(mm, 4), (50 * 27000.0 - 40 * 8000.0) / 12, 1e-6);
  const double torsion = 4 * 1125.0 * 1125.0 * 5 / 140 + 140 * 125.0 / 3;
  EXPECT_NEAR(section.torsion / std::pow(mm, 4) / torsion, 1.0, 0.06);
  ASSERT_EQ(section.points.size(), 4u);
  double y = 0.0, z = 0.0, yz = 0.0;
  for (const auto& point : section.points) {
    EXPECT_NEAR(std::abs(point.y), 25 * mm, 1e-15);
    EXPECT_NEAR(std::abs(point.z), 15 * mm, 1e-15);
    EXPECT_NEAR(point.shear * std::pow(mm, 3) / (1.0 / (2 * 1125 * 5) + 5 / torsion), 1.0, 0.04);
    y += point.y;
    z += point.z;
    yz += point.y * point.z;
  }
  // One in each corner.
  EXPECT_NEAR(y, 0.0, 1e-15);
  EXPECT_NEAR(z, 0.0, 1e-15);
  EXPECT_NEAR(yz, 0.0, 1e-15);
}

TEST(BoxSection, TurnsWithItsSides) {
  const auto one = box_section(0.012, 0.031, 0.002), other = box_section(0.031, 0.012, 0.002);
  EXPECT_NEAR(one.inertia_y, other.inertia_z, 1e-14 * one.inertia_y);
  EXPECT_NEAR(one.torsion, other.torsion, 1e-14 * one.torsion);
  EXPECT_EQ(one.points.front().y, other.points.front().z);
}

TEST(BoxSection, DerivativesAreThoseOfTheComplexStepAndOfDifferences) {
  expect_right_derivatives([](const auto& size) { return box_section(size[0], size[1], size[2]); },
                           {0.022, 0.035, 0.003});
}

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
}  // namespace pleuel::test::thin_section_test
