#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/expression.hpp"
#include "core/scene/problem_reader.hpp"
#include "tests/scene/good_problem.hpp"
#include "tests/support/files.hpp"
#include "tests/support/parameter_name.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::catalogue_test {
namespace {

// The shipped catalogue against the geometry of its shapes.

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

// Sizes and sections that are chosen from lists.

using Json = nlohmann::ordered_json;

const std::string file = source_folder() + "/problems/any.json";

/// A beam with a section, and a variable.
Json beam_document(const std::string& section, const std::string& variable) {
  return Json::parse(R"({"scene": {"catalogue": "catalogue.json", "bodies": {"beam": {
    "type": "beam", "from": [0, 0, 0], "to": [1, 0, 0], "material": "steel", "elements": 1, "section": )" +
                     section +
                     R"(}}, "joints": {"wall": {"type": "fixed", "bodies": ["ground", "beam"],
    "at": [0, 0, 0]}}}, "simulation": {"end_time": 1, "step": 1},
    "variables": {"size": )" +
                     variable + "}}");
}

ProblemFile read(const Json& document) {
  return read_problem_text(document.dump(), file).complete();
}

std::string complaint_about(const Json& document) {
  return thrown<InputError>([&] { read(document); });
}

const std::string circle = R"({"type": "circle", "diameter": {"variable": "size"}})";

std::vector<double> values_of(const DesignVariable& variable) {
  std::vector<double> values;
  for (const SizeChoice& choice : variable.choices) values.push_back(choice.value);
  return values;
}

TEST(Choices, AreInAscendingOrderEachOnce) {
  const auto problem =
      read(beam_document(circle, R"({"choices": ["30 mm", "2 cm", 0.025, "20 mm"]})"));
  const DesignVariable& size = problem.variables.front();
  EXPECT_THAT(values_of(size), ElementsAre(0.02, 0.025, 0.03));
  EXPECT_EQ(size.choices[0].text, "2 cm");
  EXPECT_EQ(size.lower, 0.02);
  EXPECT_EQ(size.upper, 0.03);
  EXPECT_EQ(size.start, 0.025);  // in the middle
  EXPECT_EQ(size.unit, "mm");
}

TEST(Choices, MayHaveAStartAmongThem) {
  const auto start_of = [](const std::string& start) {
    return beam_document(circle, R"({"choices": ["20 mm", "30 mm"], "start": ")" + start + "\"}");
  };
  EXPECT_EQ(read(start_of("30 mm")).variables.front().start, 0.03);
  EXPECT_THAT(complaint_about(start_of("25 mm")),
              HasSubstr("/variables/size/start must be one of the choices, got \"25 mm\""));
}

TEST(Choices, HaveNoBounds) {
  EXPECT_THAT(complaint_about(beam_document(circle, R"({"choices": [1], "lower": 1})")),
              HasSubstr("/variables/size has the unknown key \"lower\""));
  EXPECT_THAT(complaint_about(beam_document(circle, R"({"choices": []})")),
              HasSubstr("/variables/size/choices must have at least one choice"));
  EXPECT_THAT(complaint_about(beam_document(circle, R"({"choices": ["-2 mm", "3 mm"]})")),
              HasSubstr("must be positive"));
}

TEST(Choices, OfSectionsAreSortedByArea) {
  const auto problem = read(beam_document(
      R"({"variable": "size"})",
      R"({"choices": ["CHS 42.4x2.6", "CHS 26.9x2.3", "CHS 33.7x2.6"], "start": "CHS 42.4x2.6"})"));
  const DesignVariable& size = problem.variables.front();
  EXPECT_EQ(size.start, 2.0);
  EXPECT_EQ(size.lower, 0.0);
  EXPECT_EQ(size.upper, 2.0);
  ASSERT_EQ(size.choices.size(), 3u);
  EXPECT_EQ(size.choices[0].text, "CHS 26.9x2.3");
  EXPECT_EQ(size.choices[1].text, "CHS 33.7x2.6");
}

