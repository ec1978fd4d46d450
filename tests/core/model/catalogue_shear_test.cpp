#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/model/resolve_beam.hpp"
#include "tests/support/source_folder.hpp"

namespace pleuel::test::catalogue_shear_test {
namespace {

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
}  // namespace pleuel::test::catalogue_shear_test
