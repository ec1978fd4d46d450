#include <cstdio>
#include <fstream>
#include <map>

#include <nlohmann/json.hpp>

#include "core/model/resolve_beam.hpp"
#include "core/model/scene_geometry.hpp"
#include "core/scene/visit_numbers.hpp"
#include "tests/support/files.hpp"
#include "tests/support/test.hpp"

namespace pleuel::test::resolve_section_test {
namespace {

Number doubled(int variable) {
  return Number::bound(variable, 2.0);
}

/// One of every kind, all its numbers bound to the variables 0, 1, …
std::vector<Section> bound_sections() {
  const auto x = [](int i) { return Number::bound(i); };
  return {RectangleSection{x(0), x(1)},
          CircleSection{x(0)},
          TubeSection{x(0), x(2)},
          EllipseSection{x(0), x(1)},
          BoxSection{x(0), x(1), x(2)},
          ISection{x(0), x(1), x(2), doubled(2)},
          GeneralSection{x(0), x(1), x(2), x(3), {{0.01, 0.02, 3.0}}}};
}

const Design<double> design = {0.03, 0.05, 0.004, 0.02};

void expect_derivative(const Dual& dual, double more, double less, double step) {
  const double difference = (more - less) / (2 * step);
  // Central differences with 1e-6 of x: truncation 1e-12, round-off 1e-10 of the value over x.
  EXPECT_NEAR(derivative_of(dual), difference, 1e-8 * std::abs(difference) + 1e-9 * value_of(dual));
}

TEST(ResolvedSection, DependsOnItsVariablesAndOnNoOthers) {
  for (const Section& section : bound_sections()) {
    SCOPED_TRACE(section.index());
    std::set<int> bound;
    visit_numbers(section, [&](const Number& number) {
      if (number.is_bound()) bound.insert(number.variable);
    });
    for (int i = 0; i < static_cast<int>(design.size()); ++i) {
      const auto k = static_cast<std::size_t>(i);
      Design<Dual> seeded(design.begin(), design.end());
      seeded[k].derivatives()[0] = 1.0;
      Design<double> more = design, less = design;
      const double step = 1e-6 * design[k];
      more[k] += step;
      less[k] -= step;
      const auto dual = resolve_section(section, seeded);
      const auto upper = resolve_section(section, more), lower = resolve_section(section, less);
      expect_derivative(dual.area, upper.area, lower.area, step);
      expect_derivative(dual.inertia_y, upper.inertia_y, lower.inertia_y, step);
      expect_derivative(dual.inertia_z, upper.inertia_z, lower.inertia_z, step);
      expect_derivative(dual.torsion, upper.torsion, lower.torsion, step);
      const double change =
          std::abs(derivative_of(dual.area)) + std::abs(derivative_of(dual.inertia_y)) +
          std::abs(derivative_of(dual.inertia_z)) + std::abs(derivative_of(dual.torsion));
      EXPECT_EQ(change > 0.0, bound.count(i) == 1) << i;
    }
  }
}

/// Each about the right axis: height lies along y.
TEST(ResolvedSection, IsStifferAlongItsHeight) {
  for (const Section& section : bound_sections()) {
    const auto properties = resolve_section(section, design);
    const bool is_round = std::holds_alternative<CircleSection>(section) ||
                          std::holds_alternative<TubeSection>(section);
    const bool is_general = std::holds_alternative<GeneralSection>(section);
    if (is_round || is_general) continue;
    EXPECT_GT(properties.inertia_z, properties.inertia_y) << section.index();
    EXPECT_EQ(properties.points.front().y,
              std::holds_alternative<EllipseSection>(section) ? properties.radius_y : 0.05 / 2)
        << section.index();
  }
}

TEST(ResolvedSection, OfGivenNumbersIsThoseNumbers) {
  const GeneralSection given{1e-4, 2e-8, 3e-8, 4e-8, {{0.01, -0.02, 5.0}, {0.0, 0.03, 6.0}}};
  const auto section = resolve_section<double>(given, {});
  EXPECT_EQ(section.area, 1e-4);
  EXPECT_EQ(section.inertia_y, 2e-8);
  EXPECT_EQ(section.inertia_z, 3e-8);
  EXPECT_EQ(section.torsion, 4e-8);
  EXPECT_FALSE(section.is_round());
  ASSERT_EQ(section.points.size(), 2U);
  EXPECT_EQ(section.points[0].y, 0.01);
  EXPECT_EQ(section.points[0].z, -0.02);
  EXPECT_EQ(section.points[1].shear, 6.0);
}

double square_centimetres(const nlohmann::json& text) {
  return std::stod(text.get<std::string>()) * 1e-4;
}

/// Web and flange [mm] of EN 10365.
const std::map<std::string, std::pair<double, double>> thicknesses = {
    {"IPE 80", {3.8, 5.2}},  {"IPE 100", {4.1, 5.7}}, {"IPE 120", {4.4, 6.3}},
    {"IPE 140", {4.7, 6.9}}, {"IPE 160", {5.0, 7.4}}, {"IPE 180", {5.3, 8.0}},
    {"IPE 200", {5.6, 8.5}}};

/// The section of parts without fillets and corner radii.
Section plain_section(const std::string& name, const nlohmann::json& section) {
  if (const auto of = thicknesses.find(name); of != thicknesses.end()) {
    const nlohmann::json& corner = section.at("points").at(0);
    const auto twice = [&](const char* key) {
      return 2e-3 * std::stod(corner.at(key).get<std::string>());
    };
    return ISection{twice("z"), twice("y"), 1e-3 * of->second.second, 1e-3 * of->second.first};
  }
  double height = 0.0, width = 0.0, wall = 0.0;
  EXPECT_EQ(std::sscanf(name.c_str() + 4, "%lfx%lfx%lf", &height, &width, &wall), 3) << name;
  return BoxSection{1e-3 * width, 1e-3 * height, 1e-3 * wall};
}

/// Four digits of the catalogue, with Poisson's ratio of steel.
TEST(Catalogue, HasTheShearAreasOfItsShapes) {
  std::ifstream stream(std::string(source_folder()) + "/problems/catalogue.json");
  const nlohmann::json catalogue = nlohmann::json::parse(stream);
  int count = 0;
  for (const auto& [name, section] : catalogue.at("sections").items()) {
    if (section.at("type") != "general") continue;
    SectionProperties<double> properties{};
    properties.area = square_centimetres(section.at("area"));
    const ShearArea<double> expected =
        shear_area(plain_section(name, section), properties, 0.3, Design<double>());
    EXPECT_NEAR(square_centimetres(section.at("shear_area_y")) / expected.along_y, 1.0, 5e-4)
        << name;
    EXPECT_NEAR(square_centimetres(section.at("shear_area_z")) / expected.along_z, 1.0, 5e-4)
        << name;
    ++count;
  }
  EXPECT_EQ(count, 20);
}

}  // namespace
}  // namespace pleuel::test::resolve_section_test