TEST(Choices, OfSectionsAreThoseOfTheCatalogueAtWholeNumbers) {
  const std::vector<std::string> names = {"IPE 80", "IPE 100", "IPE 120"};
  const auto chosen = read(
      beam_document(R"({"variable": "size"})", R"({"choices": ["IPE 80", "IPE 100", "IPE 120"]})"));
  const auto section_of = [](const ProblemFile& problem) {
    return std::get<GeneralSection>(
        std::get<BeamBody>(problem.scene.bodies[0].shape).segments[0].section);
  };
  const GeneralSection path = section_of(chosen);
  for (std::size_t i = 0; i < names.size(); ++i) {
    Json document = beam_document(R"({"catalogue": ")" + names[i] + "\"}", "{}");
    document.erase("variables");
    const GeneralSection entry = section_of(read(document));
    const Design<double> at = {static_cast<double>(i)};
    EXPECT_EQ(resolve(path.area, at), entry.area.constant);
    EXPECT_EQ(resolve(path.inertia_y, at), entry.inertia_y.constant);
    EXPECT_EQ(resolve(path.inertia_z, at), entry.inertia_z.constant);
    EXPECT_EQ(resolve(path.torsion, at), entry.torsion.constant);
    ASSERT_EQ(path.points.size(), entry.points.size());
    for (std::size_t k = 0; k < entry.points.size(); ++k) {
      EXPECT_EQ(resolve(path.points[k].y, at), entry.points[k].y.constant);
      EXPECT_EQ(resolve(path.points[k].z, at), entry.points[k].z.constant);
      EXPECT_EQ(resolve(path.points[k].shear, at), entry.points[k].shear.constant);
    }
  }
}

TEST(Choices, OfSectionsSayWhatIsWrong) {
  const std::string section = R"({"variable": "size"})";
  EXPECT_THAT(complaint_about(beam_document(section, R"({"choices": ["CHS 26.9"]})")),
              AllOf(HasSubstr("/variables/size/choices/0"), HasSubstr("CHS 26.9")));
  EXPECT_THAT(complaint_about(beam_document(section, R"({"choices": ["IPE 80", "SHS 20x20x2"]})")),
              HasSubstr("must be sections of one type"));
  EXPECT_THAT(
      complaint_about(beam_document(R"({"variable": "sise"})", R"({"choices": ["IPE 80"]})")),
      HasSubstr("did you mean \"size\""));
  Json without = beam_document(section, R"({"choices": ["IPE 80"]})");
  without["scene"].erase("catalogue");
  EXPECT_THAT(complaint_about(without), HasSubstr("/scene names none"));
}

TEST(ValuePath, GoesThroughItsValuesAndNeverLeavesThoseBesideIt) {
  const std::vector<double> values = {1.0, 1.5, 4.0, 4.0, 3.0, 9.0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(path_point(values, static_cast<double>(i)).value, values[i]);
  }
  for (double at = 0.0; at < 5.0; at += 0.01) {
    const auto i = static_cast<std::size_t>(at);
    const auto [low, high] = std::minmax(values[i], values[i + 1]);
    EXPECT_GE(path_point(values, at).value, low - 1e-12) << at;
    EXPECT_LE(path_point(values, at).value, high + 1e-12) << at;
  }
}

TEST(ValuePath, HasTheSlopeOfItsDifferences) {
  const std::vector<double> values = {1.0, 1.5, 4.0, 4.5, 3.0, 9.0};
  constexpr double step = 1e-6;
  for (const double at : {0.0, 0.4, 1.0, 1.7, 2.0, 3.3, 4.0, 4.9, 5.0}) {
    const double difference =
        (path_point(values, at + step).value - path_point(values, at - step).value) / (2.0 * step);
    EXPECT_NEAR(path_point(values, at).slope, difference, 1e-4) << at;  // second derivatives jump
  }
}

TEST(ValuePath, IsTheStraightLineThroughValuesOnOne) {
  for (const double at : {-0.5, 0.0, 0.3, 1.0, 2.6, 3.0, 3.5}) {
    EXPECT_NEAR(path_point({1.0, 3.0, 5.0, 7.0}, at).value, 1.0 + 2.0 * at, 1e-13);
    EXPECT_NEAR(path_point({1.0, 3.0, 5.0, 7.0}, at).slope, 2.0, 1e-13);
  }
  EXPECT_EQ(path_point({4.0}, 0.0).value, 4.0);
}

}  // namespace
}  // namespace pleuel::test::catalogue_test
