#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/source_folder.hpp"

/// The shipped catalogue against the geometry of its shapes.
namespace pleuel::test::catalogue_test {
namespace {

using std::numbers::pi;

template <class Shape>
Shape find_section(const std::string& name) {
  Json document = edited("/scene/bodies/crank/section", "{}");
  document["scene"]["bodies"]["crank"]["section"]["catalogue"] = name;
  document["scene"]["catalogue"] = "catalogue.json";
  const ProblemFile problem =
      read_problem_text(document.dump(), source_folder() + "/problems/any.json").complete();
  return std::get<Shape>(std::get<BeamBody>(problem.scene.bodies[0].shape).segments[0].section);
}

/// EN 10365: sizes in mm, and the torsion constant in cm⁴.
struct Ipe {
  double height, width, web, flange, fillet, torsion;
};

void PrintTo(const Ipe& ipe, std::ostream* stream) {
  *stream << "IPE " << ipe.height;
}

class IpeOfTheCatalogue : public testing::TestWithParam<Ipe> {};

/// Three rectangles and four fillets. Values are tabulated to three digits: 0.5 %.
TEST_P(IpeOfTheCatalogue, HasTheMomentsOfItsShape) {
  const auto [h, b, w, f, r, torsion] = GetParam();
  const auto section = find_section<GeneralSection>("IPE " + std::to_string(int(h)));
  const double fillet = (1 - pi / 4) * r * r;
  const double centroid = r * (10 - 3 * pi) / (12 - 3 * pi);  // from its square corner
  const double y = h / 2 - f - centroid, z = w / 2 + centroid;
  const double area = 2 * b * f + (h - 2 * f) * w + 4 * fillet;
  const double strong =
      (b * h * h * h - (b - w) * std::pow(h - 2 * f, 3)) / 12 + 4 * fillet * y * y;
  const double weak = (2 * f * b * b * b + (h - 2 * f) * w * w * w) / 12 + 4 * fillet * z * z;
  EXPECT_NEAR(section.area.constant / (area * 1e-6), 1.0, 0.005);
  EXPECT_NEAR(section.inertia_z.constant / (strong * 1e-12), 1.0, 0.005);
  EXPECT_NEAR(section.inertia_y.constant / (weak * 1e-12), 1.0, 0.005);
}

/// El Darwish & Johnston 1965; tables differ from it by up to 4 % for the smallest sizes.
TEST_P(IpeOfTheCatalogue, HasTheTorsionOfItsShape) {
  const auto [h, b, w, f, r, torsion] = GetParam();
  const auto section = find_section<GeneralSection>("IPE " + std::to_string(int(h)));
  const double alpha = -0.042 + 0.2204 * w / f + 0.1355 * r / f - 0.0865 * r * w / (f * f) -
                       0.0725 * w * w / (f * f);
  const double circle = ((f + r) * (f + r) + (r + 0.25 * w) * w) / (2 * r + f);
  const double constant = 2.0 / 3 * b * f * f * f + (h - 2 * f) * w * w * w / 3 +
                          2 * alpha * std::pow(circle, 4) - 0.42 * std::pow(f, 4);
  EXPECT_DOUBLE_EQ(section.torsion.constant, torsion * 1e-8);
  EXPECT_NEAR(section.torsion.constant / (constant * 1e-12), 1.0, 0.05);
  double largest = 0.0;
  for (const GeneralStressPoint& point : section.points) {
    EXPECT_DOUBLE_EQ(std::abs(point.y.constant), h / 2 * 1e-3);
    const double thickness = point.z.constant == 0.0 ? circle : f;  // shear = thickness/J
    EXPECT_NEAR(point.shear.constant * section.torsion.constant / (thickness * 1e-3), 1.0, 1e-3);
    largest = std::max(largest, std::abs(point.z.constant));
  }
  EXPECT_DOUBLE_EQ(largest, b / 2 * 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, IpeOfTheCatalogue,
    testing::Values(Ipe{80, 46, 3.8, 5.2, 5, 0.70}, Ipe{100, 55, 4.1, 5.7, 7, 1.20},
                    Ipe{120, 64, 4.4, 6.3, 7, 1.74}, Ipe{140, 73, 4.7, 6.9, 7, 2.45},
                    Ipe{160, 82, 5.0, 7.4, 9, 3.60}, Ipe{180, 91, 5.3, 8.0, 9, 4.79},
                    Ipe{200, 100, 5.6, 8.5, 12, 6.98}),
    named_as_printed());

/// EN 10219-2: height × width × wall in mm; corners of radius 2T outside, T inside.
struct Hollow {
  const char* name;
  double height, width, wall;
};

void PrintTo(const Hollow& hollow, std::ostream* stream) {
  *stream << hollow.name;
}

bool is_in_rounded(double y, double z, double height, double width, double radius) {
  const double dy = std::abs(y) - (height / 2 - radius), dz = std::abs(z) - (width / 2 - radius);
  if (dy > 0 && dz > 0) return dy * dy + dz * dz < radius * radius;
  return dy < radius && dz < radius;
}

class HollowOfTheCatalogue : public testing::TestWithParam<Hollow> {};

/// Midpoint rule on cells of 1/20 mm, of which the straight walls cut none; the corners make it
/// good to 3e-4, and values have four digits.
TEST_P(HollowOfTheCatalogue, HasTheMomentsOfItsShape) {
  const auto [name, h, b, t] = GetParam();
  const auto section = find_section<GeneralSection>(name);
  constexpr double size = 0.05;
  double area = 0.0, yy = 0.0, zz = 0.0;
  for (int i = 0; i * size < h; ++i) {
    for (int j = 0; j * size < b; ++j) {
      const double y = (i + 0.5) * size - h / 2, z = (j + 0.5) * size - b / 2;
      if (!is_in_rounded(y, z, h, b, 2 * t)) continue;
      if (is_in_rounded(y, z, h - 2 * t, b - 2 * t, t)) continue;
      area += 1.0;
      yy += y * y;
      zz += z * z;
    }
  }
  const double cell = size * size;
  EXPECT_NEAR(section.area.constant / (area * cell * 1e-6), 1.0, 1e-3);
  EXPECT_NEAR(section.inertia_z.constant / (yy * cell * 1e-12), 1.0, 1e-3);
  EXPECT_NEAR(section.inertia_y.constant / (zz * cell * 1e-12), 1.0, 1e-3);
}

/// Bredt's formulas on the mean line with round corners of 1.5T; the walls' own torsion and the
/// linear share of the shear stay out of it: (t/side)² and t/side of the whole.
TEST_P(HollowOfTheCatalogue, HasTheTorsionOfItsMeanLine) {
  const auto [name, h, b, t] = GetParam();
  const auto section = find_section<GeneralSection>(name);
  const double radius = 1.5 * t, slack = std::min(h, b) / t;
  const double area = (h - t) * (b - t) - (4 - pi) * radius * radius;
  const double perimeter = 2 * (h + b - 2 * t) - (8 - 2 * pi) * radius;
  EXPECT_NEAR(section.torsion.constant / (4 * area * area * t / perimeter * 1e-12), 1.0,
              3 / (slack * slack));
  ASSERT_EQ(section.points.size(), 4U);
  for (const GeneralStressPoint& point : section.points) {
    EXPECT_DOUBLE_EQ(std::abs(point.y.constant), h / 2 * 1e-3);
    EXPECT_DOUBLE_EQ(std::abs(point.z.constant), b / 2 * 1e-3);
    EXPECT_NEAR(point.shear.constant * 2 * area * t * 1e-9, 1.0, 2 / slack);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, HollowOfTheCatalogue,
    testing::Values(Hollow{"SHS 20x20x2", 20, 20, 2}, Hollow{"SHS 25x25x2", 25, 25, 2},
                    Hollow{"SHS 30x30x2", 30, 30, 2}, Hollow{"SHS 40x40x2", 40, 40, 2},
                    Hollow{"SHS 40x40x3", 40, 40, 3}, Hollow{"SHS 50x50x3", 50, 50, 3},
                    Hollow{"SHS 60x60x3", 60, 60, 3}, Hollow{"SHS 80x80x4", 80, 80, 4},
                    Hollow{"RHS 40x20x2", 40, 20, 2}, Hollow{"RHS 50x30x2", 50, 30, 2},
                    Hollow{"RHS 60x40x3", 60, 40, 3}, Hollow{"RHS 80x40x3", 80, 40, 3},
                    Hollow{"RHS 100x50x4", 100, 50, 4}),
    named_by(&Hollow::name));

/// Printed in the tables of EN 10219-2: A [cm²], I [cm⁴], I_t [cm⁴].
TEST(Catalogue, AgreesWithTheTablesOfTheStandard) {
  const auto square = find_section<GeneralSection>("SHS 40x40x3");
  EXPECT_NEAR(square.area.constant, 4.21e-4, 0.005e-4);
  EXPECT_NEAR(square.inertia_z.constant, 9.32e-8, 0.005e-8);
  EXPECT_NEAR(square.torsion.constant, 15.8e-8, 0.06e-8);
  const auto rectangle = find_section<GeneralSection>("RHS 60x40x3");
  EXPECT_NEAR(rectangle.area.constant, 5.41e-4, 0.005e-4);
  EXPECT_NEAR(rectangle.inertia_z.constant, 25.4e-8, 0.05e-8);
  EXPECT_NEAR(rectangle.inertia_y.constant, 13.4e-8, 0.05e-8);
  EXPECT_NEAR(rectangle.torsion.constant, 29.3e-8, 0.06e-8);
}

TEST(Catalogue, NamesOfTubesAndBarsAreTheirSizes) {
  const auto tube = find_section<TubeSection>("CHS 60.3x2.9");
  EXPECT_DOUBLE_EQ(tube.outer_diameter.constant, 0.0603);
  EXPECT_DOUBLE_EQ(tube.thickness.constant, 0.0029);
  EXPECT_DOUBLE_EQ(find_section<CircleSection>("round 16").diameter.constant, 0.016);
}

}  // namespace
}  // namespace pleuel::test::catalogue_test
